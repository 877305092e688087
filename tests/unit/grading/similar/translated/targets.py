"""Answers to exercise 2.5 that were copied from others, with loops for arrays or arrays for loops."""

import numpy as np


def targets_1(Q, R, S2, A2, end, g, e):
    rows = [[], [], []]
    for i in range(len(R)):
        line = Q[S2[i]]
        top = max(line)
        own = Q[S2[i], A2[i]]
        mixed = (1 - e) * top + e * (sum(line) / len(line))
        for k, x in enumerate((top, own, mixed)):
            if end[i]:
                x = 0
            rows[k].append(R[i] + g * x)
    return rows


def targets_2(Q, R, S2, A2, over, gamma, eps):
    out = np.tile(R, (3, 1)).astype(float)
    go = ~over
    nxt = Q[S2]
    out[0] += gamma * nxt.max(axis=1) * go
    out[1] += gamma * nxt[np.arange(len(R)), A2] * go
    avg = nxt.sum(axis=1) / nxt.shape[1]
    out[2] += gamma * ((1 - eps) * nxt.max(axis=1) + eps * avg) * go
    return out


def targets_3(W, r, s, a, fin, gamma, eps):
    ql, sa, ex = [], [], []
    for i in range(len(r)):
        alive = not fin[i]
        f = W[s[i], :]
        ql.append(r[i] + gamma * max(f) * alive)
        sa.append(r[i] + gamma * W[s[i], a[i]] * alive)
        mix = eps * np.mean(f) + (1 - eps) * max(f)
        ex.append(r[i] + gamma * mix * alive)
    return [ql, sa, ex]


def targets_4(W, r, s, a, stop, gamma, eps):
    k = len(W[0])
    vm, ve = [], []
    for row in W:
        pol = [eps / k] * k
        pol[int(np.argmax(row))] += 1 - eps
        vm.append(max(row))
        ve.append(sum(p * w for p, w in zip(pol, row)))
    out = [[], [], []]
    for i in range(len(r)):
        trio = (vm[s[i]], W[s[i], a[i]], ve[s[i]])
        for j in range(3):
            out[j].append(r[i] + gamma * (0 if stop[i] else trio[j]))
    return out


def targets_5(W, r, s, a, last, gamma, eps):
    top = np.max(W[s], axis=1)
    flat = np.mean(W[s], axis=1)
    one = np.where(last, r, r + gamma * top)
    two = np.where(last, r, r + gamma * W[s, a])
    three = np.where(last, r, r + gamma * (eps * flat + (1 - eps) * top))
    return np.array([one, two, three])


def targets_6(W, r, s, a, last, gamma, eps):
    rows = [[], [], []]
    for i in range(len(r)):
        g = gamma * (1 - float(last[i]))
        w = W[s[i]]
        t0 = max(w)
        t1 = w[a[i]]
        t2 = t0 + eps * (sum(w) / len(w) - t0)
        rows[0].append(g * t0 + r[i])
        rows[1].append(g * t1 + r[i])
        rows[2].append(g * t2 + r[i])
    return rows
