"""The human expert: key points on a map, a smooth path through them, a robot that follows it (section 5.5.5)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline

from robonav.progress import Progress
from robonav.robot import COLLISION_DISTANCE, Simulator, Worlds, clearance
from robonav.robot._fast import TURNS
from robonav.validation import (
    check_array,
    check_instance,
    check_integer,
    check_positive,
    check_real,
)

from .computer_expert import ComputerExpert
from .demonstrations import LEARNED, Actions, Demonstrations, record

Floats = NDArray[np.float64]

SPACING = 0.25  # metres between points of a path
AHEAD = 1.5  # steps: how far ahead on its path a robot looks
CLEAR = 2.0  # metres that a sketched path keeps: following it takes up to one of them
STRAIGHT = 2.0  # metres that a way may bend before it gets a key point
CARE = 0.9 ** np.arange(40)


def smooth_path(key_points: ArrayLike, *, spacing: float = SPACING) -> Floats:
    """A smooth path (P, 2) through key points (K, 2): a cubic spline, one point every ``spacing`` metres or so.

    The spline runs over the square root of the distances between key points, which keeps it from swinging out where
    a short piece follows a long one (Lee 1989).

    Raises
    ------
    ValueError : if there are fewer than two key points, or the same twice in a row.
    """
    points = check_array("key_points", key_points, shape=("K", 2))
    gaps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    if len(points) < 2 or (gaps == 0).any():
        raise ValueError(
            f"key_points must be at least two, each apart from the one before it, got {len(points)}"
        )
    return spline_through(points, check_positive("spacing", spacing))


def spline_through(points: Floats, spacing: float) -> Floats:
    """Return a cubic spline (P, 2) through points (K, 2), over the square root of their distances (Lee 1989)."""
    gaps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    knots = np.concatenate([[0], np.cumsum(np.sqrt(gaps))])
    spline = CubicSpline(knots, points, bc_type="natural")
    pieces = [
        np.linspace(start, stop, max(2, round(gap / spacing)), endpoint=False)
        for start, stop, gap in zip(knots[:-1], knots[1:], gaps, strict=True)
    ]
    return spline(np.concatenate([*pieces, knots[-1:]]))


def path_clearance(world: Worlds, path: ArrayLike) -> Floats:
    """Distance (P,) from each point of a path (P, 2) to the nearest obstacle or border; 0 outside the map.

    Where it is less than 1 m, a robot on the path would collide.
    """
    points = check_array("path", path, shape=("P", 2))
    return clearance(world[np.zeros(len(points), dtype=int)], points)


class PathFollower:
    """Follows one path a robot, by the action that brings it nearest to a point some way ahead on it.

    Parameters
    ----------
    paths : (P, 2) each, one a robot.
    """

    def __init__(self, paths: Sequence[ArrayLike]) -> None:
        self.paths = [
            check_array(f"paths[{k}]", path, shape=("P", 2))
            for k, path in enumerate(paths)
        ]
        self._reached = [0] * len(self.paths)

    def __call__(self, simulator: Simulator, asked: Actions) -> Actions:
        """The next actions (n,) of the robots ``asked`` (n,)."""
        aims = np.array(
            [
                self._aim(robot, simulator.poses[robot], simulator.speed)
                for robot in asked
            ]
        )
        poses = simulator.poses[asked]
        headings = poses[:, 2, None] + TURNS[:LEARNED]
        ends = poses[:, None, :2] + simulator.speed * np.stack(
            [np.cos(headings), np.sin(headings)], axis=-1
        )
        return np.linalg.norm(ends - aims[:, None], axis=2).argmin(axis=1)

    def _aim(self, robot: int, pose: Floats, speed: float) -> Floats:
        """The point of the path to make for: ahead of the nearest of those not yet passed."""
        path = self.paths[robot][self._reached[robot] :]
        way = np.concatenate(
            [[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))]
        )
        off = np.linalg.norm(path - pose[:2], axis=1)
        nearest = int(off.argmin())
        self._reached[robot] += nearest
        return path[
            min(int(np.searchsorted(way, way[nearest] + AHEAD * speed)), len(way) - 1)
        ]


def demonstrate_by_hand(
    worlds: Worlds,
    key_points: Sequence[ArrayLike],
    *,
    speed: float = 2.0,
    slip: ArrayLike | None = None,
    progress: Progress | None = None,
) -> Demonstrations:
    """Demonstrations by a human: the robot follows a smooth path through key points, one drive in each of D worlds.

    The robot keeps its reflexes. Where nothing is in range it makes for the target and leaves the path, to which it
    finds back where something is.

    Parameters
    ----------
    worlds : batch of D.
    key_points : (K, 2) each, one a world, in metres; the path starts at the world's start and ends at its target, which
        are not among them.
    speed, slip : as in :func:`demonstrate`.

    Raises
    ------
    ValueError : if key points are not one set a world, or their path comes nearer than 1 m to an obstacle or border;
        the message says where.
    """
    check_instance("worlds", worlds, Worlds)
    if len(check_instance("key_points", key_points, Sequence)) != len(worlds):
        raise ValueError(
            f"key_points must be one set a world, {len(worlds)}, got {len(key_points)}"
        )
    paths = [
        smooth_path(between_ends(world, points))
        for world, points in zip(worlds, key_points, strict=True)
    ]
    for number, (world, path) in enumerate(zip(worlds, paths, strict=True)):
        crossing = path_clearance(world, path) < COLLISION_DISTANCE
        if crossing.any():
            x, y = path[crossing.argmax()]
            raise ValueError(
                f"key_points[{number}] must lead clear of obstacles: near ({x:.1f}, {y:.1f}) their path comes nearer "
                f"than {COLLISION_DISTANCE:g} m to one"
            )
    return record(
        PathFollower(paths), worlds, speed=speed, slip=slip, progress=progress
    )


def between_ends(world: Worlds, key_points: ArrayLike) -> Floats:
    """Start, key points (K, 2), target of one world: (K + 2, 2)."""
    points = check_array("key_points", key_points, shape=("K", 2))
    return np.concatenate([world.starts, points, world.targets])


def sketch(worlds: Worlds, *, seed: int, shake: float = 1.0) -> list[Floats]:
    """Key points as a person might give them, one set (K, 2) for each of D worlds: few, and none too exact.

    Stands in for a hand where hundreds of drives are wanted. It looks for a good way, marks where that bends, and its
    hand shakes; where the smooth path then comes nearer than 2 m to something it tries again, more and more
    carefully. World i depends on (seed, i) alone.

    Parameters
    ----------
    shake : standard deviation in metres of the error of each key point, at first.

    Raises
    ------
    ValueError : if an argument is out of bounds.
    """
    check_instance("worlds", worlds, Worlds)
    check_integer("seed", seed, at_least=0)
    check_real("shake", shake, at_least=0)
    return [
        _sketch(world, np.random.default_rng([seed, i]), shake)
        for i, world in enumerate(worlds)
    ]


def _sketch(world: Worlds, rng: np.random.Generator, shake: float) -> Floats:
    """Key points (K, 2) in one world."""
    way = ComputerExpert().plan_from(Simulator(world), 0).poses[:, :2]
    for care in CARE:
        bends = _bends(way, STRAIGHT * care)[1:-1]
        points = bends + rng.normal(scale=shake * care, size=bends.shape)
        if (
            path_clearance(
                world, smooth_path(between_ends(world, points), spacing=1.0)
            ).min()
            >= CLEAR
        ):
            break
    return points


def _bends(way: Floats, straight: float) -> Floats:
    """The corners of a polygon that stays within ``straight`` metres of a way (P, 2) (Douglas and Peucker 1973)."""
    along = way[-1] - way[0]
    off = np.abs(
        along[0] * (way[:, 1] - way[0, 1]) - along[1] * (way[:, 0] - way[0, 0])
    ) / np.hypot(*along)
    farthest = int(off.argmax())
    if off[farthest] <= straight:
        return way[[0, -1]]
    return np.concatenate(
        [_bends(way[: farthest + 1], straight)[:-1], _bends(way[farthest:], straight)]
    )
