"""Thirty ways to write exercise 3.2, as students who do not know each other would."""

import math

import numpy as np


def encode_1(ranges, bearing, distance, reach):
    borders = np.array([3, 7, 11, 15, 20, 25, 30]) / 30 * reach
    danger = 7 - np.searchsorted(borders, ranges, side="right")
    region = (np.round(np.degrees(bearing) / 40).astype(int) % 9) + 1
    seen = (distance <= reach).astype(int)
    return np.hstack([danger, region[:, None], seen[:, None]])


def encode_2(ranges, bearing, distance, reach):
    limits = [30, 25, 20, 15, 11, 7, 3]
    result = []
    for i in range(len(ranges)):
        row = []
        for r in ranges[i]:
            d = 0
            for limit in limits:
                if r < limit * reach / 30:
                    d += 1
            row.append(d)
        angle = math.degrees(bearing[i]) % 360
        region = int((angle + 20) // 40) + 1
        if region == 10:
            region = 1
        row.append(region)
        row.append(1 if distance[i] <= reach else 0)
        result.append(row)
    return np.array(result)


def encode_3(ranges, bearing, distance, reach):
    scaled = ranges * 30 / reach
    bins = np.array([3, 7, 11, 15, 20, 25, 30])
    danger = 7 - np.digitize(scaled.round(9), bins)
    sector = np.floor((np.rad2deg(bearing) + 20) / 40) % 9 + 1
    return np.column_stack((danger, sector, distance <= reach)).astype(int)


def encode_4(ranges, bearing, distance, reach):
    states = np.zeros((len(ranges), 11), dtype=int)
    for border in (3, 7, 11, 15, 20, 25, 30):
        states[:, :9] += ranges < border * reach / 30
    width = 2 * np.pi / 9
    states[:, 9] = np.mod(np.floor((bearing + width / 2) / width), 9) + 1
    states[distance <= reach, 10] = 1
    return states


def encode_5(ranges, bearing, distance, reach):
    def degree(x):
        for danger, top in zip((7, 6, 5, 4, 3, 2, 1), (3, 7, 11, 15, 20, 25, 30)):
            if x < top * reach / 30:
                return danger
        return 0

    def region(angle):
        while angle < -math.pi / 9:
            angle += 2 * math.pi
        while angle >= 2 * math.pi - math.pi / 9:
            angle -= 2 * math.pi
        return int((angle + math.pi / 9) / (2 * math.pi / 9)) + 1

    return [
        [*map(degree, row), region(b), int(d <= reach)]
        for row, b, d in zip(ranges, bearing, distance)
    ]


def encode_6(ranges, bearing, distance, reach):
    unit = reach / 30
    danger = np.select(
        [ranges < k * unit for k in (3, 7, 11, 15, 20, 25, 30)],
        [7, 6, 5, 4, 3, 2, 1],
        0,
    )
    turns = bearing / (2 * np.pi) * 9
    region = np.floor(turns + 0.5).astype(int)
    region = region - 9 * np.floor_divide(region, 9) + 1
    near = np.where(distance > reach, 0, 1)
    return np.concatenate([danger, np.stack([region, near], axis=1)], axis=1)


def encode_7(ranges, bearing, distance, reach):
    table = reach * np.array([0.1, 7 / 30, 11 / 30, 0.5, 2 / 3, 5 / 6, 1.0])
    out = np.empty((ranges.shape[0], 11), int)
    for n in range(ranges.shape[0]):
        for k in range(9):
            out[n, k] = np.count_nonzero(ranges[n, k] < table)
        degrees = np.degrees(bearing[n])
        out[n, 9] = np.floor((degrees + 20) / 40) % 9 + 1
        out[n, 10] = distance[n] <= reach
    return out


def encode_8(ranges, bearing, distance, reach):
    centres = np.radians(np.arange(9) * 40)
    off = bearing[:, None] - centres[None, :]
    apart = np.cos(off)
    region = np.argmax(apart, axis=1) + 1
    borders = np.array([3, 7, 11, 15, 20, 25, 30]) * reach / 30
    danger = np.zeros(ranges.shape, int)
    for level, border in enumerate(borders[::-1], start=1):
        danger[ranges < border] = level
    return np.c_[danger, region, (distance <= reach) * 1]


def encode_9(ranges, bearing, distance, reach):
    rows = []
    factor = reach / 30.0
    for readings, angle, dist in zip(
        ranges.tolist(), bearing.tolist(), distance.tolist()
    ):
        dangers = [
            sum(x < b * factor for b in (3, 7, 11, 15, 20, 25, 30)) for x in readings
        ]
        sector = math.floor(angle * 9 / (2 * math.pi) + 0.5) % 9
        rows.append(dangers + [sector + 1, int(dist <= reach)])
    return np.array(rows)


def encode_10(ranges, bearing, distance, reach):
    low = np.array([0, 3, 7, 11, 15, 20, 25]) * reach / 30
    high = np.array([3, 7, 11, 15, 20, 25, 30]) * reach / 30
    r = ranges[..., np.newaxis]
    inside = (r >= low) & (r < high)
    danger = (inside * np.arange(7, 0, -1)).sum(axis=-1)
    b = np.arctan2(np.sin(bearing), np.cos(bearing))
    region = np.rint(np.degrees(b) / 40).astype(int)
    region[region < 0] += 9
    return np.column_stack([danger, region + 1, distance <= reach])


def encode_11(ranges, bearing, distance, reach):
    percent = [0.1, 7 / 30, 11 / 30, 0.5, 20 / 30, 25 / 30, 1]
    danger = sum((ranges < p * reach).astype(int) for p in percent)
    positive = np.mod(bearing + np.deg2rad(20), 2 * np.pi)
    region = 1 + (positive // np.deg2rad(40)).astype(int)
    last = np.less_equal(distance, reach)
    return np.concatenate((danger, region.reshape(-1, 1), last.reshape(-1, 1)), axis=1)


def encode_12(ranges, bearing, distance, reach):
    N = len(bearing)
    danger = np.full((N, 9), 7)
    for edge in [3, 7, 11, 15, 20, 25, 30]:
        danger = danger - (ranges >= edge * reach / 30)
    edges = np.radians([20, 60, 100, 140, 180, 220, 260, 300, 340])
    turned = bearing % (2 * np.pi)
    region = np.array([np.sum(edges <= x) for x in turned])
    region = np.where(region == 9, 0, region) + 1
    return np.column_stack([danger, region, np.array(distance <= reach, dtype=int)])


def encode_13(ranges, bearing, distance, reach):
    number = ranges.shape[0]
    states = np.zeros((number, 11), dtype=int)
    scale = reach / 30.0
    for i in range(number):
        for sensor in range(9):
            reading = ranges[i, sensor]
            if reading < 3 * scale:
                states[i, sensor] = 7
            elif reading < 7 * scale:
                states[i, sensor] = 6
            elif reading < 11 * scale:
                states[i, sensor] = 5
            elif reading < 15 * scale:
                states[i, sensor] = 4
            elif reading < 20 * scale:
                states[i, sensor] = 3
            elif reading < 25 * scale:
                states[i, sensor] = 2
            elif reading < 30 * scale:
                states[i, sensor] = 1
            else:
                states[i, sensor] = 0
        degrees = bearing[i] * 180 / np.pi
        while degrees < 0:
            degrees += 360
        while degrees >= 360:
            degrees -= 360
        if degrees >= 340:
            states[i, 9] = 1
        else:
            states[i, 9] = int((degrees + 20) / 40) + 1
        if distance[i] <= reach:
            states[i, 10] = 1
    return states


def encode_14(ranges, bearing, distance, reach):
    from bisect import bisect_right

    borders = [b * reach / 30 for b in (3, 7, 11, 15, 20, 25, 30)]
    out = []
    for r, b, d in zip(ranges, bearing, distance):
        danger = [7 - bisect_right(borders, x) for x in r]
        turn = (b + math.pi / 9) % (2 * math.pi)
        out.append([*danger, 1 + int(turn * 9 / (2 * math.pi)), 1 if d <= reach else 0])
    return out


def encode_15(ranges, bearing, distance, reach):
    thresholds = np.array([3, 7, 11, 15, 20, 25, 30]) * (reach / 30)
    danger = (ranges[:, :, None] < thresholds[None, None, :]).sum(axis=2)
    step = 2 * np.pi / 9
    region = np.floor(np.mod(bearing + step / 2, 2 * np.pi) / step) + 1
    seen = distance <= reach
    return np.concatenate([danger, region[:, None], seen[:, None]], 1).astype(np.int64)


def encode_16(ranges, bearing, distance, reach):
    conditions = {3: 7, 7: 6, 11: 5, 15: 4, 20: 3, 25: 2, 30: 1}
    danger = np.zeros_like(ranges, dtype=int)
    for border, degree in sorted(conditions.items(), reverse=True):
        danger = np.where(ranges < border * reach / 30, degree, danger)
    full = np.degrees(bearing) % 360
    region = np.ones(len(bearing), dtype=int)
    for k in range(1, 9):
        region[(full >= 40 * k - 20) & (full < 40 * k + 20)] = k + 1
    return np.hstack(
        (danger, region.reshape(-1, 1), (distance <= reach).reshape(-1, 1))
    )


def encode_17(ranges, bearing, distance, reach):
    class Sensor:
        table = (3, 7, 11, 15, 20, 25, 30)

        def danger(self, metres):
            centimetres = metres / reach * 30
            return sum(1 for t in self.table if centimetres < t - 1e-9)

        def region(self, angle):
            x, y = math.cos(angle), math.sin(angle)
            direction = math.degrees(math.atan2(y, x))
            return round(direction / 40) % 9 + 1

    s = Sensor()
    rows = []
    for i in range(len(ranges)):
        row = [s.danger(x) for x in ranges[i]]
        row.append(s.region(bearing[i]))
        row.append(int(distance[i] <= reach))
        rows.append(row)
    return np.array(rows)


def encode_18(ranges, bearing, distance, reach):
    result = np.empty((len(bearing), 11))
    edges = np.array([-np.inf, 3, 7, 11, 15, 20, 25, 30, np.inf]) * reach / 30
    for low, high, degree in zip(edges[:-1], edges[1:], range(7, -1, -1)):
        result[:, :9][(ranges >= low) & (ranges < high)] = degree
    shift = np.remainder(bearing, 2 * np.pi) / np.radians(40)
    result[:, 9] = np.floor(shift + 1 / 2)
    result[:, 9][result[:, 9] > 8] = 0
    result[:, 9] += 1
    result[:, 10] = np.where(distance <= reach, 1, 0)
    return result.astype(int)


def encode_19(ranges, bearing, distance, reach):
    @np.vectorize
    def danger(x):
        borders = (3, 7, 11, 15, 20, 25, 30)
        for index in range(7):
            if x < borders[index] * reach / 30:
                return 7 - index
        return 0

    @np.vectorize
    def region(angle):
        return math.floor((math.degrees(angle) + 20) / 40) % 9 + 1

    columns = [danger(ranges[:, k]) for k in range(9)]
    columns += [region(bearing), np.array([int(d <= reach) for d in distance])]
    return np.transpose(columns)


def encode_20(ranges, bearing, distance, reach):
    cm = ranges * (30 / reach)
    # a tiny amount keeps readings on a border on the safe side
    cm = cm + 1e-9
    danger = np.digitize(cm, [30, 25, 20, 15, 11, 7, 3])
    z = np.exp(1j * bearing)
    sector = np.rint(np.angle(z) * 9 / (2 * np.pi)).astype(int)
    sector = np.where(sector < 0, sector + 9, sector) + 1
    flag = np.heaviside(reach - distance, 1).astype(int)
    return np.c_[danger, sector, flag]


def encode_21(ranges, bearing, distance, reach):
    def one_row(readings, angle, far):
        state = []
        for x in readings:
            d, limits = 7, [3, 7, 11, 15, 20, 25, 30]
            while limits and x >= limits[0] * reach / 30:
                limits.pop(0)
                d -= 1
            state.append(d)
        a = math.fmod(angle + math.pi / 9, 2 * math.pi)
        a = a + 2 * math.pi if a < 0 else a
        state.append(int(a // (2 * math.pi / 9)) + 1)
        state.append(int(not far > reach))
        return state

    return np.array([one_row(*x) for x in zip(ranges, bearing, distance)])


def encode_22(ranges, bearing, distance, reach):
    N = ranges.shape[0]
    limits = np.array([30, 25, 20, 15, 11, 7, 3]) * reach / 30
    state = np.zeros((N, 11), dtype=np.int64)
    for j in range(9):
        for limit in limits:
            state[:, j] = state[:, j] + np.less(ranges[:, j], limit)
    in_degrees = np.rad2deg(bearing)
    state[:, 9] = (in_degrees + 20) // 40
    state[:, 9] %= 9
    state[:, 9] += 1
    state[:, 10] = np.less_equal(distance, reach)
    return state


def encode_23(ranges, bearing, distance, reach):
    flat = ranges.ravel()
    borders = np.array([3, 7, 11, 15, 20, 25, 30]) / 30 * reach
    position = np.array([np.count_nonzero(borders <= x) for x in flat])
    danger = (7 - position).reshape(ranges.shape)
    angles = np.unwrap(np.zeros(len(bearing))) + bearing
    quotient, _ = np.divmod(angles + np.pi / 9, 2 * np.pi / 9)
    region = np.mod(quotient, 9).astype(int) + 1
    return np.append(danger, np.stack((region, distance <= reach), axis=-1), axis=1)


def encode_24(ranges, bearing, distance, reach):
    borders = reach / 30 * np.array([3.0, 7.0, 11.0, 15.0, 20.0, 25.0, 30.0])
    danger = np.piecewise(
        ranges,
        [ranges < borders[0]]
        + [(ranges >= borders[k]) & (ranges < borders[k + 1]) for k in range(6)],
        [7, 6, 5, 4, 3, 2, 1, 0],
    )
    middle = np.arange(9) * 2 * np.pi / 9
    gap = np.abs((bearing[:, None] - middle + np.pi) % (2 * np.pi) - np.pi)
    region = gap.argmin(axis=1) + 1
    return np.column_stack((danger, region, distance <= reach)).astype(int)


def encode_25(ranges, bearing, distance, reach):
    degrees_of_danger = []
    for row in ranges * 30 / reach:
        levels = []
        for value in row:
            if value >= 30 - 1e-9:
                levels.append(0)
                continue
            for border, level in [(25, 1), (20, 2), (15, 3), (11, 4), (7, 5), (3, 6)]:
                if value >= border - 1e-9:
                    levels.append(level)
                    break
            else:
                levels.append(7)
        degrees_of_danger.append(levels)
    regions = [int(round(math.degrees(b) % 360 / 40)) % 9 + 1 for b in bearing]
    in_range = [bool(d <= reach) for d in distance]
    return np.array(
        [[*x, r, int(s)] for x, r, s in zip(degrees_of_danger, regions, in_range)]
    )


def encode_26(ranges, bearing, distance, reach):
    lookup = np.array([7, 6, 5, 4, 3, 2, 1, 0])
    limits = np.multiply([3, 7, 11, 15, 20, 25, 30], reach / 30)
    danger = lookup[np.searchsorted(limits, ranges, "right")]
    width = np.deg2rad(40)
    shifted = bearing + width / 2
    shifted = shifted - 2 * np.pi * np.floor(shifted / (2 * np.pi))
    extra = np.zeros((len(ranges), 2), dtype=int)
    extra[:, 0] = np.trunc(shifted / width) + 1
    extra[:, 1][distance <= reach] = 1
    return np.block([danger, extra])


def encode_27(ranges, bearing, distance, reach):
    from functools import reduce

    tests = (ranges < k / 30 * reach for k in (3, 7, 11, 15, 20, 25, 30))
    danger = reduce(np.add, tests, np.zeros(ranges.shape, dtype=int))
    cycles = bearing / (2 * np.pi)
    cycles -= np.floor(cycles)
    sector = [(int(9 * c + 0.5) % 9) + 1 for c in cycles]
    near = [*map(int, distance <= reach)]
    return np.array([[*d, s, n] for d, s, n in zip(danger.tolist(), sector, near)])


def encode_28(ranges, bearing, distance, reach):
    states = []
    m = len(distance)
    i = 0
    while i < m:
        state = [0] * 11
        j = 0
        while j < 9:
            share = ranges[i][j] / reach
            percentages = [0.1, 7 / 30, 11 / 30, 0.5, 2 / 3, 5 / 6, 1]
            state[j] = len(
                [p for p in percentages if share < p and not np.isclose(share, p)]
            )
            j += 1
        state[9] = int(np.floor(bearing[i] / np.pi * 4.5 + 0.5) % 9 + 1)
        if not distance[i] > reach:
            state[10] = 1
        states.append(state)
        i += 1
    return np.array(states, dtype=int)


def encode_29(ranges, bearing, distance, reach):
    borders = np.array([3, 7, 11, 15, 20, 25, 30]) * reach / 30
    above = np.zeros(ranges.shape, dtype=int)
    for border in borders:
        above[ranges >= border] += 1
    bins = np.deg2rad(np.arange(-20, 341, 40))
    wrapped = bearing % (2 * np.pi)
    wrapped = wrapped - np.where(wrapped >= bins[-1], 2 * np.pi, 0)
    columns = np.empty((len(ranges), 11), dtype=int)
    columns[:, :9] = 7 - above
    columns[:, 9] = np.digitize(wrapped, bins)
    columns[:, 10] = ~(distance > reach)
    return columns


def encode_30(ranges, bearing, distance, reach):
    table = [(3, 7), (7, 6), (11, 5), (15, 4), (20, 3), (25, 2), (30, 1)]
    danger = np.max([(ranges < top * reach / 30) * d for top, d in table], axis=0)
    sin, cos = np.sin(bearing + np.pi / 9), np.cos(bearing + np.pi / 9)
    positive = np.arctan2(sin, cos)
    positive[positive < 0] += 2 * np.pi
    region = np.minimum((positive / np.radians(40)).astype(int), 8) + 1
    return np.vstack([danger.T, region, (distance <= reach).astype(int)]).T
