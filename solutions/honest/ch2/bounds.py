"""Thirty ways to write exercise 2.3, as students who do not know each other would."""

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


def bounds_13(previous, values, discount):
    number_of_states = len(values)
    smallest_change = values[0] - previous[0]
    largest_change = values[0] - previous[0]
    for state in range(1, number_of_states):
        change = values[state] - previous[state]
        if change < smallest_change:
            smallest_change = change
        elif change > largest_change:
            largest_change = change
    lower_bounds = []
    upper_bounds = []
    for state in range(number_of_states):
        lower_bounds.append(values[state] + smallest_change * discount / (1 - discount))
        upper_bounds.append(values[state] + largest_change * discount / (1 - discount))
    return np.array(lower_bounds), np.array(upper_bounds)


def bounds_14(previous, values, discount):
    residual = values - previous
    extremes = np.array([np.min(residual), np.max(residual)])
    lower, upper = np.add.outer(discount / (1 - discount) * extremes, values)
    return lower, upper


def bounds_15(previous, values, discount):
    def limit(c):
        total = c * discount
        return total / (1 - discount)

    d = values - previous
    return values + limit(d.min()), values + limit(d.max())


def bounds_16(previous, values, discount):
    ratio = discount * (1 - discount) ** -1
    ordered = sorted(values - previous)
    return values + ratio * ordered[0], values + ratio * ordered[-1]


def bounds_17(previous, values, discount):
    D = values - previous
    low = values + discount * np.full(len(D), D.min()) / (1 - discount)
    high = values + discount * np.full(len(D), D.max()) / (1 - discount)
    return low, high


def bounds_18(previous, values, discount):
    m, M = np.inf, -np.inf
    for old, new in zip(previous, values):
        m = min(m, new - old)
        M = max(M, new - old)
    gain = discount / (1 - discount)
    return np.array([v + m * gain for v in values]), np.array(
        [v + M * gain for v in values]
    )


def bounds_19(previous, values, discount):
    # x = discount * (change + x)
    change = values - previous
    x_low, x_high = np.linalg.solve(
        np.eye(2) * (1 - discount), discount * np.array([change.min(), change.max()])
    )
    return values + x_low, values + x_high


def bounds_20(previous, values, discount):
    span = np.ptp(values - previous)
    least = np.min(values - previous)
    lower = values + discount * least / (1 - discount)
    upper = lower + discount * span / (1 - discount)
    return lower, upper


def bounds_21(previous, values, discount):
    horizon = 0
    lower, upper = np.array(values), np.array(values)
    changes = values - previous
    smallest, greatest = changes.min(), changes.max()
    while horizon < 5000:
        smallest, greatest = discount * smallest, discount * greatest
        lower = lower + smallest
        upper = upper + greatest
        horizon += 1
    return lower, upper


def bounds_22(previous, values, discount):
    change = values - previous
    below, above = [values + f(change) * discount / (1 - discount) for f in (min, max)]
    return below, above


def bounds_23(previous, values, discount):
    class Bound:
        def __init__(self, change):
            self.offset = discount * change / (1 - discount)

        def of(self, v):
            return v + self.offset

    changes = [float(v - p) for p, v in zip(previous, values)]
    return Bound(min(changes)).of(values), Bound(max(changes)).of(values)


def bounds_24(previous, values, discount):
    def tail(c, k=0):
        return 0.0 if k > 800 or c == 0 else discount * (c + tail(c, k + 1))

    change = np.subtract(values, previous)
    return np.add(values, tail(change.min())), np.add(values, tail(change.max()))


def bounds_25(previous, values, discount):
    change = (values - previous) * discount
    change = change / (1.0 - discount)
    quantiles = np.quantile(change, [0.0, 1.0])
    return values + quantiles[0], values + quantiles[1]


def bounds_26(previous, values, discount):
    i, j = np.argmin(values - previous), np.argmax(values - previous)
    k = discount / (1 - discount)
    lo = values + k * (values[i] - previous[i])
    hi = values + k * (values[j] - previous[j])
    return lo, hi


def bounds_27(previous, values, discount):
    powers = discount ** np.arange(1, 4000)
    weight = powers.sum()
    diff = values - previous
    return values + diff.min() * weight, values + diff.max() * weight


def bounds_28(previous, values, discount):
    result = np.tile(values.astype(float), (2, 1))
    delta = values - previous
    result[0] += delta.min() * discount / (1 - discount)
    result[1] += delta.max() * discount / (1 - discount)
    return result[0], result[1]


def bounds_29(previous, values, discount):
    # every later sweep moves the values by a share of what this one did
    negative = -np.max(previous - values)
    positive = np.max(values - previous)
    a = negative / (1 / discount - 1) if discount > 0 else 0.0
    b = positive / (1 / discount - 1) if discount > 0 else 0.0
    return values + a, values + b


def bounds_30(previous, values, discount):
    from itertools import starmap
    from operator import sub

    differences = list(starmap(sub, zip(values, previous)))
    c = discount / (1 - discount)
    ends = (min(differences), max(differences))
    return tuple(np.array([v + c * e for v in values]) for e in ends)
