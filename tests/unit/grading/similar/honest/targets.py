"""Twelve ways to write exercise 2.5, as students who do not know each other would."""

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
