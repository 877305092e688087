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
from .geometry import box_distance, reach_of, swept_distance
from .random_numbers import DRAWING, ENDPOINTS, uniform

compiled = compiler(constants, geometry, random_numbers)


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
        half_length, half_width = shapes[m, 0], shapes[m, 1]
        x, y = centres[m, 0], centres[m, 1]
        reach = reach_of(kinds[m], half_length, half_width) + spare
        first = max(math.ceil(y - reach), 0)
        last = min(math.floor(y + reach) + 1, cells)
        for i in range(
            max(math.ceil(x - reach), 0), min(math.floor(x + reach) + 1, cells)
        ):
            row, dx = closed[i, first:last], i - x
            # loops without branches, which the compiler turns into vector instructions
            if kinds[m] == CIRCLE:
                for k in range(len(row)):
                    dy = (first + k) - y
                    row[k] |= dx * dx + dy * dy < reach * reach
            else:
                for k in range(len(row)):
                    dy = (first + k) - y
                    along, across = c * dx + s * dy, c * dy - s * dx
                    row[k] |= box_distance(along, across, half_length, half_width) < spare  # fmt: skip


@compiled
def reachable(kinds, shapes, centres, size, x0, y0, x1, y1, spare):
    """Whether a path on a grid of whole metres, ``spare`` clear of everything, joins two points (flood fill).

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
        # last pushed, first visited: the longer way towards the target
        for order in range(4):
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
            reach = reach_of(RECTANGLE, shapes[m, 0], shapes[m, 1])
        centres[m, 0] = reach + (size - 2.0 * reach) * uniform(key, DRAWING, step, m, 0)
        centres[m, 1] = reach + (size - 2.0 * reach) * uniform(key, DRAWING, step, m, 1)
        kind = CIRCLE if circle else RECTANGLE
        clear = True
        for points in (starts, targets):
            for p in range(len(points)):
                x, y = points[p, 0] - centres[m, 0], points[p, 1] - centres[m, 1]
                far = KEEP_OUT + reach + 1e-3  # no need to look closer
                if x * x + y * y > far * far:
                    continue
                clear = (
                    clear and swept_distance(kind, shapes[m], x, y, x, y) >= KEEP_OUT
                )
        if clear:
            return True
    return False


@compiled
def draw_obstacles(
    i, number, keys, still, moving, slowest, fastest, size, starts, targets, kinds, shapes, centres, speeds, headings,
):  # fmt: skip
    """Draw the obstacles of world i, attempt ``number``; False if one found no place clear of starts and targets."""
    placed = True
    for m in range(still + moving):
        circle = (m if m < still else m - still) % 2 == 0
        placed = placed and _draw_obstacle(
            keys[i], number, m, circle, size, starts, targets, shapes[i], centres[i]
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
    return placed


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
            placed = draw_obstacles(
                i, number, keys, still, moving, slowest, fastest, size, starts[s : s + 1], targets[t : t + 1], kinds,
                shapes, centres, speeds, headings,
            )  # fmt: skip
            if placed and reachable(
                kinds[i, :still], shapes[i, :still], centres[i, :still], size,
                chosen[i, 0], chosen[i, 1], chosen[i, 2], chosen[i, 3], SPARE,
            ):  # fmt: skip
                found[i] = True
                break
