"""Planning with the map known: A* over robot actions (Algorithm 4) and, to compare, over a grid (section 3.5)."""

from __future__ import annotations

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

Floats = NDArray[np.float64]
FINEST = 2e-3  # cells may have this part of the map's side, at least: the table of nodes grows with its square


@dataclass(frozen=True, eq=False)
class Plan:
    """What modified A* found in one world.

    Attributes
    ----------
    found : whether there is a path; if not, the path is the start alone.
    points : (K + 1, 2) positions in metres, the start first.
    headings : (K + 1,) radians.
    actions : (K,) of the five actions F, L30, L60, R30, R60: action k leads from pose k to pose k + 1.
    length : metres.
    expanded : number of nodes expanded.
    visited : (expanded, 3) the poses expanded, in their order, where asked for (Fig. 3.4b).
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
    """What conventional A* found in one world: points, but nothing that a robot could do as it is.

    Attributes
    ----------
    found : whether there is a path; if not, the path is the start alone.
    points : (K + 1, 2) corners of the path in metres, the start first.
    length : metres.
    expanded : number of nodes expanded.
    visited : (expanded, 2) the points expanded, in their order, where asked for.
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
    cell: float = 1.0,
    limit: int = 200_000,
    record: bool = False,
) -> Plan:
    """Plan with modified A* (Algorithm 4): a search over the robot's own actions, with no grid.

    A node is a pose that the five actions lead to. G is the distance travelled, H the straight distance to the target,
    Eq. (3.31). Positions are continuous, so no two ways ever meet in exactly one pose: poses of one heading in one
    cell count as the same node. The path keeps the sum of its length and of what is then left to the target small;
    it is the least such sum where ``cell`` is too small for different poses to share one.

    Parameters
    ----------
    world : batch of one; its obstacles are taken as they stand at the start.
    speed : length of a step in metres; the robot turns, then goes one second.
    margin : distance in metres that every step keeps from obstacles and borders, at most half the map's side.
    caution : how much dearer a metre counts in G at that distance: 1 + caution of its price, and the less the farther
        off obstacles and borders are, up to sensor range. 0 is the thesis's G.
    pose : (3,) x, y, heading to start from; by default the world's start, facing the target.
    cell : side in metres of the cells that tell nodes apart.
    limit : nodes to expand before giving up.
    record : whether to keep the poses expanded.

    Returns
    -------
    Plan. That there is no path, or none was found within ``limit``, is a result: ``found`` is False.

    Raises
    ------
    TypeError : if ``world`` is no world, or an argument no number.
    ValueError : if ``world`` is not one world, ``pose`` not in it, or an argument out of bounds.
    """
    _one_world(world)
    start = world.start_poses[0] if pose is None else _in_map("pose", pose, 3, world)
    margin, cell = _lengths(world, margin, cell)
    speed = check_positive("speed", speed)
    caution = check_real("caution", caution, at_least=0)
    limit = min(
        check_integer("limit", limit, at_least=1), _fast.HEADINGS * _nodes(world, cell)
    )
    visited = np.empty((limit if record else 0, 3))
    found, poses, actions, expanded = _fast.search_actions(
        *_map(world),
        start,
        world.targets[0],
        speed,
        margin,
        caution,
        cell,
        limit,
        record,
        visited,
    )
    points, headings, length = poses[:, :2], poses[:, 2], speed * len(actions)
    return Plan(
        found,
        points,
        headings,
        actions,
        length,
        expanded,
        visited[:expanded] if record else None,
    )


def plan_on_grid(
    world: Worlds,
    *,
    margin: float = 2.0,
    start: ArrayLike | None = None,
    cell: float = 1.0,
    record: bool = False,
) -> GridPlan:
    """Plan with conventional A* on a grid whose points have eight neighbours each (Fig. 3.5).

    Parameters
    ----------
    start : (2,) where to start; by default the world's start. The grid is laid through it.
    cell : distance of neighbouring grid points in metres.
    world, margin, record : as in :func:`plan`.

    Returns
    -------
    GridPlan, a shortest path on the grid; ``found`` is False if there is none.

    Raises
    ------
    TypeError, ValueError : as :func:`plan`.
    """
    _one_world(world)
    begin = world.starts[0] if start is None else _in_map("start", start, 2, world)
    margin, cell = _lengths(world, margin, cell)
    visited = np.empty((_nodes(world, cell) if record else 0, 2))
    found, points, expanded = _fast.search_grid(
        *_map(world), begin, world.targets[0], margin, cell, record, visited
    )
    length = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    return GridPlan(
        found, points, length, expanded, visited[:expanded] if record else None
    )


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
