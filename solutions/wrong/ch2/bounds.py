"""Known mistakes in 2.3; a function's docstring is its hint."""

import numpy as np


def largest_change(previous, values, discount):
    """These bounds hold but are too wide: use the smallest change for the lower, the largest for the upper one."""
    change = discount / (1 - discount) * np.abs(values - previous).max()
    return values - change, values + change


def one_more_sweep(previous, values, discount):
    """Add the changes of all later sweeps, not only of the next one: they form a geometric series."""
    change = discount * (values - previous)
    return values + change.min(), values + change.max()


def from_the_old_values(previous, values, discount):
    """Add the changes to the values after the sweep, not to those before it."""
    change = discount / (1 - discount) * (values - previous)
    return previous + change.min(), previous + change.max()


def this_sweep_too(previous, values, discount):
    """The values already contain the change of the last sweep: the series starts with the next one."""
    change = (values - previous) / (1 - discount)
    return values + change.min(), values + change.max()


def state_by_state(previous, values, discount):
    """Use the smallest and the largest change over all states, not each state's own change."""
    change = discount / (1 - discount) * (values - previous)
    return values + np.minimum(change, 0), values + np.maximum(change, 0)


def never_the_other_way(previous, values, discount):
    """The smallest change may be positive and the largest negative: do not limit them at 0."""
    change = discount / (1 - discount) * (values - previous)
    return values + min(change.min(), 0.0), values + max(change.max(), 0.0)


def own_change(previous, values, discount):
    """Later changes depend on all states: use the smallest and the largest change over all of them."""
    change = discount / (1 - discount) * (values - previous)
    return values + change, values + change


def swapped(previous, values, discount):
    """Return the lower bounds first, then the upper bounds."""
    change = discount / (1 - discount) * (values - previous)
    return values + change.max(), values + change.min()


def no_first_discount(previous, values, discount):
    """The next sweep changes the values by the discount times the last change already: its series is g + g^2 + ..."""
    change = (values - previous) * (1 / (1 - discount) - discount)
    return values + change.min(), values + change.max()


def series_from_the_old_values(previous, values, discount):
    """These bounds hold but are too wide: add the later changes to each value after the sweep, which is known."""
    change = (values - previous) / (1 - discount)
    return previous + change.min(), previous + change.max()
