"""Worlds as a page draws them, as worlds of the package."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.robot import Sensing, Worlds, make_world, sense

from .shown import Shown


def world_of(page: dict[str, Any], centres: ArrayLike | None = None) -> Worlds:
    """The world that a page gets, with its obstacles as they are or at other places (n, 2)."""
    obstacles = page["obstacles"]
    if centres is None:
        centres = [(o["x"], o["y"]) for o in obstacles]
    circles, rectangles = [], []
    for obstacle, (x, y) in zip(obstacles, np.asarray(centres).tolist(), strict=True):
        a, b = obstacle["a"], obstacle["b"]
        if obstacle["circle"]:
            circles.append((x, y, a))
        else:
            turned = np.degrees(obstacle["turned"])
            rectangles.append((x, y, 2 * a, 2 * b, turned))
    ends = {"start": page["start"], "target": page["target"]}
    return make_world(circles, rectangles, size=page["size"], **ends)


def pose_of(shown: Shown) -> tuple[float, float, float]:
    """Where the robot is that a reader moves, in metres and radians, as the name of the map says."""
    named = re.search(r"at ([0-9.]+), ([0-9.]+) and", shown.contents["labels"])
    assert named is not None
    return float(named[1]), float(named[2]), np.radians(shown.number("heading"))


def towards_target(world: Worlds, places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Poses (n, 3) at places (n, 2), each facing the target."""
    ahead = world.targets[0] - places
    return np.column_stack([places, np.arctan2(ahead[:, 1], ahead[:, 0])])


def sensed(world: Worlds, poses: ArrayLike) -> Sensing:
    """What a robot senses at poses (n, 3) in one world."""
    poses = np.reshape(poses, (-1, 3))
    return sense(world[np.zeros(len(poses), dtype=int)], poses)
