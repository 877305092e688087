"""Known mistakes in 3.8. The hints of an open task say what the robots did."""

import numpy as np


def untrained(inputs, labels):
    """The network was never trained."""
    rng = np.random.default_rng(0)
    return [rng.normal(size=(8, 13)), rng.normal(size=(5, 9))]


def most_frequent(inputs, labels):
    """The network always takes the expert's most frequent action."""
    last = np.zeros((5, 9))
    last[:, 0] = np.bincount(labels, minlength=5)
    return [np.zeros((8, 13)), last]


def uphill(inputs, labels):
    """The steps go up the slope of the cost, not down."""
    first, last = np.zeros((8, 13)), np.zeros((5, 9))
    last[:, 0] = -np.bincount(labels, minlength=5)
    return [first, last]
