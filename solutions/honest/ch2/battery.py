"""Thirty ways to write exercise 2.7, as students who do not know each other would."""

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


def battery_13(transitions, rewards, costs, charge):
    number_of_actions = transitions.shape[0]
    number_of_states = transitions.shape[1]
    values = np.zeros((charge + 1, number_of_states))
    for units in range(1, charge + 1):
        for state in range(number_of_states):
            best_value = -np.inf
            any_possible = False
            for action in range(number_of_actions):
                if costs[action] <= units:
                    any_possible = True
                    units_left = units - costs[action]
                    expected = 0.0
                    for next_state in range(number_of_states):
                        probability = transitions[action, state, next_state]
                        expected += probability * values[units_left, next_state]
                    value = rewards[state, action] + expected
                    if value > best_value:
                        best_value = value
            if any_possible:
                values[units, state] = best_value
            else:
                values[units, state] = 0.0
    return values


def battery_14(transitions, rewards, costs, charge):
    S = rewards.shape[0]
    V = [np.zeros(S)]
    for c in range(1, charge + 1):
        q = np.array(
            [
                rewards[:, a] + transitions[a] @ V[c - k]
                if k <= c
                else np.full(S, -np.inf)
                for a, k in enumerate(costs)
            ]
        )
        best = q.max(axis=0)
        V.append(np.where(np.isneginf(best), 0.0, best))
    return np.vstack(V)


def battery_15(transitions, rewards, costs, charge):
    # forward: every solved row is pushed to the charges from which it is reached
    S, A = rewards.shape
    best = np.full((charge + 1, S), -np.inf)
    for c in range(charge + 1):
        best[c][np.isneginf(best[c])] = 0
        for a in range(A):
            higher = c + costs[a]
            if higher <= charge:
                candidate = rewards[:, a] + transitions[a] @ best[c]
                best[higher] = np.maximum(best[higher], candidate)
    return best


def battery_16(transitions, rewards, costs, charge):
    def plan(c, known):
        if c > charge:
            return known
        possible = [a for a, cost in enumerate(costs) if cost <= c]
        if possible:
            row = np.max(
                [
                    transitions[a].dot(known[c - costs[a]]) + rewards[:, a]
                    for a in possible
                ],
                axis=0,
            )
        else:
            row = np.zeros(rewards.shape[0])
        return plan(c + 1, [*known, row])

    return np.array(plan(0, []))


def battery_17(transitions, rewards, costs, charge):
    order = np.argsort(costs)
    sorted_costs = costs[order]
    V = np.zeros((charge + 1, len(rewards)))
    for c in range(charge + 1):
        m = np.searchsorted(sorted_costs, c, side="right")
        if m == 0:
            continue
        allowed = order[:m]
        V[c] = np.stack(
            [rewards[:, a] + V[c - costs[a]] @ transitions[a].T for a in allowed]
        ).max(axis=0)
    return V


def battery_18(transitions, rewards, costs, charge):
    A, S = transitions.shape[:2]
    Q = np.full((charge + 1, S, A), -np.inf)
    V = np.zeros((charge + 1, S))
    for c in range(1, charge + 1):
        for a in range(A):
            if c - costs[a] < 0:
                continue
            for s in range(S):
                Q[c, s, a] = rewards[s, a] + np.dot(transitions[a, s], V[c - costs[a]])
        if np.isfinite(Q[c]).any():
            V[c] = Q[c].max(axis=-1)
    return V


def battery_19(transitions, rewards, costs, charge):
    class Planner:
        def __init__(self):
            self.rows = {}

        def row(self, c):
            if c in self.rows:
                return self.rows[c]
            options = []
            for action, cost in enumerate(costs):
                if cost <= c:
                    options.append(self.q(c - int(cost), action))
            self.rows[c] = np.maximum.reduce(options) if options else self.nothing()
            return self.rows[c]

        def q(self, left, action):
            return rewards[:, action] + transitions[action] @ self.row(left)

        def nothing(self):
            return np.zeros(rewards.shape[0])

    planner = Planner()
    return [planner.row(c) for c in range(charge + 1)]


def battery_20(transitions, rewards, costs, charge):
    result = np.zeros((charge + 1, rewards.shape[0]))
    for c in range(1, charge + 1):
        ok = costs <= c
        before = np.where(ok, c - costs, 0)
        q = rewards.T + np.einsum("ast,at->as", transitions, result[before])
        q = np.ma.array(q, mask=np.repeat(~ok[:, None], q.shape[1], axis=1))
        result[c] = q.max(axis=0).filled(0)
    return result


def battery_21(transitions, rewards, costs, charge):
    values = []
    for c in range(charge + 1):
        row = []
        for s in range(rewards.shape[0]):
            best = float("-inf")
            for a, (cost, r) in enumerate(zip(costs, rewards[s])):
                try:
                    if cost > c:
                        raise IndexError
                    after = values[c - cost]
                except IndexError:
                    continue
                best = max(
                    best, r + sum(p * v for p, v in zip(transitions[a][s], after))
                )
            row.append(0.0 if best == float("-inf") else best)
        values.append(row)
    return np.array(values)


def battery_22(transitions, rewards, costs, charge):
    n = rewards.shape[0]
    table = np.zeros((charge + 1, n))
    c = int(costs.min())
    while c <= charge:
        first = True
        for a in range(len(costs)):
            if costs[a] > c:
                continue
            q = rewards[:, a] + np.matmul(transitions[a], table[c - costs[a]])
            if first:
                table[c] = q
                first = False
            else:
                better = q > table[c]
                table[c, better] = q[better]
        c += 1
    return table


def battery_23(transitions, rewards, costs, charge):
    S = rewards.shape[0]
    rows = np.zeros((charge + 1, S))

    def value(a, c):
        return rewards[:, a] + (transitions[a] * rows[c - costs[a]]).sum(axis=1)

    for c in range(1, charge + 1):
        usable = filter(lambda a: costs[a] <= c, range(len(costs)))
        candidates = [*map(lambda a: value(a, c), usable)]
        rows[c] = np.amax(candidates, axis=0) if candidates else 0
    return rows


def battery_24(transitions, rewards, costs, charge):
    # a state is a pair of charge and place, and one sweep from below solves it
    S, A = rewards.shape
    V = np.zeros((charge + 1) * S)
    for state in range(len(V)):
        c, s = divmod(state, S)
        q_values = []
        for a in range(A):
            rest = c - int(costs[a])
            if rest >= 0:
                following = V[rest * S : (rest + 1) * S]
                q_values.append(rewards[s, a] + transitions[a, s] @ following)
        V[state] = max(q_values) if q_values else 0
    return V.reshape(charge + 1, S)


def battery_25(transitions, rewards, costs, charge):
    V = np.zeros((charge + 1, rewards.shape[0]))
    # sweeps until nothing changes
    while True:
        old = V.copy()
        for c in range(charge, 0, -1):
            q = [
                rewards[:, a] + transitions[a] @ old[c - costs[a]]
                for a in np.nonzero(costs <= c)[0]
            ]
            if len(q):
                V[c] = np.array(q).max(axis=0)
        if np.array_equal(V, old):
            return V


def battery_26(transitions, rewards, costs, charge):
    num_states = transitions.shape[2]
    v = {}
    for s in range(num_states):
        v[0, s] = 0.0
    for c in range(1, charge + 1):
        for s in range(num_states):
            choices = []
            for a in range(transitions.shape[0]):
                remaining = c - costs[a]
                if remaining < 0:
                    continue
                total = rewards[s, a]
                for s_next in range(num_states):
                    total += transitions[a, s, s_next] * v[remaining, s_next]
                choices.append(total)
            choices.sort(reverse=True)
            v[c, s] = choices[0] if choices else 0.0
    out = np.zeros((charge + 1, num_states))
    for (c, s), x in v.items():
        out[c, s] = x
    return out


def battery_27(transitions, rewards, costs, charge):
    from collections import deque

    longest = int(max(costs))
    recent = deque([np.zeros(rewards.shape[0])], maxlen=longest)
    output = [recent[0]]
    for level in range(1, charge + 1):
        best = None
        for action in range(rewards.shape[1]):
            if costs[action] <= level:
                q = rewards[:, action] + transitions[action] @ recent[-costs[action]]
                best = q if best is None else np.fmax(best, q)
        recent.append(np.zeros(rewards.shape[0]) if best is None else best)
        output.append(recent[-1])
    return np.array(output)


def battery_28(transitions, rewards, costs, charge):
    stacked = transitions.transpose(1, 0, 2)  # by state, action, next state
    V = np.zeros((charge + 1, stacked.shape[0]))
    for c in range(1, charge + 1):
        for s in range(stacked.shape[0]):
            q = rewards[s].astype(float).copy()
            for a in range(len(q)):
                q[a] = (
                    q[a] + stacked[s, a] @ V[c - costs[a]] if costs[a] <= c else -1e18
                )
            V[c, s] = q[np.argmax(q)] if q.max() > -1e18 else 0.0
    return V


def battery_29(transitions, rewards, costs, charge):
    actions = sorted(range(len(costs)), key=lambda a: costs[a])
    V = np.zeros((charge + 1, transitions.shape[1]))
    for c in range(1, charge + 1):
        best = np.full(V.shape[1], np.nan)
        for a in actions:
            if costs[a] > c:
                break
            best = np.fmax(
                best, rewards[:, a] + np.inner(transitions[a], V[c - costs[a]])
            )
        V[c] = np.nan_to_num(best)
    return V


def battery_30(transitions, rewards, costs, charge):
    A = len(costs)

    def rows():
        past = []
        for c in range(charge + 1):
            new = np.zeros(rewards.shape[0])
            affordable = tuple(a for a in range(A) if c // costs[a] > 0)
            for s in range(rewards.shape[0] if affordable else 0):
                new[s] = max(
                    rewards[s, a] + np.sum(transitions[a, s, :] * past[c - costs[a]])
                    for a in affordable
                )
            past.append(new)
            yield new

    return np.array(list(rows()))
