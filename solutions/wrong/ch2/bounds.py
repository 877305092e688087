"""Known mistakes in 2.3; a function's docstring is its hint."""

import numpy as np


def largest_change(previous, values, discount):
    """These bounds hold, but are too wide: the smallest and the largest change each give one, with their sign."""
    change = discount / (1 - discount) * np.abs(values - previous).max()
    return values - change, values + change


def one_more_sweep(previous, values, discount):
    """All later sweeps count, not only the next: their changes add up to a geometric series."""
    change = discount * (values - previous)
    return values + change.min(), values + change.max()


def from_the_old_values(previous, values, discount):
    """The bounds start from the values after the sweep."""
    change = discount / (1 - discount) * (values - previous)
    return previous + change.min(), previous + change.max()


def this_sweep_too(previous, values, discount):
    """The sweep that led to these values is in them already: the series starts with the next one."""
    change = (values - previous) / (1 - discount)
    return values + change.min(), values + change.max()


def state_by_state(previous, values, discount):
    """A state's value may yet move by as much as any state moved: take the smallest and the largest change of all."""
    change = discount / (1 - discount) * (values - previous)
    return values + np.minimum(change, 0), values + np.maximum(change, 0)
