"""The simulator's compiled core: every loop over robots and obstacles, in one file.

One file, because numba's cache watches the file a kernel stands in and not the files it calls. Kernels are serial and
release the GIL; :func:`in_threads` gives each thread its own range of worlds, so results never depend on the threads.
Every kernel treats world ``i`` alone: a batch of one gives the same bits as the same world in a batch of a million.

Shapes: N worlds, M obstacle slots a world. Metres, radians counter-clockwise, seconds; one step is one second.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from numba import njit

NOTHING, CIRCLE, RECTANGLE = 0, 1, 2
RUNNING, ARRIVED, COLLIDED, OUT_OF_STEPS = 0, 1, 2, 3
SENSORS = 9
SECTOR = math.radians(40)
SENSOR_RANGE = 10.0  # d_bou of Eq. (4.6)
COLLISION_DISTANCE = 1.0  # d_col: degree of danger 7
ARRIVAL_DISTANCE = 3.0  # d_win
BACKWARD, TO_TARGET = 5, 6
TURNS = np.radians(
    [0.0, 30.0, 60.0, -30.0, -60.0, 0.0, 0.0]
)  # F, L30, L60, R30, R60, B, to the target

TURN_PROBABILITY = (
    0.1  # a moving obstacle draws a new heading in about every tenth step
)
SPARE = 2.0  # clearance a drawn map keeps along some way to the target
KEEP_OUT = 6.0  # no obstacle this close to start or target
REDRAWS = 100  # places tried for one obstacle before the map is given up
SMALLEST, LARGEST = 1.5, 4.0  # circle radius
SHORTEST, LONGEST = 3.0, 8.0  # rectangle side

# What a random number is for; each purpose has a stream of its own.
DRAWING, DRIFTING, SENSING, SLIPPING = 1, 2, 3, 4
ITEMS = 1024  # obstacles, and the few other things that draw numbers in one step
ENDPOINTS = ITEMS - 1  # slot that draws start and target
MAX_OBSTACLES = ITEMS - 2

_MASK = np.uint64(0xFFFFFFFF)

compiled = njit(cache=True, nogil=True, error_model="numpy")


# ---------------------------------------------------------------------------------------------------------------------
# Random numbers: a hash of (key, purpose, step, item, draw), the same here and in JavaScript


@compiled
def _mix(x):
    """Wellons' 32-bit finaliser ("lowbias32", 2018): every input bit flips every output bit about half the time."""
    x = x & _MASK
    x ^= x >> np.uint64(16)
    x = (x * np.uint64(0x7FEB352D)) & _MASK
    x ^= x >> np.uint64(15)
    x = (x * np.uint64(0x846CA68B)) & _MASK
    return x ^ (x >> np.uint64(16))


@njit(
    "f8(u4[::1], i8, i8, i8, i8)", cache=True, nogil=True, error_model="numpy"
)  # else one a literal: 2 s more
def uniform(key, purpose, step, item, draw):
    """A number in [0, 1) from a world's key (2,) and a counter; eight draws an item, 1024 items a step."""
    counter = np.uint64((step * ITEMS + item) * 8 + draw)
    first = _mix(counter * np.uint64(0x9E3779B9) + np.uint64(key[0]))
    second = _mix(first ^ np.uint64(key[1]))
    return (
        float(_mix(second + np.uint64(purpose) * np.uint64(0x632BE5AB))) / 4294967296.0
    )


@compiled
def _normal(key, purpose, step, item):
    """A standard normal number (Box and Muller 1958)."""
    radius = math.sqrt(-2.0 * math.log(1.0 - uniform(key, purpose, step, item, 0)))
    return radius * math.cos(2.0 * math.pi * uniform(key, purpose, step, item, 1))


# ---------------------------------------------------------------------------------------------------------------------
# Geometry


@compiled
def _micrometres(distance):
    """Round to a micrometre: distances that are equal on paper are equal in what is decided on them."""
    return math.floor(distance * 1e6 + 0.5) / 1e6


@compiled
def _reach(kind, half_length, half_width):
    """Radius of the circle about the centre that holds the shape."""
    return (
        half_length
        if kind == CIRCLE
        else math.sqrt(half_length * half_length + half_width * half_width)
    )


@compiled
def _box_distance(x, y, half_length, half_width):
    """Distance from a point to an axis-parallel box about the origin; 0 inside."""
    dx, dy = max(abs(x) - half_length, 0.0), max(abs(y) - half_width, 0.0)
    return math.sqrt(dx * dx + dy * dy)


@compiled
def _segment_distance(x, y, x0, y0, x1, y1):
    """Distance from a point to a segment."""
    dx, dy = x1 - x0, y1 - y0
    length2 = dx * dx + dy * dy
    t = (
        0.0
        if length2 == 0.0
        else min(max(((x - x0) * dx + (y - y0) * dy) / length2, 0.0), 1.0)
    )
    return math.hypot(x - x0 - t * dx, y - y0 - t * dy)


@compiled
def _box_entry(x, y, dx, dy, half_length, half_width):
    """Where the line (x, y) + t (dx, dy) enters a box about the origin (slab method); enters after it leaves: a miss.

    Returns
    -------
    (enter, leave) : parameters t of entry and exit.
    """
    enter, leave = -math.inf, math.inf
    for position, direction, half in ((x, dx, half_length), (y, dy, half_width)):
        if direction != 0.0:
            t0, t1 = (-half - position) / direction, (half - position) / direction
            enter, leave = max(enter, min(t0, t1)), min(leave, max(t0, t1))
        elif abs(position) > half:
            return math.inf, -math.inf
    return enter, leave


@compiled
def _segment_box_distance(x0, y0, x1, y1, half_length, half_width):
    """Least distance between a segment and an axis-parallel box about the origin; 0 where they meet."""
    enter, leave = _box_entry(x0, y0, x1 - x0, y1 - y0, half_length, half_width)
    if enter <= leave and enter <= 1.0 and leave >= 0.0:
        return 0.0
    least = min(
        _box_distance(x0, y0, half_length, half_width),
        _box_distance(x1, y1, half_length, half_width),
    )
    for sx in (-1.0, 1.0):
        for sy in (-1.0, 1.0):
            least = min(
                least,
                _segment_distance(sx * half_length, sy * half_width, x0, y0, x1, y1),
            )
    return least


@compiled
def _swept_distance(kind, shape, x0, y0, x1, y1):
    """Least distance to an obstacle at the origin while going straight from (x0, y0) to (x1, y1)."""
    if kind == CIRCLE:
        return _segment_distance(0.0, 0.0, x0, y0, x1, y1) - shape[0]
    c, s = math.cos(shape[2]), math.sin(shape[2])
    return _segment_box_distance(
        c * x0 + s * y0,
        c * y0 - s * x0,
        c * x1 + s * y1,
        c * y1 - s * x1,
        shape[0],
        shape[1],
    )


@compiled
def swept_clearance(kinds, shapes, before, after, size, x0, y0, x1, y1, enough):
    """Least distance to any obstacle (M of them) or border during one step; no more than ``enough`` is worked out.

    Obstacles go from ``before`` to ``after`` (M, 2) while the robot goes from (x0, y0) to (x1, y1), both straight and
    at constant speed: seen from the obstacle the robot goes along a segment.
    """
    least = min(
        min(x1, size - x1),
        min(y1, size - y1),
        min(x0, size - x0),
        min(y0, size - y0),
        enough,
    )
    for m in range(len(kinds)):
        if kinds[m] == NOTHING:
            continue
        ax, ay = x0 - before[m, 0], y0 - before[m, 1]
        bx, by = x1 - after[m, 0], y1 - after[m, 1]
        near = (
            shapes[m, 0] + shapes[m, 1] + least
        )  # no root: a box reaches less far than the sum of its halves
        if (
            min(ax, bx) > near
            or max(ax, bx) < -near
            or min(ay, by) > near
            or max(ay, by) < -near
        ):
            continue
        least = min(least, _swept_distance(kinds[m], shapes[m], ax, ay, bx, by))
    return max(least, 0.0)


# ---------------------------------------------------------------------------------------------------------------------
# Sensing


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
        enter, leave = _box_entry(px, py, dx, dy, half_length, half_width)
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
        _, distance = _box_entry(x - size / 2, y - size / 2, dx, dy, size / 2, size / 2)
        for sector in (k, (k + 1) % SENSORS):
            if distance < ranges[sector]:
                ranges[sector], walls[sector] = distance, True


@compiled
def sense(
    start,
    stop,
    robots,
    kinds,
    shapes,
    centres,
    size,
    poses,
    targets,
    keys,
    steps,
    noise,
    ranges,
    walls,
    region,
    seen,
):
    """What ``robots[start]`` to ``robots[stop - 1]`` read: ranges and walls (K, 9), target region and seen (K,).

    ``robots`` (K,) are rows of the N worlds. ``noise`` is the standard deviation, in metres, of an error on every
    range that sees something.
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
        for k in range(SENSORS):
            distance = _micrometres(ranges[j, k])
            if noise > 0.0 and distance < SENSOR_RANGE:
                error = noise * _normal(keys[i], SENSING, steps[i], k)
                distance = _micrometres(min(max(distance + error, 0.0), SENSOR_RANGE))
            ranges[j, k] = distance
            walls[j, k] = walls[j, k] and distance < SENSOR_RANGE
        tx, ty = targets[i, 0] - x, targets[i, 1] - y
        bearing = math.atan2(ty, tx) - heading
        region[j] = 1 + math.floor(_micrometres(bearing) / SECTOR + 0.5) % SENSORS
        seen[j] = _micrometres(math.hypot(tx, ty)) <= SENSOR_RANGE


@compiled
def reflexes(start, stop, ranges, speed, commands):
    """What the robot does by itself (Algorithms 8 and 9): safe, to the target; blocked ahead, back; else -1, ask."""
    for i in range(start, stop):
        least = SENSOR_RANGE
        for k in range(SENSORS):
            least = min(least, ranges[i, k])
        blocked = True
        for k in (0, 1, 2, 7, 8):
            blocked = blocked and ranges[i, k] < speed + COLLISION_DISTANCE
        commands[i] = (
            TO_TARGET if least >= SENSOR_RANGE else BACKWARD if blocked else -1
        )


# ---------------------------------------------------------------------------------------------------------------------
# Motion


@compiled
def _wrap(angle):
    """The same angle in (-pi, pi]."""
    if angle > math.pi:
        return angle - 2.0 * math.pi
    if angle <= -math.pi:
        return angle + 2.0 * math.pi
    return angle


@compiled
def _drift(kinds, shapes, speeds, key, step, size, centres, headings):
    """Moving obstacles go one second on, turn at random, bounce off the borders."""
    for m in range(len(kinds)):
        if kinds[m] == NOTHING or speeds[m] == 0.0:
            continue
        heading = headings[m]
        if uniform(key, DRIFTING, step, m, 0) < TURN_PROBABILITY:
            heading = math.pi * (2.0 * uniform(key, DRIFTING, step, m, 1) - 1.0)
        x = centres[m, 0] + speeds[m] * math.cos(heading)
        y = centres[m, 1] + speeds[m] * math.sin(heading)
        reach = _reach(kinds[m], shapes[m, 0], shapes[m, 1])
        if x < reach or x > size - reach:
            x = 2.0 * reach - x if x < reach else 2.0 * (size - reach) - x
            heading = _wrap(math.pi - heading)
        if y < reach or y > size - reach:
            y = 2.0 * reach - y if y < reach else 2.0 * (size - reach) - y
            heading = -heading
        centres[m, 0], centres[m, 1], headings[m] = x, y, heading


@compiled
def _slipped(action, slip, key, step):
    """The action that comes of ``action`` when row ``action`` of ``slip`` says how likely each is."""
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
        _drift(
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
        if action == TO_TARGET:
            heading = math.atan2(targets[i, 1] - y, targets[i, 0] - x)
            action = 0
        if slip.shape[0] > 0:
            slipped = _slipped(action, slip, keys[i], steps[i])
            if slipped != action:
                action = actions[j] = slipped
        heading = _wrap(heading + TURNS[action])
        length = -speed if action == BACKWARD else speed
        x1, y1 = x + length * math.cos(heading), y + length * math.sin(heading)
        for m in range(
            len(before)
        ):  # a slice assignment would compile the text of its error, for three seconds
            before[m, 0], before[m, 1] = centres[i, m, 0], centres[i, m, 1]
        _drift(
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
        if _micrometres(clearance) < COLLISION_DISTANCE:
            outcome[i] = COLLIDED
        elif (
            _micrometres(math.hypot(targets[i, 0] - x1, targets[i, 1] - y1))
            <= ARRIVAL_DISTANCE
        ):
            outcome[i] = ARRIVED
        elif steps[i] >= max_steps:
            outcome[i] = OUT_OF_STEPS


# ---------------------------------------------------------------------------------------------------------------------
# Drawing worlds


@compiled
def _close_cells(kinds, shapes, centres, size, spare, closed):
    """Mark the cells of a grid of whole metres that are nearer than ``spare`` to an obstacle or border."""
    cells = len(closed)
    closed[:] = True
    inner = math.ceil(spare)
    closed[
        inner : math.floor(size - spare) + 1, inner : math.floor(size - spare) + 1
    ] = False
    for m in range(len(kinds)):
        if kinds[m] == NOTHING:
            continue
        c, s = math.cos(shapes[m, 2]), math.sin(shapes[m, 2])
        reach = _reach(kinds[m], shapes[m, 0], shapes[m, 1]) + spare
        for i in range(
            max(math.ceil(centres[m, 0] - reach), 0),
            min(math.floor(centres[m, 0] + reach) + 1, cells),
        ):
            for j in range(
                max(math.ceil(centres[m, 1] - reach), 0),
                min(math.floor(centres[m, 1] + reach) + 1, cells),
            ):
                dx, dy = i - centres[m, 0], j - centres[m, 1]
                if kinds[m] == CIRCLE:
                    near = dx * dx + dy * dy < reach * reach
                else:
                    near = (
                        _box_distance(
                            c * dx + s * dy, c * dy - s * dx, shapes[m, 0], shapes[m, 1]
                        )
                        < spare
                    )
                if near:
                    closed[i, j] = True


@compiled
def reachable(kinds, shapes, centres, size, x0, y0, x1, y1, spare):
    """Whether a walk on a grid of whole metres, ``spare`` clear of everything, joins two points (flood fill).

    Depth first, steps towards the target first: the answer is that of a full flood, mostly after a few hundred cells.
    """
    cells = int(size) + 1
    closed = np.empty((cells, cells), dtype=np.bool_)
    _close_cells(kinds, shapes, centres, size, spare, closed)
    stack = np.empty((cells * cells, 2), dtype=np.int32)
    i, j = math.floor(x0 + 0.5), math.floor(y0 + 0.5)
    goal_i, goal_j = math.floor(x1 + 0.5), math.floor(y1 + 0.5)
    if closed[i, j]:
        return False
    closed[i, j] = True
    stack[0, 0], stack[0, 1] = i, j
    top = 1
    while top > 0:
        top -= 1
        i, j = stack[top, 0], stack[top, 1]
        if abs(i - goal_i) <= 1 and abs(j - goal_j) <= 1:
            return True
        di = 1 if goal_i >= i else -1
        dj = 1 if goal_j >= j else -1
        sideways = abs(goal_i - i) >= abs(goal_j - j)
        for order in range(
            4
        ):  # last pushed, first visited: the longer way towards the target
            along = (order % 2 == 1) == sideways
            sign = 1 if order >= 2 else -1
            ni, nj = (i + sign * di, j) if along else (i, j + sign * dj)
            if 0 <= ni < cells and 0 <= nj < cells and not closed[ni, nj]:
                closed[ni, nj] = True
                stack[top, 0], stack[top, 1] = ni, nj
                top += 1
    return False


@compiled
def _draw_obstacle(key, number, m, circle, size, starts, targets, shapes, centres):
    """Place obstacle ``m``; False if no place was found clear of every start and target."""
    for redraw in range(REDRAWS):
        step = number * REDRAWS + redraw
        if circle:
            shapes[m, 0] = SMALLEST + (LARGEST - SMALLEST) * uniform(
                key, DRAWING, step, m, 2
            )
            shapes[m, 1] = shapes[m, 2] = 0.0
            reach = shapes[m, 0]
        else:
            shapes[m, 0] = 0.5 * (
                SHORTEST + (LONGEST - SHORTEST) * uniform(key, DRAWING, step, m, 2)
            )
            shapes[m, 1] = 0.5 * (
                SHORTEST + (LONGEST - SHORTEST) * uniform(key, DRAWING, step, m, 3)
            )
            shapes[m, 2] = math.pi * uniform(key, DRAWING, step, m, 4)
            reach = _reach(RECTANGLE, shapes[m, 0], shapes[m, 1])
        centres[m, 0] = reach + (size - 2.0 * reach) * uniform(key, DRAWING, step, m, 0)
        centres[m, 1] = reach + (size - 2.0 * reach) * uniform(key, DRAWING, step, m, 1)
        kind = CIRCLE if circle else RECTANGLE
        clear = True
        for points in (starts, targets):
            for p in range(len(points)):
                x, y = points[p, 0] - centres[m, 0], points[p, 1] - centres[m, 1]
                clear = (
                    clear and _swept_distance(kind, shapes[m], x, y, x, y) >= KEEP_OUT
                )
        if clear:
            return True
    return False


@compiled
def draw_worlds(
    start, stop, keys, still, moving, slowest, fastest, size, starts, targets, attempts, kinds, shapes, centres, speeds,
    headings, chosen, found,
):  # fmt: skip
    """Draw worlds ``start`` to ``stop`` until each has a way through, ``attempts`` times at most.

    Half of the standing obstacles are circles, half rectangles; so with the moving ones. ``chosen`` (N, 4) gets start
    and target, each one of ``starts`` (S, 2) and ``targets`` (T, 2); ``found`` (N,) whether a map was found.
    """
    for i in range(start, stop):
        kinds[i] = NOTHING
        found[i] = False
        for number in range(attempts):
            s = int(uniform(keys[i], DRAWING, number, ENDPOINTS, 0) * len(starts))
            t = int(uniform(keys[i], DRAWING, number, ENDPOINTS, 1) * len(targets))
            chosen[i, 0], chosen[i, 1] = starts[s, 0], starts[s, 1]
            chosen[i, 2], chosen[i, 3] = targets[t, 0], targets[t, 1]
            placed = True
            for m in range(still + moving):
                circle = (m if m < still else m - still) % 2 == 0
                placed = placed and _draw_obstacle(
                    keys[i],
                    number,
                    m,
                    circle,
                    size,
                    starts[s : s + 1],
                    targets[t : t + 1],
                    shapes[i],
                    centres[i],
                )
                kinds[i, m] = CIRCLE if circle else RECTANGLE
                speeds[i, m], headings[i, m] = 0.0, 0.0
                if m >= still:
                    speeds[i, m] = slowest + (fastest - slowest) * uniform(
                        keys[i], DRAWING, number, m, 5
                    )
                    headings[i, m] = math.pi * (
                        2.0 * uniform(keys[i], DRAWING, number, m, 6) - 1.0
                    )
            if placed and reachable(
                kinds[i, :still], shapes[i, :still], centres[i, :still], size,
                chosen[i, 0], chosen[i, 1], chosen[i, 2], chosen[i, 3], SPARE,
            ):  # fmt: skip
                found[i] = True
                break


# ---------------------------------------------------------------------------------------------------------------------
# Threads

_pool: ThreadPoolExecutor | None = None
_CORES = (
    len(os.sched_getaffinity(0))
    if hasattr(os, "sched_getaffinity")
    else os.cpu_count() or 1
)


def _forget_pool() -> None:
    global _pool
    _pool = None


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_pool)  # threads do not survive a fork


def in_threads(
    kernel: Callable[..., None], worlds: int, *arguments: Any, worth: int = 256
) -> None:
    """Run ``kernel(start, stop, *arguments)`` over 0..worlds, split over the machine's cores.

    Fewer than ``worth`` worlds a thread are not worth handing over.
    """
    global _pool
    if worlds < 2 * worth or _CORES == 1:
        kernel(0, worlds, *arguments)
        return
    if _pool is None:
        _pool = ThreadPoolExecutor(_CORES, thread_name_prefix="robonav")
    parts = min(_CORES, worlds // worth)
    cuts = [worlds * k // parts for k in range(parts + 1)]
    list(_pool.map(lambda k: kernel(cuts[k], cuts[k + 1], *arguments), range(parts)))
