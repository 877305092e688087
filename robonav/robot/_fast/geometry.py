"""Geometry: distances between points, segments, circles and rectangles, and the clearance of a step."""

from __future__ import annotations

import math

from robonav.compilation import compiler

from . import constants
from .constants import CIRCLE, NOTHING

compiled = compiler(constants)


@compiled
def micrometres(distance):
    """Round to a micrometre: distances that are equal on paper are equal in what is decided on them."""
    return math.floor(distance * 1e6 + 0.5) / 1e6


@compiled
def reach_of(kind, half_length, half_width):
    """Radius of the circle about the centre that holds the shape."""
    return (
        half_length
        if kind == CIRCLE
        else math.sqrt(half_length * half_length + half_width * half_width)
    )


@compiled
def box_distance(x, y, half_length, half_width):
    """Distance from a point to an axis-parallel box about the origin; 0 inside."""
    dx, dy = max(abs(x) - half_length, 0.0), max(abs(y) - half_width, 0.0)
    return math.sqrt(dx * dx + dy * dy)


@compiled
def segment_distance(x, y, x0, y0, x1, y1):
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
def box_entry(x, y, dx, dy, half_length, half_width):
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
    enter, leave = box_entry(x0, y0, x1 - x0, y1 - y0, half_length, half_width)
    if enter <= leave and enter <= 1.0 and leave >= 0.0:
        return 0.0
    least = min(
        box_distance(x0, y0, half_length, half_width),
        box_distance(x1, y1, half_length, half_width),
    )
    for sx in (-1.0, 1.0):
        for sy in (-1.0, 1.0):
            least = min(
                least,
                segment_distance(sx * half_length, sy * half_width, x0, y0, x1, y1),
            )
    return least


@compiled
def swept_distance(kind, shape, x0, y0, x1, y1):
    """Least distance to an obstacle at the origin while going straight from (x0, y0) to (x1, y1)."""
    if kind == CIRCLE:
        return segment_distance(0.0, 0.0, x0, y0, x1, y1) - shape[0]
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
def passes_by(near, x0, y0, x1, y1):
    """Whether a segment lies on one side of a square of half side ``near`` about the origin."""
    return (
        min(x0, x1) > near
        or max(x0, x1) < -near
        or min(y0, y1) > near
        or max(y0, y1) < -near
    )


@compiled
def border_clearance(size, x0, y0, x1, y1):
    """Least distance to a border on the way from (x0, y0) to (x1, y1)."""
    return min(x0, size - x0, y0, size - y0, x1, size - x1, y1, size - y1)


@compiled
def swept_clearance(kinds, shapes, before, after, size, x0, y0, x1, y1, limit):
    """Least distance to any obstacle (M of them) or border during one step, at most ``limit``.

    Obstacles go from ``before`` to ``after`` (M, 2) while the robot goes from (x0, y0) to (x1, y1), both straight and
    at constant speed: seen from the obstacle the robot goes along a segment.
    """
    least = min(border_clearance(size, x0, y0, x1, y1), limit)
    for m in range(len(kinds)):
        if kinds[m] == NOTHING:
            continue
        ax, ay = x0 - before[m, 0], y0 - before[m, 1]
        bx, by = x1 - after[m, 0], y1 - after[m, 1]
        # no root: a box reaches less far than the sum of its halves
        near = shapes[m, 0] + shapes[m, 1] + least
        if passes_by(near, ax, ay, bx, by):
            continue
        least = min(least, swept_distance(kinds[m], shapes[m], ax, ay, bx, by))
    return max(least, 0.0)
