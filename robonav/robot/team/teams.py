"""Teams: maps that several robots cross at once, each with its own start and target."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.validation import check_array, check_instance, check_integer, check_real

from .._fast import in_threads
from ..worlds import (
    ATTEMPTS,
    LARGEST_MAP,
    MOST_WORLDS,
    MOVING_SPEEDS,
    SIZE,
    START,
    Worlds,
    check_drawing,
    world_keys,
)
from . import _fast
from ._fast import ROBOT_RADIUS

MOST_ROBOTS = 64  # starts of a crossing are then 5 m apart

Floats = NDArray[np.float64]
Points = Sequence[tuple[float, float]]


@dataclass(frozen=True, eq=False)
class Teams:
    """N maps with R robots each; ``teams[i]`` is a batch of one map.

    Attributes
    ----------
    worlds : Worlds
        The N maps. Their own starts and targets, which are those of one robot, are not used.
    starts, targets : (N, R, 2) array
        Of the robots, in metres.

    Raises
    ------
    ValueError
        If shapes do not fit, a start or a target lies outside the map, or two robots start in collision.

    Examples
    --------
    >>> from robonav.robot import make_world
    >>> from robonav.robot.team import Teams
    >>> Teams(make_world(), starts=[[(20, 50), (80, 50)]], targets=[[(80, 50), (20, 50)]]).robots
    2
    """

    worlds: Worlds
    starts: Floats
    targets: Floats

    def __post_init__(self) -> None:
        n = len(check_instance("teams: worlds", self.worlds, Worlds))
        for name in ("starts", "targets"):
            points = check_array(
                f"teams: {name}", getattr(self, name), shape=(n, "R", 2)
            )
            if ((points < 0) | (points > self.worlds.size)).any():
                raise ValueError(f"teams: {name} must lie in the map")
            object.__setattr__(self, name, np.array(points, order="C"))
        if self.starts.shape != self.targets.shape or self.robots == 0:
            raise ValueError(
                "teams: starts and targets must hold one point for each robot, "
                f"got {self.starts.shape[1]} and {self.targets.shape[1]}"
            )
        apart = np.linalg.norm(self.starts[:, :, None] - self.starts[:, None], axis=3)
        if (apart + 1e9 * np.eye(self.robots) < 2 * ROBOT_RADIUS).any():
            raise ValueError(
                f"teams: starts of two robots must be {2 * ROBOT_RADIUS:g} m apart"
            )

    def __len__(self) -> int:
        return len(self.worlds)

    def __getitem__(self, index: Any) -> Teams:
        """Pick maps by a number, a slice, a mask or indices; one number gives a batch of one."""
        rows = [index] if np.ndim(index) == 0 and not isinstance(index, slice) else index  # fmt: skip
        return Teams(self.worlds[index], self.starts[rows], self.targets[rows])

    @property
    def robots(self) -> int:
        """R, how many robots a map has."""
        return self.starts.shape[1]

    def first(self, robots: int) -> Teams:
        """Return the same maps with the first robots only.

        Parameters
        ----------
        robots : int
            How many robots stay.

        Returns
        -------
        Teams

        Examples
        --------
        >>> from robonav.robot.team import random_teams
        >>> random_teams(3, robots=16, seed=1).first(4).starts.shape
        (3, 4, 2)
        """
        check_integer("robots", robots, at_least=1, at_most=self.robots)
        return Teams(self.worlds, self.starts[:, :robots], self.targets[:, :robots])

    @property
    def start_poses(self) -> Floats:
        """Poses (N * R, 3) at the start, map by map: x, y and heading. Each robot faces its target."""
        away = (self.targets - self.starts).reshape(-1, 2)
        bearing = np.arctan2(away[:, 1], away[:, 0])
        return np.column_stack([self.starts.reshape(-1, 2), bearing])

    @property
    def keys(self) -> NDArray[np.uint32]:
        """Keys (N * R, 2) of the robots' random numbers: the first robot has its world's own."""
        keys = np.repeat(self.worlds.keys[:, None], self.robots, axis=1)
        keys[:, :, 1] ^= np.arange(self.robots, dtype=np.uint32) * np.uint32(0x9E3779B9)
        return keys.reshape(-1, 2)


def crossing(robots: int, size: float = SIZE) -> tuple[Floats, Floats]:
    """Return starts and targets (R, 2) of robots that all cross in the middle of the map.

    The starts lie evenly on a square 10 m inside the borders, and each target is the place opposite. The first robot
    goes from corner to corner as the robot that is alone, the second comes towards it, the next two cross their way. So
    the first 1, 2, 4, 8 of 16 robots are spread evenly too (the order of van der Corput).

    Parameters
    ----------
    robots : int
        R, at most 64.
    size : float
        Side of the map in metres.

    Returns
    -------
    starts : (R, 2) array
        In metres.
    targets : (R, 2) array
        In metres.

    Examples
    --------
    >>> from robonav.robot.team import crossing
    >>> starts, targets = crossing(3)
    >>> starts.tolist(), targets.tolist()
    ([[10.0, 10.0], [90.0, 90.0], [90.0, 10.0]], [[90.0, 90.0], [10.0, 10.0], [10.0, 90.0]])
    """
    check_integer("robots", robots, at_least=1, at_most=MOST_ROBOTS)
    check_real("size", size, at_least=30, at_most=LARGEST_MAP)
    inset, side = START[0], size - 2 * START[0]
    corners = inset + side * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    around = np.array([4 * radical_inverse(k) for k in range(robots)])
    edge, along = np.floor(around).astype(int), (around % 1)[:, None]
    starts = corners[edge] + along * (corners[(edge + 1) % 4] - corners[edge])
    return starts, size - starts


def points_of(places: Floats) -> Points:
    """Return points (R, 2) as pairs of numbers."""
    return [(float(x), float(y)) for x, y in places]


def radical_inverse(number: int) -> float:
    """Return the number's binary digits mirrored at the point, in [0, 1): 0, 1/2, 1/4, 3/4, 1/8, ...

    Examples
    --------
    >>> [radical_inverse(k) for k in range(5)]
    [0.0, 0.5, 0.25, 0.75, 0.125]
    """
    mirrored, half = 0.0, 0.5
    while number:
        mirrored += half * (number % 2)
        number, half = number // 2, half / 2
    return mirrored


def random_teams(
    n: int,
    robots: int,
    obstacles: int = 10,
    moving: int = 0,
    *,
    seed: int | np.random.Generator,
    starts: Points | None = None,
    targets: Points | None = None,
    moving_speeds: tuple[float, float] = MOVING_SPEEDS,
    size: float = SIZE,
) -> Teams:
    """Draw n maps in which each robot can reach its target with 2 m to spare, as :func:`robonav.robot.random_worlds`.

    No obstacle is within 6 m of any start or target. Map i depends on (seed, i) and on the starts and targets alone:
    with one robot the maps are those of :func:`~robonav.robot.random_worlds`.

    Parameters
    ----------
    n : int
        Number of maps, 0 or more.
    robots : int
        R, on each map.
    obstacles : int
        Obstacles that stand still, 0 or more.
    moving : int
        Obstacles that move, on top of them.
    seed : int or numpy.random.Generator
        A Generator gives a new seed in each call.
    starts, targets : sequence of (x, y), optional
        Of the R robots of every map, in metres; by default those of :func:`crossing`.
    moving_speeds : (float, float)
        Least and greatest speed of moving obstacles, in m/s.
    size : float
        Side of the map in metres.

    Returns
    -------
    Teams

    Raises
    ------
    ValueError
        If an argument is out of bounds, or 1000 draws gave no map with a way for each robot.

    Examples
    --------
    >>> from robonav.robot import random_worlds
    >>> from robonav.robot.team import random_teams
    >>> random_teams(5, robots=4, seed=1).starts.shape
    (5, 4, 2)
    >>> random_teams(5, robots=1, seed=1).worlds.digest() == random_worlds(5, seed=1).digest()
    True
    """
    check_integer("n", n, at_least=0, at_most=MOST_WORLDS)
    begin, end = crossing(robots, size)
    starts, targets = starts or points_of(begin), targets or points_of(end)
    for name, points in (("starts", starts), ("targets", targets)):
        check_array(name, points, shape=(robots, 2))
    check_drawing(obstacles, moving, starts, targets, moving_speeds, size)
    if isinstance(seed, np.random.Generator):
        seed = int(seed.integers(2**63))
    keys = world_keys(n, check_integer("seed", seed, at_least=0))
    return draw_teams(keys, obstacles, moving, starts, targets, moving_speeds, size)


def draw_teams(
    keys: NDArray[np.uint32],
    obstacles: int,
    moving: int,
    starts: Points,
    targets: Points,
    moving_speeds: tuple[float, float] = MOVING_SPEEDS,
    size: float = SIZE,
) -> Teams:
    """Draw the maps that belong to given keys.

    Parameters
    ----------
    keys : (N, 2) array of uint32
        One a map, see :func:`robonav.robot.world_keys`.
    obstacles : int
        Obstacles that stand still, 0 or more.
    moving : int
        Obstacles that move, on top of them.
    starts, targets : sequence of (x, y)
        Of the R robots of every map.
    moving_speeds : (float, float)
        Least and greatest speed of moving obstacles, in m/s.
    size : float
        Side of the map in metres.

    Returns
    -------
    Teams

    Examples
    --------
    >>> from robonav.robot import world_keys
    >>> from robonav.robot.team import draw_teams
    >>> len(draw_teams(world_keys(3, seed=1), 10, 0, [(10, 10)], [(90, 90)]))
    3
    """
    begin, end = np.array(starts, dtype=float), np.array(targets, dtype=float)
    n, m = len(keys), obstacles + moving
    kinds = np.zeros((n, m), dtype=np.int8)
    shapes, centres = np.zeros((n, m, 3)), np.zeros((n, m, 2))
    speeds, headings = np.zeros((n, m)), np.zeros((n, m))
    found = np.zeros(n, dtype=np.bool_)
    in_threads(
        _fast.draw_teams, n, keys, obstacles, moving, float(moving_speeds[0]), float(moving_speeds[1]), float(size),
        begin, end, ATTEMPTS, kinds, shapes, centres, speeds, headings, found, least=8,
    )  # fmt: skip
    if not found.all():
        raise ValueError(
            f"obstacles must leave a way to each target: {ATTEMPTS} draws with {obstacles} standing and {moving} "
            f"moving obstacles and {len(begin)} robots in {size:g} m gave no solvable map; take fewer"
        )
    worlds = Worlds(
        kinds, shapes, centres, speeds, headings, np.tile(begin[0], (n, 1)), np.tile(end[0], (n, 1)), keys, size
    )  # fmt: skip
    return Teams(worlds, np.tile(begin, (n, 1, 1)), np.tile(end, (n, 1, 1)))
