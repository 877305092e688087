"""Answers to exercise 2.7 that were copied from others, with loops for arrays or arrays for loops."""

import numpy as np


def battery_1(P, R, k, C):
    n = P.shape[1]
    W = [[0.0] * n for _ in range(C + 1)]
    for c in range(1, C + 1):
        lists = []
        for a in range(len(k)):
            if k[a] <= c:
                line = []
                for s in range(n):
                    line.append(
                        R[s, a] + sum(P[a, s, t] * W[c - k[a]][t] for t in range(n))
                    )
                lists.append(line)
        if lists:
            W[c] = [max(col) for col in zip(*lists)]
    return W


def battery_2(P, R, k, C):
    W = np.zeros((C + 1, P.shape[1]))
    for left in range(C + 1):
        top = None
        for a in range(len(P)):
            if k[a] > left:
                continue
            x = R[:, a] + P[a] @ W[left - k[a]]
            top = x if top is None else np.where(x > top, x, top)
        if top is not None:
            W[left] = top
    return W


def battery_4(P, R, k, C):
    m, n = P.shape[:2]
    W = np.zeros((C + 1, n))
    for c in range(1, C + 1):
        for s in range(n):
            q = [-np.inf] * m
            for a in range(m):
                if k[a] <= c:
                    q[a] = R[s, a]
                    for t in range(n):
                        q[a] += P[a, s, t] * W[c - k[a], t]
            top = max(q)
            W[c, s] = 0 if np.isinf(top) else top
    return W


def battery_7(P, R, k, C):
    out = np.zeros((C + 1, len(R)))
    for c in range(1, C + 1):
        q = [R[:, a] + P[a] @ out[c - k[a]] for a in range(len(k)) if c >= k[a]]
        out[c] = np.max(q, axis=0) if len(q) > 0 else 0.0
    return out


def battery_9(P, R, k, C):
    n, m = R.shape
    W = [[0.0] * n for _ in range(C + 1)]
    known = [False] * (C + 1)
    for c in range(C + 1):
        for a in range(m):
            b = c - k[a]
            if b >= 0:
                for s in range(n):
                    x = R[s, a] + sum(W[b][t] * P[a, s, t] for t in range(n))
                    W[c][s] = max(W[c][s], x) if known[c] else x
                known[c] = True
    return W


def battery_11(P, R, k, C):
    past = np.zeros((C + 1, len(R)))
    i = 1
    while i <= C:
        possible = np.flatnonzero(k <= i)
        if possible.size:
            past[i] = np.max(
                [R[:, a] + P[a] @ past[i - k[a]] for a in possible], axis=0
            )
        i += 1
    return past
