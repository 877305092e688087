"""Known mistakes in 4.8. The hints of an open task say what the robots did."""

import numpy as np


def unchanged(rewards):
    """The robot still circles."""
    return rewards


def nothing_for_living(rewards):
    """This changes every reward between places, which is more than is needed."""
    cured = rewards.copy()
    cured[:, :3] = 0.0
    return cured


def only_standing_still(rewards):
    """A round may have two or three steps, not only one."""
    cured = rewards.copy()
    np.fill_diagonal(cured[:, :3], np.minimum(np.diag(cured[:, :3]), 0.0))
    return cured


def more_for_arrival(rewards):
    """A larger reward for the arrival hides the fault, but this row was to be left alone."""
    cured = rewards.copy()
    cured[:, 3] = 100.0
    return cured
