"""Answers to exercise 2.3 that were copied from others, with loops for arrays or arrays for loops."""

import numpy as np


def bounds_1(old, new, g):
    steps = [b - a for a, b in zip(old, new)]
    c = g / (1 - g)
    least, most = min(steps), max(steps)
    return [x + c * least for x in new], [x + c * most for x in new]


def bounds_2(v0, v1, gamma):
    lo = min(v1[i] - v0[i] for i in range(len(v0)))
    hi = max(v1[i] - v0[i] for i in range(len(v0)))
    a, b = [], []
    for x in v1:
        a.append(x + gamma * lo / (1 - gamma))
        b.append(x + gamma * hi / (1 - gamma))
    return a, b


def bounds_3(before, after, gamma):
    moved = after - before
    little, much = moved.min(), moved.max()
    ratio = gamma / (1.0 - gamma)
    return after + ratio * little, after + ratio * much


def bounds_4(u, v, g):
    d = [y - x for x, y in zip(u, v)]
    a, b = min(d), max(d)
    series = 1 / (1 - g) - 1
    down, up = [], []
    for y in v:
        down.append(y + series * a)
        up.append(y + series * b)
    return down, up


def bounds_7(V_old, V, gamma):
    tail = []
    for i in range(len(V)):
        move = V[i] - V_old[i]
        tail.append(move / (1 - gamma) - move)
    return [x + min(tail) for x in V], [x + max(tail) for x in V]


def bounds_11(old, new, g):
    change = new - old
    lo = np.full(len(new), change.min() * g / (1 - g))
    hi = np.full(len(new), change.max() * g / (1 - g))
    return lo + new, hi + new
