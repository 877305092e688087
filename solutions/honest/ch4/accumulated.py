"""Eight ways to write exercise 4.4, as students who do not know each other would."""

import numpy as np


def accumulated_1(features, actions, rewards, ended, number, discount, gradient_step):
    w = np.zeros((number, features.shape[1]))
    memory = []
    T = len(rewards)
    for t in range(T):
        if t == T - 1 and ended:
            y = rewards[t]
        else:
            y = rewards[t] + discount * np.max(w @ features[t + 1])
        memory.append((features[t], actions[t], y))
        for x, a, target in memory:
            error = target - np.dot(w[a], x)
            w[a] = w[a] + gradient_step * error * x
    return w


def accumulated_2(features, actions, rewards, ended, number, discount, gradient_step):
    k = features.shape[1]
    weights = [[0.0] * k for _ in range(number)]

    def q(a, x):
        return sum(w * f for w, f in zip(weights[a], x))

    targets = []
    for t in range(len(actions)):
        future = max(q(a, features[t + 1]) for a in range(number))
        if ended and t + 1 == len(actions):
            future = 0.0
        targets.append(rewards[t] + discount * future)
        for i in range(t + 1):
            a = actions[i]
            step = gradient_step * (targets[i] - q(a, features[i]))
            weights[a] = [w + step * f for w, f in zip(weights[a], features[i])]
    return np.array(weights)


def accumulated_3(features, actions, rewards, ended, number, discount, gradient_step):
    T, k = len(rewards), features.shape[1]
    W, y = np.zeros((number, k)), np.zeros(T)
    alive = np.ones(T)
    if ended and T:
        alive[-1] = 0
    for t in range(T):
        values = np.matmul(features[t + 1], W.T)
        y[t] = rewards[t] + discount * alive[t] * values.max()
        for j in range(t + 1):
            W[actions[j]] += (
                gradient_step * (y[j] - features[j] @ W[actions[j]]) * features[j]
            )
    return W


def accumulated_4(features, actions, rewards, ended, number, discount, gradient_step):
    class Learner:
        def __init__(self):
            self.w = np.zeros((number, len(features[0])))
            self.pairs = []

        def best(self, x):
            return (self.w * x).sum(axis=1).max()

        def train(self):
            for x, a, target in self.pairs:
                self.w[a] += gradient_step * (target - self.w[a].dot(x)) * x

    learner = Learner()
    for t, (x, a, r) in enumerate(zip(features, actions, rewards)):
        final = t == len(rewards) - 1
        target = r if final and ended else r + discount * learner.best(features[t + 1])
        learner.pairs.append((x, a, target))
        learner.train()
    return learner.w


def accumulated_5(features, actions, rewards, ended, number, discount, gradient_step):
    # the design matrix has a block for each action
    k = features.shape[1]
    theta = np.zeros(number * k)
    rows, goals = [], []
    for t in range(len(rewards)):
        row = np.zeros(number * k)
        row[actions[t] * k : (actions[t] + 1) * k] = features[t]
        rows.append(row)
        q_next = theta.reshape(number, k) @ features[t + 1]
        is_last = ended and t == len(rewards) - 1
        goals.append(rewards[t] + (0 if is_last else discount * q_next.max()))
        for row, goal in zip(rows, goals):
            theta = theta + gradient_step * (goal - row @ theta) * row
    return theta.reshape(number, k)


def accumulated_6(features, actions, rewards, ended, number, discount, gradient_step):
    w = {a: np.zeros(features.shape[1]) for a in range(number)}
    queue = []
    t = 0
    while t < len(rewards):
        target = rewards[t]
        if t < len(rewards) - 1 or not ended:
            target = target + discount * max(w[a] @ features[t + 1] for a in w)
        queue.append(target)
        for old in range(len(queue)):
            phi, a = features[old], int(actions[old])
            prediction = w[a] @ phi
            w[a] = w[a] - gradient_step * (prediction - queue[old]) * phi
        t += 1
    return np.vstack([w[a] for a in range(number)])


def accumulated_7(features, actions, rewards, ended, number, discount, gradient_step):
    from functools import reduce

    def update(weights, pair):
        phi, a, y = pair
        new = weights.copy()
        new[a] += gradient_step * (y - weights[a] @ phi) * phi
        return new

    weights = np.zeros((number, features.shape[1]))
    pairs = []
    ends = [False] * (len(rewards) - 1) + [bool(ended)]
    for phi, phi2, a, r, end in zip(
        features[:-1], features[1:], actions, rewards, ends
    ):
        y = r + (not end) * discount * np.amax(weights @ phi2)
        pairs = [*pairs, (phi, a, y)]
        weights = reduce(update, pairs, weights)
    return weights


def accumulated_8(features, actions, rewards, ended, number, discount, gradient_step):
    weights = np.zeros((number, features.shape[1]))
    target_list = np.empty(0)
    for step, reward in enumerate(rewards):
        next_value = 0.0
        if not (ended and step == rewards.size - 1):
            next_value = -np.inf
            for action in range(number):
                value = np.sum(weights[action] * features[step + 1])
                if value > next_value:
                    next_value = value
        target_list = np.append(target_list, reward + discount * next_value)
        for index, target in enumerate(target_list):
            row = weights[actions[index]]
            row += (
                gradient_step
                * (target - np.sum(row * features[index]))
                * features[index]
            )
    return weights
