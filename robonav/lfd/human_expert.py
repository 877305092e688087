"""The human expert: key points on a map, a smooth path through them, and a robot that follows it (section 5.5.5).

1. :func:`smooth_path` lays a cubic spline through key points that a person has marked.
2. :class:`PathFollower` steers a robot along such a path.
3. :func:`demonstrate_by_hand` records what the robot senses and does on its way.
4. :func:`sketch` generates key points as a person might, for experiments that need hundreds of demonstrations.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline

from robonav.progress import Progress
from robonav.robot import (
    COLLISION_DISTANCE,
    REFLEX,
    ReflexRule,
    Simulator,
    Worlds,
    clearance,
)
from robonav.robot._fast import TURNS
from robonav.validation import (
    check_array,
    check_instance,
    check_integer,
    check_positive,
    check_real,
)

from .computer_expert import ComputerExpert
from .demonstrations import LEARNED, Actions, Demonstrations, record_demonstrations

Floats = NDArray[np.float64]

SPACING = 0.25  # metres between neighbouring points of a smooth path
LOOKAHEAD = 1.5  # steps between the robot and the point of the path that it heads for
SKETCH_CLEARANCE = 2.0  # metres that sketched paths keep: a follower strays by up to 1
SKETCH_TOLERANCE = 2.0  # metres that a sketch may simplify the planned path by
ATTEMPTS = 0.9 ** np.arange(40)  # factor of a sketch's errors in each attempt


def smooth_path(key_points: ArrayLike, *, spacing: float = SPACING) -> Floats:
    """Return a smooth path through key points: a cubic spline, see :func:`spline_through`.

    Parameters
    ----------
    key_points : (K, 2) array
        x and y in metres, at least two points.
    spacing : float
        Approximate distance in metres between neighbouring points of the path.

    Returns
    -------
    (P, 2) array
        Points of the path, the key points among them.

    Raises
    ------
    ValueError
        If there are fewer than two key points, or if a key point equals the one before it.

    Examples
    --------
    >>> from robonav.lfd import smooth_path
    >>> smooth_path([(0, 0), (2, 0)], spacing=0.5)
    array([[0. , 0. ],
           [0.5, 0. ],
           [1. , 0. ],
           [1.5, 0. ],
           [2. , 0. ]])
    """
    points = check_array("key_points", key_points, shape=("K", 2))
    gaps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    if len(points) < 2 or (gaps == 0).any():
        raise ValueError(
            f"key_points must be at least two, each apart from the one before it, got {len(points)}"
        )
    return spline_through(points, check_positive("spacing", spacing))


def spline_through(points: Floats, spacing: float) -> Floats:
    """Return a cubic spline (P, 2) through points (K, 2), with one point about every ``spacing`` metres.

    The parameter of the spline grows by the square root of the distance from point to point. This centripetal
    parametrisation (Lee 1989) keeps the curve from swinging out where a short piece follows a long one.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.lfd.human_expert import spline_through
    >>> spline_through(np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]), spacing=0.5)[:, 0]
    array([0. , 0.5, 1. , 1.5, 2. ])
    """
    gaps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    knots = np.concatenate([[0], np.cumsum(np.sqrt(gaps))])
    spline = CubicSpline(knots, points, bc_type="natural")
    pieces = [
        np.linspace(start, stop, max(2, round(gap / spacing)), endpoint=False)
        for start, stop, gap in zip(knots[:-1], knots[1:], gaps, strict=True)
    ]
    return spline(np.concatenate([*pieces, knots[-1:]]))


def path_clearance(world: Worlds, path: ArrayLike) -> Floats:
    """Return the distance from each point of a path to the nearest obstacle or border.

    A robot collides where it is less than 1 m.

    Parameters
    ----------
    world : Worlds
        Batch of one.
    path : (P, 2) array
        x and y in metres.

    Returns
    -------
    (P,) array
        Distances in metres; 0 inside an obstacle and outside the map.

    Examples
    --------
    >>> from robonav.lfd import path_clearance
    >>> from robonav.robot import make_world
    >>> path_clearance(make_world(circles=[(50, 50, 5)]), [(50, 60), (50, 53)])
    array([5., 0.])
    """
    points = check_array("path", path, shape=("P", 2))
    return clearance(world[np.zeros(len(points), dtype=int)], points)


class PathFollower:
    """An expert that follows one path for each robot: it heads for a point of the path a step and a half ahead.

    This is pure pursuit (Coulter 1992) with five actions: the robot takes the action that brings it nearest to that
    point.

    Parameters
    ----------
    paths : sequence of (P, 2) arrays
        One path for each robot, in metres.

    Examples
    --------
    >>> from robonav.lfd import PathFollower, record_demonstrations, smooth_path
    >>> from robonav.robot import make_world
    >>> world = make_world(circles=[(50, 50, 5)])
    >>> path = smooth_path([world.starts[0], (40, 65), world.targets[0]])
    >>> record_demonstrations(PathFollower([path]), world).outcome.tolist()
    ['arrived']
    """

    def __init__(self, paths: Sequence[ArrayLike]) -> None:
        self.paths = [
            check_array(f"paths[{k}]", path, shape=("P", 2))
            for k, path in enumerate(paths)
        ]
        self._passed = [0] * len(self.paths)

    def __call__(self, simulator: Simulator, robots: Actions) -> Actions:
        """Return the next actions (n,) of the robots with these indices (n,)."""
        goals = np.array(
            [
                self.lookahead_point(robot, simulator.poses[robot], simulator.speed)
                for robot in robots
            ]
        )
        poses = simulator.poses[robots]
        headings = poses[:, 2, None] + TURNS[:LEARNED]
        steps = np.stack([np.cos(headings), np.sin(headings)], axis=-1)
        ends = poses[:, None, :2] + simulator.speed * steps  # (n, 5, 2): of each action
        return np.linalg.norm(ends - goals[:, None], axis=2).argmin(axis=1)

    def lookahead_point(self, robot: int, pose: Floats, speed: float) -> Floats:
        """Return the point of a robot's path that lies a step and a half beyond the point nearest to the robot.

        Parameters
        ----------
        robot : int
            The robot's index.
        pose : (3,) array
            Its x, y and heading.
        speed : float
            In metres a step.

        Returns
        -------
        (2,) array

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.lfd import PathFollower, smooth_path
        >>> follower = PathFollower([smooth_path([(0, 1), (10, 1)])])
        >>> follower.lookahead_point(0, np.array([2.0, 0.0, 0.0]), speed=2.0)
        array([5., 1.])
        """
        path = self.paths[robot][self._passed[robot] :]  # the robot never turns back
        lengths = np.linalg.norm(np.diff(path, axis=0), axis=1)
        along = np.concatenate([[0], np.cumsum(lengths)])  # metres from the first point
        nearest = int(np.linalg.norm(path - pose[:2], axis=1).argmin())
        self._passed[robot] += nearest
        ahead = int(np.searchsorted(along, along[nearest] + LOOKAHEAD * speed))
        return path[min(ahead, len(path) - 1)]


def demonstrate_by_hand(
    worlds: Worlds,
    key_points: Sequence[ArrayLike],
    *,
    speed: float = 2.0,
    slip: ArrayLike | None = None,
    reflex: ReflexRule | None = REFLEX,
    progress: Progress | None = None,
) -> Demonstrations:
    """Record demonstrations by a human expert: in each of D worlds the robot follows a path through key points.

    The robot keeps its reflexes: where nothing is in range it goes straight to the target and leaves the path. It
    returns to the path where something is in range.

    Parameters
    ----------
    worlds : Worlds
        Batch of D.
    key_points : sequence of (K, 2) arrays
        The key points in each world, in metres. The path begins at the world's start and ends at its target, which are
        not among the key points.
    speed : float
        Of the robots, in m/s.
    slip : (6, 6) array, optional
        As in :func:`demonstrate`.
    reflex : callable, optional
        As in :func:`demonstrate`.
    progress : callable, optional
        Called as ``progress(worlds done, D)``.

    Returns
    -------
    Demonstrations

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If the number of sets of key points is not D, or if a path comes nearer than 1 m to an obstacle or border. The
        message says where.

    Examples
    --------
    >>> from robonav.lfd import demonstrate_by_hand
    >>> from robonav.robot import make_world
    >>> world = make_world(circles=[(50, 50, 5)])
    >>> demonstrate_by_hand(world, [[(40, 65)]]).outcome.tolist()
    ['arrived']
    """
    check_instance("worlds", worlds, Worlds)
    if len(check_instance("key_points", key_points, Sequence)) != len(worlds):
        raise ValueError(
            f"key_points must be one set for each world, {len(worlds)}, got {len(key_points)}"
        )
    paths = [
        smooth_path(between_ends(world, points))
        for world, points in zip(worlds, key_points, strict=True)
    ]
    for number, (world, path) in enumerate(zip(worlds, paths, strict=True)):
        too_near = path_clearance(world, path) < COLLISION_DISTANCE
        if too_near.any():
            x, y = path[too_near.argmax()]
            raise ValueError(
                f"key_points[{number}] must lead clear of obstacles: near ({x:.1f}, {y:.1f}) their path comes nearer "
                f"than {COLLISION_DISTANCE:g} m to one"
            )
    return record_demonstrations(
        PathFollower(paths),
        worlds,
        speed=speed,
        slip=slip,
        reflex=reflex,
        progress=progress,
    )


def between_ends(world: Worlds, key_points: ArrayLike) -> Floats:
    """Return the start, the key points (K, 2) and the target of one world as (K + 2, 2).

    Examples
    --------
    >>> from robonav.lfd.human_expert import between_ends
    >>> from robonav.robot import make_world
    >>> between_ends(make_world(), [(40, 65)]).tolist()
    [[10.0, 10.0], [40.0, 65.0], [90.0, 90.0]]
    """
    points = check_array("key_points", key_points, shape=("K", 2))
    return np.concatenate([world.starts, points, world.targets])


def sketch(worlds: Worlds, *, seed: int, noise: float = 1.0) -> list[Floats]:
    """Generate a few inaccurate key points, such as a person might give.

    They are the corners of a simplified plan of the computer expert, with random errors. If the smooth path through
    them comes nearer than 2 m to an obstacle or border, they are drawn again with smaller errors, from a less
    simplified plan.

    Parameters
    ----------
    worlds : Worlds
        Batch of D.
    seed : int
        Of the errors. The key points in world i depend on (seed, i) alone.
    noise : float
        Standard deviation in metres of the errors in x and y, in the first attempt.

    Returns
    -------
    list of (K, 2) arrays
        The key points in each world.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong type or out of bounds.

    Examples
    --------
    >>> from robonav.lfd import demonstrate_by_hand, sketch
    >>> from robonav.robot import random_worlds
    >>> worlds = random_worlds(2, obstacles=10, seed=1)
    >>> demonstrate_by_hand(worlds, sketch(worlds, seed=5)).outcome.tolist()
    ['arrived', 'arrived']
    """
    check_instance("worlds", worlds, Worlds)
    check_integer("seed", seed, at_least=0)
    check_real("noise", noise, at_least=0)
    return [
        _sketch(world, np.random.default_rng([seed, i]), noise)
        for i, world in enumerate(worlds)
    ]


def _sketch(world: Worlds, rng: np.random.Generator, noise: float) -> Floats:
    """Return key points (K, 2) in one world."""
    planned = ComputerExpert().plan_from(Simulator(world), 0).poses[:, :2]
    for factor in ATTEMPTS:
        corners = simplified(planned, SKETCH_TOLERANCE * factor)[1:-1]
        points = corners + rng.normal(scale=noise * factor, size=corners.shape)
        path = smooth_path(between_ends(world, points), spacing=1.0)
        if path_clearance(world, path).min() >= SKETCH_CLEARANCE:
            break
    return points


def simplified(path: Floats, tolerance: float) -> Floats:
    """Return the corners of a polyline within ``tolerance`` metres of a path (P, 2) (Douglas and Peucker 1973).

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.lfd.human_expert import simplified
    >>> simplified(np.array([[0.0, 0.0], [1.0, 0.1], [2.0, 0.0], [4.0, 3.0]]), tolerance=0.5).tolist()
    [[0.0, 0.0], [2.0, 0.0], [4.0, 3.0]]
    """
    chord = path[-1] - path[0]
    off = np.abs(
        chord[0] * (path[:, 1] - path[0, 1]) - chord[1] * (path[:, 0] - path[0, 0])
    ) / np.hypot(*chord)
    farthest = int(off.argmax())
    if off[farthest] <= tolerance:
        return path[[0, -1]]
    before = simplified(path[: farthest + 1], tolerance)
    return np.concatenate([before[:-1], simplified(path[farthest:], tolerance)])
