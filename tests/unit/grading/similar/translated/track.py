"""Answers to exercise 2.4 that were copied from others, with loops for arrays or arrays for loops."""

import numpy as np


def track_1(b, P, O, acts, obs):
    n = len(b)
    for u, y in zip(acts, obs):
        b = [sum(b[i] * P[u, i, j] for i in range(n)) for j in range(n)]
        if y == -1:
            continue
        fresh = [b[j] * O[u][j, y] for j in range(n)]
        mass = sum(fresh)
        if mass > 0:
            b = [x / mass for x in fresh]
    return b


def track_2(start, P, O, acts, obs):
    cur = np.array(start)
    for k in range(len(acts)):
        u = acts[k]
        guess = cur @ P[u]
        if obs[k] >= 0:
            fixed = guess * O[u, :, obs[k]]
            total = fixed.sum()
            if total > 0:
                guess = fixed / total
        cur = guess
    return cur


def track_3(p, P, O, acts, obs):
    def move(x, u):
        return [sum(P[u, i, j] * x[i] for i in range(len(x))) for j in range(len(x))]

    def look(x, u, y):
        w = [O[u, j, y] * x[j] for j in range(len(x))]
        if all(v == 0 for v in w):
            return x
        return [v / sum(w) for v in w]

    for u, y in zip(acts, obs):
        p = move(p, u)
        if y != -1:
            p = look(p, u, y)
    return p


def track_4(p, P, O, acts, obs):
    now = [x for x in p]
    m = len(now)
    for u, y in zip(acts, obs):
        pr = [0.0] * m
        for i in range(m):
            for j in range(m):
                pr[j] += now[i] * P[u, i, j]
        lik = [1.0] * m if y < 0 else [O[u, j, y] for j in range(m)]
        ev = sum(x * w for x, w in zip(pr, lik))
        now = [x * w / ev for x, w in zip(pr, lik)] if ev else pr
    return now


def track_7(x, P, O, acts, obs):
    x = np.array(x)
    for u, y in zip(acts, obs):
        x = (x[:, None] * P[u]).sum(axis=0)
        if y == -1:
            continue
        post = x * O[u][:, y]
        if not post.any():
            continue
        x = post / post.sum()
    return x


def track_8(p, P, O, acts, obs):
    n = len(p)
    for u, y in zip(acts, obs):
        went = [sum(p[i] * P[u, i, j] for i in range(n)) for j in range(n)]
        table = [[*O[u, j], 1] for j in range(n)]
        got = [went[j] * table[j][y] for j in range(n)]
        p = [g / sum(got) for g in got] if sum(got) > 0 else went
    return p
