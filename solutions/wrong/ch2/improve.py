"""Known mistakes in 2.2; a function's docstring is its hint."""

import numpy as np


def greedy(q, policy, tolerance):
    """This always takes a best action. Keep the current action where it is equally good."""
    return q.argmax(axis=1)


def no_tolerance(q, policy, tolerance):
    """Keep the current action where the gain is at most the tolerance."""
    in_hand = q[np.arange(len(q)), policy]
    return np.where(q.max(axis=1) > in_hand, q.argmax(axis=1), policy)


def on_the_border(q, policy, tolerance):
    """Keep the current action where the gain equals the tolerance."""
    in_hand = q[np.arange(len(q)), policy]
    return np.where(q.max(axis=1) - in_hand >= tolerance, q.argmax(axis=1), policy)


def last_of_the_best(q, policy, tolerance):
    """If several actions are best, take the one with the lowest index."""
    in_hand = q[np.arange(len(q)), policy]
    last = q.shape[1] - 1 - q[:, ::-1].argmax(axis=1)
    return np.where(q.max(axis=1) - in_hand > tolerance, last, policy)


def first_better(q, policy, tolerance):
    """This takes the first action that is better. Take the best one."""
    better = q - q[np.arange(len(q)), policy][:, None] > tolerance
    return np.where(better.any(axis=1), better.argmax(axis=1), policy)
