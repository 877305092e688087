"""Thirty ways to write exercise 2.5, as students who do not know each other would."""

import numpy as np


def targets_1(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    q_next = q[next_states]
    best = q_next.max(axis=1)
    sarsa = q[next_states, next_actions]
    expected = (1 - epsilon) * best + epsilon * q_next.mean(axis=1)
    values = np.array([best, sarsa, expected])
    values[:, terminated] = 0
    return rewards + discount * values


def targets_2(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    n = len(rewards)
    result = np.zeros((3, n))
    for i in range(n):
        result[:, i] = rewards[i]
        if not terminated[i]:
            row = q[next_states[i]]
            result[0, i] += discount * max(row)
            result[1, i] += discount * row[next_actions[i]]
            mean = sum(row) / len(row)
            result[2, i] += discount * ((1 - epsilon) * max(row) + epsilon * mean)
    return result


def targets_3(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    going = ~terminated
    following = q[next_states, :]
    q_learning = rewards + discount * following.max(axis=1) * going
    sarsa = rewards + discount * q[next_states, next_actions] * going
    mixture = epsilon * following.mean(axis=1) + (1 - epsilon) * following.max(axis=1)
    expected = rewards + discount * mixture * going
    return np.vstack([q_learning, sarsa, expected])


def targets_4(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    A = q.shape[1]
    policy = np.full(q.shape, epsilon / A)
    policy[np.arange(len(q)), q.argmax(axis=1)] += 1 - epsilon
    v_max = q.max(axis=1)
    v_exp = (policy * q).sum(axis=1)
    out = np.stack(
        [v_max[next_states], q[next_states, next_actions], v_exp[next_states]]
    )
    return rewards + discount * np.where(terminated, 0, out)


def targets_5(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    first, second, third = [], [], []
    for r, s, a, done in zip(rewards, next_states, next_actions, terminated):
        if done:
            first.append(r)
            second.append(r)
            third.append(r)
            continue
        greedy = np.max(q[s])
        uniform = np.mean(q[s])
        first.append(r + discount * greedy)
        second.append(r + discount * q[s, a])
        third.append(r + discount * (epsilon * uniform + (1 - epsilon) * greedy))
    return np.array([first, second, third])


def targets_6(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    gamma = discount * (1 - terminated.astype(float))
    table = q[next_states]
    rows = np.arange(len(table))
    t = np.empty((3, len(rewards)))
    t[0] = table.max(1)
    t[1] = table[rows, next_actions]
    t[2] = t[0] + epsilon * (table.mean(1) - t[0])
    return gamma * t + rewards


def targets_7(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    def value(kind, s, a):
        if kind == "q":
            return q[s].max()
        if kind == "sarsa":
            return q[s, a]
        explore = epsilon / q.shape[1] * q[s].sum()
        return explore + (1 - epsilon) * q[s].max()

    return [
        [
            r + (0 if end else discount * value(kind, s, a))
            for r, s, a, end in zip(rewards, next_states, next_actions, terminated)
        ]
        for kind in ("q", "sarsa", "expected")
    ]


def targets_8(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    result = np.tile(rewards.astype(float), (3, 1))
    on = np.flatnonzero(~terminated)
    s, a = next_states[on], next_actions[on]
    result[0, on] += discount * q[s].max(axis=1)
    result[1, on] += discount * q[s, a]
    result[2, on] += discount * (1 - epsilon) * q[s].max(axis=1)
    result[2, on] += discount * epsilon * q[s].mean(axis=1)
    return result


def targets_9(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    states, actions = q.shape
    exploring = np.ones((states, actions)) * epsilon / actions
    for s in range(states):
        best = np.flatnonzero(q[s] == q[s].max())
        exploring[s, best] += (1 - epsilon) / len(best)
    answers = []
    for n in range(len(rewards)):
        s = next_states[n]
        v = np.array([q[s].max(), q[s, next_actions[n]], exploring[s] @ q[s]])
        answers.append(rewards[n] + discount * v * (not terminated[n]))
    return np.transpose(answers)


def targets_10(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    maximum = np.amax(q, axis=1)[next_states]
    average = np.average(q, axis=1)[next_states]
    chosen = np.take(q.ravel(), next_states * q.shape[1] + next_actions)
    lines = (maximum, chosen, epsilon * average + (1 - epsilon) * maximum)
    return [np.where(terminated, rewards, rewards + discount * line) for line in lines]


def targets_11(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    N = rewards.shape[0]
    T = np.zeros((3, N))
    for i, (state, action) in enumerate(zip(next_states, next_actions)):
        bootstrap = np.zeros(3)
        if terminated[i] == 0:
            total = 0.0
            top = -np.inf
            for w in q[state]:
                total += w
                top = w if w > top else top
            bootstrap[0] = top
            bootstrap[1] = q[state, action]
            bootstrap[2] = epsilon * total / q.shape[1] + (1 - epsilon) * top
        T[:, i] = rewards[i] + discount * bootstrap
    return T


def targets_12(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    value = np.stack([q.max(axis=1), epsilon * q.mean(axis=1)])
    value[1] += (1 - epsilon) * value[0]
    after = value[:, next_states]
    after = np.insert(after, 1, q[next_states, next_actions], axis=0)
    after *= discount * np.logical_not(terminated)
    return after + rewards


def targets_13(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    number_of_steps = len(rewards)
    q_learning_targets = np.zeros(number_of_steps)
    sarsa_targets = np.zeros(number_of_steps)
    expected_sarsa_targets = np.zeros(number_of_steps)
    for step in range(number_of_steps):
        if terminated[step]:
            q_learning_targets[step] = rewards[step]
            sarsa_targets[step] = rewards[step]
            expected_sarsa_targets[step] = rewards[step]
        else:
            state = next_states[step]
            best_action = np.argmax(q[state])
            expectation = 0.0
            for action in range(q.shape[1]):
                probability = epsilon / q.shape[1]
                if action == best_action:
                    probability += 1 - epsilon
                expectation += probability * q[state, action]
            q_learning_targets[step] = rewards[step] + discount * q[state, best_action]
            sarsa_targets[step] = (
                rewards[step] + discount * q[state, next_actions[step]]
            )
            expected_sarsa_targets[step] = rewards[step] + discount * expectation
    return np.array([q_learning_targets, sarsa_targets, expected_sarsa_targets])


def targets_14(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    q_after = np.where(terminated[:, None], 0.0, q[next_states])
    greedy = q_after.max(axis=-1)
    taken = np.take_along_axis(q_after, next_actions[:, None], axis=-1)[:, 0]
    mixed = np.average(q_after, axis=-1) * epsilon + greedy * (1.0 - epsilon)
    return rewards[None, :] + discount * np.array((greedy, taken, mixed))


def targets_15(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    _, A = q.shape
    one_hot = np.eye(A)
    greedy = one_hot[q[next_states].argmax(axis=1)]
    policies = [greedy, one_hot[next_actions], (1 - epsilon) * greedy + epsilon / A]
    alive = 1 - terminated
    return np.array(
        [
            rewards + discount * alive * (p * q[next_states]).sum(axis=1)
            for p in policies
        ]
    )


def targets_16(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    def bootstrap(estimate):
        target = rewards.astype(float).copy()
        target[~terminated] += discount * estimate[~terminated]
        return target

    ahead = q[next_states]
    return np.stack(
        (
            bootstrap(np.max(ahead, axis=1)),
            bootstrap(ahead[np.arange(len(ahead)), next_actions]),
            bootstrap((1 - epsilon) * np.max(ahead, 1) + epsilon * np.mean(ahead, 1)),
        )
    )


def targets_17(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    out = []
    steps = list(zip(rewards, next_states, next_actions, terminated))
    out.append([r + discount * max(q[s]) * (1 - d) for r, s, _, d in steps])
    out.append([r + discount * q[s][a] * (1 - d) for r, s, a, d in steps])
    last = []
    for r, s, _, d in steps:
        k = len(q[s])
        v = sum(epsilon / k * x for x in q[s]) + (1 - epsilon) * max(q[s])
        last.append(r + discount * v * (1 - d))
    out.append(last)
    return np.array(out)


def targets_18(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    weights = np.zeros((3, len(rewards), q.shape[1]))
    i = np.arange(len(rewards))
    best = np.argmax(q[next_states], axis=1)
    weights[0, i, best] = 1
    weights[1, i, next_actions] = 1
    weights[2] = epsilon / q.shape[1]
    weights[2, i, best] += 1 - epsilon
    weights[:, terminated] = 0
    return rewards + discount * np.einsum("kna,na->kn", weights, q[next_states])


def targets_19(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    extended = np.vstack([q, np.zeros(q.shape[1])])
    # terminated steps go to a state whose values are zero
    s = np.where(terminated, len(q), next_states)
    v = extended.max(axis=1)
    m = extended.mean(axis=1)
    ql = rewards + discount * v[s]
    sa = rewards + discount * extended[s, next_actions]
    es = rewards + discount * (v + epsilon * (m - v))[s]
    return np.array([ql, sa, es])


def targets_20(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    t = np.empty((3, len(rewards)))
    n = 0
    while n < len(rewards):
        t[:, n] = rewards[n]
        if terminated[n]:
            n += 1
            continue
        values = np.sort(q[next_states[n]])
        t[0, n] += discount * values[-1]
        t[1, n] += discount * q[next_states[n], next_actions[n]]
        t[2, n] += discount * (1 - epsilon) * values[-1]
        t[2, n] += discount * epsilon * values.sum() / values.size
        n += 1
    return t


def targets_21(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    from functools import partial

    def greedy(row, action):
        return row.max()

    def on_policy(row, action):
        return row[action]

    def expected(row, action, eps):
        return eps * row.mean() + (1 - eps) * row.max()

    rules = (greedy, on_policy, partial(expected, eps=epsilon))
    result = np.array([rewards, rewards, rewards], dtype=float)
    for k, rule in enumerate(rules):
        for n in np.where(~terminated)[0]:
            result[k, n] += discount * rule(q[next_states[n]], next_actions[n])
    return result


def targets_22(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    not_done = (terminated == False).astype(int)
    max_next = np.array([np.max(q[s]) for s in next_states])
    avg_next = np.array([np.mean(q[s]) for s in next_states])
    act_next = np.array([q[s, a] for s, a in zip(next_states, next_actions)])
    targets = np.zeros((3, rewards.size))
    targets[0, :] = rewards + discount * not_done * max_next
    targets[1, :] = rewards + discount * not_done * act_next
    targets[2, :] = (1 - epsilon) * targets[0, :] + epsilon * (
        rewards + discount * not_done * avg_next
    )
    return targets


def targets_23(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    A = q.shape[1]
    lookahead = rewards[:, None] + discount * np.where(
        terminated[:, None], 0, q[next_states]
    )
    q_learning = lookahead.max(axis=1)
    sarsa = np.choose(next_actions, lookahead.T)
    expected = lookahead.sum(axis=1) * (epsilon / A) + q_learning * (1 - epsilon)
    return np.concatenate([q_learning, sarsa, expected]).reshape(3, -1)


def targets_24(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    def one(n):
        if terminated[n]:
            return (rewards[n],) * 3
        row = q[next_states[n]]
        g, m = row[row.argmax()], row.sum() / row.shape[0]
        futures = (g, row[next_actions[n]], g - epsilon * (g - m))
        return tuple(rewards[n] + discount * f for f in futures)

    return np.array([one(n) for n in range(len(rewards))]).reshape(-1, 3).T


def targets_25(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    cache = {}
    for s in set(next_states.tolist()):
        cache[s] = (float(q[s].max()), float(q[s].mean()))
    rows = {"max": [], "next": [], "mean": []}
    for r, s, a, done in zip(rewards, next_states, next_actions, terminated):
        g = 0.0 if done else discount
        rows["max"].append(r + g * cache[int(s)][0])
        rows["next"].append(r + g * q[s, a])
        soft = epsilon * cache[int(s)][1] + (1 - epsilon) * cache[int(s)][0]
        rows["mean"].append(r + g * soft)
    return list(rows.values())


def targets_26(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    result = np.zeros((3, len(rewards)))
    Q = q.take(next_states, axis=0)
    result[0] = np.maximum.reduce(Q, axis=1)
    result[1] = np.diag(Q[:, next_actions])
    result[2] = epsilon * np.add.reduce(Q, axis=1) / Q.shape[1]
    result[2] += (1 - epsilon) * result[0]
    np.multiply(result, discount, out=result)
    result *= np.invert(terminated)
    result += rewards
    return result


def targets_27(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    n_actions = q.shape[1]
    expected_q = np.zeros(len(q))
    greedy_q = np.zeros(len(q))
    for state in range(len(q)):
        greedy_q[state] = max(q[state])
        others = 0
        for action in range(n_actions):
            others += q[state, action]
        expected_q[state] = epsilon * others / n_actions
        expected_q[state] += (1 - epsilon) * greedy_q[state]
    mask = terminated.astype(bool)
    a = discount * greedy_q[next_states]
    b = discount * q[next_states, next_actions]
    c = discount * expected_q[next_states]
    a[mask] = b[mask] = c[mask] = 0
    return np.array([rewards + a, rewards + b, rewards + c])


def targets_28(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    ended = np.flatnonzero(terminated)
    nxt = q[next_states]
    top = np.partition(nxt, -1, axis=1)[:, -1]
    probabilities = np.full(nxt.shape, epsilon / nxt.shape[1])
    probabilities[range(len(nxt)), nxt.argmax(1)] += 1 - epsilon
    mixed = (probabilities * nxt).sum(1)
    table = np.array([top, nxt[range(len(nxt)), next_actions], mixed])
    table = rewards + discount * table
    table[:, ended] = rewards[ended]
    return table


def targets_29(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    ql, sarsa, esarsa = (rewards * 1.0 for _ in range(3))
    for i, done in enumerate(terminated):
        if not done:
            best = -float("inf")
            for value in q[next_states[i]]:
                best = max(best, value)
            ql[i] += discount * best
            sarsa[i] += discount * q[next_states[i]][next_actions[i]]
            random_part = discount * epsilon * np.mean(q[next_states[i]])
            esarsa[i] += random_part + discount * (1 - epsilon) * best
    return np.vstack((ql, sarsa, esarsa))


def targets_30(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    masked = np.ma.masked_array(
        q[next_states], np.repeat(terminated[:, None], q.shape[1], 1)
    )
    largest = masked.max(axis=1).filled(0)
    middle = masked.mean(axis=1).filled(0)
    chosen = masked[np.arange(len(rewards)), next_actions].filled(0)
    return (
        np.outer(np.ones(3), rewards)
        + discount
        * np.r_["0,2", largest, chosen, largest * (1 - epsilon) + middle * epsilon]
    )
