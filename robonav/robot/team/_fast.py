"""The compiled core of several robots on one map: :mod:`robonav.robot._fast` with one more loop, over the other robots.

N maps with R robots each. Robot r of map i is row i * R + r of every array of robots, so that rows of robots are read
as those of a :class:`robonav.robot.Simulator`.
"""

from __future__ import annotations

import math

import numpy as np

from robonav.compilation import compiler

from .._fast import constants, drawing, geometry, motion, random_numbers, sensing
from .._fast.constants import (
    COLLISION_DISTANCE,
    NOTHING,
    RUNNING,
    SENSOR_RANGE,
    SPARE,
)
from .._fast.drawing import draw_obstacles, empty_grid, reachable
from .._fast.geometry import (
    border_clearance,
    micrometres,
    passes_by,
    segment_distance,
    swept_distance,
)
from .._fast.motion import destination, drift_obstacle, outcome_of
from .._fast.sensing import (
    look,
    nearby,
    report,
    see_circle,
)

ROBOT_RADIUS = 1.0  # what comes nearer than this to a robot's centre has hit it

compiled = compiler(constants, drawing, geometry, motion, random_numbers, sensing)


@compiled
def draw_teams(
    start, stop, keys, still, moving, slowest, fastest, size, starts, targets, attempts, kinds, shapes, centres, speeds,
    headings, found,
):  # fmt: skip
    """Draw maps ``start`` to ``stop`` until each robot has a way through, ``attempts`` times at most.

    The starts and targets (R, 2) are those of every map. With one robot, the maps are those of
    :func:`robonav.robot._fast.draw_worlds`.
    """
    empty = empty_grid(size, SPARE)
    closed, stack = np.empty_like(empty), np.empty(empty.size, dtype=np.int64)
    for i in range(start, stop):
        kinds[i] = NOTHING
        found[i] = False
        for number in range(attempts):
            found[i] = draw_obstacles(
                i, number, keys, still, moving, slowest, fastest, size, starts, targets, kinds, shapes, centres, speeds,
                headings,
            )  # fmt: skip
            for r in range(len(starts)):
                found[i] = found[i] and reachable(
                    i, still, kinds, shapes, centres, starts[r, 0], starts[r, 1], targets[r, 0], targets[r, 1], SPARE,
                    empty, closed, stack,
                )  # fmt: skip
            if found[i]:
                break


@compiled
def sense_robots(j, i, first, last, poses, outcome, c, s, ranges):
    """Let robot i see the others of ``first`` to ``last - 1``, its map's, that are running: circles of 1 m."""
    x, y = poses[i, 0], poses[i, 1]
    near = SENSOR_RANGE + ROBOT_RADIUS
    for k in range(first, last):
        dx, dy = poses[k, 0] - x, poses[k, 1] - y
        if k == i or outcome[k] != RUNNING or dx * dx + dy * dy >= near * near:
            continue
        forward, left = c * dx + s * dy, c * dy - s * dx
        see_circle(j, ranges, forward, left, ROBOT_RADIUS)


@compiled
def sense(
    start, stop, robots, team, kinds, shapes, centres, speeds, size, poses, outcome, targets, keys, steps, noise,
    ranges, walls, region, seen,
):  # fmt: skip
    """What ``robots[start]`` to ``robots[stop - 1]`` read, in maps of ``team`` robots: as the kernel of one robot."""
    ranges[start:stop] = SENSOR_RANGE
    walls[start:stop] = False
    near = np.empty(kinds.shape[1], dtype=np.int64)
    for j in range(start, stop):
        robot = robots[j]
        i = robot // team
        number = nearby(
            i, shapes, centres, speeds, poses[robot, 0], poses[robot, 1], SENSOR_RANGE, near
        )  # fmt: skip
        c, s = math.cos(poses[robot, 2]), math.sin(poses[robot, 2])
        sense_robots(j, robot, i * team, (i + 1) * team, poses, outcome, c, s, ranges)
        look(
            j, robot, i, kinds, shapes, centres, size, poses, targets, c, s, near, number, ranges, walls, region, seen
        )  # fmt: skip
    report(start, stop, robots, keys, steps, noise, ranges, walls)


@compiled
def step(
    start, stop, team, kinds, shapes, speeds, map_keys, clock, size, targets, keys, slip, speed, max_steps, actions,
    poses, centres, headings, steps, outcome, met,
):  # fmt: skip
    """Move the running robots of maps ``start`` to ``stop - 1`` for one second, all at once.

    What one robot hits on its way is decided as in the kernel of one robot. Two robots both go straight: each sees the
    other go along a segment. ``met`` (N * R,) says who came too near to another robot. In a map where no robot is
    running, time stands still.
    """
    after, clearance = np.empty((team, 3)), np.empty(team)
    for i in range(start, stop):
        first, running = i * team, 0
        for r in range(team):
            j = first + r
            if outcome[j] != RUNNING:
                continue
            running += 1
            x1, y1, heading, _, _ = destination(
                j, j, keys, targets, slip, speed, actions, poses, steps
            )
            after[r, 0], after[r, 1], after[r, 2] = x1, y1, heading
            clearance[r] = min(
                border_clearance(size, poses[j, 0], poses[j, 1], x1, y1),
                COLLISION_DISTANCE + 1e-3,  # more does not matter
            )
        if running == 0:
            continue
        for m in range(kinds.shape[1]):
            if kinds[i, m] == NOTHING:
                continue
            x, y = centres[i, m, 0], centres[i, m, 1]
            if speeds[i, m] != 0.0:
                drift_obstacle(
                    i, m, kinds, shapes, speeds, map_keys, clock[i], size, centres, headings
                )  # fmt: skip
            for r in range(team):
                j = first + r
                if outcome[j] != RUNNING:
                    continue
                ax, ay = poses[j, 0] - x, poses[j, 1] - y
                bx, by = after[r, 0] - centres[i, m, 0], after[r, 1] - centres[i, m, 1]
                near = shapes[i, m, 0] + shapes[i, m, 1] + clearance[r]
                if not passes_by(near, ax, ay, bx, by):
                    clearance[r] = min(
                        clearance[r],
                        swept_distance(kinds[i, m], shapes[i, m], ax, ay, bx, by),
                    )
        meet(first, team, poses, after, outcome, clearance, met)
        clock[i] += 1
        for r in range(team):
            j = first + r
            if outcome[j] != RUNNING:
                continue
            for k in range(3):
                poses[j, k] = after[r, k]
            steps[j] += 1
            dx, dy = targets[j, 0] - after[r, 0], targets[j, 1] - after[r, 1]
            outcome[j] = outcome_of(max(clearance[r], 0.0), dx, dy, steps[j], max_steps)


@compiled
def meet(first, team, poses, after, outcome, clearance, met):
    """Let the clearance of each two running robots of a map be at most their distance on the way."""
    limit = ROBOT_RADIUS + COLLISION_DISTANCE + 1e-3
    for r in range(team):
        j = first + r
        if outcome[j] != RUNNING:
            continue
        for q in range(r + 1, team):
            k = first + q
            if outcome[k] != RUNNING:
                continue
            ax, ay = poses[j, 0] - poses[k, 0], poses[j, 1] - poses[k, 1]
            bx, by = after[r, 0] - after[q, 0], after[r, 1] - after[q, 1]
            if passes_by(limit, ax, ay, bx, by):
                continue
            distance = segment_distance(0.0, 0.0, ax, ay, bx, by) - ROBOT_RADIUS
            clearance[r] = min(clearance[r], distance)
            clearance[q] = min(clearance[q], distance)
            if micrometres(distance) < COLLISION_DISTANCE:
                met[j] = met[k] = True
