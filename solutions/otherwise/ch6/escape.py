"""6.6 robot by robot: it leaves a wall where it stands nearer to its target than where it met the wall."""

import math

TURNS = [math.radians(a) for a in (60, 30, 0, -30, -60)]
ACTIONS = [2, 1, 0, 3, 4]


def room(ranges, way):
    """How far a way is free."""
    least = 10.0
    for k, reading in enumerate(ranges):
        if reading >= 10:
            continue
        for edge in (-12, 0, 12):
            off = way - math.radians(40 * k + edge)
            ahead, beside = reading * math.cos(off), abs(reading * math.sin(off))
            if ahead > 0 and beside < 1.5:
                least = min(least, ahead - math.sqrt(1.5**2 - beside**2))
    return least


def one(ranges, bearing, distance, memory):
    side, best, *_ = memory
    clear = room(ranges, bearing) >= min(5.0, distance)
    ways = [room(ranges, turn) >= 4 for turn in TURNS]
    beside = min(ranges[:5] if side > 0 else ranges[5:] + ranges[:1])
    if (clear and distance < best - 1) or beside >= 10:
        side = 0
    if not side and not clear:
        right, left = (
            next((a for a in range(10, 180, 10) if room(ranges, bearing + s * math.radians(a)) >= 5), 180)
            for s in (-1, 1)
        )  # fmt: skip
        side, best = (1 if right <= left else -1), distance
    order = range(5)
    if not side:
        off = [abs(math.remainder(bearing - turn, 2 * math.pi)) for turn in TURNS]
        order = sorted(order, key=lambda n: off[n])
    else:
        hand = [0, 1, 2, 3, 4] if side > 0 else [0, 8, 7, 6, 5]
        wall = min(hand, key=lambda k: ranges[k])
        wall = math.radians(40 * hand.index(wall)) * side
        order = order if side > 0 else reversed(order)
        order = [n for n in order if side * TURNS[n] <= side * wall + 1e-9]
    last = 4 if side > 0 else 0 if side < 0 else 2
    chosen = next((n for n in order if ways[n]), last)
    return ACTIONS[chosen], (side, best, 0, 0)


def escape(ranges, bearing, distance, memory):
    found = [
        one(*row)
        for row in zip(
            ranges.tolist(), bearing.tolist(), distance.tolist(), memory.tolist()
        )
    ]
    return [action for action, _ in found], [kept for _, kept in found]
