"""Twelve ways to write exercise 3.2, as students who do not know each other would."""

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
