"""A* path planning on a known map: on a grid, and over the robot's own actions.

A* keeps an open list of the nodes that it has reached, and always goes on from the one with the smallest estimate of
the cost of a whole path through it,

    F = G + H,                                                                                         (3.31)

where G is the cost of the path from the start to the node, and H estimates the cost that remains by the straight
distance to the target. No path is shorter than H. When the target itself has the smallest F of the list, no other path
can therefore be cheaper than the one found. With H = 0 this is Dijkstra's algorithm, which searches in all directions.

The file is to be read from top to bottom:

1. :class:`Node` is what the search knows about a place that it has reached.
2. :func:`grid_astar` is textbook A* on a grid.
3. :func:`modified_astar` is the thesis's Algorithm 4 (section 3.5): the same search over the poses that the robot's
   actions lead to, instead of the points of a grid.
4. :func:`plan_on_grid` and :func:`plan` are what the rest of the package calls. They check their arguments and run
   compiled twins of 2 and 3, which return the same paths.
"""

from __future__ import annotations

import heapq
import math
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, field

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
from ._fast import ACTION_TURNS, CLOSE_ENOUGH, HEADINGS

Floats = NDArray[np.float64]
Point = tuple[float, float]
Index = tuple[int, ...]

EIGHT_DIRECTIONS = [
    (right, up) for right in (-1, 0, 1) for up in (-1, 0, 1) if (right, up) != (0, 0)
]
SMALLEST_CELL = 2e-3  # times the map's side; halving the cells makes four times as many
LOWEST_SPEED = 1e-5  # times the map's side; slower robots take 100,000 steps and more
MOVE = 1.0  # metres: slower robots turn at most once in this distance


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
            point = grid_point(origin, neighbour, cell)
            if step_clearance(world, current.point, point, margin) < margin:
                continue  # the step would come too near to an obstacle or leave the map
            if neighbour in closed_set:
                continue
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

    The numbers in the comments are the lines of Algorithm 4. Those missing only end a block.

    Parameters
    ----------
    world : Worlds
        Batch of one.
    pose : (3,) array
        x, y and heading at the start.
    speed, margin, caution, cell : float
        As in :func:`plan`.
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


@dataclass(frozen=True, eq=False)
class Plan:
    """The path that :func:`plan` found in one world.

    Attributes
    ----------
    found : bool
        Whether a path was found. If not, ``points`` and ``headings`` hold the start alone.
    points : (K + 1, 2) array
        x and y in metres along the path, the start first.
    headings : (K + 1,) array
        Headings in radians at these points.
    actions : (K,) array of int
        F, L30, L60, R30 or R60: action k leads from pose k to pose k + 1.
    length : float
        Length of the path in metres.
    expanded : int
        Number of nodes expanded.
    visited : (expanded, 3) array, optional
        The poses expanded, in order of expansion, if they were recorded (Fig. 3.4b).

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
    """The path that :func:`plan_on_grid` found in one world: points of a grid, without actions for a robot.

    Attributes
    ----------
    found : bool
        Whether there is a path. If not, ``points`` holds the start alone.
    points : (K + 1, 2) array
        x and y in metres along the path, the start first.
    length : float
        Length of the path in metres.
    expanded : int
        Number of nodes expanded.
    visited : (expanded, 2) array, optional
        The points expanded, in order of expansion, if they were recorded.

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
    """Plan a path of robot actions by modified A*; this runs the compiled twin of :func:`modified_astar`.

    A node is a pose that the five actions lead to. G is the distance travelled, and H is the straight distance to the
    target. Points are continuous, so two paths never lead to exactly the same pose. Poses of one heading in one cell
    therefore count as one node. If ``cell`` is so small that different poses never share a cell, the path found
    minimises its length plus the distance from its end to the target. With larger cells it may be longer than that.

    Parameters
    ----------
    world : Worlds
        Batch of one. Moving obstacles are taken to stand where they start.
    speed : float
        Length of a step in metres: the robot turns, then goes straight on for one second.
    margin : float
        Distance in metres that every step keeps from obstacles and borders, at most half the map's side.
    caution : float
        Extra cost of steps near obstacles and borders. A step costs its length times ``1 + caution * (1 - d / 10)**2``,
        where d is the clearance in metres at the middle of the cell that the step ends in, at most 10 (the range of
        the sensors). The thesis has 0.
    pose : (3,) array, optional
        x, y and heading at the start. By default the world's start, facing the target.
    cell : float, optional
        Side in metres of the cells that tell nodes apart, by default 1 m. A move that ends in the cell it began in,
        with its heading unchanged, leads to a node that is closed already. Cells larger than a move can therefore hide
        a path. A move is one step. If ``speed`` is less than 1 m/s and less than ``cell``, a move is as many steps
        straight on as cover the cell or 1 m, and the robot turns only at the start of a move.
    limit : int
        The most nodes to expand.
    record : bool
        Whether to keep the poses expanded.

    Returns
    -------
    Plan
        ``found`` is False if there is no path, or if none was found within ``limit`` nodes.

    Raises
    ------
    TypeError
        If ``world`` is not Worlds, or an argument is not a number.
    ValueError
        If ``world`` is not a batch of one, if ``pose`` lies outside its map, or if an argument is out of bounds.

    Warns
    -----
    UserWarning
        If no path was found and ``cell`` is larger than a move.

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
    check_real("speed", speed, at_least=LOWEST_SPEED * world.size)
    margin, cell = _lengths(world, margin, MOVE if cell is None else cell)
    caution = check_real("caution", caution, at_least=0)
    limit = min(
        check_integer("limit", limit, at_least=1), _fast.HEADINGS * _nodes(world, cell)
    )
    visited = np.empty((limit if record else 0, 3))
    steps = steps_in_move(speed, cell)
    found, poses, actions, expanded = _fast.search_actions(
        *_map(world), start, world.targets[0], steps * speed, margin, caution, cell, limit, record, visited,
    )  # fmt: skip
    if not found and cell > steps * speed:
        warnings.warn(
            f"plan found no path with cells of {cell:g} m and moves of {steps * speed:g} m: a move that ends in the "
            f"cell it began in leads to no new node, so cell should be at most {steps * speed:g}",
            stacklevel=2,
        )
    poses, actions = as_single_steps(poses, actions, steps, world.targets[0])
    points, headings, length = poses[:, :2], poses[:, 2], speed * len(actions)
    seen = visited[:expanded] if record else None
    return Plan(found, points, headings, actions, length, expanded, seen)


def steps_in_move(speed: float, cell: float) -> int:
    """Return how many steps a robot goes straight on before it may turn again: as many as cover a cell, or 1 m.

    Examples
    --------
    >>> from robonav.lfd.astar import steps_in_move
    >>> steps_in_move(speed=2.0, cell=1.0), steps_in_move(speed=0.25, cell=1.0)
    (1, 4)
    """
    return max(1, math.ceil(min(cell, MOVE) / speed))


def as_single_steps(
    poses: Floats, actions: NDArray[np.int64], steps: int, target: Floats
) -> tuple[Floats, NDArray[np.int64]]:
    """Return a path of moves, each of several steps, as a path of steps that ends where the robot arrives.

    Parameters
    ----------
    poses : (M + 1, 3) array
        x, y and heading before and after each move.
    actions : (M,) array of int
        The action that each move begins with. Its other steps go forward.
    steps : int
        Number of steps in a move.
    target : (2,) array
        x and y.

    Returns
    -------
    poses : (K + 1, 3) array
        x, y and heading before and after each step.
    actions : (K,) array of int
        The action of each step.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.lfd.astar import as_single_steps
    >>> poses = np.array([[5.0, 5.0, 0.0], [6.0, 5.0, 0.0], [7.0, 5.0, 0.0]])
    >>> moved, actions = as_single_steps(poses, np.array([0, 0]), steps=2, target=np.array([9.9, 5]))
    >>> moved[:, 0], actions
    (array([5. , 5.5, 6. , 6.5, 7. ]), array([0, 0, 0, 0]))
    """
    if steps == 1:
        return poses, actions
    part = np.tile(np.arange(1, steps + 1) / steps, len(actions))[:, None]
    before = np.repeat(poses[:-1, :2], steps, axis=0)
    after = np.repeat(poses[1:], steps, axis=0)
    after[:, :2] = before + part * (after[:, :2] - before)
    turns = np.zeros((len(actions), steps), dtype=np.int64)
    turns[:, 0] = actions
    arrived = np.hypot(*(after[:, :2] - target).T) <= CLOSE_ENOUGH
    last = int(arrived.argmax()) + 1 if arrived.any() else len(after)
    return np.concatenate([poses[:1], after[:last]]), turns.ravel()[:last]


def plan_on_grid(
    world: Worlds,
    *,
    margin: float = 2.0,
    start: ArrayLike | None = None,
    cell: float = 1.0,
    record: bool = False,
) -> GridPlan:
    """Plan a path on a grid by A* (Fig. 3.5); this runs the compiled twin of :func:`grid_astar`.

    Each point of the grid has eight neighbours.

    Parameters
    ----------
    world : Worlds
        Batch of one.
    margin : float
        As in :func:`plan`.
    start : (2,) array, optional
        x and y of the start, through which the grid is laid. By default the world's start.
    cell : float
        Distance in metres between neighbouring points of the grid.
    record : bool
        Whether to keep the points expanded.

    Returns
    -------
    GridPlan
        A shortest path on the grid. ``found`` is False if there is none.

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
    origin, index = grid_through(begin, cell)
    found, points, expanded = _fast.search_grid(
        *_map(world), origin, index, world.targets[0], margin, cell, record, visited
    )
    length = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    seen = visited[:expanded] if record else None
    return GridPlan(found, points, length, expanded, seen)


def _one_world(world: Worlds) -> None:
    """Raise an error if ``world`` is not a batch of one."""
    if len(check_instance("world", world, Worlds)) != 1:
        raise ValueError(f"world must be one world, got a batch of {len(world)}")


def _in_map(name: str, place: ArrayLike, numbers: int, world: Worlds) -> Floats:
    """Return a point (2,) or pose (3,) as an array, checked to lie in the map."""
    given = check_array(name, place, shape=(numbers,))
    if (given[:2] < 0).any() or (given[:2] > world.size).any():
        raise ValueError(
            f"{name} must lie in the map, 0 to {world.size:g} m, got {tuple(map(float, given[:2]))}"
        )
    return given


def _lengths(world: Worlds, margin: float, cell: float) -> tuple[float, float]:
    """Return the margin and the cells' side, checked against the map's size."""
    return (
        check_real("margin", margin, above=0, at_most=world.size / 2),
        check_real(
            "cell", cell, at_least=SMALLEST_CELL * world.size, at_most=world.size
        ),
    )


def _map(world: Worlds) -> tuple[NDArray[np.int8], Floats, Floats, float]:
    """Return the obstacles and the size of the world to plan in."""
    return world.kinds[0], world.shapes[0], world.centres[0], world.size


def _nodes(world: Worlds, cell: float) -> int:
    """Return the largest number of cells, or of points of a grid, that the map can hold."""
    return (int(world.size / cell) + 1) ** 2
