"""Sensing: the least distance in each of nine sectors, and the reflexes that depend on it."""

from __future__ import annotations

import math

import numpy as np

from robonav.compilation import compiler

from . import constants, geometry, random_numbers
from .constants import (
    BACKWARD,
    CIRCLE,
    COLLISION_DISTANCE,
    NO_REFLEX,
    NOTHING,
    SECTOR,
    SENSOR_RANGE,
    SENSORS,
)
from .geometry import box_entry, micrometres
from .random_numbers import SENSING, normal

# Directions of the rays between the sectors k and k + 1, in the robot's frame
COSINES = np.array([math.cos((k + 0.5) * SECTOR) for k in range(SENSORS)])
SINES = np.array([math.sin((k + 0.5) * SECTOR) for k in range(SENSORS)])

compiled = compiler(constants, geometry, random_numbers)
inlined = compiler(constants, geometry, random_numbers, inline=True)


@compiled
def _sector(forward, left):
    """Index 0..8 of the 40-degree sector that holds a point in the robot's frame; 0 looks ahead, counter-clockwise."""
    return math.floor(math.atan2(left, forward) / SECTOR + 0.5) % SENSORS


@compiled
def _see(ranges, sector, distance):
    if distance < ranges[sector]:
        ranges[sector] = distance


@compiled
def _see_on_rays(ranges, along):
    """Let both sectors beside each ray see what is on it; ray k lies between sectors k and k + 1.

    ``along`` (9,) has the distances along the rays, infinity where nothing is. The loops that fill it have no branches,
    so that the compiler turns them into vector instructions.
    """
    ranges[0] = min(ranges[0], along[0], along[SENSORS - 1])
    for k in range(1, SENSORS):
        ranges[k] = min(ranges[k], along[k], along[k - 1])


@compiled
def see_circle(ranges, cosines, sines, along, x, y, radius):
    """A circle centred at (x, y) in the robot's frame."""
    distance = math.hypot(x, y)
    if distance <= radius:
        ranges[:] = 0.0
        return
    _see(ranges, _sector(x, y), distance - radius)
    for k in range(SENSORS):
        ahead = x * cosines[k] + y * sines[k]
        across = x * sines[k] - y * cosines[k]
        half_chord2 = radius * radius - across * across
        meets = ahead > 0.0 and half_chord2 >= 0.0
        root = math.sqrt(half_chord2 if half_chord2 >= 0.0 else 0.0)
        along[k] = ahead - root if meets else math.inf
    _see_on_rays(ranges, along)


@compiled
def _see_rectangle(
    ranges, cosines, sines, along, x, y, half_length, half_width, turned
):
    """A rectangle centred at (x, y) in the robot's frame, its length turned by ``turned`` against the heading."""
    c, s = math.cos(turned), math.sin(turned)
    px, py = -(c * x + s * y), -(c * y - s * x)  # the robot in the rectangle's frame
    if abs(px) <= half_length and abs(py) <= half_width:
        ranges[:] = 0.0
        return
    nx = min(max(px, -half_length), half_length) - px
    ny = min(max(py, -half_width), half_width) - py
    distance = math.hypot(nx, ny)
    if distance > SENSOR_RANGE + 1e-6:  # and every ray is longer
        return
    _see(ranges, _sector(c * nx - s * ny, s * nx + c * ny), distance)
    for k in range(SENSORS):
        dx = c * cosines[k] + s * sines[k]
        dy = c * sines[k] - s * cosines[k]
        enter_x, leave_x = _slab(px, dx, half_length)
        enter_y, leave_y = _slab(py, dy, half_width)
        enter, leave = max(enter_x, enter_y), min(leave_x, leave_y)
        along[k] = enter if 0.0 <= enter <= leave else math.inf
    _see_on_rays(ranges, along)


@compiled
def _slab(position, direction, half):
    """Where a line enters and leaves the strip from -half to half, as ``box_entry`` says, without a branch."""
    t0, t1 = (-half - position) / direction, (half - position) / direction
    inside, along = abs(position) <= half, direction == 0.0
    enter = (-math.inf if inside else math.inf) if along else min(t0, t1)
    leave = (math.inf if inside else -math.inf) if along else max(t0, t1)
    return enter, leave


@compiled
def sense_obstacles(
    i, kinds, shapes, centres, x, y, heading, cosines, sines, along, ranges
):
    """Least distance in each sector to the obstacles of world i.

    Seen from outside, a convex shape's distance falls and then rises with the bearing. So its least distance in a
    sector is that of its nearest point, if the sector holds it, or else lies on one of the sector's two rays.
    """
    c, s = math.cos(heading), math.sin(heading)
    for m in range(kinds.shape[1]):
        kind = kinds[i, m]
        half_length, half_width = shapes[i, m, 0], shapes[i, m, 1]
        dx, dy = centres[i, m, 0] - x, centres[i, m, 1] - y
        near = SENSOR_RANGE + half_length + half_width
        if kind == NOTHING or dx * dx + dy * dy >= near * near:
            continue
        forward, left = c * dx + s * dy, c * dy - s * dx
        if kind == CIRCLE:
            see_circle(ranges, cosines, sines, along, forward, left, half_length)
        else:
            turned = shapes[i, m, 2] - heading
            _see_rectangle(
                ranges, cosines, sines, along, forward, left, half_length, half_width, turned
            )  # fmt: skip


@compiled
def sense_borders(size, x, y, heading, cosines, sines, ranges, walls):
    """Let the map's borders shorten the ranges; where one is the nearest thing, the wall flag is set.

    In a sector the nearest border point is a wall's nearest point or lies on one of the sector's rays.
    """
    margin = min(min(x, size - x), min(y, size - y))
    if margin >= SENSOR_RANGE:
        return
    if margin <= 0.0:  # it went through a wall, and has collided
        ranges[:], walls[:] = 0.0, True
        return
    c, s = math.cos(heading), math.sin(heading)
    for distance, nx, ny in (
        (x, -1.0, 0.0),
        (size - x, 1.0, 0.0),
        (y, 0.0, -1.0),
        (size - y, 0.0, 1.0),
    ):
        sector = _sector(c * nx + s * ny, c * ny - s * nx)
        if distance < ranges[sector]:
            ranges[sector], walls[sector] = distance, True
    for k in range(SENSORS):
        dx = c * cosines[k] - s * sines[k]
        dy = s * cosines[k] + c * sines[k]
        _, distance = box_entry(x - size / 2, y - size / 2, dx, dy, size / 2, size / 2)
        for sector in (k, (k + 1) % SENSORS):
            if distance < ranges[sector]:
                ranges[sector], walls[sector] = distance, True


@compiled
def _with_error(distance, keys, i, step, k, noise):
    """Round a distance to a micrometre, and let noise disturb it if something is seen."""
    distance = micrometres(distance)
    if noise > 0.0 and distance < SENSOR_RANGE:
        error = noise * normal(keys[i], SENSING, step, k)
        distance = micrometres(min(max(distance + error, 0.0), SENSOR_RANGE))
    return distance


@compiled
def target_region(dx, dy, heading):
    """Number 1 to 9 of the sector that holds a target (dx, dy) away from the robot."""
    bearing = math.atan2(dy, dx) - heading
    return 1 + math.floor(micrometres(bearing) / SECTOR + 0.5) % SENSORS


@inlined
def report(
    j, i, near, border, poses, targets, keys, steps, noise, ranges, walls, region, seen
):  # fmt: skip
    """Put what robot i reads, of the distances ``near`` (9,), into row j: ranges and walls, target region and seen."""
    for k in range(SENSORS):
        distance = near[k]
        if distance < SENSOR_RANGE:  # otherwise rounding and noise change nothing
            distance = _with_error(distance, keys, i, steps[i], k, noise)
        ranges[j, k] = distance
        walls[j, k] = border[k] and distance < SENSOR_RANGE
    dx, dy = targets[i, 0] - poses[i, 0], targets[i, 1] - poses[i, 1]
    seen[j] = micrometres(math.hypot(dx, dy)) <= SENSOR_RANGE
    region[j] = target_region(dx, dy, poses[i, 2])


@compiled
def sense(
    start, stop, robots, kinds, shapes, centres, size, poses, targets, keys, steps, noise, ranges, walls, region,
    seen,
):  # fmt: skip
    """What ``robots[start]`` to ``robots[stop - 1]`` read: ranges and walls (K, 9), target region and seen (K,).

    ``robots`` (K,) are rows of the N worlds. Each reads what ``sense`` of ``plain_environment.py`` says. No row is
    cut out of an array: ``motion.py`` says why. ``noise`` is the standard deviation, in metres, of an error on every
    range that sees something.
    """
    along, near = np.empty(SENSORS), np.empty(SENSORS)
    border = np.empty(SENSORS, dtype=np.bool_)
    for j in range(start, stop):
        i = robots[j]
        x, y, heading = poses[i, 0], poses[i, 1], poses[i, 2]
        for k in range(SENSORS):
            near[k], border[k] = SENSOR_RANGE, False
        sense_obstacles(
            i, kinds, shapes, centres, x, y, heading, COSINES, SINES, along, near
        )
        sense_borders(size, x, y, heading, COSINES, SINES, near, border)
        report(
            j, i, near, border, poses, targets, keys, steps, noise, ranges, walls, region, seen
        )  # fmt: skip


@compiled
def reflexes(start, stop, ranges, speed, to_target, commands):
    """Compute the actions of the reflex: ``to_target`` if safe, back if blocked ahead, else the policy decides."""
    for i in range(start, stop):
        least = SENSOR_RANGE
        for k in range(SENSORS):
            least = min(least, ranges[i, k])
        blocked = True
        for k in (0, 1, 2, 7, 8):
            blocked = blocked and ranges[i, k] < speed + COLLISION_DISTANCE
        commands[i] = (
            to_target if least >= SENSOR_RANGE else BACKWARD if blocked else NO_REFLEX
        )
