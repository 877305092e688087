"""The compiled twins of the two searches in :mod:`robonav.lfd.astar` (section 3.5).

They return the same paths as the readable functions, and expand the same nodes in the same order. A node is a whole
number here, the index into arrays that hold G, the parent and the position of each node.

Lengths are in metres, angles in radians counter-clockwise. A world has M slots for obstacles. The functions use one
core and release the GIL.
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
# Turns of F, L30, L60, R30 and R60 in multiples of 30 degrees.
ACTION_TURNS = np.array([0, 1, 2, -1, -2])
# The simulator rounds to a micrometre. At this distance it, too, counts a robot as arrived.
CLOSE_ENOUGH = ARRIVAL_DISTANCE - 2e-6
NONE = -1

compiled = compiler(constants, geometry)


@compiled
def square_of(x, y, cell, cells):
    """Return the number of the square that holds a point of the map.

    A quotient may be rounded up to ``cells``, and a point may lie on the border: both are in the last column or row.
    """
    return min(int(x / cell), cells - 1) * cells + min(int(y / cell), cells - 1)


@compiled
def search_actions(
    kinds, shapes, centres, size, pose, target, speed, margin, caution, cell, limit, record, visited,
):  # fmt: skip
    """Modified A* in one world: the compiled twin of :func:`robonav.lfd.astar.modified_astar`.

    Node ``(column * cells + row) * HEADINGS + heading`` stands for the poses of one heading in one cell. The clearance
    at the middle of a cell is computed when it is first needed. Where it is large, steps that end in the cell are safe
    and are not checked.

    Parameters
    ----------
    kinds, shapes, centres, size
        The obstacles (M of them) and the side of the map.
    pose : (3,) array
        x, y and heading to start from.
    target : (2,) array
        x and y.
    speed, margin, caution, cell : float
        See :func:`robonav.lfd.plan`.
    limit : int
        The most nodes to expand.
    record : bool
        Whether to keep the poses expanded.
    visited : (limit, 3) array
        Gets the poses expanded, in their order, if ``record``.

    Returns
    -------
    found : bool
        Whether there is a path.
    poses : (K + 1, 3) array
        The path; the start alone if there is none.
    actions : (K,) array of int
        The actions of the path.
    expanded : int
        Number of nodes expanded.
    """
    cells = math.ceil(size / cell)
    positions = np.empty((cells * cells * HEADINGS, 2))
    costs = np.full(len(positions), math.inf)  # G
    parents = np.empty(len(positions), dtype=np.int32)
    closed = np.zeros(len(positions), dtype=np.bool_)
    displacements = displacements_of_a_step(pose[2], speed)
    # With this clearance at the middle of a square, every step that ends there is safe.
    far_enough = margin + speed + cell
    most = SENSOR_RANGE if caution > 0.0 else far_enough  # clearances are cut off here
    clear = np.full(cells * cells, -1.0)  # of each square; -1: not computed yet

    start = square_of(pose[0], pose[1], cell, cells) * HEADINGS
    positions[start, 0], positions[start, 1] = pose[0], pose[1]
    costs[start], parents[start] = 0.0, NONE
    rest = math.hypot(target[0] - pose[0], target[1] - pose[1])
    # F, then H: of equal F, the node nearest to the target
    queue = [(rest, rest, start)]
    reached, expanded = NONE, 0
    while len(queue) > 0 and expanded < limit:
        node = heapq.heappop(queue)[2]
        if closed[node]:
            continue
        closed[node] = True
        x, y, h = positions[node, 0], positions[node, 1], node % HEADINGS
        if record:
            heading = wrapped_heading(pose[2], h)
            visited[expanded, 0], visited[expanded, 1], visited[expanded, 2] = (
                x,
                y,
                heading,
            )
        expanded += 1
        if math.hypot(target[0] - x, target[1] - y) <= CLOSE_ENOUGH:
            reached = node
            break
        for turns in ACTION_TURNS:
            turned = (h + turns) % HEADINGS
            x1, y1 = x + displacements[turned, 0], y + displacements[turned, 1]
            if not (0.0 < x1 < size and 0.0 < y1 < size):
                continue
            square = square_of(x1, y1, cell, cells)
            neighbour = square * HEADINGS + turned
            tentative = costs[node] + speed
            if closed[neighbour] or costs[neighbour] <= tentative:
                continue
            if clear[square] < 0.0:
                clear[square] = clearance_at_middle(
                    kinds, shapes, centres, size, square, cell, cells, most
                )
            if caution > 0.0:
                tentative += speed * caution * (1.0 - clear[square] / most) ** 2
            if costs[neighbour] <= tentative:
                continue
            if clear[square] < far_enough and margin > step_clearance(
                kinds, shapes, centres, size, x, y, x1, y1, margin
            ):
                continue
            positions[neighbour, 0], positions[neighbour, 1] = x1, y1
            costs[neighbour], parents[neighbour] = tentative, node
            rest = math.hypot(target[0] - x1, target[1] - y1)
            heapq.heappush(queue, (tentative + rest, rest, neighbour))
    last = start if reached == NONE else reached
    poses, actions = _path(positions, parents, last, pose[2])
    return reached != NONE, poses, actions, expanded


@compiled
def displacements_of_a_step(heading, speed):
    """Return how far a step leads in x and y (12, 2), for each number of 30-degree turns from a heading."""
    displacements = np.empty((HEADINGS, 2))
    for turns in range(HEADINGS):
        turned = heading + math.radians(30.0 * turns)
        displacements[turns, 0] = speed * math.cos(turned)
        displacements[turns, 1] = speed * math.sin(turned)
    return displacements


@compiled
def clearance_at_middle(kinds, shapes, centres, size, square, cell, cells, limit):
    """Return the distance from the middle of a square to obstacles and borders, at most ``limit``."""
    x, y = (square // cells + 0.5) * cell, (square % cells + 0.5) * cell
    return step_clearance(kinds, shapes, centres, size, x, y, x, y, limit)


@compiled
def step_clearance(kinds, shapes, centres, size, x, y, x1, y1, limit):
    """Return the distance that a step keeps from obstacles, which stand still, and borders, at most ``limit``."""
    return swept_clearance(kinds, shapes, centres, centres, size, x, y, x1, y1, limit)


@compiled
def wrapped_heading(heading, turns):
    """Turn a heading left by a number of 30-degree turns; the result lies in (-pi, pi]."""
    return math.pi - (math.pi - heading - math.radians(30.0 * turns)) % (2.0 * math.pi)


@compiled
def _path(positions, parents, last, heading):
    """Follow the parents from node ``last`` back to the start; return poses (K + 1, 3) and actions (K,) in order."""
    count, node = 0, last
    while parents[node] != NONE:
        count, node = count + 1, parents[node]
    poses, actions = np.empty((count + 1, 3)), np.empty(count, dtype=np.int64)
    node = last
    for k in range(count, -1, -1):
        poses[k, 0], poses[k, 1], poses[k, 2] = (
            positions[node, 0],
            positions[node, 1],
            wrapped_heading(heading, node % HEADINGS),
        )
        before = parents[node]
        for action in range(len(ACTION_TURNS)):
            if k > 0 and (before + ACTION_TURNS[action] - node) % HEADINGS == 0:
                actions[k - 1] = action
        node = before
    return poses, actions


@compiled
def search_grid(
    kinds, shapes, centres, size, origin, index, target, margin, cell, record, visited
):
    """A* on a grid in one world: the compiled twin of :func:`robonav.lfd.astar.grid_astar`.

    Node ``column * rows + row`` stands for a point of the grid.

    Parameters
    ----------
    kinds, shapes, centres, size
        The obstacles (M of them) and the side of the map.
    origin : (2,) array
        The point of the grid in column 0 and row 0.
    index : (int, int)
        Column and row of the start.
    target : (2,) array
        Where to go.
    margin, cell : float
        See :func:`robonav.lfd.plan_on_grid`.
    record : bool
        Whether to keep the points expanded.
    visited : (nodes, 2) array
        Gets the points expanded, in their order, if ``record``.

    Returns
    -------
    found : bool
        Whether there is a path.
    points : (K + 1, 2) array
        The path; the start alone if there is none.
    expanded : int
        Number of nodes expanded.
    """
    west, south = origin[0], origin[1]
    # A quotient may be rounded down; the start is a point of the grid in any case.
    columns = max(int((size - west) / cell), index[0]) + 1
    rows = max(int((size - south) / cell), index[1]) + 1
    costs = np.full(columns * rows, math.inf)  # G
    parents = np.empty(columns * rows, dtype=np.int32)
    closed = np.zeros(columns * rows, dtype=np.bool_)

    first = index[0] * rows + index[1]
    costs[first], parents[first] = 0.0, NONE
    rest = math.hypot(
        target[0] - (west + index[0] * cell), target[1] - (south + index[1] * cell)
    )
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
                x1 = west + (column + right) * cell
                y1 = south + (row + up) * cell
                if (
                    step_clearance(kinds, shapes, centres, size, x, y, x1, y1, margin)
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
