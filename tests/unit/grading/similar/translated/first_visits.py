"""Answers to exercise 2.6 that were copied from others, with loops for arrays or arrays for loops."""

import numpy as np


def first_visits_1(paths, gains, g, n):
    acc, num = [0.0] * n, [0] * n
    for p, w in zip(paths, gains):
        back = [0.0] * len(p)
        R = 0
        i = len(p) - 1
        while i >= 0:
            R = w[i] + g * R
            back[i] = R
            i -= 1
        known = []
        for i, x in enumerate(p):
            if x not in known:
                known.append(x)
                acc[x] += back[i]
                num[x] += 1
    return [a / k if k > 0 else 0.0 for a, k in zip(acc, num)], num


def first_visits_2(paths, gains, g, n):
    found = {x: [] for x in range(n)}
    for p, w in zip(paths, gains):
        for x in set(p):
            tail = np.array(w[p.index(x) :], dtype=float)
            found[x].append(np.sum(g ** np.arange(len(tail)) * tail))
    means = np.array([np.mean(found[x]) if found[x] else 0.0 for x in range(n)])
    return means, np.array([len(found[x]) for x in range(n)])


def first_visits_3(eps, rws, gamma, n):
    mean, k = [0.0] * n, [0] * n
    for e, w in zip(eps, rws):
        ret, last = 0.0, {}
        for i in range(len(e) - 1, -1, -1):
            ret = w[i] + gamma * ret
            last[e[i]] = ret
        for x in last:
            k[x] += 1
            mean[x] += (last[x] - mean[x]) / k[x]
    return mean, k


def first_visits_4(eps, rws, gamma, n):
    tot, cnt = [0.0] * n, [0] * n
    for e, w in zip(eps, rws):
        for i in range(len(e)):
            if e[i] in e[:i]:
                continue
            x = 0.0
            for j in range(i, len(w)):
                x += gamma ** (j - i) * w[j]
            tot[e[i]] += x
            cnt[e[i]] += 1
    return [tot[x] / cnt[x] if cnt[x] else 0 for x in range(n)], cnt


def first_visits_7(eps, rws, gamma, n):
    acc, cnt = np.zeros(n), np.zeros(n, dtype=int)
    for e, w in zip(eps, rws):
        for x in range(n):
            if x in e:
                rest = np.array(w[e.index(x) :], dtype=float)
                cnt[x] += 1
                acc[x] += rest @ gamma ** np.arange(len(rest))
    return acc / np.maximum(cnt, 1), cnt


def first_visits_9(eps, rws, gamma, n):
    vals, hits_of = np.zeros(n), np.zeros(n, dtype=int)
    for x in range(n):
        got, hits = 0.0, 0
        for e, w in zip(eps, rws):
            begun = np.cumsum(np.array(e) == x) > 0
            part = np.array(w, dtype=float)[begun]
            if begun.any():
                got += np.sum(part * gamma ** np.arange(len(part)))
                hits += 1
        vals[x] = got / hits if hits else 0.0
        hits_of[x] = hits
    return vals, hits_of
