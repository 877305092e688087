"""Twelve ways to write exercise 2.1, as students who do not know each other would."""

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
