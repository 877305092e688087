"""Twelve ways to write exercise 2.7, as students who do not know each other would."""

from functools import lru_cache

import numpy as np


def battery_1(transitions, rewards, costs, charge):
    S = transitions.shape[1]
    V = np.zeros((charge + 1, S))
    for c in range(1, charge + 1):
        Q = []
        for a in range(len(costs)):
            if costs[a] <= c:
                Q.append(rewards[:, a] + transitions[a] @ V[c - costs[a]])
        if Q:
            V[c] = np.max(Q, axis=0)
    return V


def battery_2(transitions, rewards, costs, charge):
    A, S, _ = transitions.shape
    table = np.zeros((charge + 1, S))
    for left in range(charge + 1):
        for s in range(S):
            best = None
            for a in range(A):
                if costs[a] > left:
                    continue
                value = rewards[s, a]
                for t in range(S):
                    value += transitions[a, s, t] * table[left - costs[a], t]
                if best is None or value > best:
                    best = value
            if best is not None:
                table[left, s] = best
    return table


def battery_3(transitions, rewards, costs, charge):
    n = transitions.shape[1]

    @lru_cache(maxsize=None)
    def v(c, s):
        options = [q(c, s, a) for a in range(len(costs)) if costs[a] <= c]
        return max(options, default=0.0)

    def q(c, s, a):
        rest = c - int(costs[a])
        return rewards[s, a] + sum(transitions[a, s, t] * v(rest, t) for t in range(n))

    return np.array([[v(c, s) for s in range(n)] for c in range(charge + 1)])


def battery_4(transitions, rewards, costs, charge):
    actions, states = transitions.shape[:2]
    values = np.zeros((charge + 1, states))
    for c in range(1, charge + 1):
        q = np.full((states, actions), -np.inf)
        for a in np.flatnonzero(costs <= c):
            q[:, a] = rewards[:, a] + transitions[a].dot(values[c - costs[a]])
        best = q.max(axis=1)
        values[c] = np.where(np.isinf(best), 0, best)
    return values


def battery_5(transitions, rewards, costs, charge):
    cheapest = costs.min()
    rows = [np.zeros(transitions.shape[1]) for _ in range(min(cheapest, charge + 1))]
    while len(rows) <= charge:
        c = len(rows)
        candidates = [
            r + P @ rows[c - k]
            for P, r, k in zip(transitions, rewards.T, costs)
            if k <= c
        ]
        rows.append(np.maximum.reduce(candidates))
    return np.array(rows)


def battery_6(transitions, rewards, costs, charge):
    # one padded table, so that too expensive actions look at minus infinity
    most = int(costs.max())
    V = np.full((charge + 1 + most, transitions.shape[1]), -np.inf)
    for c in range(charge + 1):
        row = c + most
        affordable = costs <= c
        if not affordable.any():
            V[row] = 0
            continue
        following = V[row - costs[affordable]]
        expected = np.einsum("ast,at->as", transitions[affordable], following)
        V[row] = (rewards.T[affordable] + expected).max(axis=0)
    return V[most:]


def battery_7(transitions, rewards, costs, charge):
    result = [[0.0] * len(rewards)]
    for c in range(1, charge + 1):
        line = []
        for s in range(len(rewards)):
            values = [
                rewards[s][a] + float(np.dot(transitions[a][s], result[c - costs[a]]))
                for a in range(len(costs))
                if c >= costs[a]
            ]
            line.append(max(values) if len(values) > 0 else 0.0)
        result.append(line)
    return result


def battery_8(transitions, rewards, costs, charge):
    memory = {}

    def solve(c):
        if c not in memory:
            best = np.full(transitions.shape[1], -np.inf)
            for a, cost in enumerate(costs.tolist()):
                if cost <= c:
                    best = np.maximum(
                        best, rewards[:, a] + transitions[a] @ solve(c - cost)
                    )
            memory[c] = best if np.isfinite(best).all() else np.zeros_like(best)
        return memory[c]

    return np.stack([solve(c) for c in range(charge + 1)])


def battery_9(transitions, rewards, costs, charge):
    S, A = rewards.shape
    V = np.zeros((charge + 1, S))
    reached = np.zeros(charge + 1, dtype=bool)
    for c in range(charge + 1):
        for a in range(A):
            before = c - costs[a]
            if before >= 0:
                new = rewards[:, a] + V[before] @ transitions[a].T
                V[c] = np.maximum(V[c], new) if reached[c] else new
                reached[c] = True
    return V


def battery_10(transitions, rewards, costs, charge):
    V = np.zeros((charge + 1, rewards.shape[0]))
    for c, _ in enumerate(V):
        mask = costs <= c
        if mask.sum() == 0:
            continue
        Q = rewards[:, mask].copy()
        for j, a in enumerate(np.where(mask)[0]):
            Q[:, j] += np.sum(transitions[a] * V[c - costs[a]][None, :], axis=1)
        V[c] = np.amax(Q, axis=1)
    return V


def battery_11(transitions, rewards, costs, charge):
    history = {0: np.zeros(len(rewards))}
    level = 1
    while level <= charge:
        history[level] = np.zeros(len(rewards))
        ok = [a for a in range(len(costs)) if costs[a] <= level]
        for s in range(len(rewards)):
            if ok:
                history[level][s] = max(
                    rewards[s, a] + transitions[a, s] @ history[level - costs[a]]
                    for a in ok
                )
        level += 1
    return [history[c] for c in sorted(history)]


def battery_12(transitions, rewards, costs, charge):
    V = np.zeros((charge + 1, transitions.shape[-1]))
    for c in range(int(min(costs)), charge + 1):
        ahead = np.array([V[max(c - k, 0)] for k in costs])
        Q = rewards + np.matmul(transitions, ahead[:, :, None])[:, :, 0].T
        Q[:, costs > c] = -1e300
        V[c] = Q.max(axis=1)
    return V
