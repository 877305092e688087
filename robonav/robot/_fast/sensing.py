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

compiled = compiler(constants, geometry, random_numbers)


@compiled
def _sector(forward, left):
    """Index 0..8 of the 40-degree sector that holds a point in the robot's frame; 0 looks ahead, counter-clockwise."""
    return math.floor(math.atan2(left, forward) / SECTOR + 0.5) % SENSORS


@compiled
def _see(ranges, sector, distance):
    if distance < ranges[sector]:
        ranges[sector] = distance


@compiled
def _see_on_border(ranges, border, distance):
    """Something on the ray between sectors ``border`` and ``border + 1`` is seen by both."""
    _see(ranges, border, distance)
    _see(ranges, (border + 1) % SENSORS, distance)


@compiled
def _see_circle(ranges, rays, x, y, radius):
    """A circle centred at (x, y) in the robot's frame."""
    distance = math.hypot(x, y)
    if distance <= radius:
        ranges[:] = 0.0
        return
    _see(ranges, _sector(x, y), distance - radius)
    for k in range(SENSORS):
        along = x * rays[k, 0] + y * rays[k, 1]
        across = x * rays[k, 1] - y * rays[k, 0]
        half_chord2 = radius * radius - across * across
        if along > 0.0 and half_chord2 >= 0.0:
            _see_on_border(ranges, k, along - math.sqrt(half_chord2))


@compiled
def _see_rectangle(ranges, rays, x, y, half_length, half_width, turned):
    """A rectangle centred at (x, y) in the robot's frame, its length turned by ``turned`` against the heading."""
    c, s = math.cos(turned), math.sin(turned)
    px, py = -(c * x + s * y), -(c * y - s * x)  # the robot in the rectangle's frame
    if abs(px) <= half_length and abs(py) <= half_width:
        ranges[:] = 0.0
        return
    nx = min(max(px, -half_length), half_length) - px
    ny = min(max(py, -half_width), half_width) - py
    _see(ranges, _sector(c * nx - s * ny, s * nx + c * ny), math.hypot(nx, ny))
    for k in range(SENSORS):
        dx, dy = c * rays[k, 0] + s * rays[k, 1], c * rays[k, 1] - s * rays[k, 0]
        enter, leave = box_entry(px, py, dx, dy, half_length, half_width)
        if 0.0 <= enter <= leave:
            _see_on_border(ranges, k, enter)


@compiled
def _sector_rays():
    """Directions (9, 2) of the rays between neighbouring sectors, in the robot's frame."""
    rays = np.empty((SENSORS, 2))
    for k in range(SENSORS):
        rays[k, 0], rays[k, 1] = (
            math.cos((k + 0.5) * SECTOR),
            math.sin((k + 0.5) * SECTOR),
        )
    return rays


@compiled
def _sense_obstacles(kinds, shapes, centres, x, y, heading, rays, ranges):
    """Least distance in each sector to the obstacles of one world.

    Seen from outside, a convex shape's distance falls and then rises with the bearing. So its least distance in a
    sector is that of its nearest point, if the sector holds it, or else lies on one of the sector's two rays.
    """
    c, s = math.cos(heading), math.sin(heading)
    for m in range(len(kinds)):
        kind = kinds[m]
        if kind == NOTHING:
            continue
        dx, dy = centres[m, 0] - x, centres[m, 1] - y
        near = SENSOR_RANGE + shapes[m, 0] + shapes[m, 1]
        if dx * dx + dy * dy >= near * near:
            continue
        forward, left = c * dx + s * dy, c * dy - s * dx
        if kind == CIRCLE:
            _see_circle(ranges, rays, forward, left, shapes[m, 0])
        else:
            _see_rectangle(
                ranges,
                rays,
                forward,
                left,
                shapes[m, 0],
                shapes[m, 1],
                shapes[m, 2] - heading,
            )


@compiled
def _sense_borders(size, x, y, heading, rays, ranges, walls):
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
        dx, dy = c * rays[k, 0] - s * rays[k, 1], s * rays[k, 0] + c * rays[k, 1]
        _, distance = box_entry(x - size / 2, y - size / 2, dx, dy, size / 2, size / 2)
        for sector in (k, (k + 1) % SENSORS):
            if distance < ranges[sector]:
                ranges[sector], walls[sector] = distance, True


@compiled
def _read_out(key, step, noise, ranges, walls):
    """Round the ranges of a robot to micrometres, and let noise disturb those that see something."""
    for k in range(SENSORS):
        distance = micrometres(ranges[k])
        if noise > 0.0 and distance < SENSOR_RANGE:
            error = noise * normal(key, SENSING, step, k)
            distance = micrometres(min(max(distance + error, 0.0), SENSOR_RANGE))
        ranges[k] = distance
        walls[k] = walls[k] and distance < SENSOR_RANGE


@compiled
def target_region(dx, dy, heading):
    """Number 1 to 9 of the sector that holds a target (dx, dy) away from the robot."""
    bearing = math.atan2(dy, dx) - heading
    return 1 + math.floor(micrometres(bearing) / SECTOR + 0.5) % SENSORS


@compiled
def sense(
    start, stop, robots, kinds, shapes, centres, size, poses, targets, keys, steps, noise, ranges, walls, region,
    seen,
):  # fmt: skip
    """What ``robots[start]`` to ``robots[stop - 1]`` read: ranges and walls (K, 9), target region and seen (K,).

    ``robots`` (K,) are rows of the N worlds. Each reads what :func:`robonav.robot.environments.sense` says, and the
    rays are made only once. ``noise`` is the standard deviation, in metres, of an error on every range that sees
    something.
    """
    rays = _sector_rays()
    for j in range(start, stop):
        i = robots[j]
        x, y, heading = poses[i, 0], poses[i, 1], poses[i, 2]
        ranges[j] = SENSOR_RANGE
        walls[j] = False
        _sense_obstacles(
            kinds[i], shapes[i], centres[i], x, y, heading, rays, ranges[j]
        )
        _sense_borders(size, x, y, heading, rays, ranges[j], walls[j])
        _read_out(keys[i], steps[i], noise, ranges[j], walls[j])
        dx, dy = targets[i, 0] - x, targets[i, 1] - y
        seen[j] = micrometres(math.hypot(dx, dy)) <= SENSOR_RANGE
        region[j] = target_region(dx, dy, heading)


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
