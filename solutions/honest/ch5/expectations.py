"""Eight ways to write exercise 5.1, as students who do not know each other would."""

import numpy as np


def expectations_1(trajectories, discount):
    total = np.zeros(trajectories[0].shape[1])
    for trajectory in trajectories:
        T = len(trajectory)
        weights = np.array([discount**t for t in range(T)])
        weights = weights / np.sum(weights)
        for t in range(T):
            total += weights[t] * trajectory[t]
    return total / len(trajectories)


def expectations_2(trajectories, discount):
    return np.mean(
        [
            np.average(f, axis=0, weights=np.power(discount, np.arange(f.shape[0])))
            for f in trajectories
        ],
        axis=0,
    )


def expectations_3(trajectories, discount):
    result = 0
    for steps in trajectories:
        numerator, denominator, factor = 0, 0, 1.0
        for phi in steps:
            numerator = numerator + factor * phi
            denominator = denominator + factor
            factor *= discount
        result = result + numerator / denominator
    return result / len(trajectories)


def expectations_4(trajectories, discount):
    def mean_of(features):
        n = features.shape[0]
        norm = n if discount == 1 else (1 - discount**n) / (1 - discount)
        gamma = discount ** np.arange(n)
        return np.einsum("t,tk->k", gamma, features) / norm

    found = [mean_of(features) for features in trajectories]
    return sum(found) / len(found)


def expectations_5(trajectories, discount):
    # backwards, as a return is computed
    means = np.zeros((len(trajectories), trajectories[0].shape[1]))
    for i, features in enumerate(trajectories):
        total, mass = np.zeros(features.shape[1]), 0.0
        for row in features[::-1]:
            total = row + discount * total
            mass = 1 + discount * mass
        means[i] = total / mass
    return means.mean(axis=0)


def expectations_6(trajectories, discount):
    longest = max(len(t) for t in trajectories)
    k = trajectories[0].shape[1]
    padded = np.zeros((len(trajectories), longest, k))
    mask = np.zeros((len(trajectories), longest))
    for i, t in enumerate(trajectories):
        padded[i, : len(t)] = t
        mask[i, : len(t)] = 1
    w = mask * discount ** np.arange(longest)
    w /= w.sum(axis=1, keepdims=True)
    return (w[:, :, None] * padded).sum(axis=1).mean(axis=0)


def expectations_7(trajectories, discount):
    N = len(trajectories)
    mu = [0.0] * trajectories[0].shape[1]
    for tau in trajectories:
        z = sum(discount**t for t in range(len(tau)))
        for j in range(len(mu)):
            mu[j] += sum(discount**t * tau[t][j] for t in range(len(tau))) / z / N
    return np.array(mu)


def expectations_8(trajectories, discount):
    every = np.concatenate(trajectories)
    weights = []
    for trajectory in trajectories:
        g = np.cumprod(np.r_[1.0, np.full(len(trajectory) - 1, discount)])
        weights.append(g / (g.sum() * len(trajectories)))
    return np.dot(np.concatenate(weights), every)
