"""Driving: a policy, many worlds, no loop over robots (Algorithm 9 with any policy)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.progress import Progress
from robonav.validation import check_generator

from ._fast import RUNNING
from .simulator import OUTCOMES, Action, Reflex, Sensing, Simulator, check_actions
from .worlds import Worlds

Policy = Callable[[Sensing, np.random.Generator], ArrayLike]
"""``policy(sensing, rng) -> (N,)`` indices of actions, for any number N of robots."""

REFLEX = Reflex()


@dataclass(frozen=True)
class Navigation:
    """How N drives ended.

    Attributes
    ----------
    outcome : (N,) "arrived", "collided" or "out of steps".
    steps : (N,) seconds driven.
    paths : N arrays (steps + 1, 3) of x, y, heading, if recorded; else None.
    """

    outcome: NDArray[np.str_]
    steps: NDArray[np.int64]
    paths: tuple[NDArray[np.float64], ...] | None = None

    @property
    def success(self) -> NDArray[np.bool_]:
        """(N,) arrived."""
        return self.outcome == "arrived"

    @property
    def collision(self) -> NDArray[np.bool_]:
        """(N,) collided."""
        return self.outcome == "collided"


def navigate(
    policy: Policy,
    worlds: Worlds,
    speed: float = 2.0,
    max_steps: int = 500,
    record_paths: bool = False,
    *,
    reflex: Callable[[Sensing, float], NDArray[np.int64]] | None = REFLEX,
    slip: ArrayLike | None = None,
    noise: float = 0.0,
    seed: int | np.random.Generator = 0,
    progress: Progress | None = None,
) -> Navigation:
    """Drive one robot through each of N worlds.

    Parameters
    ----------
    policy : called with the sensing of those robots whose reflex does not decide, and a Generator.
    worlds : batch of N.
    speed : m/s, positive.
    max_steps : seconds after which a drive is out of steps.
    record_paths : whether to keep the poses.
    reflex : what the robot does before any policy; None leaves every step to the policy.
    slip, noise : uncertainty of motion and sensing, see :class:`Simulator`.
    seed : of the Generator handed to the policy.

    Raises
    ------
    TypeError, ValueError : if the policy's actions are not N whole numbers 0..5, or an argument is out of bounds.
    """
    if not callable(policy):
        raise TypeError(
            f"policy must be callable as policy(sensing, rng), got {type(policy).__name__}"
        )
    if reflex is not None and not callable(reflex):
        raise TypeError(
            f"reflex must be callable as reflex(sensing, speed), or None, got {reflex!r}"
        )
    rng = check_generator("seed", seed)
    simulator = Simulator(worlds, speed, slip=slip, noise=noise, max_steps=max_steps)
    n = len(worlds)
    running = np.arange(n)
    outcome, steps = np.zeros(n, dtype=np.int8), np.zeros(n, dtype=np.int64)
    track = [(running, simulator.poses.copy())]
    while len(running):
        simulator.step(decide(policy, reflex, simulator.sense(), speed, rng))
        if record_paths:
            track.append((running, simulator.poses.copy()))
        ended = simulator.outcome != RUNNING
        if ended.any():
            outcome[running[ended]] = simulator.outcome[ended]
            steps[running[ended]] = simulator.steps[ended]
            running = running[~ended]
            simulator.keep(~ended)
        if progress is not None:
            progress(n - len(running), n)
    return Navigation(
        OUTCOMES[outcome], steps, _paths(track, n) if record_paths else None
    )


def decide(
    policy: Policy,
    reflex: Callable[[Sensing, float], NDArray[np.int64]] | None,
    sensing: Sensing,
    speed: float,
    rng: np.random.Generator,
) -> NDArray[np.int64]:
    """Commands (N,): the reflex's, and the policy's where the reflex leaves it the choice."""
    if reflex is None:
        return check_actions(policy(sensing, rng), (len(sensing),))
    commands = reflex(sensing, speed)
    asked = commands < 0
    if asked.any():
        commands[asked] = check_actions(
            policy(sensing[asked], rng), (int(asked.sum()),)
        )
    return commands


def straight(sensing: Sensing, rng: np.random.Generator) -> NDArray[np.int64]:
    """The policy that always goes forward: the first yardstick beside every table."""
    return np.full(len(sensing), Action.F)


def freer_side(sensing: Sensing, rng: np.random.Generator) -> NDArray[np.int64]:
    """A rule of three lines that has learned nothing: something near ahead, turn 60 degrees to the side with more room.

    The second yardstick: what learning has to beat.
    """
    left, right = sensing.ranges[:, 1:3].min(axis=1), sensing.ranges[:, 7:9].min(axis=1)
    turn = np.where(left > right, Action.L60, Action.R60)
    return np.where(sensing.ranges[:, 0] < 6.0, turn, Action.F)


def _paths(
    track: list[tuple[NDArray[np.int64], NDArray[np.float64]]], n: int
) -> tuple[NDArray[np.float64], ...]:
    """Poses by robot from poses by step."""
    owners = np.concatenate([owner for owner, _ in track])
    poses = np.concatenate([pose for _, pose in track])
    order = np.argsort(owners, kind="stable")
    return tuple(
        np.split(poses[order], np.cumsum(np.bincount(owners, minlength=n))[:-1])
    )
