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


def best_of_all_states(q, policy, tolerance):
    """Look for the best action in every state: take the maximum along each row of q."""
    current = q[np.arange(len(q)), policy]
    best = int(q.max(axis=0).argmax())
    return np.where(q[:, best] - current > tolerance, best, policy)


def any_best_is_kept(q, policy, tolerance):
    """Compare with the value of the current action, not with the mean of the actions."""
    better = q.max(axis=1) - q.mean(axis=1) > tolerance
    return np.where(better, q.argmax(axis=1), policy)


def first_within_the_tolerance(q, policy, tolerance):
    """Keep the current action unless one gains more than the tolerance. Then take the best, not the first good one."""
    return (q >= q.max(axis=1, keepdims=True) - tolerance).argmax(axis=1)


def tolerance_of_the_best(q, policy, tolerance):
    """The tolerance decides whether to change. A change goes to the best action, not to the first good one."""
    current = q[np.arange(len(q)), policy]
    good = q >= q.max(axis=1, keepdims=True) - tolerance
    return np.where(q.max(axis=1) - current > tolerance, good.argmax(axis=1), policy)
