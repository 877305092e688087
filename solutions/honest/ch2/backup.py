"""Thirty ways to write exercise 2.1, as students who do not know each other would."""

import numpy as np


def backup_1(transitions, rewards, discount, values, terminal):
    v = np.where(terminal, 0, values)
    q = (transitions * (rewards + discount * v)).sum(axis=2).T
    q[terminal] = 0
    return q


def backup_2(transitions, rewards, discount, values, terminal):
    A, S, _ = transitions.shape
    Q = np.zeros((S, A))
    for s in range(S):
        if terminal[s]:
            continue
        for a in range(A):
            for s2 in range(S):
                next_value = 0 if terminal[s2] else values[s2]
                Q[s, a] += transitions[a, s, s2] * (
                    rewards[a, s, s2] + discount * next_value
                )
    return Q


def backup_3(transitions, rewards, discount, values, terminal):
    expected_reward = np.einsum("ast,ast->sa", transitions, rewards)
    expected_value = np.einsum("ast,t->sa", transitions, values * ~terminal)
    result = expected_reward + discount * expected_value
    result[terminal, :] = 0.0
    return result


def backup_4(transitions, rewards, discount, values, terminal):
    alive = 1.0 - terminal
    target = rewards + discount * alive * values
    q = np.sum(transitions * target, axis=-1)
    return (q * alive).T


def backup_5(transitions, rewards, discount, values, terminal):
    values = values.copy()
    values[terminal] = 0
    columns = []
    for p, r in zip(transitions, rewards):
        column = np.sum(p * r, axis=1) + discount * p @ values
        column[terminal] = 0
        columns.append(column)
    return np.column_stack(columns)


def backup_6(transitions, rewards, discount, values, terminal):
    def q_value(s, a):
        if terminal[s]:
            return 0.0
        total = 0.0
        for t, p in enumerate(transitions[a, s]):
            future = 0.0 if terminal[t] else discount * values[t]
            total += p * (rewards[a, s, t] + future)
        return total

    return [
        [q_value(s, a) for a in range(len(transitions))] for s in range(len(values))
    ]


def backup_7(transitions, rewards, discount, values, terminal):
    n_actions, n_states = transitions.shape[:2]
    q = np.empty((n_states, n_actions))
    for a in range(n_actions):
        for s in range(n_states):
            q[s, a] = transitions[a, s] @ (
                rewards[a, s] + discount * np.where(terminal, 0, values)
            )
    q[terminal] = 0
    return q


def backup_8(transitions, rewards, discount, values, terminal):
    immediate = (transitions * rewards).sum(-1)
    later = transitions @ np.where(terminal, 0.0, values)
    both = immediate + discount * later
    return np.where(terminal[:, None], 0.0, both.T)


def backup_9(transitions, rewards, discount, values, terminal):
    go_on = np.flatnonzero(~terminal)
    out = np.zeros((transitions.shape[1], transitions.shape[0]))
    for s in go_on:
        steps = transitions[:, s, :] * rewards[:, s, :]
        out[s] = steps.sum(axis=1)
        out[s] += discount * (transitions[:, s][:, go_on] @ values[go_on])
    return out


def backup_10(transitions, rewards, discount, values, terminal):
    masked = np.ma.array(values, mask=terminal).filled(0)
    inner = rewards + discount * masked[None, None, :]
    q = np.zeros(transitions.shape[:2])
    for t in range(len(values)):
        q += transitions[:, :, t] * inner[:, :, t]
    q = q.transpose()
    q[np.nonzero(terminal)] = 0
    return q


def backup_11(transitions, rewards, discount, values, terminal):
    table = []
    for s in range(len(terminal)):
        row = []
        for a in range(transitions.shape[0]):
            if terminal[s]:
                row.append(0)
            else:
                terms = [
                    p * (r + (not done) * discount * v)
                    for p, r, v, done in zip(
                        transitions[a, s], rewards[a, s], values, terminal
                    )
                ]
                row.append(sum(terms))
        table.append(row)
    return np.array(table)


def backup_12(transitions, rewards, discount, values, terminal):
    weights = transitions * ~terminal[None, :, None]
    gain = np.einsum("ijk,ijk->ji", weights, rewards)
    follow = np.tensordot(weights, np.where(terminal, 0, values), axes=(2, 0)).T
    return gain + discount * follow


def backup_13(transitions, rewards, discount, values, terminal):
    number_of_actions = transitions.shape[0]
    number_of_states = transitions.shape[1]
    action_values = np.zeros((number_of_states, number_of_actions))
    for state in range(number_of_states):
        for action in range(number_of_actions):
            if terminal[state]:
                action_values[state, action] = 0
            else:
                expectation = 0
                for next_state in range(number_of_states):
                    probability = transitions[action, state, next_state]
                    reward = rewards[action, state, next_state]
                    if terminal[next_state]:
                        expectation = expectation + probability * reward
                    else:
                        later = discount * values[next_state]
                        expectation = expectation + probability * (reward + later)
                action_values[state, action] = expectation
    return action_values


def backup_14(transitions, rewards, discount, values, terminal):
    v = values * (1 - terminal)
    q = np.average(rewards + discount * v, axis=2, weights=transitions)
    return np.where(terminal, 0, q).T


def backup_15(transitions, rewards, discount, values, terminal):
    live = np.logical_not(terminal).astype(float)
    R = np.sum(transitions * rewards, axis=2)
    EV = np.dot(transitions, live * values)
    return ((R + discount * EV) * live[None, :]).swapaxes(0, 1)


def backup_16(transitions, rewards, discount, values, terminal):
    clean = [0.0 if end else v for v, end in zip(values, terminal)]
    q = np.zeros((len(values), len(transitions)))
    for a, (P, R) in enumerate(zip(transitions, rewards)):
        for s in np.where(terminal == False)[0]:
            q[s, a] = np.dot(P[s], R[s]) + discount * np.dot(P[s], clean)
    return q


def backup_17(transitions, rewards, discount, values, terminal):
    following = np.zeros(len(values))
    following[~terminal] = values[~terminal]
    result = np.array(
        [
            np.diag(p @ (r + discount * following).T)
            for p, r in zip(transitions, rewards)
        ]
    )
    result[:, terminal] = 0
    return np.transpose(result)


def backup_18(transitions, rewards, discount, values, terminal):
    A, S = transitions.shape[0], transitions.shape[1]
    # all pairs of state and action below one another
    P = transitions.transpose(1, 0, 2).reshape(S * A, S)
    R = rewards.transpose(1, 0, 2).reshape(S * A, S)
    masked = np.ma.masked_array(values, terminal)
    q = (P * R).sum(axis=1) + discount * P @ masked.filled(0.0)
    q = q.reshape(S, A)
    q[terminal] *= 0
    return q


def backup_19(transitions, rewards, discount, values, terminal):
    def expect(p, x):
        return sum(a * b for a, b in zip(p, x))

    v = [values[s] if not terminal[s] else 0 for s in range(len(values))]
    q = []
    for s in range(len(v)):
        if terminal[s]:
            q.append([0.0] * len(transitions))
            continue
        q.append(
            [
                expect(transitions[a][s], rewards[a][s])
                + discount * expect(transitions[a][s], v)
                for a in range(len(transitions))
            ]
        )
    return np.array(q)


def backup_20(transitions, rewards, discount, values, terminal):
    target = rewards.astype(float).copy()
    target[:, :, ~terminal] += discount * values[~terminal]
    target[:, terminal, :] = 0
    return np.einsum("ijk,ijk->ij", transitions, target).T


def backup_21(transitions, rewards, discount, values, terminal):
    q = np.zeros((transitions.shape[1], transitions.shape[0]))
    for index in np.ndindex(transitions.shape):
        a, s, t = index
        if terminal[s]:
            continue
        q[s, a] += transitions[index] * rewards[index]
        if not terminal[t]:
            q[s, a] += discount * transitions[index] * values[t]
    return q


def backup_22(transitions, rewards, discount, values, terminal):
    class State:
        def __init__(self, number):
            self.number = number
            self.value = 0.0 if terminal[number] else values[number]

        def q(self, action, others):
            if terminal[self.number]:
                return 0.0
            p, r = transitions[action, self.number], rewards[action, self.number]
            return sum(p[o.number] * (r[o.number] + discount * o.value) for o in others)

    all_states = [State(n) for n in range(len(values))]
    return np.array(
        [[s.q(a, all_states) for a in range(len(rewards))] for s in all_states]
    )


def backup_23(transitions, rewards, discount, values, terminal):
    nonterminal = ~terminal
    total = transitions * rewards
    total = (
        total + discount * transitions * (values * nonterminal)[np.newaxis, np.newaxis]
    )
    summed = np.add.reduce(total, axis=2)
    return np.multiply(summed, nonterminal).transpose()


def backup_24(transitions, rewards, discount, values, terminal):
    from functools import partial

    def column(v, a):
        one_step = transitions[a] * rewards[a]
        return one_step.sum(1) + discount * transitions[a].dot(v)

    masked = partial(column, np.choose(terminal, [values, 0]))
    q = np.stack([masked(a) for a in range(transitions.shape[0])], axis=1)
    return q * (~terminal).reshape(-1, 1)


def backup_25(transitions, rewards, discount, values, terminal):
    v = values.astype(float)
    for s in range(len(v)):
        if terminal[s]:
            v = np.concatenate([v[:s], [0.0], v[s + 1 :]])
    q = np.full((len(v), transitions.shape[0]), 0.0)
    s = 0
    while s < len(v):
        if not terminal[s]:
            for a in range(transitions.shape[0]):
                q[s][a] = (transitions[a][s] * (rewards[a][s] + discount * v)).sum()
        s += 1
    return q


def backup_26(transitions, rewards, discount, values, terminal):
    rows = np.flatnonzero(terminal == 0)
    P, R = transitions[:, rows], rewards[:, rows]
    inside = P[:, :, rows] @ values[rows]
    out = np.zeros(transitions.shape[:2][::-1])
    out[rows] = (np.einsum("asn,asn->as", P, R) + discount * inside).T
    return out


def backup_27(transitions, rewards, discount, values, terminal):
    terminal_states = set(np.flatnonzero(terminal).tolist())
    table = {}
    for a in range(len(transitions)):
        for s in range(len(values)):
            table[s, a] = 0.0
            for n in range(len(values)):
                if s in terminal_states:
                    break
                r = rewards[a][s][n]
                if n not in terminal_states:
                    r = r + discount * values[n]
                table[s, a] += transitions[a][s][n] * r
    return [[table[s, a] for a in range(len(transitions))] for s in range(len(values))]


def backup_28(transitions, rewards, discount, values, terminal):
    discounts = np.where(terminal, 0, discount)
    backed_up = rewards + (discounts * values)[None, None, :]
    q = np.matmul(transitions[:, :, None, :], backed_up[:, :, :, None]).squeeze((2, 3))
    q = q.T.copy()
    q[np.where(terminal)[0], :] = 0
    return q


def backup_29(transitions, rewards, discount, values, terminal):
    absorbing = np.diag(1.0 - terminal)
    q = []
    for a in range(transitions.shape[0]):
        r = (transitions[a] * rewards[a]) @ np.ones(len(values))
        q.append(absorbing @ (r + discount * transitions[a] @ absorbing @ values))
    return np.vstack(q).T


def backup_30(transitions, rewards, discount, values, terminal):
    def future(t):
        return 0.0 if terminal[t] else values[t]

    result = np.empty((len(terminal), transitions.shape[0]))
    for s, ended in enumerate(terminal):
        if ended:
            result[s] = 0
        else:
            gains = transitions[:, s] * rewards[:, s]
            afterwards = [discount * future(t) for t in range(len(terminal))]
            result[s] = gains.sum(axis=-1) + np.inner(transitions[:, s], afterwards)
    return result
