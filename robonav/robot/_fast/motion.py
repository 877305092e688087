"""Motion: one second of robots and moving obstacles, and how it ends."""

from __future__ import annotations

import math

import numpy as np

from robonav.compilation import compiler

from . import constants, geometry, random_numbers, sensing
from .constants import (
    ARRIVAL_DISTANCE,
    ARRIVED,
    BACKWARD,
    COLLIDED,
    COLLISION_DISTANCE,
    NOTHING,
    OUT_OF_STEPS,
    RUNNING,
    SECTOR,
    SENSOR_RANGE,
    TO_SECTOR,
    TO_TARGET,
    TURN_PROBABILITY,
    TURNS,
)
from .geometry import (
    border_clearance,
    micrometres,
    passes_by,
    reach_of,
    swept_distance,
)
from .random_numbers import DRIFTING, SLIPPING, uniform
from .sensing import look, nearby, report, target_region, within

compiled = compiler(constants, geometry, random_numbers, sensing)
inlined = compiler(constants, geometry, random_numbers, sensing, inline=True)


@compiled
def wrap(angle):
    """The same angle in (-pi, pi]."""
    if angle > math.pi:
        return angle - 2.0 * math.pi
    if angle <= -math.pi:
        return angle + 2.0 * math.pi
    return angle


@compiled
def turned_to_target(command, heading, dx, dy):
    """The heading of a robot that has turned to a target at (dx, dy) from it, or to the middle of its sector."""
    if command == TO_TARGET:
        return math.atan2(dy, dx)
    return wrap(
        heading
        + SECTOR
        * (target_region(dx, dy, heading, math.cos(heading), math.sin(heading)) - 1)
    )


# The kernels get the arrays of all worlds and the number i of one: to cut a row out of an array for each robot would
# count references to the array, in turn with the other threads, and take longer than the work.


@compiled
def drift_obstacle(i, m, kinds, shapes, speeds, keys, step, size, centres, headings):
    """Let obstacle m of world i go on for one second: it may turn at random, and borders reflect it."""
    heading = headings[i, m]
    if uniform(keys[i], DRIFTING, step, m, 0) < TURN_PROBABILITY:
        heading = math.pi * (2.0 * uniform(keys[i], DRIFTING, step, m, 1) - 1.0)
    x = centres[i, m, 0] + speeds[i, m] * math.cos(heading)
    y = centres[i, m, 1] + speeds[i, m] * math.sin(heading)
    reach = reach_of(kinds[i, m], shapes[i, m, 0], shapes[i, m, 1])
    if x < reach or x > size - reach:
        x = 2.0 * reach - x if x < reach else 2.0 * (size - reach) - x
        heading = wrap(math.pi - heading)
    if y < reach or y > size - reach:
        y = 2.0 * reach - y if y < reach else 2.0 * (size - reach) - y
        heading = -heading
    centres[i, m, 0], centres[i, m, 1], headings[i, m] = x, y, heading


@compiled
def slipped(action, slip, key, step):
    """Draw the action that the robot executes when it is told ``action``, from row ``action`` of ``slip``."""
    draw = uniform(key, SLIPPING, step, 0, 0)
    total = 0.0
    for other in range(slip.shape[1]):
        total += slip[action, other]
        if draw < total:
            return other
    return action


@compiled
def drift(start, stop, kinds, shapes, speeds, keys, steps, size, centres, headings):
    """Moving obstacles of worlds ``start`` to ``stop`` alone, one second on."""
    for i in range(start, stop):
        for m in range(kinds.shape[1]):
            if kinds[i, m] != NOTHING and speeds[i, m] != 0.0:
                drift_obstacle(
                    i, m, kinds, shapes, speeds, keys, steps[i], size, centres, headings
                )  # fmt: skip


@inlined
def destination(j, i, keys, targets, slip, speed, actions, poses, steps):
    """Where robot i is after this second's action j, and its heading; ``actions`` gets the action that a slip left."""
    x, y, heading = poses[i, 0], poses[i, 1], poses[i, 2]
    action = actions[j]
    if action in (TO_TARGET, TO_SECTOR):
        heading = turned_to_target(
            action, heading, targets[i, 0] - x, targets[i, 1] - y
        )
        action = 0
    if slip.shape[0] > 0:
        other = slipped(action, slip, keys[i], steps[i])
        if other != action:
            action = actions[j] = other
    heading = wrap(heading + TURNS[action])
    length = -speed if action == BACKWARD else speed
    c, s = math.cos(heading), math.sin(heading)
    return x + length * c, y + length * s, heading, c, s


@inlined
def outcome_of(clearance, dx, dy, steps, max_steps):
    """How the episode of a robot stands after a second, by its clearance on the way and its target (dx, dy) away."""
    if micrometres(clearance) < COLLISION_DISTANCE:
        return COLLIDED
    if within(ARRIVAL_DISTANCE, dx, dy):
        return ARRIVED
    if steps >= max_steps:
        return OUT_OF_STEPS
    return RUNNING


@inlined
def move(
    j, i, kinds, shapes, speeds, keys, size, targets, slip, speed, max_steps, near, number, actions, poses, centres,
    headings, steps, outcome,
):  # fmt: skip
    """Move robot i for one second, record how its episode stands, and return the cosine and sine of its heading.

    ``near`` has the ``number`` obstacles of its world that move or may be in its way.
    """
    x, y = poses[i, 0], poses[i, 1]
    x1, y1, heading, c, s = destination(
        j, i, keys, targets, slip, speed, actions, poses, steps
    )
    clearance = border_clearance(size, x, y, x1, y1)
    clearance = min(clearance, COLLISION_DISTANCE + 1e-3)  # more does not matter
    for n in range(number):
        m = near[n]
        if kinds[i, m] == NOTHING:
            continue
        # seen from the obstacle, which goes straight too, the robot goes along a segment
        ax, ay = x - centres[i, m, 0], y - centres[i, m, 1]
        if speeds[i, m] != 0.0:
            drift_obstacle(
                i, m, kinds, shapes, speeds, keys, steps[i], size, centres, headings
            )
        bx, by = x1 - centres[i, m, 0], y1 - centres[i, m, 1]
        reach = shapes[i, m, 0] + shapes[i, m, 1] + clearance
        if not passes_by(reach, ax, ay, bx, by):
            distance = swept_distance(kinds[i, m], shapes[i, m], ax, ay, bx, by)
            clearance = min(clearance, distance)
    clearance = max(clearance, 0.0)
    poses[i, 0], poses[i, 1], poses[i, 2] = x1, y1, heading
    steps[i] += 1
    outcome[i] = outcome_of(
        clearance, targets[i, 0] - x1, targets[i, 1] - y1, steps[i], max_steps
    )
    return c, s


@compiled
def step(
    start, stop, robots, kinds, shapes, speeds, keys, size, targets, slip, speed, max_steps, actions, poses, centres,
    headings, steps, outcome,
):  # fmt: skip
    """Move ``robots[start]`` to ``robots[stop - 1]`` for one second, and record how their episodes stand.

    A collision anywhere along the way counts. ``slip`` is (6, 6), or (0, 0) for none; where a robot slips, ``actions``
    (K,) gets what it did instead. Robots whose outcome is no longer RUNNING stand still.
    """
    near = np.empty(kinds.shape[1], dtype=np.int64)
    radius = speed + COLLISION_DISTANCE + 1e-2
    for j in range(start, stop):
        i = robots[j]
        if outcome[i] != RUNNING:
            continue
        number = nearby(
            i, shapes, centres, speeds, poses[i, 0], poses[i, 1], radius, near
        )
        move(
            j, i, kinds, shapes, speeds, keys, size, targets, slip, speed, max_steps, near, number, actions, poses,
            centres, headings, steps, outcome,
        )  # fmt: skip


@compiled
def second(
    start, stop, robots, kinds, shapes, speeds, keys, size, targets, slip, speed, max_steps, noise, actions, poses,
    centres, headings, steps, outcome, ranges, walls, region, seen,
):  # fmt: skip
    """Simulate one second as ``step`` does, and then let the robots sense as ``sense`` does.

    A robot looks for obstacles nearby once, before it moves, and computes the cosine of its heading once.
    """
    near = np.empty(kinds.shape[1], dtype=np.int64)
    ranges[start:stop] = SENSOR_RANGE
    walls[start:stop] = False
    radius = speed + SENSOR_RANGE + 1e-2
    for j in range(start, stop):
        i = robots[j]
        number = nearby(
            i, shapes, centres, speeds, poses[i, 0], poses[i, 1], radius, near
        )
        if outcome[i] == RUNNING:
            c, s = move(
                j, i, kinds, shapes, speeds, keys, size, targets, slip, speed, max_steps, near, number, actions, poses,
                centres, headings, steps, outcome,
            )  # fmt: skip
        else:
            c, s = math.cos(poses[i, 2]), math.sin(poses[i, 2])
        look(
            j, i, i, kinds, shapes, centres, size, poses, targets, c, s, near, number, ranges, walls, region, seen
        )  # fmt: skip
    report(start, stop, robots, keys, steps, noise, ranges, walls)
