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
    TO_SECTOR,
    TO_TARGET,
    TURN_PROBABILITY,
    TURNS,
)
from .geometry import micrometres, reach_of, swept_clearance
from .random_numbers import DRIFTING, SLIPPING, uniform
from .sensing import target_region

compiled = compiler(constants, geometry, random_numbers, sensing)


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
    """The heading of a robot that turns to a target (dx, dy) away: to the target itself, or to its sector's middle."""
    if command == TO_TARGET:
        return math.atan2(dy, dx)
    return wrap(heading + SECTOR * (target_region(dx, dy, heading) - 1))


@compiled
def drift_world(kinds, shapes, speeds, key, step, size, centres, headings):
    """Moving obstacles go one second on, turn at random, bounce off the borders."""
    for m in range(len(kinds)):
        if kinds[m] == NOTHING or speeds[m] == 0.0:
            continue
        heading = headings[m]
        if uniform(key, DRIFTING, step, m, 0) < TURN_PROBABILITY:
            heading = math.pi * (2.0 * uniform(key, DRIFTING, step, m, 1) - 1.0)
        x = centres[m, 0] + speeds[m] * math.cos(heading)
        y = centres[m, 1] + speeds[m] * math.sin(heading)
        reach = reach_of(kinds[m], shapes[m, 0], shapes[m, 1])
        if x < reach or x > size - reach:
            x = 2.0 * reach - x if x < reach else 2.0 * (size - reach) - x
            heading = wrap(math.pi - heading)
        if y < reach or y > size - reach:
            y = 2.0 * reach - y if y < reach else 2.0 * (size - reach) - y
            heading = -heading
        centres[m, 0], centres[m, 1], headings[m] = x, y, heading


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
        drift_world(
            kinds[i],
            shapes[i],
            speeds[i],
            keys[i],
            steps[i],
            size,
            centres[i],
            headings[i],
        )


@compiled
def step(
    start, stop, robots, kinds, shapes, speeds, keys, size, targets, slip, speed, max_steps, actions, poses, centres,
    headings, steps, outcome,
):  # fmt: skip
    """One second for ``robots[start]`` to ``robots[stop - 1]``: turn, go; did it collide, arrive, run out of steps?

    A collision anywhere along the way counts. ``slip`` is (6, 6), or (0, 0) for none; where a robot slips, ``actions``
    (K,) gets what it did instead. Robots whose outcome is no longer RUNNING stand still.
    """
    before = np.empty_like(centres[0])
    for j in range(start, stop):
        i = robots[j]
        if outcome[i] != RUNNING:
            continue
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
        x1, y1 = x + length * math.cos(heading), y + length * math.sin(heading)
        # a slice assignment would compile the text of its error, for three seconds
        for m in range(len(before)):
            before[m, 0], before[m, 1] = centres[i, m, 0], centres[i, m, 1]
        drift_world(
            kinds[i],
            shapes[i],
            speeds[i],
            keys[i],
            steps[i],
            size,
            centres[i],
            headings[i],
        )
        clearance = swept_clearance(
            kinds[i],
            shapes[i],
            before,
            centres[i],
            size,
            x,
            y,
            x1,
            y1,
            COLLISION_DISTANCE + 1e-3,
        )
        poses[i, 0], poses[i, 1], poses[i, 2] = x1, y1, heading
        steps[i] += 1
        if micrometres(clearance) < COLLISION_DISTANCE:
            outcome[i] = COLLIDED
        elif (
            micrometres(math.hypot(targets[i, 0] - x1, targets[i, 1] - y1))
            <= ARRIVAL_DISTANCE
        ):
            outcome[i] = ARRIVED
        elif steps[i] >= max_steps:
            outcome[i] = OUT_OF_STEPS
