"""Known mistakes in 2.2; a function's docstring is its hint."""

import numpy as np


def greedy(q, policy, tolerance):
    """This takes a best action always. Where the action in hand is as good, it should stay."""
    return q.argmax(axis=1)


def no_tolerance(q, policy, tolerance):
    """A gain no larger than the tolerance is not worth a change."""
    in_hand = q[np.arange(len(q)), policy]
    return np.where(q.max(axis=1) > in_hand, q.argmax(axis=1), policy)


def on_the_border(q, policy, tolerance):
    """A gain of exactly the tolerance is not yet worth a change."""
    in_hand = q[np.arange(len(q)), policy]
    return np.where(q.max(axis=1) - in_hand >= tolerance, q.argmax(axis=1), policy)


def last_of_the_best(q, policy, tolerance):
    """Of several best actions the one with the lowest index is asked for."""
    in_hand = q[np.arange(len(q)), policy]
    last = q.shape[1] - 1 - q[:, ::-1].argmax(axis=1)
    return np.where(q.max(axis=1) - in_hand > tolerance, last, policy)


def first_better(q, policy, tolerance):
    """This takes the first action that is better; the best one is asked for."""
    better = q - q[np.arange(len(q)), policy][:, None] > tolerance
    return np.where(better.any(axis=1), better.argmax(axis=1), policy)
