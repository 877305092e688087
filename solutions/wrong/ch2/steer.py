"""Known mistakes in 2.9. The hints of an open task say what the robots did."""

import numpy as np


def straight_on(ranges, region, seen):
    """The robot must turn to its target, and away from what is ahead."""
    return np.zeros(len(ranges), dtype=int)


def blind(ranges, region, seen):
    """The robot turns to its target but runs into what stands in its way."""
    return np.array([0, 1, 2, 2, 2, 4, 4, 4, 3])[region - 1]


def _with_sides(ranges, action):
    """Turn to the side with more room where something is near ahead."""
    left, right = ranges[:, 1:3].min(axis=1), ranges[:, 7:9].min(axis=1)
    return np.where(ranges[:, 0] < 6, np.where(left > right, 2, 4), action)


def counts_from_zero(ranges, region, seen):
    """The robot turns to the sector beside that of its target, as if regions were counted from 0."""
    return _with_sides(ranges, np.array([0, 1, 2, 2, 2, 4, 4, 4, 3])[region % 9])


def always_left(ranges, region, seen):
    """The robot turns left also if its target is on the right, in the sectors 6 to 9."""
    return _with_sides(ranges, np.array([0, 1, 2, 2, 2, 2, 2, 2, 1])[region - 1])


def no_target(ranges, region, seen):
    """The robot avoids obstacles but does not look for its target."""
    left, right = ranges[:, 1:3].min(axis=1), ranges[:, 7:9].min(axis=1)
    return np.where(ranges[:, 0] < 6, np.where(left > right, 2, 4), 0)
