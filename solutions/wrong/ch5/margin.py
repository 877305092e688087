"""Known mistakes in 5.4; a function's docstring is its hint."""

import numpy as np


def _onto_the_simplex(theta):
    theta = np.maximum(theta, 0.0)
    return (
        theta / theta.sum() if theta.sum() > 0 else np.full(len(theta), 1 / len(theta))
    )


def against_the_mean(expert, found):
    """This is the best answer for the average policy. The margin is the smallest difference over all policies."""
    return np.eye(len(expert))[np.argmax(expert - found.mean(axis=0))]


def difference_of_means(expert, found):
    """Weights in proportion to the mean differences do not maximise the smallest difference."""
    return _onto_the_simplex(expert - found.mean(axis=0))


def all_alike(expert, found):
    """Equal weights do not separate the policies from the expert: weight features in which it exceeds them all."""
    return np.full(len(expert), 1 / len(expert))


def signs_swapped(expert, found):
    """The expert must have larger values than the policies, not smaller ones."""
    payoff = found - expert
    theta, losses, total = (
        np.full(len(expert), 1 / len(expert)),
        np.zeros(len(found)),
        np.zeros(len(expert)),
    )
    for _ in range(300):
        losses += payoff @ theta
        theta = np.eye(len(expert))[np.argmax(payoff[np.argmin(losses)])]
        total += theta
    return total / total.sum()


def last_policy_alone(expert, found):
    """Use all policies found so far, not only the last one."""
    return np.eye(len(expert))[np.argmax(expert - found[-1])]


def last_round(expert, found):
    """The weights of the last round go around the solution: return the mean over all rounds."""
    payoff = expert - found
    payoff = payoff / max(np.abs(payoff).max(), 1e-300)
    policies, features = payoff.shape
    theta, against = np.full(features, 1 / features), np.full(policies, 1 / policies)
    for _ in range(2000):
        gain, loss = against @ payoff, payoff @ theta
        theta = theta * np.exp(0.1 * gain)
        against = against * np.exp(-0.1 * loss)
        theta, against = theta / theta.sum(), against / against.sum()
    return theta
