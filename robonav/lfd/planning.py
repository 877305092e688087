"""Planning with the map known: A* over robot actions (Algorithm 4) and, to compare, over a grid (section 3.5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav import expect
from robonav.robot import Worlds

from . import kernels

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
    margin : distance in metres that every step keeps from obstacles and borders.
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
    ValueError : if ``world`` is not one world, ``pose`` not in it, or an argument out of bounds.
    """
    start = world.start_poses[0] if pose is None else expect.array("pose", pose, shape=(3,))
    speed = expect.positive("speed", speed)
    caution = expect.real("caution", caution, at_least=0)
    limit = min(expect.integer("limit", limit, at_least=1), kernels.HEADINGS * _nodes(world, cell))
    visited = np.empty((limit if record else 0, 3))
    found, poses, actions, expanded = kernels.search_actions(
        *_setting(world, start, margin), start, world.targets[0], speed, margin, caution, cell, limit, record, visited
    )
    points, headings, length = poses[:, :2], poses[:, 2], speed * len(actions)
    return Plan(found, points, headings, actions, length, expanded, visited[:expanded] if record else None)


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
    ValueError : as :func:`plan`.
    """
    begin = world.starts[0] if start is None else expect.array("start", start, shape=(2,))
    visited = np.empty((_nodes(world, cell) if record else 0, 2))
    found, points, expanded = kernels.search_grid(
        *_setting(world, begin, margin), begin, world.targets[0], margin, cell, record, visited
    )
    length = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    return GridPlan(found, points, length, expanded, visited[:expanded] if record else None)


def _setting(world: Worlds, start: Floats, margin: float) -> tuple[NDArray[np.int8], Floats, Floats, float]:
    """Obstacles and size of the one world to plan in."""
    if len(world) != 1:
        raise ValueError(f"world must be one world, got a batch of {len(world)}")
    if (start[:2] < 0).any() or (start[:2] > world.size).any():
        raise ValueError(f"the start must lie in the map, 0 to {world.size:g} m, got {tuple(map(float, start[:2]))}")
    expect.positive("margin", margin)
    return world.kinds[0], world.shapes[0], world.centres[0], world.size


def _nodes(world: Worlds, cell: float) -> int:
    """The most positions that cells of this side tell apart."""
    return (int(world.size / expect.real("cell", cell, at_least=FINEST * world.size)) + 1) ** 2
