"""Answers to exercise 3.5 that were copied from others, with loops for arrays or arrays for loops."""

import numpy as np


def effective_1(X, y):
    chosen = [i for i in range(len(X)) if any(v > 0 for v in X[i][:9])]
    xs, ys = [X[i] for i in chosen], [y[i] for i in chosen]
    flags = [True] * len(xs)
    for i in range(1, len(xs)):
        if all(u == v for u, v in zip(xs[i], xs[i - 1])) and ys[i] == ys[i - 1]:
            flags[i] = False
    xs = [x for x, f in zip(xs, flags) if f]
    return np.array(xs, dtype=int).reshape(-1, 11), [v for v, f in zip(ys, flags) if f]


def effective_2(X, y):
    some = X[:, :9].sum(axis=1) != 0
    X, y = X[some], y[some]
    again = (X[1:] == X[:-1]).all(axis=1) & (y[1:] == y[:-1])
    keep = np.concatenate([[True], ~again])[: len(X)]
    return X[keep], y[keep]


def effective_3(X, y):
    lines = []
    for row, act in zip(X.tolist(), y.tolist()):
        if max(row[:9]) > 0:
            lines.append([*row, act])
    chosen = []
    for i, line in enumerate(lines):
        if i == 0 or any(u - v for u, v in zip(line, lines[i - 1])):
            chosen.append(line)
    table = np.array(chosen, dtype=int).reshape(-1, 12)
    return table[:, :-1], table[:, -1]


def effective_6(X, y):
    near = [i for i in range(len(X)) if sum(X[i, :9])]
    if not near:
        return X[:0], y[:0]
    picked = [near[0]]
    for before, now in zip(near[:-1], near[1:]):
        other = any(X[now, j] != X[before, j] for j in range(11))
        other = other or y[now] != y[before]
        if other:
            picked.append(now)
    return X[picked], y[picked]


def effective_7(X, y):
    full = np.column_stack([X, y])
    full = full[full[:, :9].max(axis=1) > 0]
    fresh = np.ones(len(full), dtype=bool)
    fresh[1:] = (full[1:] != full[:-1]).any(axis=1)
    full = full[fresh]
    return full[:, :11], full[:, 11]


def effective_8(X, y):
    rows = [i for i in range(len(X)) if sum(v != 0 for v in X[i, :9]) >= 1]
    out = []
    for n, i in enumerate(rows):
        h = rows[n - 1]
        same = all(X[i, j] == X[h, j] for j in range(11)) and y[i] == y[h]
        if n == 0:
            same = False
        if not same:
            out.append(i)
    return X[out], y[out]
