"""Known mistakes in 5.1; a function's docstring is its hint."""

import numpy as np


def sums(trajectories, discount):
    """Divide the weights of each trajectory by their sum: a feature that is always 1 must have the expectation 1."""
    return np.mean([discount ** np.arange(len(f)) @ f for f in trajectories], axis=0)


def endless(trajectories, discount):
    """A trajectory is finite: divide by the sum of its own weights, not by the sum of the infinite series."""
    return np.mean(
        [(1 - discount) * (discount ** np.arange(len(f)) @ f) for f in trajectories],
        axis=0,
    )


def pooled(trajectories, discount):
    """Give every trajectory the same weight: first take the mean within each trajectory."""
    weights = [discount ** np.arange(len(f)) for f in trajectories]
    return sum(w @ f for w, f in zip(weights, trajectories)) / sum(
        w.sum() for w in weights
    )


def no_discount(trajectories, discount):
    """Later steps have smaller weights: the discount to the power of the step's number."""
    return np.mean([f.mean(axis=0) for f in trajectories], axis=0)


def from_the_end(trajectories, discount):
    """The first step has the largest weight, 1, and the last the smallest."""
    means = []
    for features in trajectories:
        weights = discount ** np.arange(len(features))[::-1]
        means.append(weights @ features / weights.sum())
    return np.mean(means, axis=0)


def one_long_trajectory(trajectories, discount):
    """Start the discounting again with each trajectory."""
    features = np.concatenate(trajectories)
    weights = discount ** np.arange(len(features))
    return weights @ features / weights.sum()


def divided_by_length(trajectories, discount):
    """Divide by the sum of the weights, not by the number of steps."""
    return np.mean(
        [discount ** np.arange(len(f)) @ f / len(f) for f in trajectories], axis=0
    )


def _by_formula(trajectories, discount):
    means = []
    for features in trajectories:
        weights = discount ** np.arange(len(features))
        series = (1 - discount ** len(features)) / (1 - discount)
        means.append(weights @ features / series)
    return np.mean(means, axis=0)


def formula_of_the_series(trajectories, discount):
    """The formula of the geometric series is 0 divided by 0 for a discount of 1: add up the weights themselves."""
    return _by_formula(trajectories, discount)


def formula_of_the_series_in_numpy(trajectories, discount):
    """The formula of the geometric series is 0 divided by 0 for a discount of 1: add up the weights themselves."""
    return _by_formula(trajectories, np.float64(discount))


def weighted_by_length(trajectories, discount):
    """Give every trajectory the same weight, whatever its length."""
    means, lengths = [], [len(f) for f in trajectories]
    for features in trajectories:
        weights = discount ** np.arange(len(features))
        means.append(weights @ features / weights.sum())
    return np.average(means, axis=0, weights=lengths)
