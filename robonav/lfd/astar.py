"""A* path planning on a known map: on a grid, and over the robot's own actions.

A* keeps an open list of the nodes that it has reached, and always goes on from the one with the smallest estimate of
the cost of a whole path through it,

    F = G + H,                                                                                         (3.31)

where G is the cost of the path from the start to the node, and H estimates the cost that remains by the straight
distance to the target. Two properties of H matter:

- It is *admissible*: no path from a node to the target is shorter than H. When the target itself has the smallest F of
  the list, no other path can therefore be cheaper than the one found.
- It is *consistent*: H(n) <= cost of a step from n to n' + H(n'), by the triangle inequality. Along a path F therefore
  never falls. When a node is taken from the list, its G is final, and the node can go into the closed set for good.

With H = 0 this is Dijkstra's algorithm, which searches in all directions.

Here the robot has arrived within 3 m of the target, so the search ends with the first node in this disc. This is A* on
a graph with one more node, the target, to which a straight step leads from each node within 3 m. So the path and this
last step are together as short as can be. The path alone may be up to 3 m longer than the shortest one into the disc.

A wall, and the path (o) around it, from the left to the right:

>>> from robonav.robot import make_world
>>> world = make_world(rectangles=[(10, 9, 2, 10, 0)], start=(3, 7), target=(17, 7), size=20)
>>> found, path, expanded = grid_astar(world, world.starts[0], margin=0.5, cell=2.0)
>>> places = {node.index for node in path}
>>> def mark(column, row):
...     point = (2.0 * column + 1, 2.0 * row + 1)
...     wall = step_clearance(world, point, point, 0.5) < 0.5
...     return "#" if wall else "o" if (column, row) in places else "."
>>> for row in reversed(range(10)):
...     print(*(mark(column, row) for column in range(10)))
. . . . . . . . . .
. . . . . . . . . .
. . . . . . . . . .
. . . . # # . . . .
. . . . # # . . . .
. . . . # # . . . .
. o o . # # . o . .
. . . o # # o . . .
. . . . o o . . . .
. . . . . . . . . .

The path ends 2 m before the target at (17, 7).

The file reads from top to bottom:

1. :class:`Node` is what the search knows about a place that it has reached.
2. :func:`grid_astar` is textbook A* on a grid.
3. :func:`modified_astar` is the thesis's Algorithm 4 (section 3.5): the same search over the poses that the robot's
   actions lead to, instead of the points of a grid.

The rest of the package calls :func:`robonav.lfd.plan_on_grid` and :func:`robonav.lfd.plan`, which run compiled twins of
2 and 3.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from robonav.robot import SENSOR_RANGE, Worlds
from robonav.robot._fast import swept_clearance

from ._fast import (
    ACTION_TURNS,  # of the five actions, in steps of 30 degrees: 0, 1, 2, -1, -2
    CLOSE_ENOUGH,  # to the target: the distance of an arrival, 3 m
    HEADINGS,  # 12
)
from .cells import warns_if_cells_hide_paths

Floats = NDArray[np.float64]
Point = tuple[float, float]
Index = tuple[int, ...]

EIGHT_DIRECTIONS = [
    (right, up) for right in (-1, 0, 1) for up in (-1, 0, 1) if (right, up) != (0, 0)
]


@dataclass(frozen=True, eq=False)
class Node:
    """A place that A* has reached, with the cheapest path to it found so far.

    Attributes
    ----------
    index : tuple of int
        Identifies the node: (column, row) on a grid, (column, row, turns) in modified A*.
    point : (float, float)
        x and y in metres.
    G : float
        Cost of the path from the start to this node.
    H : float
        Straight distance from here to the target, the estimate of the cost that remains. No path is shorter.
    parent : Node, optional
        The node before this one on the path. The start has none.
    action : int
        The action that leads from the parent to this node; -1 at the start and on a grid.

    Examples
    --------
    >>> from robonav.lfd.astar import Node
    >>> Node(index=(0, 0), point=(0.0, 0.0), G=2.0, H=3.0).F
    5.0
    """

    index: Index
    point: Point
    G: float
    H: float
    parent: Node | None = field(default=None, repr=False)
    action: int = -1

    @property
    def F(self) -> float:
        """Estimated cost of a path to the target through this node, Eq. (3.31)."""
        return self.G + self.H  # Eq. (3.31)

    @property
    def priority(self) -> tuple[float, float, Index]:
        """Sort key in the open list: least F first; of equal F, least H first."""
        return self.F, self.H, self.index


def grid_astar(
    world: Worlds, start: Floats, *, margin: float, cell: float
) -> tuple[bool, list[Node], int]:
    """A* on a grid whose points have eight neighbours each (Hart, Nilsson and Raphael 1968).

    The open list is a heap. A heap cannot lower the F of an entry, so a node that is reached again at a lower cost is
    pushed once more. Its older entry is skipped when it comes up, because the node is in the closed set by then.

    Parameters
    ----------
    world : Worlds
        Batch of one.
    start : (2,) array
        x and y of the start. The grid is laid through this point.
    margin : float
        Distance in metres that every step keeps from obstacles and borders.
    cell : float
        Distance in metres between neighbouring points of the grid.

    Returns
    -------
    found : bool
        Whether there is a path.
    path : list of Node
        The path, from the start; the start alone if there is none.
    expanded : int
        Number of nodes expanded.

    Examples
    --------
    >>> from robonav.lfd.astar import grid_astar
    >>> from robonav.robot import random_worlds
    >>> world = random_worlds(1, obstacles=0, seed=1)
    >>> found, path, expanded = grid_astar(world, world.starts[0], margin=2.0, cell=1.0)
    >>> found, path[0].index, round(float(path[-1].G), 1)
    (True, (10, 10), 110.3)
    """
    target = world.targets[0]
    origin, first = grid_through(start, cell)
    point = grid_point(origin, first, cell)
    nodes = {first: Node(first, point, G=0.0, H=distance(point, target))}
    open_list = [nodes[first].priority]
    closed_set: set[Index] = set()
    while open_list:
        _, _, index = heapq.heappop(open_list)  # the node with the least F
        if index in closed_set:
            continue  # an older entry
        closed_set.add(index)
        current = nodes[index]
        if current.H <= CLOSE_ENOUGH:
            return True, path_to(current), len(closed_set)
        for right, up in EIGHT_DIRECTIONS:
            neighbour = (index[0] + right, index[1] + up)
            if neighbour in closed_set:
                continue  # its G is final: H is consistent
            point = grid_point(origin, neighbour, cell)
            if step_clearance(world, current.point, point, margin) < margin:
                continue  # the step would come too near to an obstacle or leave the map
            G = current.G + cell * math.sqrt(right * right + up * up)  # the tentative G
            if neighbour not in nodes or G < nodes[neighbour].G:
                H = distance(point, target)
                nodes[neighbour] = Node(neighbour, point, G, H, current)
                heapq.heappush(open_list, nodes[neighbour].priority)
    return False, [nodes[first]], len(closed_set)


def grid_through(start: Floats, cell: float) -> tuple[Floats, Index]:
    """Return the point (0, 0) of the grid that is laid through the start, and the index of the start.

    The origin follows from the index. If each were rounded by itself, 48 m could be column 15 of cells of 3.2 m, and
    lie 3.2 m from the grid's origin all the same: the start would be one column away from where it is.

    Examples
    --------
    >>> from robonav.lfd.astar import grid_through
    >>> grid_through(np.array([10.5, 12.0]), cell=1.0)
    (array([0.5, 0. ]), (10, 12))
    """
    column, row = int(start[0] / cell), int(start[1] / cell)
    return start - np.array([column, row]) * cell, (column, row)


def grid_point(origin: Floats, index: Index, cell: float) -> Point:
    """Return x and y of a point of the grid, whose point (0, 0) is ``origin``.

    Examples
    --------
    >>> grid_point(np.array([0.5, 0.5]), (2, 0), 1.0)
    (np.float64(2.5), np.float64(0.5))
    """
    return origin[0] + index[0] * cell, origin[1] + index[1] * cell


@warns_if_cells_hide_paths
def modified_astar(
    world: Worlds,
    pose: Floats,
    *,
    speed: float,
    margin: float,
    caution: float,
    cell: float,
    limit: int,
) -> tuple[bool, list[Node], int]:
    """Modified A*, Algorithm 4: A* whose neighbours are the poses that the robot's five actions lead to.

    It differs from :func:`grid_astar` in four things:

    - A node is a pose. Its index is ``(column, row, turns)``: the cell that holds its point, and its heading as the
      number of 30-degree turns from the first one. Points are not rounded to cells; two poses of one heading in one
      cell count as one node, for no two paths lead to exactly the same pose.
    - The neighbours of a node are where the five actions take the robot.
    - A node remembers the action that led to it, so that the path is a list of actions.
    - Steps near obstacles can be made to cost more (``caution``), and ``limit`` ends a search that takes too long. The
      thesis has neither.

    The numbers in the comments are the lines of Algorithm 4. Those missing only end a block. The algorithm looks for
    obstacles before it looks into the closed set, which would be cheaper; the result is the same.

    Parameters
    ----------
    world : Worlds
        Batch of one.
    pose : (3,) array
        x, y and heading at the start.
    speed, margin, caution, cell : float
        As in :func:`plan`. ``cell`` should be at most ``speed``: a step that ends in the cell it began in leads to no
        new node. (:func:`plan` joins short steps into moves that cover a cell.)
    limit : int
        The most nodes to expand.

    Returns
    -------
    found : bool
        Whether a path was found.
    path : list of Node
        The path, from the start; the start alone if none was found.
    expanded : int
        Number of nodes expanded.

    Warns
    -----
    UserWarning
        If no path was found and ``cell`` is larger than a step.

    Examples
    --------
    >>> from robonav.lfd.astar import modified_astar
    >>> from robonav.robot import random_worlds
    >>> world = random_worlds(1, obstacles=0, seed=1)
    >>> found, path, expanded = modified_astar(
    ...     world, world.start_poses[0], speed=2.0, margin=2.0, caution=0.0, cell=1.0, limit=1000)
    >>> found, len(path), path[-1].G
    (True, 57, 112.0)
    """
    target, point = world.targets[0], (pose[0], pose[1])
    closed_set: set[Index] = set()  # 1
    first: Index = (*cell_of(world, pose, cell), 0)
    nodes = {first: Node(first, point, G=0.0, H=distance(point, target))}
    open_list = [nodes[first].priority]  # 2
    while open_list and len(closed_set) < limit:  # 3 and 27
        _, _, index = heapq.heappop(open_list)  # 4
        if index in closed_set:
            continue  # an older entry
        closed_set.add(index)  # 5
        current = nodes[index]
        if current.H <= CLOSE_ENOUGH:  # 6
            return True, path_to(current), len(closed_set)  # 7, then 28 to 35
        safe_steps = [
            (action, turns, point)
            for action, turns, point in five_steps(current, pose[2], speed)  # 9
            if step_clearance(world, current.point, point, margin) >= margin  # 10 to 14
        ]
        for action, turns, point in safe_steps:  # 15
            neighbour = (*cell_of(world, point, cell), turns)
            if neighbour in closed_set:  # 16
                continue  # 17
            G = current.G + speed  # 19: the tentative G
            G += speed * caution * nearness(world, point, cell)  # not in the thesis
            if neighbour not in nodes or G < nodes[neighbour].G:  # 20
                H = distance(point, target)
                nodes[neighbour] = Node(neighbour, point, G, H, current, action)  # 21
                heapq.heappush(open_list, nodes[neighbour].priority)  # 22 and 23
    return False, [nodes[first]], len(closed_set)


def five_steps(
    current: Node, start_heading: float, speed: float
) -> Iterator[tuple[int, int, Point]]:
    """Yield what each of the five actions leads to: the action, the turns (0 to 11) and the point afterwards.

    Examples
    --------
    >>> from robonav.lfd.astar import Node, five_steps
    >>> start = Node(index=(0, 0, 0), point=(0.5, 0.5), G=0.0, H=9.0)
    >>> [(action, turns) for action, turns, point in five_steps(start, 0.0, 2.0)]
    [(0, 0), (1, 1), (2, 2), (3, 11), (4, 10)]
    """
    for action, turn in enumerate(ACTION_TURNS.tolist()):
        turns = (current.index[2] + turn) % HEADINGS
        heading = start_heading + math.radians(30.0 * turns)
        x = current.point[0] + speed * math.cos(heading)
        y = current.point[1] + speed * math.sin(heading)
        yield action, turns, (x, y)


def cell_of(world: Worlds, point: Point | Floats, cell: float) -> Index:
    """Return column and row of the cell that holds a point.

    Examples
    --------
    >>> from robonav.robot import make_world
    >>> cell_of(make_world(), (12.5, 99.9), 5.0)
    (2, 19)
    """
    last = math.ceil(world.size / cell) - 1
    return min(int(point[0] / cell), last), min(int(point[1] / cell), last)


def step_clearance(world: Worlds, start: Point, end: Point, limit: float) -> float:
    """Return the distance that a step keeps from obstacles and borders, at most ``limit``; 0 if it leaves the map.

    Examples
    --------
    >>> from robonav.robot import make_world
    >>> world = make_world(circles=[(53, 50, 2)])
    >>> step_clearance(world, (50.0, 47.5), (56.0, 47.5), limit=3.0)
    0.5
    """
    centres = world.centres[0]
    obstacles = world.kinds[0], world.shapes[0], centres, centres, world.size
    return swept_clearance(*obstacles, *start, *end, limit)


def nearness(world: Worlds, point: Point, cell: float) -> float:
    """Return 1 at an obstacle, falling to 0 at sensor range, for the middle of the cell that holds a point.

    Examples
    --------
    >>> from robonav.robot import make_world
    >>> world = make_world(circles=[(50, 50, 2)])
    >>> nearness(world, (20.0, 20.0), cell=1.0), nearness(world, (50.0, 50.0), cell=1.0)
    (0.0, 1.0)
    """
    column, row = cell_of(world, point, cell)
    middle = ((column + 0.5) * cell, (row + 0.5) * cell)
    clear = step_clearance(world, middle, middle, SENSOR_RANGE)
    return (1.0 - clear / SENSOR_RANGE) ** 2


def distance(point: Point, target: Floats) -> float:
    """Return the straight distance from a point to the target, the heuristic H.

    Examples
    --------
    >>> distance((0.0, 0.0), np.array([3.0, 4.0]))
    5.0
    """
    return float(np.hypot(target[0] - point[0], target[1] - point[1]))


def path_to(node: Node) -> list[Node]:
    """Return the path to a node, found by following the parents back to the start.

    Examples
    --------
    >>> start = Node(index=(0, 0), point=(0.0, 0.0), G=0.0, H=1.0)
    >>> end = Node((1, 0), (1.0, 0.0), 1.0, 0.0, start)
    >>> [node.index for node in path_to(end)]
    [(0, 0), (1, 0)]
    """
    path = [node]
    while path[-1].parent is not None:
        path.append(path[-1].parent)
    return path[::-1]
