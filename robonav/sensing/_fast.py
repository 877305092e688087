"""The compiled twins of the sensors: ranges in a ring of sectors, and a picture of what is around the robot."""

from __future__ import annotations

import math

from robonav.compilation import compiler
from robonav.robot._fast import constants, geometry, in_threads, random_numbers
from robonav.robot._fast.constants import CIRCLE, NOTHING, SENSOR_RANGE
from robonav.robot._fast.geometry import box_entry, micrometres
from robonav.robot._fast.random_numbers import SENSING, normal

__all__ = ["in_threads", "read_sectors", "take_pictures"]

compiled = compiler(constants, geometry, random_numbers)


@compiled
def sector_of(forward, left, sectors):
    """Index of the sector that holds a point in the robot's frame; 0 looks ahead, counter-clockwise."""
    return math.floor(math.atan2(left, forward) * sectors / math.tau + 0.5) % sectors


@compiled
def see(ranges, j, sector, distance):
    """Shorten the range of a sector in row j."""
    if distance < ranges[j, sector]:
        ranges[j, sector] = distance


@compiled
def see_on_ray(ranges, j, ray, distance):
    """Shorten the ranges of the two sectors beside a ray; ray k lies between sectors k and k + 1."""
    see(ranges, j, ray, distance)
    see(ranges, j, (ray + 1) % ranges.shape[1], distance)


@compiled
def see_circle(ranges, j, x, y, radius):
    """Read a circle centred at (x, y) in the robot's frame."""
    distance, sectors = math.hypot(x, y), ranges.shape[1]
    if distance <= radius:
        ranges[j, :] = 0.0
        return
    see(ranges, j, sector_of(x, y, sectors), distance - radius)
    for k in range(sectors):
        angle = (k + 0.5) * math.tau / sectors
        c, s = math.cos(angle), math.sin(angle)
        ahead, across = x * c + y * s, x * s - y * c
        half_chord2 = radius * radius - across * across
        if ahead > 0.0 and half_chord2 >= 0.0:
            see_on_ray(ranges, j, k, ahead - math.sqrt(half_chord2))


@compiled
def see_rectangle(ranges, j, x, y, half_length, half_width, turned):
    """Read a rectangle centred at (x, y) in the robot's frame, its length turned by ``turned`` against the heading."""
    sectors = ranges.shape[1]
    c, s = math.cos(turned), math.sin(turned)
    px, py = -(c * x + s * y), -(c * y - s * x)  # the robot in the rectangle's frame
    if abs(px) <= half_length and abs(py) <= half_width:
        ranges[j, :] = 0.0
        return
    nx = min(max(px, -half_length), half_length) - px
    ny = min(max(py, -half_width), half_width) - py
    sector = sector_of(c * nx - s * ny, s * nx + c * ny, sectors)
    see(ranges, j, sector, math.hypot(nx, ny))
    for k in range(sectors):
        angle = (k + 0.5) * math.tau / sectors - turned
        enter, leave = box_entry(
            px, py, math.cos(angle), math.sin(angle), half_length, half_width
        )
        if 0.0 <= enter <= leave:
            see_on_ray(ranges, j, k, enter)


@compiled
def see_borders(ranges, j, size, x, y, heading):
    """Read the borders of the map."""
    margin = min(min(x, size - x), min(y, size - y))
    if margin >= SENSOR_RANGE:
        return
    if margin <= 0.0:  # it went through a border, and has collided
        ranges[j, :] = 0.0
        return
    sectors, half = ranges.shape[1], size / 2
    c, s = math.cos(heading), math.sin(heading)
    for distance, nx, ny in (
        (x, -1.0, 0.0),
        (size - x, 1.0, 0.0),
        (y, 0.0, -1.0),
        (size - y, 0.0, 1.0),
    ):
        sector = sector_of(c * nx + s * ny, c * ny - s * nx, sectors)
        see(ranges, j, sector, distance)
    for k in range(sectors):
        angle = heading + (k + 0.5) * math.tau / sectors
        _, distance = box_entry(
            x - half, y - half, math.cos(angle), math.sin(angle), half, half
        )
        see_on_ray(ranges, j, k, distance)


@compiled
def read_sectors(
    start, stop, robots, kinds, shapes, centres, size, poses, keys, steps, noise, ranges
):  # fmt: skip
    """Fill rows ``start`` to ``stop - 1`` of ``ranges`` (K, sectors) with what robots (K,) read in their sectors.

    With nine sectors these are the ranges that the simulator itself reports, errors included.
    """
    for j in range(start, stop):
        i = robots[j]
        x, y, heading = poses[i, 0], poses[i, 1], poses[i, 2]
        c, s = math.cos(heading), math.sin(heading)
        ranges[j, :] = SENSOR_RANGE
        for m in range(kinds.shape[1]):
            a, b = shapes[i, m, 0], shapes[i, m, 1]
            dx, dy = centres[i, m, 0] - x, centres[i, m, 1] - y
            near = SENSOR_RANGE + a + b
            if kinds[i, m] == NOTHING or dx * dx + dy * dy >= near * near:
                continue
            forward, left = c * dx + s * dy, c * dy - s * dx
            if kinds[i, m] == CIRCLE:
                see_circle(ranges, j, forward, left, a)
            else:
                see_rectangle(ranges, j, forward, left, a, b, shapes[i, m, 2] - heading)
        see_borders(ranges, j, size, x, y, heading)
        for k in range(ranges.shape[1]):
            distance = micrometres(ranges[j, k])
            if noise > 0.0 and distance < SENSOR_RANGE:
                error = noise * normal(keys[i], SENSING, steps[i], k)
                distance = micrometres(min(max(distance + error, 0.0), SENSOR_RANGE))
            ranges[j, k] = distance


@compiled
def covers(kind, shape, dx, dy):
    """Whether an obstacle holds a point (dx, dy) away from its centre."""
    if kind == CIRCLE:
        return dx * dx + dy * dy <= shape[0] * shape[0]
    c, s = math.cos(shape[2]), math.sin(shape[2])
    return abs(c * dx + s * dy) <= shape[0] and abs(c * dy - s * dx) <= shape[1]


@compiled
def take_pictures(
    start, stop, robots, kinds, shapes, centres, size, poses, pictures
):  # fmt: skip
    """Fill ``pictures`` (K, cells, cells) from ``start`` to ``stop - 1``: 1 where a cell's middle is not free."""
    cells = pictures.shape[1]
    width = 2 * SENSOR_RANGE / cells
    for j in range(start, stop):
        i = robots[j]
        x, y = poses[i, 0], poses[i, 1]
        c, s = math.cos(poses[i, 2]), math.sin(poses[i, 2])
        for row in range(cells):
            forward = SENSOR_RANGE - (row + 0.5) * width
            for column in range(cells):
                left = SENSOR_RANGE - (column + 0.5) * width
                pictures[j, row, column] = 0.0
                if forward * forward + left * left > SENSOR_RANGE * SENSOR_RANGE:
                    continue
                px, py = x + c * forward - s * left, y + s * forward + c * left
                if px < 0.0 or px > size or py < 0.0 or py > size:
                    pictures[j, row, column] = 1.0
        for m in range(kinds.shape[1]):
            kind, shape = kinds[i, m], shapes[i, m]
            dx, dy = x - centres[i, m, 0], y - centres[i, m, 1]
            near = SENSOR_RANGE + shape[0] + shape[1]
            if kind == NOTHING or dx * dx + dy * dy >= near * near:
                continue
            for row in range(cells):
                forward = SENSOR_RANGE - (row + 0.5) * width
                for column in range(cells):
                    left = SENSOR_RANGE - (column + 0.5) * width
                    if forward * forward + left * left > SENSOR_RANGE * SENSOR_RANGE:
                        continue
                    px, py = dx + c * forward - s * left, dy + s * forward + c * left
                    if covers(kind, shape, px, py):
                        pictures[j, row, column] = 1.0
