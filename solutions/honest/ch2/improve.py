"""Thirty ways to write exercise 2.2, as students who do not know each other would."""

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


def improve_13(q, policy, tolerance):
    number_of_states = q.shape[0]
    number_of_actions = q.shape[1]
    new_policy = np.zeros(number_of_states, dtype=int)
    for state in range(number_of_states):
        current_action = policy[state]
        current_value = q[state, current_action]
        best_action = current_action
        best_value = current_value + tolerance
        for action in range(number_of_actions):
            if q[state, action] > best_value:
                best_value = q[state, action]
                best_action = action
        new_policy[state] = best_action
    return new_policy


def improve_14(q, policy, tolerance):
    value_now = np.diag(q[:, policy])
    change = np.max(q, axis=1) > value_now + tolerance
    new = np.array(policy)
    np.putmask(new, change, np.argmax(q, axis=1))
    return new


def improve_15(q, policy, tolerance):
    def gain(s):
        return max(q[s]) - q[s, policy[s]]

    return np.array(
        [
            list(q[s]).index(max(q[s])) if gain(s) > tolerance else policy[s]
            for s in range(len(q))
        ]
    )


def improve_16(q, policy, tolerance):
    S = len(q)
    one_hot = np.zeros(q.shape, dtype=bool)
    one_hot[np.arange(S), policy] = True
    stays = q[one_hot]
    leader = q.argmax(axis=-1)
    worth = np.amax(q, axis=-1) - stays > tolerance
    return np.choose(worth, (policy, leader))


def improve_17(q, policy, tolerance):
    actions = policy.tolist()
    for s, row in enumerate(q):
        order = np.argsort(-row, kind="stable")
        if row[order[0]] > row[actions[s]] + tolerance:
            actions[s] = int(order[0])
    return np.array(actions)


def improve_18(q, policy, tolerance):
    q_bonus = q.copy()
    rows = np.indices(policy.shape)[0]
    own = q_bonus[rows, policy]
    best = np.nanargmax(q_bonus, axis=1)
    keep = ~(q_bonus[rows, best] - own > tolerance)
    best[keep] = policy[keep]
    return best


def improve_19(q, policy, tolerance):
    from functools import reduce

    def better(row):
        return reduce(lambda i, j: j if row[j] > row[i] else i, range(len(row)))

    result = []
    for s in range(policy.size):
        candidate = better(q[s])
        difference = q[s, candidate] - q[s, policy[s]]
        result += [candidate] if difference > tolerance else [policy[s]]
    return np.array(result)


def improve_20(q, policy, tolerance):
    s = 0
    improved = policy * 1
    while s < len(policy):
        a = q[s].argmax()
        if abs(q[s][a] - q[s][improved[s]]) > tolerance:
            improved[s] = a
        s = s + 1
    return improved


def improve_21(q, policy, tolerance):
    q_pi = np.einsum("sa,sa->s", q, np.eye(q.shape[1])[policy])
    regret = q.max(1) - q_pi
    switch = regret > tolerance
    return policy + switch * (q.argmax(1) - policy)


def improve_22(q, policy, tolerance):
    new = {}
    for s in range(q.shape[0]):
        new[s] = policy[s]
        threshold = q[s, policy[s]] + tolerance
        above = [a for a in range(q.shape[1]) if q[s, a] > threshold]
        if above:
            new[s] = min(above, key=lambda a: (-q[s, a], a))
    return np.array(list(new.values()))


def improve_23(q, policy, tolerance):
    flat = q.ravel()[np.arange(len(q)) * q.shape[1] + policy]
    highest = np.max(q, axis=1)
    first_best = (q == highest[:, None]).argmax(axis=1)
    return np.where(highest <= flat + tolerance, policy, first_best)


def improve_24(q, policy, tolerance):
    class Improver:
        def __init__(self, values):
            self.values = values

        def action(self, old):
            best = int(self.values.argmax())
            if self.values[best] - self.values[old] > tolerance:
                return best
            return old

    return np.array([Improver(row).action(a) for row, a in zip(q, policy)])


def improve_25(q, policy, tolerance):
    out = np.empty_like(policy)
    for s, a in enumerate(policy):
        if np.all(q[s] - q[s, a] <= tolerance):
            out[s] = a
        else:
            out[s] = np.flatnonzero(q[s] == np.max(q[s]))[0]
    return out


def improve_26(q, policy, tolerance):
    current = q[np.arange(len(q)), policy][:, np.newaxis]
    gains = q - current
    gains[gains <= tolerance] = -1.0
    best = gains.argmax(axis=1)
    return np.where(gains.max(axis=1) < 0, policy, best)


def improve_27(q, policy, tolerance):
    if len(policy) == 0:
        return policy
    head = policy[0]
    top = q[0].max()
    if top - q[0, head] > tolerance:
        head = q[0].tolist().index(top)
    return np.append([head], improve_27(q[1:], policy[1:], tolerance)).astype(int)


def improve_28(q, policy, tolerance):
    def per_state(row_and_action):
        *row, action = row_and_action
        action = int(action)
        best = max(range(len(row)), key=row.__getitem__)
        return best if row[best] > row[action] + tolerance else action

    return np.apply_along_axis(per_state, 1, np.column_stack([q, policy]))


def improve_29(q, policy, tolerance):
    states = range(len(policy))
    best_values = [max(q[s, a] for a in range(q.shape[1])) for s in states]
    p = np.array(policy, copy=True)
    for s in states:
        if best_values[s] - q[s, policy[s]] > tolerance:
            a = 0
            while q[s, a] != best_values[s]:
                a += 1
            p[s] = a
    return p


def improve_30(q, policy, tolerance):
    greedy = np.argmax(q, axis=1)
    idx = np.arange(q.shape[0])
    delta = np.subtract(q[idx, greedy], q[idx, policy])
    improved = policy.copy()
    for i in np.where(delta > tolerance)[0]:
        improved[i] = greedy[i]
    return improved
