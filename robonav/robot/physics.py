"""What happens around one robot in a second: its action may slip, obstacles move, and its way may end at one of them.

The map reaches from (0, 0) to (size, size). Of M obstacles there are the kinds (M,), the shapes (M, 3) and the centres
(M, 2). A shape is a circle's radius, or half a rectangle's length, half its width, and the angle of its length.

numba compiles these functions, which are plain Python for one robot. ``_fast`` moves many, and tests hold the two
equal, bit for bit. From ``_fast`` come ``swept_distance`` from a segment to a shape at the origin; ``reach_of``, the
radius of the circle about a shape; ``wrap``, which keeps an angle in (-pi, pi]; ``micrometres``, which rounds a
distance; and ``uniform``, a random number in [0, 1) that is a hash of the world's key, a purpose, the step and a
count.
"""

from __future__ import annotations

import math

from robonav.compilation import compiler

from ._fast import constants, geometry, motion, random_numbers
from ._fast.constants import (
    COLLISION_DISTANCE,  # 1 m
    NOTHING,
    TURN_PROBABILITY,  # of a moving obstacle in a second: 0.1
)
from ._fast.geometry import micrometres, reach_of, swept_distance
from ._fast.motion import wrap
from ._fast.random_numbers import DRIFTING, SLIPPING, uniform
from .sensors import Array, Obstacles

Point = tuple[float, float]

compiled = compiler(constants, geometry, motion, random_numbers)


@compiled
def slip_to(action: int, slip: Array, key: Array, step: int) -> int:
    """Draw the action that comes of ``action``, whose row of ``slip`` says how likely each is.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot import random_worlds
    >>> always_straight = np.eye(6)[[0, 0, 0, 0, 0, 5]]
    >>> slip_to(1, always_straight, random_worlds(1, seed=0).keys[0], 0)
    0
    """
    draw, total = uniform(key, SLIPPING, step, 0, 0), 0.0
    for other in range(slip.shape[1]):
        total += slip[action, other]
        if draw < total:
            return other
    return action


@compiled
def drift(
    obstacles: Obstacles, headings: Array, speeds: Array,
    size: float, key: Array, step: int,
) -> None:  # fmt: skip
    """Let moving obstacles go on for one second. Some turn at random, and borders reflect them.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot import make_world
    >>> world = make_world(circles=[(50, 50, 2)])
    >>> obstacles = world.kinds[0], world.shapes[0], world.centres[0].copy()
    >>> drift(obstacles, np.array([0.0]), np.array([1.5]), 100.0, world.keys[0], 0)
    >>> obstacles[2].tolist()
    [[51.5, 50.0]]
    """
    kinds, shapes, centres = obstacles
    for m in range(len(kinds)):
        if kinds[m] == NOTHING or speeds[m] == 0.0:
            continue
        heading = headings[m]
        if uniform(key, DRIFTING, step, m, 0) < TURN_PROBABILITY:
            heading = math.pi * (2.0 * uniform(key, DRIFTING, step, m, 1) - 1.0)
        x = centres[m, 0] + speeds[m] * math.cos(heading)
        y = centres[m, 1] + speeds[m] * math.sin(heading)
        reach = reach_of(kinds[m], shapes[m, 0], shapes[m, 1])
        most = size - reach  # for its centre
        if x < reach or x > most:
            x = 2.0 * (reach if x < reach else most) - x
            heading = wrap(math.pi - heading)
        if y < reach or y > most:
            y = 2.0 * (reach if y < reach else most) - y
            heading = -heading
        centres[m, 0], centres[m, 1], headings[m] = x, y, heading


@compiled
def least_clearance(
    obstacles: Obstacles, centres_before: Array, size: float, start: Point, end: Point
) -> float:
    """Least distance to an obstacle or border while the robot goes from ``start`` to ``end``.

    Obstacles go straight and evenly from ``centres_before`` to their centres, and the robot does too. So, seen from an
    obstacle, the robot goes straight along a segment. Exact below :data:`COLLISION_DISTANCE`.

    Examples
    --------
    >>> from robonav.robot import make_world
    >>> world = make_world(circles=[(53, 50, 2)])
    >>> obstacles = world.kinds[0], world.shapes[0], world.centres[0]
    >>> least_clearance(obstacles, world.centres[0], 100.0, (50.0, 47.5), (56.0, 47.5))
    0.5
    """
    kinds, shapes, centres = obstacles
    (x0, y0), (x1, y1) = start, end
    least = min(x0, x1, size - x0, size - x1, y0, y1, size - y0, size - y1)
    least = min(least, 2.0 * COLLISION_DISTANCE)  # more does not matter
    for m in range(len(kinds)):
        ax, ay = x0 - centres_before[m, 0], y0 - centres_before[m, 1]
        bx, by = x1 - centres[m, 0], y1 - centres[m, 1]
        near = shapes[m, 0] + shapes[m, 1] + least
        far_in_x = min(ax, bx) > near or max(ax, bx) < -near
        far_in_y = min(ay, by) > near or max(ay, by) < -near
        if kinds[m] == NOTHING or far_in_x or far_in_y:
            continue
        least = min(least, swept_distance(kinds[m], shapes[m], ax, ay, bx, by))
    return micrometres(max(least, 0.0))
