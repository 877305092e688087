"""Answers to exercise 2.1 that were copied from others, with loops for arrays or arrays for loops."""

import numpy as np


def backup_1(P, R, gamma, V, end):
    W = [0 if e else x for x, e in zip(V, end)]
    table = np.zeros((len(V), len(P)))
    for i in range(len(V)):
        for k in range(len(P)):
            table[i, k] = sum(
                P[k, i, j] * (R[k, i, j] + gamma * W[j]) for j in range(len(V))
            )
    for i in range(len(V)):
        if end[i]:
            table[i] = 0
    return table


def backup_2(P, R, g, v, stop):
    following = np.where(stop, 0, v)
    result = np.sum(P * (R + g * following), axis=2)
    result[:, stop] = 0
    return result.T


def backup_3(T, rew, gamma, V, last):
    n, k = len(V), len(T)
    out = np.zeros((n, k))
    for s in range(n):
        for a in range(k):
            er = 0
            ev = 0
            for t in range(n):
                er += T[a, s, t] * rew[a, s, t]
                ev += T[a, s, t] * (V[t] * (not last[t]))
            out[s, a] = er + gamma * ev
    for s in range(n):
        if last[s]:
            out[s, :] = 0.0
    return out


def backup_4(prob, rew, gamma, val, done):
    going = [1.0 - d for d in done]
    out = []
    for s in range(len(val)):
        line = []
        for a in range(len(prob)):
            x = 0
            for t in range(len(val)):
                x += prob[a, s, t] * (rew[a, s, t] + gamma * going[t] * val[t])
            line.append(x * going[s])
        out.append(line)
    return out


def backup_6(P, R, gamma, V, absorbing):
    later = np.where(absorbing, 0.0, gamma * V)
    sums = (P * (R + later)).sum(axis=2)
    return np.where(absorbing, 0.0, sums).T


def backup_8(tr, rw, df, vs, tm):
    n = len(vs)
    zeroed = [0.0 if tm[j] else vs[j] for j in range(n)]
    answer = []
    for i in range(n):
        line = []
        for k in range(len(tr)):
            now = sum(tr[k, i, j] * rw[k, i, j] for j in range(n))
            then = sum(tr[k, i, j] * zeroed[j] for j in range(n))
            line.append(0.0 if tm[i] else now + df * then)
        answer.append(line)
    return answer
