"""6.7 with a linear critic, and a penalty on how much the policy changes instead of the clipping."""

import numpy as np


def ones(x):
    return np.column_stack([np.ones(len(x)), x])


def policy_of(first, last, x):
    hidden = np.tanh(ones(x) @ first.T)
    z = ones(hidden) @ last.T
    powers = np.exp(z - z.max(axis=1, keepdims=True))
    return hidden, powers / powers.sum(axis=1, keepdims=True)


def reinforce(layers, states, actions, log_before, episodes, ends, rounds_left):
    known = np.column_stack([ones(states), states**2])
    values, steps = np.zeros(len(states)), np.arange(len(states))
    for _ in range(5):  # fit the critic to its own advantages, some times
        gain = np.zeros(len(states))
        for episode in np.unique(episodes):
            rows = steps[episodes == episode]
            after = np.append(values[rows[1:]], 0.0)
            errors = ends[rows] - 0.03 + 0.95 * after - values[rows]
            total = 0.0
            for row, error in zip(rows[::-1], errors[::-1]):
                total = gain[row] = error + 0.95 * 0.95 * total
        target = values + gain
        squared = known.T @ known + 0.1 * np.eye(known.shape[1])
        values = known @ np.linalg.solve(squared, known.T @ target)
    gain = target - values
    gain = (gain - gain.mean()) / gain.std()
    weights = [np.array(layer) for layer in layers[:2]]
    before, taken = policy_of(*weights, states)[1], np.eye(5)[actions]
    mean, square = [0.0, 0.0], [0.0, 0.0]
    for n in range(1, 81):
        hidden, policy = policy_of(*weights, states)
        ratio = (policy * taken).sum(axis=1) / np.exp(log_before)
        up = (ratio * gain)[:, None] * (taken - policy) + 1.0 * (before - policy)
        back = up @ weights[1][:, 1:] * (1 - hidden**2)
        slopes = back.T @ ones(states), up.T @ ones(hidden)
        for k, slope in enumerate(slope / len(states) for slope in slopes):
            mean[k] = 0.9 * mean[k] + 0.1 * slope
            square[k] = 0.99 * square[k] + 0.01 * slope**2
            step = mean[k] / (1 - 0.9**n)
            weights[k] += 0.01 * step / (np.sqrt(square[k] / (1 - 0.99**n)) + 1e-6)
    return [*weights, layers[2], layers[3]]
