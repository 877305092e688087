"""Planning on a known map: modified A* over the robot's actions, and A* on a grid to compare (section 3.5)."""

from __future__ import annotations

import heapq
import math
import warnings
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.robot import SENSOR_RANGE, Worlds
from robonav.robot._fast import swept_clearance
from robonav.validation import (
    check_array,
    check_instance,
    check_integer,
    check_positive,
    check_real,
)

from . import _fast

Floats = NDArray[np.float64]
Point = tuple[float, float]
Node = tuple[int, ...]
FINEST = 2e-3  # the smallest cell, as a fraction of the map's side: the table of nodes grows with its square


@dataclass(frozen=True, eq=False)
class Plan:
    """The path that modified A* found in one world.

    Attributes
    ----------
    found : bool
        Whether there is a path. If not, the path is the start alone.
    points : (K + 1, 2) array
        Positions in metres, the start first.
    headings : (K + 1,) array
        Radians.
    actions : (K,) array of int
        F, L30, L60, R30 or R60: action k leads from pose k to pose k + 1.
    length : float
        Metres.
    expanded : int
        Number of nodes expanded.
    visited : (expanded, 3) array, optional
        The poses expanded, in their order, if recorded (Fig. 3.4b).

    Examples
    --------
    >>> from robonav.lfd import plan
    >>> from robonav.robot import random_worlds
    >>> plan(random_worlds(1, obstacles=0, seed=1)).length
    112.0
    """

    found: bool
    points: Floats
    headings: Floats
    actions: NDArray[np.int64]
    length: float
    expanded: int
    visited: Floats | None = None


@dataclass(frozen=True, eq=False)
class GridPlan:
    """The path that A* on a grid found in one world: points, without actions that a robot could take.

    Attributes
    ----------
    found : bool
        Whether there is a path. If not, the path is the start alone.
    points : (K + 1, 2) array
        Corners of the path in metres, the start first.
    length : float
        Metres.
    expanded : int
        Number of nodes expanded.
    visited : (expanded, 2) array, optional
        The points expanded, in their order, if recorded.

    Examples
    --------
    >>> from robonav.lfd import plan_on_grid
    >>> from robonav.robot import random_worlds
    >>> plan_on_grid(random_worlds(1, obstacles=0, seed=1)).found
    True
    """

    found: bool
    points: Floats
    length: float
    expanded: int
    visited: Floats | None = None


def modified_astar(
    world: Worlds,
    pose: Floats,
    *,
    speed: float,
    margin: float,
    caution: float,
    cell: float,
    limit: int,
) -> tuple[bool, list[tuple[int, Point, int]], int]:
    """Modified A*, Algorithm 4 and Eq. (3.31).

    A node is ``(column, row, turns)``: a cell, and the number of 30-degree turns from the first heading. F orders the
    open set; of nodes with one F, the nearest to the target comes first. :func:`plan` runs a compiled twin.

    Parameters
    ----------
    world : Worlds
        Batch of one.
    pose : (3,) array
        x, y and heading to start from.
    speed, margin, caution, cell, limit
        As in :func:`plan`.

    Returns
    -------
    found : bool
        Whether there is a path.
    path : list of (turns, (x, y), action)
        The path from the start; the action is the one that led here, -1 at the start.
    expanded : int
        Number of nodes expanded.

    Examples
    --------
    >>> from robonav.lfd.astar import modified_astar
    >>> from robonav.robot import random_worlds
    >>> world = random_worlds(1, obstacles=0, seed=1)
    >>> found, path, expanded = modified_astar(
    ...     world, world.start_poses[0], speed=2.0, margin=2.0, caution=0.0, cell=1.0, limit=1000)
    >>> found, len(path)
    (True, 57)
    """
    start = (*cell_of(world, pose, cell), 0)
    point, parent, action = {start: (pose[0], pose[1])}, {start: start}, {start: -1}
    G, closed_set = {start: 0.0}, set[Node]()  # 1
    rest = distance(point[start], world.targets[0])
    open_set = [(rest, rest, start)]  # 2
    while open_set and len(closed_set) < limit:  # 3
        F, H, current = heapq.heappop(open_set)  # 4
        if current in closed_set:
            continue  # an entry that a cheaper one has overtaken
        closed_set.add(current)  # 5
        if found := H <= _fast.CLOSE_ENOUGH:  # 6
            break  # 7
        here, turns = point[current], current[2]
        for taken, turned, there in five_steps(pose[2], turns, here, speed):  # 9, 15
            if step_clearance(world, here, there, margin) < margin:  # 10
                continue  # 11
            neighbour = (*cell_of(world, there, cell), turned)
            if neighbour in closed_set:  # 16
                continue  # 17
            tentative = G[current] + speed  # 19
            if caution > 0:  # not in the thesis: steps near obstacles cost more
                tentative += speed * caution * nearness(world, there, cell)
            if neighbour not in G or tentative < G[neighbour]:  # 20
                G[neighbour], point[neighbour] = tentative, there  # 21
                parent[neighbour], action[neighbour] = current, taken
                H = distance(there, world.targets[0])
                F = G[neighbour] + H  # Eq. (3.31)
                heapq.heappush(open_set, (F, H, neighbour))  # 23
    nodes = path_to(current if found else start, parent)  # 28 to 35
    return found, [(n[2], point[n], action[n]) for n in nodes], len(closed_set)


def grid_astar(
    world: Worlds, start: Floats, *, margin: float, cell: float
) -> tuple[bool, list[Point], int]:
    """Conventional A* on a grid, whose points have eight neighbours each.

    A node is ``(column, row)``. :func:`plan_on_grid` runs a compiled twin.

    Parameters
    ----------
    world : Worlds
        Batch of one.
    start : (2,) array
        Where to start. The grid is laid through it.
    margin, cell : float
        As in :func:`plan_on_grid`.

    Returns
    -------
    found : bool
        Whether there is a path.
    path : list of (x, y)
        The path; the start alone if there is none.
    expanded : int
        Number of nodes expanded.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.lfd.astar import grid_astar
    >>> from robonav.robot import random_worlds
    >>> world = random_worlds(1, obstacles=0, seed=1)
    >>> grid_astar(world, world.starts[0], margin=2.0, cell=1.0)[0]
    True
    """
    west, south = start[0] % cell, start[1] % cell
    columns, rows = (int((world.size - edge) / cell) + 1 for edge in (west, south))
    first: Node = (int(start[0] / cell), int(start[1] / cell))
    G, parent, closed_set = {first: 0.0}, {first: first}, set[Node]()
    rest = distance((start[0], start[1]), world.targets[0])
    open_set = [(rest, rest, first)]
    current, found = first, False
    while open_set:
        *_, current = heapq.heappop(open_set)
        if current in closed_set:
            continue  # an entry that a cheaper one has overtaken
        closed_set.add(current)
        here = (west + current[0] * cell, south + current[1] * cell)
        if found := distance(here, world.targets[0]) <= _fast.CLOSE_ENOUGH:
            break
        for right, up in EIGHT_NEIGHBOURS:
            neighbour = (current[0] + right, current[1] + up)
            if not (0 <= neighbour[0] < columns and 0 <= neighbour[1] < rows):
                continue
            there = (here[0] + right * cell, here[1] + up * cell)
            tentative = G[current] + cell * math.sqrt(right * right + up * up)
            if neighbour in closed_set or G.get(neighbour, math.inf) <= tentative:
                continue
            if step_clearance(world, here, there, margin) >= margin:
                G[neighbour], parent[neighbour] = tentative, current
                H = distance(there, world.targets[0])
                heapq.heappush(open_set, (G[neighbour] + H, H, neighbour))
    nodes = path_to(current if found else first, parent)
    path = [(west + node[0] * cell, south + node[1] * cell) for node in nodes]
    return found, path, len(closed_set)


EIGHT_NEIGHBOURS = [
    (right, up) for right in (-1, 0, 1) for up in (-1, 0, 1) if (right, up) != (0, 0)
]


def five_steps(
    heading: float, turns: int, here: Point, speed: float
) -> Iterator[tuple[int, int, Point]]:
    """Yield what the five actions lead to: the action, the number of turns (0 to 11) and the position."""
    for action, turn in enumerate(_fast.ACTION_TURNS.tolist()):
        turned = (turns + turn) % _fast.HEADINGS
        angle = heading + math.radians(30.0 * turned)
        x = here[0] + speed * math.cos(angle)
        y = here[1] + speed * math.sin(angle)
        yield action, turned, (x, y)


def cell_of(world: Worlds, place: Point | Floats, cell: float) -> Node:
    """Return column and row of the cell that holds a place."""
    last = math.ceil(world.size / cell) - 1
    return min(int(place[0] / cell), last), min(int(place[1] / cell), last)


def step_clearance(world: Worlds, here: Point, there: Point, enough: float) -> float:
    """Return the distance that a step keeps from obstacles and borders, or ``enough`` where it keeps more."""
    centres = world.centres[0]
    obstacles = world.kinds[0], world.shapes[0], centres, centres, world.size
    return swept_clearance(*obstacles, *here, *there, enough)


def nearness(world: Worlds, there: Point, cell: float) -> float:
    """Return 1 at an obstacle and 0 out of sensor range, for the middle of the cell that holds a place."""
    column, row = cell_of(world, there, cell)
    middle = ((column + 0.5) * cell, (row + 0.5) * cell)
    clear = step_clearance(world, middle, middle, SENSOR_RANGE)
    return (1.0 - clear / SENSOR_RANGE) ** 2


def distance(here: Point, target: Floats) -> float:
    """Return the straight distance from a place to the target, the heuristic H."""
    return float(np.hypot(target[0] - here[0], target[1] - here[1]))


def path_to(node: Node, parent: dict[Node, Node]) -> list[Node]:
    """Follow the parents of a node back to the start, which is its own parent, and return the path from there."""
    path = [node]
    while parent[path[-1]] != path[-1]:
        path.append(parent[path[-1]])
    return path[::-1]


def plan(
    world: Worlds,
    *,
    speed: float = 2.0,
    margin: float = 2.0,
    caution: float = 0.0,
    pose: ArrayLike | None = None,
    cell: float | None = None,
    limit: int = 200_000,
    record: bool = False,
) -> Plan:
    """Plan over the robot's own actions, without a grid: a compiled twin of :func:`modified_astar`.

    A node is a pose that the five actions lead to. G is the distance travelled and H the straight distance to the
    target. Positions are continuous, so that two paths never meet in exactly one pose; poses of one heading in one
    cell therefore count as the same node. The path minimises its length plus the distance left to the target where
    ``cell`` is so small that different poses never share one. With larger cells it may be longer.

    Parameters
    ----------
    world : Worlds
        Batch of one. Its obstacles are taken as they stand at the start.
    speed : float
        Length of a step in metres; the robot turns, then goes for one second.
    margin : float
        Distance in metres that every step keeps from obstacles and borders, at most half the map's side.
    caution : float
        How much more a metre costs in G near an obstacle or border: 1 + caution times its length right at it, falling
        with the square of the distance to 1 at sensor range. The thesis has 0.
    pose : (3,) array, optional
        x, y and heading to start from; by default the world's start, facing the target.
    cell : float, optional
        Side in metres of the cells that tell nodes apart. A step that stays in its cell leads nowhere, so that cells
        larger than ``speed`` can hide a path. By default 1 m, or ``speed`` if that is less.
    limit : int
        Nodes to expand before giving up.
    record : bool
        Whether to keep the poses expanded.

    Returns
    -------
    Plan
        If there is no path, or none was found within ``limit``, ``found`` is False.

    Warns
    -----
    UserWarning
        If no path was found and ``cell`` is larger than ``speed``.

    Raises
    ------
    TypeError
        If ``world`` is not Worlds, or an argument is not a number.
    ValueError
        If ``world`` is not one world, ``pose`` is outside of it, or an argument is out of bounds.

    Examples
    --------
    >>> from robonav.lfd import plan
    >>> from robonav.robot import random_worlds
    >>> path = plan(random_worlds(1, obstacles=10, seed=1), margin=1.0)
    >>> path.found, len(path.points) - len(path.actions)
    (True, 1)
    """
    _one_world(world)
    start = world.start_poses[0] if pose is None else _in_map("pose", pose, 3, world)
    speed = check_positive("speed", speed)
    margin, cell = _lengths(world, margin, min(1.0, speed) if cell is None else cell)
    caution = check_real("caution", caution, at_least=0)
    limit = min(
        check_integer("limit", limit, at_least=1), _fast.HEADINGS * _nodes(world, cell)
    )
    visited = np.empty((limit if record else 0, 3))
    found, poses, actions, expanded = _fast.search_actions(
        *_map(world), start, world.targets[0], speed, margin, caution, cell, limit, record, visited,
    )  # fmt: skip
    if not found and cell > speed:
        warnings.warn(
            f"plan found no path with cells of {cell:g} m and steps of {speed:g} m: a step that stays in its cell "
            "leads nowhere, so that cell should be at most speed",
            stacklevel=2,
        )
    points, headings, length = poses[:, :2], poses[:, 2], speed * len(actions)
    seen = visited[:expanded] if record else None
    return Plan(found, points, headings, actions, length, expanded, seen)


def plan_on_grid(
    world: Worlds,
    *,
    margin: float = 2.0,
    start: ArrayLike | None = None,
    cell: float = 1.0,
    record: bool = False,
) -> GridPlan:
    """Plan on a grid whose points have eight neighbours each (Fig. 3.5): a compiled twin of :func:`grid_astar`.

    Parameters
    ----------
    world : Worlds
        Batch of one.
    margin : float
        As in :func:`plan`.
    start : (2,) array, optional
        Where to start; by default the world's start. The grid is laid through it.
    cell : float
        Distance of neighbouring grid points in metres.
    record : bool
        Whether to keep the points expanded.

    Returns
    -------
    GridPlan
        A shortest path on the grid; ``found`` is False if there is none.

    Raises
    ------
    TypeError, ValueError
        As :func:`plan`.

    Examples
    --------
    >>> from robonav.lfd import plan_on_grid
    >>> from robonav.robot import random_worlds
    >>> plan_on_grid(random_worlds(1, obstacles=10, seed=1), margin=1.0).found
    True
    """
    _one_world(world)
    begin = world.starts[0] if start is None else _in_map("start", start, 2, world)
    margin, cell = _lengths(world, margin, cell)
    visited = np.empty((_nodes(world, cell) if record else 0, 2))
    found, points, expanded = _fast.search_grid(
        *_map(world), begin, world.targets[0], margin, cell, record, visited
    )
    length = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    seen = visited[:expanded] if record else None
    return GridPlan(found, points, length, expanded, seen)


def _one_world(world: Worlds) -> None:
    """Refuse anything but a batch of one."""
    if len(check_instance("world", world, Worlds)) != 1:
        raise ValueError(f"world must be one world, got a batch of {len(world)}")


def _in_map(name: str, place: ArrayLike, numbers: int, world: Worlds) -> Floats:
    """A place (2,) or pose (3,) whose x and y lie in the map."""
    given = check_array(name, place, shape=(numbers,))
    if (given[:2] < 0).any() or (given[:2] > world.size).any():
        raise ValueError(
            f"{name} must lie in the map, 0 to {world.size:g} m, got {tuple(map(float, given[:2]))}"
        )
    return given


def _lengths(world: Worlds, margin: float, cell: float) -> tuple[float, float]:
    """Margin and side of the cells, within what the map's size allows."""
    return (
        check_real("margin", margin, above=0, at_most=world.size / 2),
        check_real("cell", cell, at_least=FINEST * world.size, at_most=world.size),
    )


def _map(world: Worlds) -> tuple[NDArray[np.int8], Floats, Floats, float]:
    """Obstacles and size of the one world to plan in."""
    return world.kinds[0], world.shapes[0], world.centres[0], world.size


def _nodes(world: Worlds, cell: float) -> int:
    """The most positions that cells of this side tell apart."""
    return (int(world.size / cell) + 1) ** 2
