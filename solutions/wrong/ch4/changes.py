"""Known mistakes in 4.6; a function's docstring is its hint."""

import numpy as np


def _measures(change, absolute=None):
    absolute = np.abs(change).sum(axis=1) if absolute is None else absolute
    return np.column_stack([change.sum(axis=1), absolute, np.abs(change).max(axis=1)])


def backwards(weights):
    """Subtract the weights before the episode from those after it, not the other way round."""
    return _measures(-np.diff(weights, axis=0))


def since_the_start(weights):
    """Measure each episode from its own beginning, not from that of the first."""
    return _measures(weights[1:] - weights[0])


def absolute_too_late(weights):
    """Take the absolute value of each change before you add them, not of their sum."""
    change = np.diff(weights, axis=0)
    return _measures(change, np.abs(change.sum(axis=1)))


def absolute_weights(weights):
    """Take the absolute value of the changes, not the change of the absolute values."""
    return _measures(
        np.diff(weights, axis=0), np.abs(np.diff(np.abs(weights), axis=0)).sum(axis=1)
    )


def largest_rise(weights):
    """The largest change may be negative: take the absolute values before the maximum."""
    change = np.diff(weights, axis=0)
    return np.column_stack(
        [change.sum(axis=1), np.abs(change).sum(axis=1), change.max(axis=1)]
    )


def absolute_sum_signed_largest(weights):
    """The order is: signed sum, sum of absolute values, largest absolute value."""
    change = np.diff(weights, axis=0)
    return np.column_stack(
        [np.abs(change).sum(axis=1), change.sum(axis=1), np.abs(change).max(axis=1)]
    )


def means(weights):
    """Add the changes of all weights; do not average them."""
    change = np.diff(weights, axis=0)
    return np.column_stack(
        [change.mean(axis=1), np.abs(change).mean(axis=1), np.abs(change).max(axis=1)]
    )


def over_the_episodes(weights):
    """A row is one episode: add over the weights, along a row, not over the episodes."""
    change = np.diff(weights, axis=0)
    return np.column_stack(
        [change.sum(axis=0), np.abs(change).sum(axis=0), np.abs(change).max(axis=0)]
    )


def of_the_weights(weights):
    """Measure how the weights change, not the weights themselves."""
    return _measures(weights[1:])


def root_of_the_squares(weights):
    """The second measure is made of absolute values: do not square them and take the root."""
    change = np.diff(weights, axis=0)
    return _measures(change, np.sqrt((change**2).sum(axis=1)))


def smallest(weights):
    """The third measure is the largest absolute change, not the smallest."""
    change = np.diff(weights, axis=0)
    return np.column_stack([_measures(change)[:, :2], np.abs(change).min(axis=1)])


def a_row_before_the_first(weights):
    """There is one row for each episode; the weights before the first episode have no change of their own."""
    return np.vstack([np.zeros(3), _measures(np.diff(weights, axis=0))])
