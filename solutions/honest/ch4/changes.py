"""Eight ways to write exercise 4.6, as students who do not know each other would."""

import numpy as np


def changes_1(weights):
    difference = weights[1:] - weights[:-1]
    absolute = abs(difference)
    return np.array([difference.sum(1), absolute.sum(1), absolute.max(1)]).T


def changes_2(weights):
    E = len(weights) - 1
    result = np.zeros((E, 3))
    for e in range(E):
        d = weights[e + 1] - weights[e]
        result[e, 0] = np.sum(d)
        result[e, 1] = np.sum(np.abs(d))
        result[e, 2] = np.max(np.abs(d))
    return result


def changes_3(weights):
    rows = []
    for before, after in zip(weights, weights[1:]):
        step = [b - a for a, b in zip(before, after)]
        sizes = [abs(x) for x in step]
        rows.append([sum(step), sum(sizes), max(sizes)])
    return np.array(rows).reshape(-1, 3)


def changes_4(weights):
    delta = np.diff(weights.T).T
    measures = (
        np.sum(delta, axis=1),
        np.linalg.norm(delta, 1, axis=1),
        np.linalg.norm(delta, np.inf, axis=1),
    )
    return np.stack(measures, axis=-1)


def changes_5(weights):
    totals = weights.sum(axis=1)
    signed = totals[1:] - totals[:-1]
    moved = np.absolute(np.subtract(weights[1:], weights[:-1]))
    return np.c_[signed, moved.sum(axis=1), np.amax(moved, axis=1)]


def changes_6(weights):
    out = []
    for e in range(1, weights.shape[0]):
        signed, total, largest = 0.0, 0.0, 0.0
        for i in range(weights.shape[1]):
            change = weights[e, i] - weights[e - 1, i]
            signed += change
            total += abs(change)
            if abs(change) > largest:
                largest = abs(change)
        out.append((signed, total, largest))
    return np.array(out)


def changes_7(weights):
    def measure(change):
        up, down = change[change > 0].sum(), -change[change < 0].sum()
        return up - down, up + down, max(change.max(), -change.min())

    return np.array([measure(c) for c in np.diff(weights, axis=0)])


def changes_8(weights):
    previous, current = np.roll(weights, 1, axis=0)[1:], weights[1:]
    c = current - previous
    table = np.empty((c.shape[0], 3))
    table[:, 0] = c @ np.ones(c.shape[1])
    table[:, 1] = (c * np.sign(c)).sum(axis=1)
    table[:, 2] = np.maximum(c.max(axis=1), (-c).max(axis=1))
    return table
