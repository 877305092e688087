"""Twelve ways to write exercise 2.3, as students who do not know each other would."""

import numpy as np


def bounds_1(previous, values, discount):
    change = values - previous
    factor = discount / (1 - discount)
    return values + factor * change.min(), values + factor * change.max()


def bounds_2(previous, values, discount):
    m = min(values - previous)
    M = max(values - previous)
    lower = values + discount * m / (1 - discount)
    upper = values + discount * M / (1 - discount)
    return lower, upper


def bounds_3(previous, values, discount):
    diffs = [v - p for v, p in zip(values, previous)]
    smallest, largest = min(diffs), max(diffs)
    c = discount / (1.0 - discount)
    return [v + c * smallest for v in values], [v + c * largest for v in values]


def bounds_4(previous, values, discount):
    delta = np.subtract(values, previous)
    lowest, highest = np.min(delta), np.max(delta)
    geometric = 1 / (1 - discount) - 1
    return values + geometric * lowest, values + geometric * highest


def bounds_5(previous, values, discount):
    scaled = discount * (values - previous) / (1 - discount)
    return np.amin(scaled) + values, np.amax(scaled) + values


def bounds_6(previous, values, discount):
    lo = hi = values[0] - previous[0]
    for i in range(len(values)):
        d = values[i] - previous[i]
        if d < lo:
            lo = d
        if d > hi:
            hi = d
    k = discount / (1 - discount)
    lower = np.zeros(len(values))
    upper = np.zeros(len(values))
    for i in range(len(values)):
        lower[i] = values[i] + k * lo
        upper[i] = values[i] + k * hi
    return lower, upper


def bounds_7(previous, values, discount):
    # the whole series from the first table: previous + change / (1 - discount)
    step = values - previous
    rest = step / (1 - discount) - step
    return values + rest.min(), values + rest.max()


def bounds_8(previous, values, discount):
    def shifted(extreme):
        return values + discount / (1 - discount) * extreme(values - previous)

    return shifted(np.min), shifted(np.max)


def bounds_9(previous, values, discount):
    lower, upper = values.copy(), values.copy()
    m, M = (values - previous).min(), (values - previous).max()
    for k in range(1, 3000):
        lower += discount**k * m
        upper += discount**k * M
    return lower, upper


def bounds_10(previous, values, discount):
    changes = np.sort(values - previous)
    ends = changes[[0, -1]] * discount / (1 - discount)
    low, high = values[None, :] + ends[:, None]
    return low, high


def bounds_11(previous, values, discount):
    size = values.size
    difference = np.array([values[s] - previous[s] for s in range(size)])
    below = difference.min() * discount / (1 - discount) * np.ones(size)
    above = difference.max() * discount / (1 - discount) * np.ones(size)
    return below + values, above + values


def bounds_12(previous, values, discount):
    total_low = total_high = 0.0
    low, high = np.min(values - previous), np.max(values - previous)
    weight = discount
    while weight > 1e-14:
        total_low += weight * low
        total_high += weight * high
        weight *= discount
    return values + total_low, values + total_high
