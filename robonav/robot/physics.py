"""What happens to one robot in its map: actions slip, obstacles move, the robot collides and senses (section 2.5).

``NavigationEnv.step`` calls :func:`slip_to`, :func:`drift`, :func:`least_clearance` and :func:`sense`, in this order.
They are plain Python, which numba compiles. ``_fast`` has the same for many robots, and tests hold the two equal, bit
for bit.

Angles are in radians, counter-clockwise, distances in metres. The map reaches from (0, 0) to (size, size). Of its M
obstacles there are the kinds (M,), the shapes (M, 3) and the centres (M, 2). A shape is a circle's radius, or half a
rectangle's length, half its width, and the angle of its length.

From ``_fast`` come ``swept_distance`` from a segment to a shape at the origin; ``box_entry``, the way along a line to a
box; ``reach_of``, the radius of the circle about a shape; ``wrap``, which keeps an angle in (-pi, pi]; ``micrometres``,
which rounds a distance, so that the last bit of a sine decides nothing; and ``uniform`` and ``normal``, random numbers
that are a hash of the world's key, a purpose, the step and a count.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robonav.compilation import compiler

from ._fast import constants, geometry, motion, random_numbers
from ._fast.constants import (
    CIRCLE,
    COLLISION_DISTANCE,  # 1 m
    NOTHING,
    SECTOR,  # 40 degrees
    SENSOR_RANGE,  # 10 m
    SENSORS,  # 9
    TURN_PROBABILITY,  # of a moving obstacle in a second: 0.1
)
from ._fast.geometry import box_entry, micrometres, reach_of, swept_distance
from ._fast.motion import wrap
from ._fast.random_numbers import DRIFTING, SENSING, SLIPPING, normal, uniform
from .worlds import Worlds

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Obstacles = tuple[Array, Array, Array]  # kinds (M,), shapes (M, 3), centres (M, 2)
Point = tuple[float, float]
Pose = tuple[float, float, float]  # x, y and heading

# of the actions 0 to 5: 0, 30, 60, -30, -60, 0 degrees, in radians
TURNS: list[float] = constants.TURNS.tolist()

compiled = compiler(constants, geometry, motion, random_numbers)


@dataclass(eq=False)
class Map:
    """The map of one robot: one world, taken out of its batch. Its obstacles may move.

    Its methods pass its arrays to the functions below.

    Attributes
    ----------
    kinds, shapes, centres : (M,), (M, 3) and (M, 2) arrays
        Of M obstacles, see :class:`Worlds`.
    headings, speeds : (M,) arrays
        Of their motion.
    size : float
        Length of the map's sides in metres.
    key : (2,) array
        Random numbers of the episode are a hash of it.
    start : (x, y, heading)
        Pose of the robot at the start; it faces its target.
    target : (x, y)

    Examples
    --------
    >>> from robonav.robot import make_world
    >>> Map.of(make_world(circles=[(58, 50, 2)])).centres
    array([[58., 50.]])
    """

    kinds: Array
    shapes: Array
    centres: Array
    headings: Array
    speeds: Array
    size: float
    key: NDArray[np.uint32]
    start: tuple[float, float, float]
    target: tuple[float, float]

    def __post_init__(self) -> None:
        self.obstacles = self.kinds, self.shapes, self.centres
        self.moving = bool(self.speeds.any())

    @staticmethod
    def of(world: Worlds) -> Map:
        """Return the map of a batch of one world, which stays as it is."""
        return Map(
            world.kinds[0], world.shapes[0], world.centres[0].copy(), world.headings[0].copy(), world.speeds[0],
            world.size, world.keys[0], tuple(world.start_poses[0].tolist()), tuple(world.targets[0].tolist()),
        )  # fmt: skip

    def heading_to_target(self, x: float, y: float) -> float:
        """Return the direction of the target from (x, y)."""
        return math.atan2(self.target[1] - y, self.target[0] - x)

    def distance_to_target(self, x: float, y: float) -> float:
        """Return the distance of the target from (x, y)."""
        return micrometres(math.hypot(self.target[0] - x, self.target[1] - y))

    def move_obstacles(self, step: int) -> Array:
        """Let the moving obstacles go on for one second; return the centres (M, 2) of all obstacles before."""
        before = self.centres
        if self.moving:
            before = before.copy()
            drift(self.obstacles, self.headings, self.speeds, self.size, self.key, step)
        return before

    def least_clearance(self, centres_before: Array, start: Point, end: Point) -> float:
        """Return the least distance to anything on the way from ``start`` to ``end``."""
        return least_clearance(self.obstacles, centres_before, self.size, start, end)

    def sense(
        self, pose: Pose, noise: float, step: int
    ) -> tuple[Array, Flags, int, bool]:
        """Return what a robot senses: see :func:`sense`."""
        return sense(
            self.obstacles, self.size, pose, self.target, noise, self.key, step
        )


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


@compiled
def sense(
    obstacles: Obstacles, size: float, pose: Pose, target: Point,
    noise: float, key: Array, step: int,
) -> tuple[Array, Flags, int, bool]:  # fmt: skip
    """Sense the least distance in each of nine sectors, and where the target is.

    Returns the ranges (9,), whether the nearest thing in each sector is a border (9,), the sector of the target, 0 to
    8, and whether the target is in range. ``noise`` is the standard deviation of the error of a range.

    Examples
    --------
    >>> from robonav.robot import make_world
    >>> world = make_world(circles=[(58, 50, 2)])
    >>> obstacles = world.kinds[0], world.shapes[0], world.centres[0]
    >>> ranges, walls, region, seen = sense(
    ...     obstacles, 100.0, (50.0, 50.0, 0.0), (90.0, 50.0), 0.0, world.keys[0], 0
    ... )
    >>> ranges, region, seen
    (array([ 6., 10., 10., 10., 10., 10., 10., 10., 10.]), 0, False)
    """
    ranges, walls = np.empty(SENSORS), np.empty(SENSORS, dtype=np.bool_)
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
    return ranges, walls, sector_at(bearing), seen


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
