"""Known mistakes in 5.1; a function's docstring is its hint."""

import numpy as np


def sums(trajectories, discount):
    """Divide the weights of each trajectory by their sum: a feature that is always 1 must come out as 1."""
    return np.mean([discount ** np.arange(len(f)) @ f for f in trajectories], axis=0)


def endless(trajectories, discount):
    """A trajectory ends: the sum of its weights is that of its own steps, not of a series without end."""
    return np.mean([(1 - discount) * (discount ** np.arange(len(f)) @ f) for f in trajectories], axis=0)


def pooled(trajectories, discount):
    """Every trajectory counts alike, however long it is: take the mean in each first."""
    weights = [discount ** np.arange(len(f)) for f in trajectories]
    return sum(w @ f for w, f in zip(weights, trajectories)) / sum(w.sum() for w in weights)


def no_discount(trajectories, discount):
    """Later steps count less, by the discount to the power of their number."""
    return np.mean([f.mean(axis=0) for f in trajectories], axis=0)


def from_the_end(trajectories, discount):
    """The first step has the weight 1; the later ones count less."""
    means = []
    for features in trajectories:
        weights = discount ** np.arange(len(features))[::-1]
        means.append(weights @ features / weights.sum())
    return np.mean(means, axis=0)


def one_long_trajectory(trajectories, discount):
    """Discounting starts anew with each trajectory."""
    features = np.concatenate(trajectories)
    weights = discount ** np.arange(len(features))
    return weights @ features / weights.sum()
