"""The simulator: N robots in N worlds, held as arrays, sensed and stepped in one compiled call (section 2.5)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import (
    check_array,
    check_instance,
    check_integer,
    check_one_of,
    check_positive,
    check_real,
)

from . import _fast
from ._fast import OUT_OF_STEPS, RUNNING
from ._fast.constants import DIRECTION
from .worlds import Worlds

NO_SLIP = np.zeros((0, 0))
NEVER = 2**19  # steps; the random numbers of a world count no further


class Outcome(IntEnum):
    """How an episode stands, by number: the environments put this number into ``info["outcome"]``.

    Examples
    --------
    >>> from robonav.robot import Outcome
    >>> Outcome(1).name, Outcome.COLLIDED == 2
    ('ARRIVED', True)
    """

    RUNNING = 0
    ARRIVED = 1
    COLLIDED = 2
    OUT_OF_STEPS = 3


OUTCOMES = np.array([outcome.name.lower().replace("_", " ") for outcome in Outcome])
"""The same in words, by number: running, arrived, collided, out of steps."""


class Action(IntEnum):
    """Actions of a step, Eq. (4.4): F forward, L and R turn left and right by that many degrees, B steps back.

    A policy chooses among the first five, or all six. TO_TARGET and TO_SECTOR belong to the reflex alone.

    Examples
    --------
    >>> from robonav.robot import Action
    >>> Action.L60, int(Action.L60)
    (<Action.L60: 2>, 2)
    """

    F = 0  # Eq. (4.4): A = {F, L30, L60, R30, R60, B}
    L30 = 1
    L60 = 2
    R30 = 3
    R60 = 4
    B = 5
    TO_TARGET = 6  # in a safe state: turn to the target and go
    TO_SECTOR = 7  # in a safe state: turn to the middle of the target's sector and go


DIRECTIONS = {"exact": Action.TO_TARGET, "sector": Action.TO_SECTOR}
"""What the reflex does in a safe state, by what it knows of the direction of the target."""


@dataclass(frozen=True, eq=False)
class Sensing:
    """What N robots sense; a policy decides for itself how to encode it.

    ``sensing[index]`` picks rows by a slice, a mask or indices.

    Attributes
    ----------
    ranges : (N, 9) array
        Least distance in each sector in metres; 10 where nothing is in range. Column 0 is sensor 1, which looks ahead;
        sensors are numbered counter-clockwise.
    walls : (N, 9) bool array
        Whether that nearest thing is the map's border.
    target_region : (N,) int array
        Number 1 to 9 of the sector that holds the target.
    target_seen : (N,) bool array
        Whether the target is within sensor range.

    Examples
    --------
    >>> from robonav.robot import make_world, sense
    >>> sensing = sense(make_world(circles=[(58, 50, 2)]), [(50, 50, 0)])
    >>> sensing.ranges
    array([[ 6., 10., 10., 10., 10., 10., 10., 10., 10.]])
    >>> sensing.target_region, sensing.safe
    (array([2]), array([False]))
    """

    ranges: NDArray[np.float64]
    walls: NDArray[np.bool_]
    target_region: NDArray[np.int64]
    target_seen: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.ranges)

    def __getitem__(self, index: slice | NDArray[Any]) -> Sensing:
        """Pick rows by a slice, a mask or indices."""
        return Sensing(
            self.ranges[index],
            self.walls[index],
            self.target_region[index],
            self.target_seen[index],
        )

    @property
    def safe(self) -> NDArray[np.bool_]:
        """Which robots (N,) are in a safe state: nothing is in sensor range."""
        return self.ranges.min(axis=1) >= _fast.SENSOR_RANGE

    @staticmethod
    def empty(n: int) -> Sensing:
        """Return N rows whose values are still to be filled in.

        Parameters
        ----------
        n : int
            N.

        Returns
        -------
        Sensing

        Examples
        --------
        >>> from robonav.robot import Sensing
        >>> Sensing.empty(3).ranges.shape
        (3, 9)
        """
        shape = (n, _fast.SENSORS)
        return Sensing(
            np.empty(shape),
            np.empty(shape, np.bool_),
            np.empty(n, np.int64),
            np.empty(n, np.bool_),
        )


@dataclass(frozen=True)
class Reflex:
    """What the robot does before any policy is asked.

    In a safe state, with nothing in sensor range, it turns to its target and goes forward. Where all five sectors
    ahead read less than one step plus the collision distance, it steps back. Elsewhere the policy decides. Algorithms 8
    and 9 both use it.

    Attributes
    ----------
    direction : {"exact", "sector"}
        What the robot knows of the direction of its target in a safe state. "exact": it turns to the target itself.
        "sector": it knows only which sector the target lies in, as section 4.4.5.1 says, and turns to the middle of
        that sector. The target then lies in the sector ahead, so the robot goes straight on until the target has
        left that sector.

    Raises
    ------
    ValueError
        If the direction is another one.

    Examples
    --------
    >>> from robonav.robot import Reflex, make_world, sense
    >>> world = make_world(circles=[(58, 50, 2)])
    >>> [int(Reflex("exact")(sense(world, [pose]), speed=2.0)[0]) for pose in [(50, 50, 0), (20, 20, 0)]]
    [-1, 6]
    >>> int(Reflex("sector")(sense(world, [(20, 20, 0)]), speed=2.0)[0])
    7
    """

    direction: str = DIRECTION

    def __post_init__(self) -> None:
        check_one_of("direction", self.direction, DIRECTIONS)

    def __call__(self, sensing: Sensing, speed: float) -> NDArray[np.int64]:
        """Return ``TO_TARGET`` or ``TO_SECTOR``, ``B``, or -1 (``NO_REFLEX``) where the policy decides, (N,)."""
        n, to_target = len(sensing), int(DIRECTIONS[self.direction])
        commands = np.empty(n, dtype=np.int64)
        _fast.in_threads(
            _fast.reflexes, n, sensing.ranges, speed, to_target, commands, least=16384
        )
        return commands


def check_actions(actions: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.int64]:
    """Return actions of this shape as whole numbers 0 to 5; raise TypeError or ValueError for anything else."""
    try:
        given = np.asarray(actions)
    except ValueError:
        raise TypeError(
            "action must be whole numbers 0 to 5, got lists of several lengths"
        ) from None
    if given.dtype.kind not in "iu":
        raise TypeError(f"action must be whole numbers 0 to 5, got {given.dtype}")
    if given.shape != shape:
        raise ValueError(f"action must have shape {shape}, got {given.shape}")
    # negative numbers become very large ones
    if given.size and given.astype(np.uint64).max() > _fast.BACKWARD:
        wrong = given[(given < 0) | (given > _fast.BACKWARD)].flat[0]
        raise ValueError(
            f"action must be one of F, L30, L60, R30, R60, B (0 to 5), got {wrong}"
        )
    return given.astype(np.int64)


def check_action(action: Any) -> int:
    """Return one action as a whole number 0 to 5; raise TypeError or ValueError for anything else."""
    if type(action) in (int, np.int64) and 0 <= action <= _fast.BACKWARD:
        return int(action)  # the usual cases, quickly
    return int(check_actions(action, ()))


def check_commands(commands: Any, number: int) -> NDArray[np.int64]:
    """Return the commands of ``number`` robots, whole numbers 0 to 7; raise ValueError for anything else."""
    fits = (
        isinstance(commands, np.ndarray)
        and commands.dtype.kind in "iu"
        and commands.shape == (number,)
    )
    if not fits or (commands.astype(np.uint64) > Action.TO_SECTOR).any():
        raise ValueError(
            f"commands must be an array of {number} whole numbers 0 to 7, got {commands!r}"
        )
    checked: NDArray[np.int64] = commands.astype(np.int64, copy=False)
    return checked


def check_slip(slip: ArrayLike | None) -> NDArray[np.float64]:
    """Check a slip matrix (6, 6), whose row a says how likely action a turns into each action; None never slips."""
    if slip is None:
        return NO_SLIP
    matrix = check_array("slip", slip, shape=(6, 6))
    if (matrix < 0).any() or not np.allclose(matrix.sum(axis=1), 1.0, atol=1e-9):
        raise ValueError("slip must have rows of probabilities that sum to 1")
    return np.ascontiguousarray(matrix)


def neighbour_slip(probability: float) -> NDArray[np.float64]:
    """Return the slip matrix of a robot whose turns come out 30 degrees off with some probability.

    Parameters
    ----------
    probability : float
        Of a slip, to either side; at the ends, R60 and L60, to the one side there is. Action B never slips.

    Returns
    -------
    (6, 6) array
        Row a says how likely action a turns into each action.

    Examples
    --------
    >>> from robonav.robot import Action, neighbour_slip
    >>> neighbour_slip(0.2)[Action.F].round(2)
    array([0.8, 0.1, 0. , 0.1, 0. , 0. ])
    """
    check_real("probability", probability, at_least=0, at_most=1)
    by_angle = [Action.R60, Action.R30, Action.F, Action.L30, Action.L60]
    matrix = np.eye(6)
    for k, action in enumerate(by_angle):
        beside = [by_angle[j] for j in (k - 1, k + 1) if 0 <= j < len(by_angle)]
        matrix[action, action] -= probability
        matrix[action, beside] += probability / len(beside)
    return matrix


class Simulator:
    """N robots, one in each of N worlds, stepped together; a step is one second.

    Parameters
    ----------
    worlds : Worlds
        A batch of N.
    speed : float
        Of the robots in m/s, positive.
    slip : (6, 6) array, optional
        Uncertainty of prediction, section 2.5.1: probabilities that action a (row) turns into another.
    noise : float
        Uncertainty of sensing: standard deviation in metres of an error on every range that sees something.
    max_steps : int
        An episode ends as "out of steps" after this many seconds.

    Attributes
    ----------
    poses : (N, 3) array
        x and y in metres and heading in radians, now.
    centres : (N, M, 2) array
        Where the obstacles are now.
    headings : (N, M) array
        Where moving obstacles are going now.
    steps : (N,) int array
        Steps taken.
    outcome : (N,) int array
        How the episodes stand: codes into ``OUTCOMES``.

    Raises
    ------
    ValueError
        If speed is not positive, noise negative, or slip not (6, 6) with rows that sum to one.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot import Action, Simulator, make_world
    >>> simulator = Simulator(make_world(start=(10, 10), target=(10, 90)), speed=2.0)
    >>> simulator.step(np.array([Action.F]))
    array([0])
    >>> simulator.poses.round(3)
    array([[10.   , 12.   ,  1.571]])
    """

    def __init__(
        self,
        worlds: Worlds,
        speed: float = 2.0,
        *,
        slip: ArrayLike | None = None,
        noise: float = 0.0,
        max_steps: int = NEVER,
    ) -> None:
        self.worlds = check_instance("worlds", worlds, Worlds)
        self.speed = check_positive("speed", speed)
        self.slip = check_slip(slip)
        self.noise = check_real("noise", noise, at_least=0)
        self.max_steps = check_integer(
            "max_steps", max_steps, at_least=1, at_most=NEVER
        )
        self._owns_worlds = False
        self._everyone = np.arange(len(worlds))
        self.poses = worlds.start_poses
        self.centres = worlds.centres.copy()
        self.headings = worlds.headings.copy()
        self.steps = np.zeros(len(worlds), dtype=np.int64)
        self.outcome = np.zeros(len(worlds), dtype=np.int8)

    def __len__(self) -> int:
        return len(self.worlds)

    def sense(self, robots: NDArray[np.int64] | None = None) -> Sensing:
        """What robots perceive now.

        Parameters
        ----------
        robots : (K,) array of int, optional
            Their indices; by default all N.

        Returns
        -------
        Sensing

        Examples
        --------
        >>> from robonav.robot import Simulator, make_world
        >>> world = make_world(circles=[(50, 58, 2)], start=(50, 50), target=(50, 90))
        >>> Simulator(world).sense().ranges[0, 0]  # ahead
        np.float64(6.0)
        """
        rows = self._rows(robots)
        w, read = self.worlds, Sensing.empty(len(rows))
        _fast.in_threads(
            _fast.sense, len(rows), rows, w.kinds, w.shapes, self.centres, w.speeds, w.size, self.poses, w.targets,
            w.keys, self.steps, self.noise, read.ranges, read.walls, read.target_region, read.target_seen,
        )  # fmt: skip
        return read

    def step(
        self, commands: NDArray[np.int64], robots: NDArray[np.int64] | None = None
    ) -> NDArray[np.int64]:
        """One second for ``robots`` (K,), by default all N; those whose episode has ended stand still.

        Parameters
        ----------
        commands : (K,) array of int
            What each robot is to do, codes of :class:`Action`.
        robots : (K,) array of int, optional
            Indices of different robots. For all others, time stands still.

        Returns
        -------
        (K,) array of int
            What each robot did: ``commands``, or another action where it slipped.

        Raises
        ------
        ValueError
            If the commands are not K whole numbers 0 to 7.

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.robot import Action, Simulator, make_world
        >>> simulator = Simulator(make_world(start=(10, 10), target=(10, 90)), speed=2.0)
        >>> simulator.step(np.array([Action.F]))
        array([0])
        >>> simulator.poses.round(3)
        array([[10.   , 12.   ,  1.571]])
        """
        rows = self._rows(robots)
        commands = check_commands(commands, len(rows))
        w = self.worlds
        executed = commands.copy() if len(self.slip) else commands
        _fast.in_threads(
            _fast.step, len(rows), rows, w.kinds, w.shapes, w.speeds, w.keys, w.size, w.targets, self.slip, self.speed,
            self.max_steps, executed, self.poses, self.centres, self.headings, self.steps, self.outcome,
        )  # fmt: skip
        return executed

    def second(self, commands: NDArray[np.int64]) -> Sensing:
        """One second for all N robots, as :meth:`step`, and what they perceive then.

        Parameters
        ----------
        commands : (N,) array of int
            64-bit numbers 0 to 7, which are not checked; those of robots that slip change.

        Returns
        -------
        Sensing

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.robot import Simulator, make_world
        >>> world = make_world(circles=[(50, 58, 2)], start=(50, 50), target=(50, 90))
        >>> Simulator(world, speed=2.0).second(np.array([0])).ranges[0, 0]  # two metres nearer
        np.float64(4.0)
        """
        w, read = self.worlds, Sensing.empty(len(self))
        _fast.in_threads(
            _fast.second, len(self), self._everyone, w.kinds, w.shapes, w.speeds, w.keys, w.size, w.targets, self.slip,
            self.speed, self.max_steps, self.noise, commands, self.poses, self.centres, self.headings, self.steps,
            self.outcome, read.ranges, read.walls, read.target_region, read.target_seen,
        )  # fmt: skip
        return read

    def stop(self, robots: NDArray[np.int64]) -> None:
        """End the episodes of robots that still run; their outcome is "out of steps".

        Parameters
        ----------
        robots : (K,) array of int
            Their indices.

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.robot import Outcome, Simulator, random_worlds
        >>> simulator = Simulator(random_worlds(2, seed=1))
        >>> simulator.stop(np.array([1]))
        >>> [Outcome(code).name for code in simulator.outcome]
        ['RUNNING', 'OUT_OF_STEPS']
        """
        rows = self._rows(robots)
        self.outcome[rows[self.outcome[rows] == RUNNING]] = OUT_OF_STEPS

    def _rows(self, robots: NDArray[np.int64] | None) -> NDArray[np.int64]:
        """The robots to sense or step; the compiled code below does not check that they exist."""
        if robots is None:
            return self._everyone
        rows = check_array("robots", robots, shape=("K",), dtype=np.int64)
        if len(rows) and not 0 <= rows.min() <= rows.max() < len(self):
            raise ValueError(f"robots must lie in 0..{len(self) - 1}, got {robots!r}")
        return rows

    def restart(self, index: NDArray[np.int64], worlds: Worlds) -> None:
        """Put robots at the start of new worlds.

        The new worlds may have no more obstacle slots than the old ones, and the same map size.

        Parameters
        ----------
        index : (K,) array of int
            The robots' indices.
        worlds : Worlds
            K worlds.

        Raises
        ------
        ValueError
            If the map size is another one.

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.robot import Simulator, random_worlds
        >>> simulator = Simulator(random_worlds(2, seed=1))
        >>> _ = simulator.step(np.zeros(2, dtype=int))
        >>> simulator.restart(np.array([1]), random_worlds(1, seed=2))
        >>> simulator.steps
        array([1, 0])
        """
        if worlds.size != self.worlds.size:
            raise ValueError(
                f"worlds must have the map size of those they replace, {self.worlds.size:g} m, got {worlds.size:g} m"
            )
        if not self._owns_worlds:  # the caller's worlds are not changed
            self.worlds, self._owns_worlds = self.worlds[:], True
        worlds = worlds.with_slots(self.worlds.slots)
        self.worlds.put(index, worlds)
        self.poses[index] = worlds.start_poses
        self.centres[index], self.headings[index] = worlds.centres, worlds.headings
        self.steps[index], self.outcome[index] = 0, RUNNING


def sense(worlds: Worlds, poses: ArrayLike, *, noise: float = 0.0) -> Sensing:
    """Return what robots at given poses would sense, one in each of N worlds, obstacles where they start.

    Parameters
    ----------
    worlds : Worlds
        A batch of N.
    poses : (N, 3) array
        x and y in metres and heading in radians.
    noise : float
        Standard deviation in metres of an error on every range that sees something.

    Returns
    -------
    Sensing
        N rows.

    Raises
    ------
    ValueError
        If poses are not finite, not (N, 3), or outside the map.

    Examples
    --------
    >>> from robonav.robot import make_world, sense
    >>> sense(make_world(circles=[(58, 50, 2)]), [(50, 50, 0)]).ranges[0, :2]
    array([ 6., 10.])
    """
    simulator = Simulator(worlds, noise=noise)
    placed = check_array("poses", poses, shape=(len(worlds), 3))
    if (placed[:, :2] < 0).any() or (placed[:, :2] > worlds.size).any():
        raise ValueError(f"poses must lie in the map, 0 to {worlds.size:g} m")
    simulator.poses = np.ascontiguousarray(placed)
    return simulator.sense()


def obstacle_tracks(worlds: Worlds, steps: int) -> NDArray[np.float64]:
    """Return where the obstacles are over time; the robot does not influence them.

    Parameters
    ----------
    worlds : Worlds
        A batch of N, with M obstacle slots each.
    steps : int
        Seconds.

    Returns
    -------
    (N, steps + 1, M, 2) array
        Centres in metres, from the start on.

    Examples
    --------
    >>> from robonav.robot import obstacle_tracks, random_worlds
    >>> obstacle_tracks(random_worlds(2, obstacles=3, moving=1, seed=0), steps=5).shape
    (2, 6, 4, 2)
    """
    check_instance("worlds", worlds, Worlds)
    check_integer("steps", steps, at_least=0, at_most=NEVER)
    centres, headings = worlds.centres.copy(), worlds.headings.copy()
    track = [centres.copy()]
    for step in range(steps):
        now = np.full(len(worlds), step, dtype=np.int64)
        _fast.in_threads(
            _fast.drift, len(worlds), worlds.kinds, worlds.shapes, worlds.speeds, worlds.keys, now, worlds.size,
            centres, headings,
        )  # fmt: skip
        track.append(centres.copy())
    return np.stack(track, axis=1)
