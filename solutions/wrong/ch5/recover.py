"""Known mistakes in 5.7. The hints of an open task say what the robots did."""

import numpy as np


def zero(transitions, features, paths, discount):
    """The reward is 0: every way is as good."""
    return np.zeros(features.shape[1])


def upside_down(transitions, features, paths, discount):
    """The weights have the wrong sign."""
    return -features[paths].mean(axis=(0, 1))


def counts_visits(transitions, features, paths, discount):
    """What the expert visited most need not be what it wanted: it may have had to cross it."""
    return features[paths].mean(axis=(0, 1))
