"""Drawing random worlds, and the flood fill that rejects those without a way to the target."""

from __future__ import annotations

import math

import numpy as np

from robonav.compilation import compiler

from . import constants, geometry, random_numbers
from .constants import (
    CIRCLE,
    KEEP_OUT,
    LARGEST,
    LONGEST,
    NOTHING,
    RECTANGLE,
    REDRAWS,
    SHORTEST,
    SMALLEST,
    SPARE,
)
from .geometry import reach_of, swept_distance
from .random_numbers import DRAWING, ENDPOINTS, draw_from

LANES = 16  # numbers that a few vector instructions compute

compiled = compiler(constants, geometry, random_numbers)
inlined = compiler(constants, geometry, random_numbers, inline=True)


@compiled
def empty_grid(size, spare):
    """Return a grid of whole metres for an empty map: 1 where a cell is nearer than ``spare`` to a border, or 0.

    Rows are longer than the map, to hold whole groups of LANES cells. Their length is a power of two: the flood fill
    gets the row and the column of a cell's number without a division.
    """
    cells, inner = int(size) + 1, math.ceil(spare)
    width = 1
    while width < cells + LANES:
        width *= 2
    grid = np.ones((cells, width), dtype=np.uint8)
    last = math.floor(size - spare) + 1
    grid[inner:last, inner:last] = 0
    return grid


@compiled
def _close_cells(i, still, kinds, shapes, centres, spare, closed):
    """Mark the cells of a grid of whole metres that are nearer than ``spare`` to an obstacle of world i.

    A circle is a box without sides here, of which the cells nearer than the radius and ``spare`` are marked. The loop
    over a fixed number of cells has no branches, so that the compiler turns it into vector instructions.
    """
    cells = len(closed)
    for m in range(still):
        if kinds[i, m] == NOTHING:
            continue
        x, y = centres[i, m, 0], centres[i, m, 1]
        half_length, half_width, angle = (
            shapes[i, m, 0],
            shapes[i, m, 1],
            shapes[i, m, 2],
        )
        reach = spare + reach_of(kinds[i, m], half_length, half_width)
        c, s, near = 1.0, 0.0, reach
        if kinds[i, m] == CIRCLE:
            half_length = 0.0
        else:
            c, s, near = math.cos(angle), math.sin(angle), spare
        left, right = (
            max(math.ceil(x - reach), 0),
            min(math.floor(x + reach) + 1, cells),
        )
        low, high = max(math.ceil(y - reach), 0), min(math.floor(y + reach) + 1, cells)
        for column in range(left, right):
            dx = column - x
            for first in range(low, high, LANES):
                row = closed[column, first : first + LANES]
                for k in range(LANES):
                    dy = (first + k) - y
                    along = max(abs(c * dx + s * dy) - half_length, 0.0)
                    across = max(abs(c * dy - s * dx) - half_width, 0.0)
                    row[k] |= along * along + across * across < near * near


@compiled
def reachable(
    i, still, kinds, shapes, centres, x0, y0, x1, y1, spare, empty, closed, stack
):
    """Whether a path on a grid of whole metres, ``spare`` clear of everything, joins two points (flood fill).

    The first ``still`` obstacles of world i are in its way. ``empty`` is the :func:`empty_grid` without them. The grid
    ``closed`` and the ``stack`` of cells are as large; both are written over.

    Depth first, steps towards the target first: the answer is that of a full flood, mostly after a few hundred cells.
    """
    flat, free = closed.reshape(-1), empty.reshape(-1)
    for k in range(len(flat)):  # as closed[:] = empty, but ten times as fast
        flat[k] = free[k]
    _close_cells(i, still, kinds, shapes, centres, spare, closed)
    width = closed.shape[1]
    bits = 0
    while 1 << bits < width:
        bits += 1
    goal_row, goal_column = math.floor(x1 + 0.5), math.floor(y1 + 0.5)
    cell = (math.floor(x0 + 0.5) << bits) + math.floor(y0 + 0.5)
    if flat[cell]:
        return False
    flat[cell] = 1
    stack[0], top = cell, 1
    while top > 0:
        top -= 1
        cell = stack[top]
        rows, columns = goal_row - (cell >> bits), goal_column - (cell & (width - 1))
        if abs(rows) <= 1 and abs(columns) <= 1:
            return True
        longer, shorter = width if rows >= 0 else -width, 1 if columns >= 0 else -1
        if abs(rows) < abs(columns):
            longer, shorter = shorter, longer
        # last put on the stack, first visited: the longer way towards the target; a border's cells are never open
        for turn in range(4):
            step = longer if turn in (0, 3) else shorter
            following = cell + step if turn >= 2 else cell - step
            if not flat[following]:
                flat[following] = 1
                stack[top] = following
                top += 1
    return False


@inlined
def _draw_obstacle(i, keys, number, m, circle, size, starts, targets, shapes, centres):
    """Place obstacle ``m``; False if no place was found clear of every start and target."""
    low, high = keys[i, 0], keys[i, 1]
    placed = False
    for redraw in range(REDRAWS):
        step = number * REDRAWS + redraw
        if circle:
            shapes[i, m, 0] = SMALLEST + (LARGEST - SMALLEST) * draw_from(
                low, high, DRAWING, step, m, 2
            )
            shapes[i, m, 1] = shapes[i, m, 2] = 0.0
            reach = shapes[i, m, 0]
        else:
            shapes[i, m, 0] = 0.5 * (
                SHORTEST
                + (LONGEST - SHORTEST) * draw_from(low, high, DRAWING, step, m, 2)
            )
            shapes[i, m, 1] = 0.5 * (
                SHORTEST
                + (LONGEST - SHORTEST) * draw_from(low, high, DRAWING, step, m, 3)
            )
            shapes[i, m, 2] = math.pi * draw_from(low, high, DRAWING, step, m, 4)
            reach = reach_of(RECTANGLE, shapes[i, m, 0], shapes[i, m, 1])
        across = size - 2.0 * reach
        centres[i, m, 0] = reach + across * draw_from(low, high, DRAWING, step, m, 0)
        centres[i, m, 1] = reach + across * draw_from(low, high, DRAWING, step, m, 1)
        kind = CIRCLE if circle else RECTANGLE
        placed = True
        for points in (starts, targets):
            for p in range(len(points)):
                x, y = points[p, 0] - centres[i, m, 0], points[p, 1] - centres[i, m, 1]
                far = KEEP_OUT + reach + 1e-3  # no need to look closer
                if x * x + y * y <= far * far:
                    distance = swept_distance(kind, shapes[i, m], x, y, x, y)
                    placed = placed and distance >= KEEP_OUT
        if placed:
            break
    return placed


@compiled
def draw_obstacles(
    i, number, keys, still, moving, slowest, fastest, size, starts, targets, kinds, shapes, centres, speeds, headings,
):  # fmt: skip
    """Draw the obstacles of world i, attempt ``number``; False if one found no place clear of starts and targets."""
    placed = True
    for m in range(still + moving):
        circle = (m if m < still else m - still) % 2 == 0
        if placed:
            placed = _draw_obstacle(
                i, keys, number, m, circle, size, starts, targets, shapes, centres
            )
        kinds[i, m] = CIRCLE if circle else RECTANGLE
        speeds[i, m], headings[i, m] = 0.0, 0.0
        if m >= still:
            low, high = keys[i, 0], keys[i, 1]
            speeds[i, m] = slowest + (fastest - slowest) * draw_from(
                low, high, DRAWING, number, m, 5
            )
            headings[i, m] = math.pi * (
                2.0 * draw_from(low, high, DRAWING, number, m, 6) - 1.0
            )
    return placed


@compiled
def draw_worlds(
    start, stop, keys, still, moving, slowest, fastest, size, starts, targets, attempts, kinds, shapes, centres, speeds,
    headings, chosen, found,
):  # fmt: skip
    """Draw worlds ``start`` to ``stop`` until each has a path to its target, ``attempts`` times at most.

    Half of the standing obstacles are circles and half rectangles, and so are the moving ones. ``chosen`` (N, 4) gets
    the start and the target, drawn from ``starts`` (S, 2) and ``targets`` (T, 2). ``found`` (N,) gets whether a map was
    found.
    """
    empty = empty_grid(size, SPARE)
    closed, stack = np.empty_like(empty), np.empty(empty.size, dtype=np.int64)
    for i in range(start, stop):
        kinds[i] = NOTHING
        found[i] = False
        low, high = keys[i, 0], keys[i, 1]
        for number in range(attempts):
            s = int(draw_from(low, high, DRAWING, number, ENDPOINTS, 0) * len(starts))
            t = int(draw_from(low, high, DRAWING, number, ENDPOINTS, 1) * len(targets))
            chosen[i, 0], chosen[i, 1] = starts[s, 0], starts[s, 1]
            chosen[i, 2], chosen[i, 3] = targets[t, 0], targets[t, 1]
            placed = draw_obstacles(
                i, number, keys, still, moving, slowest, fastest, size, starts[s : s + 1], targets[t : t + 1], kinds,
                shapes, centres, speeds, headings,
            )  # fmt: skip
            if placed and reachable(
                i, still, kinds, shapes, centres, chosen[i, 0], chosen[i, 1], chosen[i, 2], chosen[i, 3], SPARE, empty,
                closed, stack,
            ):  # fmt: skip
                found[i] = True
                break
