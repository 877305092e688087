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

# Directions of the rays between the sectors k and k + 1, in the robot's frame; the first five look to the left
COSINES = np.array([math.cos((k + 0.5) * SECTOR) for k in range(SENSORS)])
SINES = np.array([math.sin((k + 0.5) * SECTOR) for k in range(SENSORS)])
LEFT = 5

compiled = compiler(constants, geometry, random_numbers)
inlined = compiler(constants, geometry, random_numbers, inline=True)


@compiled
def sector_of(forward, left, margin):
    """Index 0..8 of the 40-degree sector that holds a point in the robot's frame; 0 looks ahead, counter-clockwise.

    The sector is the number of rays that lie between the x axis and the point, which the cross product of a ray and the
    point tells without its angle. -1 if the point lies within about ``margin`` radians of a ray: its angle has to tell.
    """
    side, passed, on_ray = abs(left), 0, False
    margin *= side + abs(forward)
    for k in range(LEFT):
        across = COSINES[k] * side - SINES[k] * forward
        passed += across > 0.0
        on_ray |= abs(across) <= margin
    if on_ray:
        return -1
    return passed if left >= 0.0 else (SENSORS - passed) % SENSORS


@compiled
def _sector(forward, left):
    """Index 0..8 of the sector that holds a point in the robot's frame."""
    sector = sector_of(forward, left, 1e-9)
    if sector < 0:
        return math.floor(math.atan2(left, forward) / SECTOR + 0.5) % SENSORS
    return sector


@compiled
def _see(j, ranges, sector, distance):
    if distance < ranges[j, sector]:
        ranges[j, sector] = distance


@compiled
def _see_on_ray(j, ranges, k, distance):
    """Let both sectors beside a ray see what is on it; ray k lies between sectors k and k + 1."""
    _see(j, ranges, k, distance)
    _see(j, ranges, (k + 1) % SENSORS, distance)


@inlined
def see_circle(j, ranges, x, y, radius):
    """A circle centred at (x, y) in the robot's frame."""
    distance = math.sqrt(x * x + y * y)
    if distance <= radius:
        for k in range(SENSORS):
            ranges[j, k] = 0.0
    else:
        _see(j, ranges, _sector(x, y), distance - radius)
        for k in range(SENSORS):
            ahead = x * COSINES[k] + y * SINES[k]
            across = x * SINES[k] - y * COSINES[k]
            half_chord2 = radius * radius - across * across
            if half_chord2 >= 0.0 and ahead > 0.0:
                _see_on_ray(j, ranges, k, ahead - math.sqrt(half_chord2))


@compiled
def _see_rectangle(j, ranges, x, y, half_length, half_width, turned):
    """A rectangle centred at (x, y) in the robot's frame, its length turned by ``turned`` against the heading."""
    c, s = math.cos(turned), math.sin(turned)
    px, py = -(c * x + s * y), -(c * y - s * x)  # the robot in the rectangle's frame
    if abs(px) <= half_length and abs(py) <= half_width:
        for k in range(SENSORS):
            ranges[j, k] = 0.0
        return
    nx = min(max(px, -half_length), half_length) - px
    ny = min(max(py, -half_width), half_width) - py
    distance = math.sqrt(nx * nx + ny * ny)
    if distance > SENSOR_RANGE + 1e-6:  # and every ray is longer
        return
    _see(j, ranges, _sector(c * nx - s * ny, s * nx + c * ny), distance)
    for k in range(SENSORS):
        dx = c * COSINES[k] + s * SINES[k]
        dy = c * SINES[k] - s * COSINES[k]
        # no division where the ray's line passes the rectangle for certain
        reach = half_length * abs(dy) + half_width * abs(dx) + 1e-9
        if abs(px * dy - py * dx) < reach:
            enter, leave = box_entry(px, py, dx, dy, half_length, half_width)
            if 0.0 <= enter <= leave:
                _see_on_ray(j, ranges, k, enter)


@inlined
def nearby(i, shapes, centres, speeds, x, y, radius, near):
    """Put into ``near`` the obstacle slots of world i that move or may lie within ``radius`` of (x, y); count them."""
    number = 0
    for m in range(shapes.shape[1]):
        dx, dy = centres[i, m, 0] - x, centres[i, m, 1] - y
        # no root: a box reaches less far than the sum of its halves
        reach = radius + shapes[i, m, 0] + shapes[i, m, 1]
        # the next one is written over it, unless it counts; a branch would take longer
        near[number] = m
        number += (dx * dx + dy * dy < reach * reach) | (speeds[i, m] != 0.0)
    return number


@inlined
def sense_obstacles(
    j, i, kinds, shapes, centres, x, y, heading, c, s, near, number, ranges
):
    """Least distance in each sector to the obstacles of world i, in row j; ``c`` and ``s`` belong to the heading.

    Seen from outside, a convex shape's distance falls and then rises with the bearing. So its least distance in a
    sector is that of its nearest point, if the sector holds it, or else lies on one of the sector's two rays.
    """
    for n in range(number):
        m = near[n]
        dx, dy = centres[i, m, 0] - x, centres[i, m, 1] - y
        reach = SENSOR_RANGE + shapes[i, m, 0] + shapes[i, m, 1]
        if dx * dx + dy * dy >= reach * reach or kinds[i, m] == NOTHING:
            continue
        forward, left = c * dx + s * dy, c * dy - s * dx
        if kinds[i, m] == CIRCLE:
            see_circle(j, ranges, forward, left, shapes[i, m, 0])
        else:
            turned = shapes[i, m, 2] - heading
            _see_rectangle(
                j, ranges, forward, left, shapes[i, m, 0], shapes[i, m, 1], turned
            )  # fmt: skip


@compiled
def sense_borders(j, size, x, y, c, s, ranges, walls):
    """Let the map's borders shorten the ranges of row j; where one is the nearest thing, the wall flag is set.

    In a sector the nearest border point is a wall's nearest point or lies on one of the sector's rays.
    """
    if min(x, size - x, y, size - y) <= 0.0:  # it went through a wall, and has collided
        for k in range(SENSORS):
            ranges[j, k], walls[j, k] = 0.0, True
        return
    for distance, nx, ny in (
        (x, -1.0, 0.0),
        (size - x, 1.0, 0.0),
        (y, 0.0, -1.0),
        (size - y, 0.0, 1.0),
    ):
        if distance < SENSOR_RANGE:
            sector = _sector(c * nx + s * ny, c * ny - s * nx)
            if distance < ranges[j, sector]:
                ranges[j, sector], walls[j, sector] = distance, True
    half = size / 2
    for k in range(SENSORS):
        dx = c * COSINES[k] - s * SINES[k]
        dy = s * COSINES[k] + c * SINES[k]
        _, distance = box_entry(x - half, y - half, dx, dy, half, half)
        for sector in (k, (k + 1) % SENSORS):
            if distance < ranges[j, sector]:
                ranges[j, sector], walls[j, sector] = distance, True


@compiled
def within(distance, dx, dy):
    """Whether a point (dx, dy) away is at most ``distance`` away, to the micrometre."""
    square = dx * dx + dy * dy
    if abs(square - distance * distance) > 1e-4 * distance:  # no doubt about it
        return square < distance * distance
    return micrometres(math.hypot(dx, dy)) <= distance


@compiled
def target_region(dx, dy, heading, c, s):
    """Number 1 to 9 of the sector that holds a target (dx, dy) away; ``c`` and ``s`` belong to the heading."""
    sector = sector_of(c * dx + s * dy, c * dy - s * dx, 1e-6)
    if sector < 0:
        bearing = micrometres(math.atan2(dy, dx) - heading)
        return 1 + math.floor(bearing / SECTOR + 0.5) % SENSORS
    return 1 + sector


@compiled
def report(start, stop, robots, keys, steps, noise, ranges, walls):
    """Round the ranges of rows ``start`` to ``stop - 1`` to a micrometre, and let noise disturb what is seen."""
    flat, flags = ranges[start:stop].reshape(-1), walls[start:stop].reshape(-1)
    for k in range(len(flat)):
        flat[k] = micrometres(flat[k])
    if noise > 0.0:
        for j in range(start, stop):
            i = robots[j]
            for k in range(SENSORS):
                if ranges[j, k] < SENSOR_RANGE:
                    error = noise * normal(keys[i], SENSING, steps[i], k)
                    disturbed = min(max(ranges[j, k] + error, 0.0), SENSOR_RANGE)
                    ranges[j, k] = micrometres(disturbed)
    for k in range(len(flat)):
        flags[k] &= flat[k] < SENSOR_RANGE


@inlined
def look(
    j, i, world, kinds, shapes, centres, size, poses, targets, c, s, near, number, ranges, walls, region, seen
):  # fmt: skip
    """Put what robot i of a world reads into row j, its ranges still to be rounded.

    ``c`` and ``s`` belong to its heading. The row keeps what it holds where nothing nearer is seen.
    """
    x, y, heading = poses[i, 0], poses[i, 1], poses[i, 2]
    sense_obstacles(
        j, world, kinds, shapes, centres, x, y, heading, c, s, near, number, ranges
    )
    if min(x, size - x, y, size - y) < SENSOR_RANGE:
        sense_borders(j, size, x, y, c, s, ranges, walls)
    dx, dy = targets[i, 0] - x, targets[i, 1] - y
    seen[j] = within(SENSOR_RANGE, dx, dy)
    region[j] = target_region(dx, dy, heading, c, s)


@compiled
def sense(
    start, stop, robots, kinds, shapes, centres, speeds, size, poses, targets, keys, steps, noise, ranges, walls,
    region, seen,
):  # fmt: skip
    """What ``robots[start]`` to ``robots[stop - 1]`` read: ranges and walls (K, 9), target region and seen (K,).

    ``robots`` (K,) are rows of the N worlds. Each reads what ``sense`` of ``plain_environment.py`` says. No row is
    cut out of an array: ``motion.py`` says why. ``noise`` is the standard deviation, in metres, of an error on every
    range that sees something.
    """
    near = np.empty(kinds.shape[1], dtype=np.int64)
    ranges[start:stop] = SENSOR_RANGE
    walls[start:stop] = False
    for j in range(start, stop):
        i = robots[j]
        number = nearby(
            i, shapes, centres, speeds, poses[i, 0], poses[i, 1], SENSOR_RANGE, near
        )  # fmt: skip
        c, s = math.cos(poses[i, 2]), math.sin(poses[i, 2])
        look(
            j, i, i, kinds, shapes, centres, size, poses, targets, c, s, near, number, ranges, walls, region, seen
        )  # fmt: skip
    report(start, stop, robots, keys, steps, noise, ranges, walls)


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
