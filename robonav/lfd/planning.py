"""Paths for robots: the two searches of ``astar.py``, compiled, with arguments that are checked (section 3.5)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.robot import Worlds
from robonav.validation import (
    check_array,
    check_instance,
    check_integer,
    check_positive,
    check_real,
)

from . import _fast
from ._fast import CLOSE_ENOUGH
from .astar import Floats, grid_through
from .cells import warn_if_cells_hide_paths

SMALLEST_CELL = 2e-3  # times the map's side; halving the cells makes four times as many
LOWEST_SPEED = 1e-5  # times the map's side; slower robots take 100,000 steps and more
MOVE = 1.0  # metres: slower robots turn at most once in this distance


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
    """Plan a path of robot actions by modified A*; this runs the compiled twin of :func:`robonav.lfd.modified_astar`.

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
    if not found:
        warn_if_cells_hide_paths("plan", cell, steps * speed)
    poses, actions = as_single_steps(poses, actions, steps, world.targets[0])
    points, headings, length = poses[:, :2], poses[:, 2], speed * len(actions)
    seen = visited[:expanded] if record else None
    return Plan(found, points, headings, actions, length, expanded, seen)


def steps_in_move(speed: float, cell: float) -> int:
    """Return how many steps a robot goes straight on before it may turn again: as many as cover a cell, or 1 m.

    Examples
    --------
    >>> from robonav.lfd.planning import steps_in_move
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
    >>> from robonav.lfd.planning import as_single_steps
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
    """Plan a path on a grid by A* (Fig. 3.5); this runs the compiled twin of :func:`robonav.lfd.grid_astar`.

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
