"""Twelve ways to write exercise 2.2, as students who do not know each other would."""

import numpy as np


def improve_1(q, policy, tolerance):
    current = q[np.arange(len(policy)), policy]
    best = q.argmax(axis=1)
    gain = q.max(axis=1) - current
    return np.where(gain > tolerance, best, policy)


def improve_2(q, policy, tolerance):
    new_policy = []
    for s in range(len(policy)):
        best_action = int(np.argmax(q[s]))
        if q[s][best_action] - q[s][policy[s]] > tolerance:
            new_policy.append(best_action)
        else:
            new_policy.append(policy[s])
    return np.array(new_policy)


def improve_3(q, policy, tolerance):
    result = policy.copy()
    rows = np.arange(q.shape[0])
    improvement = q.max(axis=1) - q[rows, policy]
    mask = improvement > tolerance
    result[mask] = np.argmax(q, axis=1)[mask]
    return result


def improve_4(q, policy, tolerance):
    S, A = q.shape
    out = np.zeros(S, dtype=int)
    for s in range(S):
        best = 0
        for a in range(1, A):
            if q[s, a] > q[s, best]:
                best = a
        out[s] = policy[s]
        if q[s, best] > q[s, policy[s]] + tolerance:
            out[s] = best
    return out


def improve_5(q, policy, tolerance):
    advantage = q - np.take_along_axis(q, policy[:, None], axis=1)
    changed = (advantage > tolerance).any(axis=1)
    return np.where(changed, advantage.argmax(axis=1), policy)


def improve_6(q, policy, tolerance):
    def choose(values, action):
        top = max(values)
        if top - values[action] <= tolerance:
            return action
        return values.index(top)

    return [choose(row, a) for row, a in zip(q.tolist(), policy.tolist())]


def improve_7(q, policy, tolerance):
    best = np.argmax(q, 1)
    index = np.arange(len(q))
    better = q[index, best] - q[index, policy] > tolerance
    return better * best + (1 - better) * policy


def improve_8(q, policy, tolerance):
    policy = np.array(policy)
    for state, values in enumerate(q):
        old = policy[state]
        difference = values.max() - values[old]
        if difference > tolerance:
            policy[state] = values.argmax()
    return policy


def improve_9(q, policy, tolerance):
    kept = q[range(len(q)), policy] + tolerance
    candidates = np.where(q > kept[:, None], q, -np.inf)
    actions = np.argmax(candidates, axis=1)
    none = np.isneginf(candidates).all(axis=1)
    actions[none] = policy[none]
    return actions


def improve_10(q, policy, tolerance):
    updated = list(policy)
    gains = np.max(q, axis=1) - np.array([q[i, p] for i, p in enumerate(policy)])
    for i in np.flatnonzero(gains > tolerance):
        updated[i] = np.argmax(q[i])
    return updated


def improve_11(q, policy, tolerance):
    answer = []
    for row, action in zip(q, policy):
        ranked = sorted(range(len(row)), key=lambda a: (-row[a], a))
        first = ranked[0]
        stay = row[first] - row[action] <= tolerance
        answer.append(action if stay else first)
    return answer


def improve_12(q, policy, tolerance):
    maxima = q.max(axis=1)
    now = np.choose(policy, q.T)
    return np.array(
        [
            policy[s] if maxima[s] - now[s] <= tolerance else q[s].argmax()
            for s in range(len(q))
        ]
    )
