"""Twelve ways to write exercise 3.5, as students who do not know each other would."""

from itertools import groupby

import numpy as np


def effective_1(states, actions):
    mask = np.any(states[:, :9] > 0, axis=1)
    s, a = states[mask], actions[mask]
    keep = np.ones(len(s), dtype=bool)
    for i in range(1, len(s)):
        if np.array_equal(s[i], s[i - 1]) and a[i] == a[i - 1]:
            keep[i] = False
    return s[keep], a[keep]


def effective_2(states, actions):
    kept_states, kept_actions = [], []
    for state, action in zip(states, actions):
        if sum(state[:9]) == 0:
            continue
        if (
            kept_states
            and (state == kept_states[-1]).all()
            and action == kept_actions[-1]
        ):
            continue
        kept_states.append(state)
        kept_actions.append(action)
    return np.array(kept_states, dtype=int).reshape(-1, 11), np.array(kept_actions)


def effective_3(states, actions):
    both = np.column_stack([states, actions])
    both = both[states[:, :9].max(axis=1) > 0]
    changed = np.diff(both, axis=0).any(axis=1)
    both = both[np.concatenate(([True] * (len(both) > 0), changed)).astype(bool)]
    return both[:, :-1], both[:, -1]


def effective_4(states, actions):
    pairs = [(tuple(s), int(a)) for s, a in zip(states.tolist(), actions) if any(s[:9])]
    unique = [pair for pair, _ in groupby(pairs)]
    return (
        np.array([s for s, _ in unique], dtype=int).reshape(len(unique), 11),
        np.array([a for _, a in unique], dtype=int),
    )


def effective_5(states, actions):
    indices = []
    last = None
    for t in range(len(states)):
        if not np.any(states[t, 0:9]):
            continue
        if (
            last is None
            or actions[t] != actions[last]
            or np.any(states[t] != states[last])
        ):
            indices.append(t)
        last = t
    return states[indices], actions[indices]


def effective_6(states, actions):
    near = np.flatnonzero(states[:, :9].sum(axis=1))
    if near.size == 0:
        return states[:0], actions[:0]
    previous, current = near[:-1], near[1:]
    different = (states[current] != states[previous]).any(axis=1)
    different |= actions[current] != actions[previous]
    chosen = np.r_[near[0], current[different]]
    return states[chosen], actions[chosen]


def effective_7(states, actions):
    def detects(state):
        return max(state[i] for i in range(9)) > 0

    result = []
    for t in range(len(actions)):
        entry = [*states[t].tolist(), int(actions[t])]
        if detects(entry):
            result.append(entry)
    result = [e for k, e in enumerate(result) if k == 0 or e != result[k - 1]]
    table = np.array(result, dtype=int).reshape(-1, 12)
    return table[:, :11], table[:, 11]


def effective_8(states, actions):
    danger = states[:, :9]
    select = (danger != 0).sum(axis=1) >= 1
    states, actions = states[select, :], actions[select]
    shifted = np.roll(states, 1, axis=0)
    repeated = (states == shifted).all(axis=1) & (actions == np.roll(actions, 1))
    repeated[:1] = False
    return np.delete(states, np.where(repeated), axis=0), actions[~repeated]


def effective_9(states, actions):
    out_s, out_a = np.zeros((0, 11), dtype=int), np.zeros(0, dtype=int)
    before = None
    for k in range(states.shape[0]):
        count = 0
        for j in range(9):
            if states[k, j] > 0:
                count += 1
        if count > 0:
            now = (*states[k], actions[k])
            if now != before:
                out_s = np.vstack([out_s, states[k]])
                out_a = np.append(out_a, actions[k])
            before = now
    return out_s, out_a


def effective_10(states, actions):
    keys = [row.tobytes() + bytes([a]) for row, a in zip(states, actions.astype(int))]
    rows = [t for t in range(len(keys)) if states[t, :9].any()]
    first = [t for n, t in enumerate(rows) if n == 0 or keys[t] != keys[rows[n - 1]]]
    return states[first], actions[first]


def effective_11(states, actions):
    i = 0
    s = states[(states[:, :9] > 0).any(1)]
    a = actions[(states[:, :9] > 0).any(1)]
    picked = []
    while i < len(a):
        picked.append(i)
        j = i + 1
        while j < len(a) and a[j] == a[i] and (s[j] == s[i]).all():
            j += 1
        i = j
    return s[picked], a[picked]


def effective_12(states, actions):
    sensed = np.where(np.count_nonzero(states[:, :9], axis=1) > 0)[0]
    S, A = states.take(sensed, axis=0), actions.take(sensed)
    run = np.zeros(len(A), dtype=int)
    for n in range(1, len(A)):
        new = not (np.all(S[n] == S[n - 1]) and A[n] == A[n - 1])
        run[n] = run[n - 1] + new
    _, starts = np.unique(run, return_index=True)
    return S[starts], A[starts]
