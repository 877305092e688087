"""What one robot senses: the least distance in each of nine sectors, and the sector of its target (section 2.5).

The map reaches from (0, 0) to (size, size). Of M obstacles there are the kinds (M,), the shapes (M, 3) and the centres
(M, 2). A shape is a circle's radius, or half a rectangle's length, half its width, and the angle of its length.

numba compiles these functions, which are plain Python for one robot; ``_fast`` senses for many, and tests hold the two
equal, bit for bit. From ``_fast`` come ``box_entry``, the way along a line to a box; ``micrometres``, which rounds a
distance, so that the last bit of a sine decides nothing; and ``normal``, a random number that is a hash of the world's
key, a purpose, the step and a count.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from robonav.compilation import compiler

from ._fast import constants, geometry, random_numbers
from ._fast.constants import (
    CIRCLE,
    NOTHING,
    SECTOR,  # 40 degrees
    SENSOR_RANGE,  # 10 m
    SENSORS,  # 9
)
from ._fast.geometry import box_entry, micrometres
from ._fast.random_numbers import SENSING, normal

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Pose = tuple[float, float, float]  # x, y and heading
Obstacles = tuple[Array, Array, Array]  # kinds, shapes and centres

compiled = compiler(constants, geometry, random_numbers)


@compiled
def sense(
    obstacles: Obstacles, size: float, pose: Pose, target: tuple[float, float],
    noise: float, key: Array, step: int, ranges: Array, walls: Flags,
) -> tuple[int, bool]:  # fmt: skip
    """Sense the least distance in each of nine sectors, and where the target is.

    Fills in ``ranges`` (9,) and ``walls`` (9,), whether the nearest thing is a border. Returns the target's sector, 1
    to 9, and whether it is in range. ``noise`` is the standard deviation of the error of a range.

    Examples
    --------
    >>> from robonav.robot import make_world
    >>> world = make_world(circles=[(58, 50, 2)])
    >>> obstacles = world.kinds[0], world.shapes[0], world.centres[0]
    >>> ranges, walls = np.empty(9), np.empty(9, dtype=bool)
    >>> sense(obstacles, 100.0, (50.0, 50.0, 0.0), (90.0, 50.0), 0.0, world.keys[0], 0, ranges, walls)
    (1, False)
    >>> ranges
    array([ 6., 10., 10., 10., 10., 10., 10., 10., 10.])
    """
    ranges[:], walls[:] = SENSOR_RANGE, False
    sense_obstacles(obstacles, pose, ranges, walls)
    sense_borders(size, pose, ranges, walls)
    for k in range(SENSORS):
        distance = micrometres(ranges[k])
        if noise > 0.0 and distance < SENSOR_RANGE:
            error = noise * normal(key, SENSING, step, k)
            distance = micrometres(min(max(distance + error, 0.0), SENSOR_RANGE))
        ranges[k], walls[k] = distance, walls[k] and distance < SENSOR_RANGE

    dx, dy = target[0] - pose[0], target[1] - pose[1]
    bearing = micrometres(math.atan2(dy, dx) - pose[2])
    seen = micrometres(math.hypot(dx, dy)) <= SENSOR_RANGE
    return 1 + sector_at(bearing), seen


@compiled
def sector_at(bearing: float) -> int:
    """Index 0 to 8 of the sector of 40 degrees that holds a bearing; 0 looks ahead, counter-clockwise.

    Examples
    --------
    >>> sector_at(0.0), sector_at(math.radians(30)), sector_at(math.radians(-30))
    (0, 1, 8)
    """
    return math.floor(bearing / SECTOR + 0.5) % SENSORS


@compiled
def see(distance: float, k: int, wall: bool, ranges: Array, walls: Flags) -> None:
    """Keep the distance in sector ``k`` if nothing there is nearer."""
    if distance < ranges[k]:
        ranges[k], walls[k] = distance, wall


@compiled
def see_on_ray(
    distance: float, k: int, wall: bool, ranges: Array, walls: Flags
) -> None:
    """See something on the ray between sectors ``k`` and ``k + 1``: both have it."""
    see(distance, k, wall, ranges, walls)
    see(distance, (k + 1) % SENSORS, wall, ranges, walls)


@compiled
def sense_obstacles(
    obstacles: Obstacles, pose: Pose, ranges: Array, walls: Flags
) -> None:
    """See each obstacle at its nearest point, and where the rays between two sectors meet it.

    This is enough: seen from outside, the distance to a convex shape falls and then rises with the bearing. So its
    least distance in a sector is at its nearest point, if the sector holds it, or else on one of the sector's two rays.

    Examples
    --------
    >>> from robonav.robot import make_world
    >>> world = make_world(circles=[(50, 57, 2)])
    >>> ranges, walls = np.full(9, 10.0), np.zeros(9, dtype=bool)
    >>> obstacles = world.kinds[0], world.shapes[0], world.centres[0]
    >>> sense_obstacles(obstacles, (50.0, 50.0, 0.0), ranges, walls)
    >>> ranges[2]  # 80 degrees to the left
    np.float64(5.0)
    """
    kinds, shapes, centres = obstacles
    x, y, heading = pose
    c, s = math.cos(heading), math.sin(heading)
    rays = directions_of_rays()
    for m in range(len(kinds)):
        dx, dy = centres[m, 0] - x, centres[m, 1] - y
        near = SENSOR_RANGE + shapes[m, 0] + shapes[m, 1]
        if kinds[m] == NOTHING or dx * dx + dy * dy >= near * near:
            continue
        forward, left = c * dx + s * dy, c * dy - s * dx  # in the robot's frame
        if kinds[m] == CIRCLE:
            see_circle(forward, left, shapes[m, 0], rays, ranges, walls)
        else:
            turned = shapes[m, 2] - heading
            see_rectangle(forward, left, shapes[m], turned, rays, ranges, walls)


@compiled
def directions_of_rays() -> Array:
    """Directions (9, 2) in the robot's frame of the rays between sectors k and k + 1."""
    rays = np.empty((SENSORS, 2))
    for k in range(SENSORS):
        rays[k, 0] = math.cos((k + 0.5) * SECTOR)
        rays[k, 1] = math.sin((k + 0.5) * SECTOR)
    return rays


@compiled
def see_circle(
    x: float, y: float, radius: float,
    rays: Array, ranges: Array, walls: Flags,
) -> None:  # fmt: skip
    """See a circle whose centre is x ahead and y to the left.

    Examples
    --------
    >>> ranges, walls = np.full(9, 10.0), np.zeros(9, dtype=bool)
    >>> see_circle(8.0, 0.0, 2.0, directions_of_rays(), ranges, walls)
    >>> ranges[0]
    np.float64(6.0)
    """
    distance = math.hypot(x, y) - radius
    if distance <= 0.0:  # the robot is in it
        ranges[:] = 0.0
        return
    see(distance, sector_at(math.atan2(y, x)), False, ranges, walls)
    for k in range(SENSORS):
        along = x * rays[k, 0] + y * rays[k, 1]
        across = x * rays[k, 1] - y * rays[k, 0]
        half_chord2 = radius * radius - across * across
        if along > 0.0 and half_chord2 >= 0.0:  # the ray meets it
            distance = along - math.sqrt(half_chord2)
            see_on_ray(distance, k, False, ranges, walls)


@compiled
def see_rectangle(
    x: float, y: float, shape: Array, turned: float,
    rays: Array, ranges: Array, walls: Flags,
) -> None:  # fmt: skip
    """See a rectangle whose centre is x ahead and y to the left, its length turned to the left.

    Examples
    --------
    >>> ranges, walls = np.full(9, 10.0), np.zeros(9, dtype=bool)
    >>> shape = np.array([3.0, 1.0, 0.0])  # half its length and its width
    >>> see_rectangle(8.0, 0.0, shape, 0.0, directions_of_rays(), ranges, walls)
    >>> ranges[0]
    np.float64(5.0)
    """
    half_length, half_width = shape[0], shape[1]
    c, s = math.cos(turned), math.sin(turned)
    px, py = -(c * x + s * y), -(c * y - s * x)  # the robot in the rectangle's frame
    nx = min(max(px, -half_length), half_length) - px  # from it to the nearest point
    ny = min(max(py, -half_width), half_width) - py
    if nx == 0.0 and ny == 0.0:  # the robot is in it
        ranges[:] = 0.0
        return
    nearest = sector_at(math.atan2(s * nx + c * ny, c * nx - s * ny))
    see(math.hypot(nx, ny), nearest, False, ranges, walls)
    for k in range(SENSORS):
        dx, dy = c * rays[k, 0] + s * rays[k, 1], c * rays[k, 1] - s * rays[k, 0]
        enter, leave = box_entry(px, py, dx, dy, half_length, half_width)
        if 0.0 <= enter <= leave:  # the ray meets it
            see_on_ray(enter, k, False, ranges, walls)


@compiled
def sense_borders(size: float, pose: Pose, ranges: Array, walls: Flags) -> None:
    """See each border at its nearest point, and where the rays between two sectors leave the map.

    Examples
    --------
    >>> ranges, walls = np.full(9, 10.0), np.zeros(9, dtype=bool)
    >>> sense_borders(100.0, (96.0, 50.0, 0.0), ranges, walls)
    >>> ranges[0], walls[0]
    (np.float64(4.0), np.True_)
    """
    x, y, heading = pose
    margin = min(x, size - x, y, size - y)
    if margin >= SENSOR_RANGE:
        return
    if margin <= 0.0:  # the robot went through a border
        ranges[:], walls[:] = 0.0, True
        return
    c, s = math.cos(heading), math.sin(heading)
    for distance, nx, ny in (
        (x, -1.0, 0.0),
        (size - x, 1.0, 0.0),
        (y, 0.0, -1.0),
        (size - y, 0.0, 1.0),
    ):
        k = sector_at(math.atan2(c * ny - s * nx, c * nx + s * ny))
        see(distance, k, True, ranges, walls)
    rays, half = directions_of_rays(), size / 2
    for k in range(SENSORS):
        dx, dy = c * rays[k, 0] - s * rays[k, 1], s * rays[k, 0] + c * rays[k, 1]
        _, distance = box_entry(x - half, y - half, dx, dy, half, half)
        see_on_ray(distance, k, True, ranges, walls)
