"""Known mistakes in 6.6. The hints of an open task say what the robots did."""

import numpy as np

TURNS = np.radians([0, 30, 60, -30, -60])


def _towards(bearing):
    off = np.abs((bearing[:, None] - TURNS + np.pi) % (2 * np.pi) - np.pi)
    return off.argmin(axis=1)


def blind(ranges, bearing, distance, memory):
    """The robot goes to its target, into whatever stands in its way."""
    return _towards(bearing), memory


def remembers_nothing(ranges, bearing, distance, memory):
    """The robot turns to the clearer side of what is ahead, and goes to and fro in the pocket."""
    left, right = ranges[:, 1:3].min(axis=1), ranges[:, 7:9].min(axis=1)
    away = np.where(left > right, 2, 4)
    return np.where(ranges[:, 0] < 6, away, _towards(bearing)), memory


def wipes_its_memory(ranges, bearing, distance, memory):
    """The robot would store the side on which it follows a wall, but returns an empty memory."""
    side = np.where(memory[:, 0] == 0, 1.0, memory[:, 0])
    near = ranges[:, [0, 1, 8]].min(axis=1) < 5
    actions = np.where(near, np.where(side > 0, 4, 2), _towards(bearing))
    return actions, np.zeros_like(memory)


def never_leaves(ranges, bearing, distance, memory):
    """The robot remembers that it has met a wall, but not to leave it again."""
    met = (memory[:, 0] > 0) | (ranges[:, 0] < 6)
    left = ranges[:, 1:4].min(axis=1)
    along = np.where(ranges[:, 0] < 5, 4, np.where(left < 4, 3, 1))
    kept = memory.copy()
    kept[:, 0] = met
    return np.where(met, along, _towards(bearing)), kept


def avoids_obstacles_alone(ranges, bearing, distance, memory):
    """The robot turns away from what is near, but does not look for its target."""
    left, right = ranges[:, 1:3].min(axis=1), ranges[:, 7:9].min(axis=1)
    return np.where(ranges[:, 0] < 6, np.where(left > right, 2, 4), 0), memory
