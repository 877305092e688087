"""The simulator: N worlds as arrays, sensed and stepped in one compiled call (section 2.5)."""

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
    check_positive,
    check_real,
)

from . import _fast
from ._fast import OUT_OF_STEPS, RUNNING
from .worlds import Worlds

OUTCOMES = np.array(["running", "arrived", "collided", "out of steps"])
NO_SLIP = np.zeros((0, 0))
NEVER = 2**19  # steps: as far as the random numbers of a world count


class Action(IntEnum):
    """What the robot can do in a step, Eq. (4.4); a policy chooses among the first five, or all six."""

    F = 0
    L30 = 1
    L60 = 2
    R30 = 3
    R60 = 4
    B = 5
    TO_TARGET = 6  # the reflex of a safe state: turn to the target and go; never a policy's choice


@dataclass(frozen=True)
class Sensing:
    """What N robots perceive; how to encode it is a policy's own business.

    Attributes
    ----------
    ranges : (N, 9) least distance in each sector in metres, 10 where nothing is in range. Column 0 is sensor 1, which
        looks ahead; sensors are numbered counter-clockwise.
    walls : (N, 9) whether that nearest thing is the map's border.
    target_region : (N,) number 1..9 of the sector that holds the target.
    target_seen : (N,) whether the target is within sensor range.
    """

    ranges: NDArray[np.float64]
    walls: NDArray[np.bool_]
    target_region: NDArray[np.int64]
    target_seen: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.ranges)

    def __getitem__(self, index: slice | NDArray[Any]) -> Sensing:
        """The rows picked by a slice, a mask or indices."""
        return Sensing(
            self.ranges[index],
            self.walls[index],
            self.target_region[index],
            self.target_seen[index],
        )

    @property
    def safe(self) -> NDArray[np.bool_]:
        """Safe states, Eq. (4.6): nothing in sensor range."""
        return self.ranges.min(axis=1) >= _fast.SENSOR_RANGE

    @staticmethod
    def empty(n: int) -> Sensing:
        """Rows to be filled in."""
        shape = (n, _fast.SENSORS)
        return Sensing(
            np.empty(shape),
            np.empty(shape, np.bool_),
            np.empty(n, np.int64),
            np.empty(n, np.bool_),
        )


@dataclass(frozen=True)
class Reflex:
    """What the robot does before any policy is asked (Algorithms 8 and 9).

    In a safe state it turns to its target and goes; where the five sectors ahead all read less than a step and the
    collision distance, it steps back (action B).
    """

    def __call__(self, sensing: Sensing, speed: float) -> NDArray[np.int64]:
        """Commands (N,): ``Action.TO_TARGET``, ``Action.B``, or -1 where the policy decides."""
        commands = np.empty(len(sensing), dtype=np.int64)
        _fast.in_threads(_fast.reflexes, len(sensing), sensing.ranges, speed, commands)
        return commands


def check_actions(actions: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.int64]:
    """Actions of this shape as whole numbers 0..5; TypeError or ValueError for anything else."""
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
    if (
        given.size and given.astype(np.uint64).max() > _fast.BACKWARD
    ):  # what is negative becomes very large
        wrong = given[(given < 0) | (given > _fast.BACKWARD)].flat[0]
        raise ValueError(
            f"action must be one of F, L30, L60, R30, R60, B (0 to 5), got {wrong}"
        )
    return given.astype(np.int64)


def check_slip(slip: ArrayLike | None) -> NDArray[np.float64]:
    """A matrix (6, 6) whose row a says how likely action a turns into each action; None for no slipping."""
    if slip is None:
        return NO_SLIP
    matrix = check_array("slip", slip, shape=(6, 6))
    if (matrix < 0).any() or not np.allclose(matrix.sum(axis=1), 1.0, atol=1e-9):
        raise ValueError("slip must have rows of probabilities that sum to 1")
    return np.ascontiguousarray(matrix)


def neighbour_slip(probability: float) -> NDArray[np.float64]:
    """A slip matrix (6, 6): with ``probability`` a turn comes out 30 degrees off, to either side; B never slips."""
    check_real("probability", probability, at_least=0, at_most=1)
    by_angle = [Action.R60, Action.R30, Action.F, Action.L30, Action.L60]
    matrix = np.eye(6)
    for k, action in enumerate(by_angle):
        beside = [by_angle[j] for j in (k - 1, k + 1) if 0 <= j < len(by_angle)]
        matrix[action, action] -= probability
        matrix[action, beside] += probability / len(beside)
    return matrix


class Simulator:
    """N robots, one a world, driven step by step.

    Parameters
    ----------
    worlds : batch of N.
    speed : of the robot in m/s, positive; a step is one second.
    slip : prediction uncertainty, section 2.5.1: (6, 6) probabilities that action a (row) turns into another; or None.
    noise : sensing uncertainty: standard deviation in metres of an error on every range that sees something.
    max_steps : seconds after which a drive is out of steps.

    Attributes
    ----------
    poses : (N, 3) x, y, heading. ``centres`` (N, M, 2) and ``headings`` (N, M): the obstacles now.
    steps : (N,) taken. ``outcome`` (N,): codes into ``OUTCOMES``.

    Raises
    ------
    ValueError : if speed is not positive, noise negative, or slip not (6, 6) with rows that sum to one.
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
        """What ``robots`` (K,) perceive now; by default all N."""
        rows = self._rows(robots)
        w, read = self.worlds, Sensing.empty(len(rows))
        _fast.in_threads(
            _fast.sense, len(rows), rows, w.kinds, w.shapes, self.centres, w.size, self.poses, w.targets, w.keys,
            self.steps, self.noise, read.ranges, read.walls, read.target_region, read.target_seen,
        )  # fmt: skip
        return read

    def step(
        self, commands: NDArray[np.int64], robots: NDArray[np.int64] | None = None
    ) -> NDArray[np.int64]:
        """One second for ``robots`` (K,), by default all N; those whose episode has ended stand still.

        Parameters
        ----------
        commands : (K,) int64 array
            What each robot is to do, codes of :class:`Action`.
        robots : (K,) int64 array, optional
            Indices of different robots. For all others, time stands still.

        Returns
        -------
        (K,) int64 array
            What each robot did: ``commands``, or another action where it slipped.

        Raises
        ------
        ValueError
            If the commands are not K whole numbers 0 to 6.
        """
        rows = self._rows(robots)
        fits = (
            isinstance(commands, np.ndarray)
            and commands.dtype == np.int64
            and commands.shape == rows.shape
        )
        if not fits or (commands.astype(np.uint64) > Action.TO_TARGET).any():
            raise ValueError(
                f"commands must be an array of {len(rows)} whole numbers 0 to 6, got {commands!r}"
            )
        w = self.worlds
        executed = commands.copy() if len(self.slip) else commands
        _fast.in_threads(
            _fast.step, len(rows), rows, w.kinds, w.shapes, w.speeds, w.keys, w.size, w.targets, self.slip, self.speed,
            self.max_steps, executed, self.poses, self.centres, self.headings, self.steps, self.outcome,
        )  # fmt: skip
        return executed

    def stop(self, robots: NDArray[np.int64]) -> None:
        """End the episodes of ``robots`` (K,) that still run; their outcome is "out of steps"."""
        rows = self._rows(robots)
        self.outcome[rows[self.outcome[rows] == RUNNING]] = OUT_OF_STEPS

    def _rows(self, robots: NDArray[np.int64] | None) -> NDArray[np.int64]:
        """The robots to sense or step; the compiled code below does not look whether they exist."""
        if robots is None:
            return self._everyone
        rows = check_array("robots", robots, shape=("K",), dtype=np.int64)
        if len(rows) and not 0 <= rows.min() <= rows.max() < len(self):
            raise ValueError(f"robots must lie in 0..{len(self) - 1}, got {robots!r}")
        return rows

    def restart(self, index: NDArray[np.int64], worlds: Worlds) -> None:
        """Put the robots ``index`` (K,) at the start of K new worlds, of no more obstacle slots than the old."""
        if worlds.size != self.worlds.size:
            raise ValueError(
                f"worlds must have the map size of those they replace, {self.worlds.size:g} m, got {worlds.size:g} m"
            )
        if not self._owns_worlds:  # those handed in stay as they are
            self.worlds, self._owns_worlds = self.worlds[:], True
        worlds = worlds.with_slots(self.worlds.slots)
        for name in (
            "kinds",
            "shapes",
            "centres",
            "speeds",
            "headings",
            "starts",
            "targets",
            "keys",
        ):
            getattr(self.worlds, name)[index] = getattr(worlds, name)
        self.poses[index] = worlds.start_poses
        self.centres[index], self.headings[index] = worlds.centres, worlds.headings
        self.steps[index], self.outcome[index] = 0, RUNNING


def sense(worlds: Worlds, poses: ArrayLike, *, noise: float = 0.0) -> Sensing:
    """What robots at ``poses`` (N, 3) would perceive, one in each of N worlds, obstacles where they start.

    Raises
    ------
    ValueError : if poses are not finite, not (N, 3), or outside the map.
    """
    simulator = Simulator(worlds, noise=noise)
    placed = check_array("poses", poses, shape=(len(worlds), 3))
    if (placed[:, :2] < 0).any() or (placed[:, :2] > worlds.size).any():
        raise ValueError(f"poses must lie in the map, 0 to {worlds.size:g} m")
    simulator.poses = np.ascontiguousarray(placed)
    return simulator.sense()


def obstacle_tracks(worlds: Worlds, steps: int) -> NDArray[np.float64]:
    """Where the obstacles are (N, steps + 1, M, 2) over time: the robot does not move them."""
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
