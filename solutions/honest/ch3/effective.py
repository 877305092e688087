"""Thirty ways to write exercise 3.5, as students who do not know each other would."""

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


def effective_13(states, actions):
    new_states = []
    new_actions = []
    previous_state = None
    previous_action = None
    for t in range(len(states)):
        detected = False
        for sensor in range(9):
            if states[t][sensor] != 0:
                detected = True
        if detected:
            same = False
            if previous_state is not None:
                same = (
                    list(previous_state) == list(states[t])
                    and previous_action == actions[t]
                )
            if not same:
                new_states.append(states[t])
                new_actions.append(actions[t])
            previous_state = states[t]
            previous_action = actions[t]
    if len(new_states) == 0:
        return np.zeros((0, 11), dtype=int), np.zeros(0, dtype=int)
    return np.array(new_states), np.array(new_actions)


def effective_14(states, actions):
    m = states[:, :9].any(axis=1)
    s, a = states[m], actions[m]
    if len(s) < 2:
        return s, a
    fresh = (s[1:] != s[:-1]).any(axis=1) | (a[1:] != a[:-1])
    fresh = np.insert(fresh, 0, True)
    return s[fresh], a[fresh]


def effective_15(states, actions):
    def pairs():
        last = None
        for s, a in zip(states, actions):
            if s[:9].max() == 0:
                continue
            pair = (s.tolist(), a)
            if pair != last:
                yield pair
            last = pair

    chosen = list(pairs())
    kept = np.array([s for s, _ in chosen], dtype=states.dtype)
    return kept.reshape(-1, states.shape[1]), np.array(
        [a for _, a in chosen], dtype=int
    )


def effective_16(states, actions):
    data = np.hstack([states, actions[:, None]])
    data = data[np.sum(data[:, :9], axis=1) > 0]
    # each row next to the one before it; nothing is before the first
    before = (
        np.vstack([np.full((1, data.shape[1]), -1), data[:-1]]) if len(data) else data
    )
    data = data[~np.all(data == before, axis=1)]
    return data[:, :11], data[:, 11]


def effective_17(states, actions):
    effective_rows = [t for t in range(len(states)) if np.sum(states[t, :9] > 0)]
    keep = effective_rows[:1]
    for earlier, later in zip(effective_rows, effective_rows[1:]):
        if actions[earlier] == actions[later]:
            if np.array_equal(states[earlier], states[later]):
                continue
        keep.append(later)
    return states[keep], actions[keep]


def effective_18(states, actions):
    def without_repetitions(rows):
        if len(rows) <= 1:
            return rows
        head, *tail = rows
        while tail and tail[0] == head:
            tail = tail[1:]
        return [head, *without_repetitions(tail)]

    rows = [(*map(int, s), int(a)) for s, a in zip(states, actions) if s[:9].sum() > 0]
    found = np.array(without_repetitions(rows), dtype=int).reshape(-1, 12)
    return np.split(found, [11], axis=1)[0], found[:, -1]


def effective_19(states, actions):
    index = np.nonzero(states[:, :9].max(axis=1))[0]
    _, code = np.unique(
        np.c_[states[index], actions[index]], axis=0, return_inverse=True
    )
    code = code.reshape(-1)
    first = np.ones(len(index), dtype=bool)
    first[1:] = code[1:] != code[:-1]
    return states[index[first]], actions[index[first]]


def effective_20(states, actions):
    class Recorder:
        def __init__(self):
            self.states, self.actions = [], []

        def add(self, state, action):
            if self.actions and self.actions[-1] == action:
                if (self.states[-1] == state).all():
                    return
            self.states.append(state)
            self.actions.append(action)

    recorder = Recorder()
    for t, action in enumerate(actions):
        if np.count_nonzero(states[t][:9]):
            recorder.add(states[t], action)
    if not recorder.actions:
        return states[:0], actions[:0]
    return np.stack(recorder.states), np.stack(recorder.actions)


def effective_21(states, actions):
    sensing = (states[:, 0:9] > 0).sum(axis=1) > 0
    positions = np.arange(len(states))[sensing]
    result = []
    for n, p in enumerate(positions):
        if n == 0:
            result.append(p)
        else:
            o = positions[n - 1]
            difference = np.abs(states[p] - states[o]).sum() + abs(
                actions[p] - actions[o]
            )
            if difference > 0:
                result.append(p)
    result = np.array(result, dtype=int)
    return states[result], actions[result]


def effective_22(states, actions):
    keep = np.zeros(len(actions), dtype=bool)
    prev = -1
    t = 0
    while t < len(actions):
        if states[t, :9].any():
            if prev == -1:
                keep[t] = True
            else:
                keep[t] = (
                    actions[t] != actions[prev] or (states[t] != states[prev]).any()
                )
            prev = t
        t += 1
    return states[keep], actions[keep]


def effective_23(states, actions):
    from itertools import compress

    near = [any(d > 0 for d in s[:9]) for s in states]
    s = list(compress(map(tuple, states), near))
    a = list(compress(actions, near))
    different = [k == 0 or (s[k], a[k]) != (s[k - 1], a[k - 1]) for k in range(len(a))]
    s, a = list(compress(s, different)), list(compress(a, different))
    return np.array(s, dtype=int).reshape(len(s), 11), np.array(a, dtype=int)


def effective_24(states, actions):
    in_range = np.where(states[:, :9] > 0, 1, 0).max(axis=1).astype(bool)
    states = states[in_range]
    actions = actions[in_range]
    n = len(actions)
    remove = []
    for i in range(n - 1):
        if np.all(states[i + 1] == states[i]) and actions[i + 1] == actions[i]:
            remove.append(i + 1)
    return np.delete(states, remove, axis=0), np.delete(actions, remove)


def effective_25(states, actions):
    import pandas as pd

    table = pd.DataFrame(np.column_stack([states, actions]))
    table = table[table.iloc[:, :9].gt(0).any(axis=1)]
    table = table[table.ne(table.shift()).any(axis=1)]
    numbers = table.to_numpy(dtype=int)
    return numbers[:, :11], numbers[:, 11]


def effective_26(states, actions):
    joined = ["-".join(map(str, [*s, a])) for s, a in zip(states, actions)]
    current = ""
    rows = []
    for t, text in enumerate(joined):
        if sum(states[t, :9]) > 0:
            if text != current:
                rows.append(t)
            current = text
    return states[rows].reshape(-1, 11), actions[rows]


def effective_27(states, actions):
    e = np.flatnonzero(np.any(states[:, :9], axis=1))
    S, A = states[e], actions[e]
    jumps = np.flatnonzero(np.any(np.diff(S, axis=0), axis=1) | (np.diff(A) != 0)) + 1
    starts = np.concatenate([[0], jumps]).astype(int)[: len(e)]
    return S[starts], A[starts]


def effective_28(states, actions):
    out = []
    for i in range(len(states)):
        if max(states[i, :9]) > 0:
            out.append(i)
    i = len(out) - 1
    # from the end, so that removing changes nothing before it
    while i > 0:
        if (states[out[i]] == states[out[i - 1]]).all() and actions[out[i]] == actions[
            out[i - 1]
        ]:
            del out[i]
        i -= 1
    return states[out], actions[out]


def effective_29(states, actions):
    from functools import reduce

    def add(found, pair):
        return found if found and found[-1] == pair else [*found, pair]

    table = np.concatenate((states, actions.reshape(-1, 1)), axis=1)
    rows = filter(lambda row: any(row[:9]), table.tolist())
    unique = np.array(reduce(add, rows, []), dtype=int).reshape((-1, 12))
    return unique[:, :-1], unique[:, -1]


def effective_30(states, actions):
    danger = states[:, :9].sum(1)
    s = np.compress(danger > 0, states, axis=0)
    a = np.extract(danger > 0, actions)
    equal_state = [bool(np.prod(s[k] == s[k + 1])) for k in range(len(a) - 1)]
    equal_action = np.equal(a[1:], a[:-1])
    same = np.logical_and(np.array(equal_state, dtype=bool), equal_action)
    ok = np.logical_not(np.concatenate(([False], same)))[: len(a)]
    return s[ok, :], a[ok]
