"""The planners' compiled core: the two searches of section 3.5, over robot actions and over a grid.

The searches judge a step by the simulator's own kernel, which stands in another file. numba's cache would not see an
edit there; :func:`compiled` therefore adds that file's digest to the key under which a kernel is kept.

Shapes: M obstacle slots. Metres, radians counter-clockwise. Kernels are serial and release the GIL.
"""

from __future__ import annotations

import heapq
import math

import numpy as np

from robonav.compilation import compiler
from robonav.robot._fast import (
    ARRIVAL_DISTANCE,
    SENSOR_RANGE,
    constants,
    geometry,
    swept_clearance,
)

HEADINGS = 12  # a heading changes by multiples of 30 degrees
TWELFTHS = np.array([0, 1, 2, -1, -2])  # what F, L30, L60, R30, R60 add to it
CLOSE_ENOUGH = (
    ARRIVAL_DISTANCE - 2e-6
)  # the simulator rounds to a micrometre; what we call arrived, it does too
NONE = -1

compiled = compiler(constants, geometry)


@compiled
def search_actions(
    kinds,
    shapes,
    centres,
    size,
    pose,
    target,
    speed,
    margin,
    caution,
    cell,
    limit,
    record,
    visited,
):
    """Modified A* (Algorithm 4) in one world: nodes are poses, their neighbours what the five actions lead to.

    Positions are continuous. Two poses of one heading in one ``cell`` count as the same node, of which the one with
    the lower G stays; without that no pose would ever be met twice.

    Parameters
    ----------
    pose : (3,) where to start. target : (2,).
    speed : length of a step. margin : clearance that each step keeps, at least.
    caution : how much is added to G a metre, at an obstacle; it fades, with the square of the distance, out to sensor
        range. Taken at the middle of the cell in which the step ends.
    cell : side of the cells, in metres.
    limit : nodes to expand at most.
    visited : (limit, 3) gets the poses expanded, in their order, if ``record``.

    Returns
    -------
    found : whether a path was found.
    poses (K + 1, 3), actions (K,) : the path; the start alone if there is none.
    expanded : number of nodes expanded.
    """
    cells = math.ceil(size / cell)
    places = np.empty((cells * cells * HEADINGS, 2))
    costs = np.full(len(places), math.inf)  # G
    parents = np.empty(len(places), dtype=np.int32)
    closed = np.zeros(len(places), dtype=np.bool_)
    ways = np.empty((HEADINGS, 2))
    for h in range(HEADINGS):
        heading = pose[2] + math.radians(30.0 * h)
        ways[h, 0], ways[h, 1] = speed * math.cos(heading), speed * math.sin(heading)
    far_enough = (
        margin + speed + cell
    )  # clearance of a square, beyond which no step that ends there is too near
    berth = SENSOR_RANGE if caution > 0.0 else far_enough  # no more of it need be known
    clear = np.full(
        cells * cells, -1.0
    )  # at the middle of each square, worked out when first needed

    start = (
        min(int(pose[0] / cell), cells - 1) * cells
        + min(int(pose[1] / cell), cells - 1)
    ) * HEADINGS
    places[start, 0], places[start, 1], costs[start], parents[start] = (
        pose[0],
        pose[1],
        0.0,
        NONE,
    )
    rest = math.hypot(target[0] - pose[0], target[1] - pose[1])
    queue = [
        (rest, rest, start)
    ]  # F, then H: of nodes as good as each other, the one nearest to the target
    reached, expanded = NONE, 0
    while len(queue) > 0 and expanded < limit:
        node = heapq.heappop(queue)[2]
        if closed[node]:
            continue
        closed[node] = True
        x, y, h = places[node, 0], places[node, 1], node % HEADINGS
        if record:
            visited[expanded, 0], visited[expanded, 1], visited[expanded, 2] = (
                x,
                y,
                _wrap(pose[2], h),
            )
        expanded += 1
        if math.hypot(target[0] - x, target[1] - y) <= CLOSE_ENOUGH:
            reached = node
            break
        for twelfths in TWELFTHS:
            turned = (h + twelfths) % HEADINGS
            x1, y1 = x + ways[turned, 0], y + ways[turned, 1]
            if not (0.0 < x1 < size and 0.0 < y1 < size):
                continue
            square = int(x1 / cell) * cells + int(y1 / cell)
            neighbour = square * HEADINGS + turned
            if closed[neighbour] or costs[neighbour] <= costs[node] + speed:
                continue
            if clear[square] < 0.0:
                cx, cy = (int(x1 / cell) + 0.5) * cell, (int(y1 / cell) + 0.5) * cell
                clear[square] = swept_clearance(
                    kinds, shapes, centres, centres, size, cx, cy, cx, cy, berth
                )
            tentative = costs[node] + speed
            if caution > 0.0:
                tentative += speed * caution * (1.0 - clear[square] / berth) ** 2
            if costs[neighbour] <= tentative:
                continue
            sure = clear[square] >= far_enough
            if (
                not sure
                and swept_clearance(
                    kinds, shapes, centres, centres, size, x, y, x1, y1, margin
                )
                < margin
            ):
                continue
            places[neighbour, 0], places[neighbour, 1] = x1, y1
            costs[neighbour], parents[neighbour] = tentative, node
            rest = math.hypot(target[0] - x1, target[1] - y1)
            heapq.heappush(queue, (tentative + rest, rest, neighbour))
    poses, actions = _walked(
        places, parents, start if reached == NONE else reached, pose[2]
    )
    return reached != NONE, poses, actions, expanded


@compiled
def _wrap(heading, twelfths):
    """A heading turned left by so many times 30 degrees, in (-pi, pi]."""
    return math.pi - (math.pi - heading - math.radians(30.0 * twelfths)) % (
        2.0 * math.pi
    )


@compiled
def _walked(places, parents, last, heading):
    """The way back from node ``last`` to the start, turned round: poses (K + 1, 3) and actions (K,)."""
    count, node = 0, last
    while parents[node] != NONE:
        count, node = count + 1, parents[node]
    poses, actions = np.empty((count + 1, 3)), np.empty(count, dtype=np.int64)
    node = last
    for k in range(count, -1, -1):
        poses[k, 0], poses[k, 1], poses[k, 2] = (
            places[node, 0],
            places[node, 1],
            _wrap(heading, node % HEADINGS),
        )
        before = parents[node]
        for action in range(len(TWELFTHS)):
            if k > 0 and (before + TWELFTHS[action] - node) % HEADINGS == 0:
                actions[k - 1] = action
        node = before
    return poses, actions


@compiled
def search_grid(
    kinds, shapes, centres, size, start, target, margin, cell, record, visited
):
    """Conventional A* in one world: nodes are the corners of a grid, their neighbours the eight around each.

    Parameters
    ----------
    start, target : (2,). The grid is laid so that ``start`` is one of its nodes.
    margin : clearance that each step keeps, at least.
    cell : side of the grid's cells, in metres.
    visited : (nodes, 2) gets the points expanded, in their order, if ``record``.

    Returns
    -------
    found : whether a path was found.
    points (K + 1, 2) : the path; the start alone if there is none.
    expanded : number of nodes expanded.
    """
    west, south = start[0] % cell, start[1] % cell
    columns, rows = int((size - west) / cell) + 1, int((size - south) / cell) + 1
    costs = np.full(columns * rows, math.inf)  # G
    parents = np.empty(columns * rows, dtype=np.int32)
    closed = np.zeros(columns * rows, dtype=np.bool_)

    first = int(start[0] / cell) * rows + int(start[1] / cell)
    costs[first], parents[first] = 0.0, NONE
    rest = math.hypot(target[0] - start[0], target[1] - start[1])
    queue = [(rest, rest, first)]
    reached, expanded = NONE, 0
    while len(queue) > 0:
        node = heapq.heappop(queue)[2]
        if closed[node]:
            continue
        closed[node] = True
        column, row = node // rows, node % rows
        x, y = west + column * cell, south + row * cell
        if record:
            visited[expanded, 0], visited[expanded, 1] = x, y
        expanded += 1
        if math.hypot(target[0] - x, target[1] - y) <= CLOSE_ENOUGH:
            reached = node
            break
        for right in range(-1, 2):
            for up in range(-1, 2):
                if not (0 <= column + right < columns and 0 <= row + up < rows):
                    continue
                neighbour = node + right * rows + up
                tentative = costs[node] + cell * math.sqrt(right * right + up * up)
                if closed[neighbour] or costs[neighbour] <= tentative:
                    continue
                x1, y1 = x + right * cell, y + up * cell
                if (
                    swept_clearance(
                        kinds, shapes, centres, centres, size, x, y, x1, y1, margin
                    )
                    < margin
                ):
                    continue
                costs[neighbour], parents[neighbour] = tentative, node
                rest = math.hypot(target[0] - x1, target[1] - y1)
                heapq.heappush(queue, (tentative + rest, rest, neighbour))
    backwards = [first if reached == NONE else reached]
    while parents[backwards[-1]] != NONE:
        backwards.append(parents[backwards[-1]])
    points = np.empty((len(backwards), 2))
    for k in range(len(backwards)):
        node = backwards[len(backwards) - 1 - k]
        points[k, 0], points[k, 1] = (
            west + (node // rows) * cell,
            south + (node % rows) * cell,
        )
    return reached != NONE, points, expanded
