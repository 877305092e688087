"""The one rollout: robots sense, their reflex or a policy chooses, the simulator steps."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.progress import Progress
from robonav.validation import check_generator

from ._fast import RUNNING
from .simulator import OUTCOMES, Action, Reflex, Sensing, Simulator, check_actions
from .worlds import Worlds

Policy = Callable[[Sensing, np.random.Generator], ArrayLike]
"""``policy(sensing, rng) -> (N,)`` indices of actions, for any number N of robots."""

ReflexRule = Callable[[Sensing, float], NDArray[np.int64]]
"""``reflex(sensing, speed) -> (N,)`` actions, -1 where the policy decides."""

REFLEX = Reflex()


Chooser = Callable[[Simulator, Sensing, NDArray[np.int64]], ArrayLike]
"""``choose(simulator, sensing, asked) -> (n,)`` actions of the robots with indices ``asked`` (n,)."""


@dataclass(frozen=True, eq=False)
class Transition:
    """One simulated second of the N robots of a simulator.

    Attributes
    ----------
    simulator : Simulator
        The simulator after the step.
    running : (N,) array of bool
        Whether the robot was still running before the step. The other rows of a transition mean nothing.
    asked : (N,) array of bool
        Whether the policy chose the action. Elsewhere the reflex did.
    sensing : Sensing
        What the robots sensed before the step, N rows.
    poses : (N, 3) array
        Their x, y (metres) and heading (radians) before the step.
    actions : (N,) array of int
        The actions commanded, members of :class:`robonav.robot.Action`.
    outcome : (N,) array of int
        How each episode stands after the step: an index into :data:`robonav.robot.OUTCOMES`.
    """

    simulator: Simulator
    running: NDArray[np.bool_]
    asked: NDArray[np.bool_]
    sensing: Sensing
    poses: NDArray[np.float64]
    actions: NDArray[np.int64]
    outcome: NDArray[np.int8]

    @cached_property
    def next_sensing(self) -> Sensing:
        """What the robots sense after the step, N rows. Read it before the simulator moves on."""
        return self.simulator.sense()


def drive(
    simulator: Simulator, choose: Chooser, *, reflex: ReflexRule | None = REFLEX
) -> Iterator[Transition]:
    """Step the robots of a simulator until none of them is running.

    Between two transitions the caller may change the simulator: put robots into new worlds
    (:meth:`Simulator.restart`) or go on with some of them (:meth:`Simulator.keep`).

    Parameters
    ----------
    simulator : Simulator
        N robots, one a world.
    choose : callable
        ``choose(simulator, sensing, asked)`` returns the actions of the robots ``asked``; see
        :func:`follow_policy` for a policy.
    reflex : callable, optional
        What the robot does before ``choose`` is asked. None leaves every step to ``choose``.

    Yields
    ------
    Transition
        One a simulated second.

    Examples
    --------
    >>> from robonav.robot import Simulator, drive, follow_policy, random_worlds, straight
    >>> simulator = Simulator(random_worlds(3, obstacles=0, seed=1))
    >>> sum(transition.running.sum() for transition in drive(simulator, follow_policy(straight)))
    np.int64(168)
    """
    while (running := simulator.outcome == RUNNING).any():
        sensing, poses = simulator.sense(), simulator.poses.copy()
        actions = reflex_actions(reflex, sensing, simulator.speed)
        asked = running & (actions < 0)
        actions[~running] = Action.F  # these robots stand still
        if asked.any():
            actions[asked] = choose(simulator, sensing, np.flatnonzero(asked))
        simulator.step(actions)
        outcome = simulator.outcome.copy()
        yield Transition(simulator, running, asked, sensing, poses, actions, outcome)


def reflex_actions(
    reflex: ReflexRule | None, sensing: Sensing, speed: float
) -> NDArray[np.int64]:
    """Return the actions (N,) of a reflex, -1 where the policy decides."""
    return np.full(len(sensing), -1) if reflex is None else reflex(sensing, speed)


def follow_policy(policy: Policy, rng: np.random.Generator | int = 0) -> Chooser:
    """Let a policy choose in :func:`drive`.

    Parameters
    ----------
    policy : callable
        ``policy(sensing, rng)`` returns one action (0 to 5) for each row of ``sensing``.
    rng : Generator or int
        What the policy draws random numbers from.

    Raises
    ------
    TypeError, ValueError
        If the policy's actions are not whole numbers 0 to 5, one a robot.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot import Simulator, follow_policy, random_worlds, straight
    >>> simulator = Simulator(random_worlds(3, seed=1))
    >>> follow_policy(straight)(simulator, simulator.sense(), np.array([0, 2]))
    array([0, 0])
    """
    generator = check_generator("rng", rng)

    def choose(
        simulator: Simulator, sensing: Sensing, asked: NDArray[np.int64]
    ) -> NDArray[np.int64]:
        return check_actions(policy(sensing[asked], generator), (len(asked),))

    return choose


@dataclass(frozen=True, eq=False)
class Navigation:
    """How N robots ended.

    Attributes
    ----------
    outcome : (N,) array of str
        "arrived", "collided" or "out of steps".
    steps : (N,) array of int
        Seconds driven.
    paths : tuple of arrays, optional
        N arrays (steps + 1, 3) of x, y (metres) and heading (radians), if recorded.
    """

    outcome: NDArray[np.str_]
    steps: NDArray[np.int64]
    paths: tuple[NDArray[np.float64], ...] | None = None

    @property
    def success(self) -> NDArray[np.bool_]:
        """(N,) whether the robot arrived."""
        return self.outcome == "arrived"

    @property
    def collision(self) -> NDArray[np.bool_]:
        """(N,) whether the robot collided."""
        return self.outcome == "collided"


def navigate(
    policy: Policy,
    worlds: Worlds,
    speed: float = 2.0,
    max_steps: int = 500,
    record_paths: bool = False,
    *,
    reflex: ReflexRule | None = REFLEX,
    slip: ArrayLike | None = None,
    noise: float = 0.0,
    seed: int | np.random.Generator = 0,
    progress: Progress | None = None,
) -> Navigation:
    """Drive one robot through each of N worlds.

    Parameters
    ----------
    policy : callable
        ``policy(sensing, rng)`` returns the actions of the robots whose reflex does not decide.
    worlds : Worlds
        Batch of N.
    speed : float
        Metres a second, positive.
    max_steps : int
        Seconds after which an episode is out of steps.
    record_paths : bool
        Whether to keep the poses.
    reflex : callable, optional
        What the robot does before the policy is asked. None leaves every step to the policy.
    slip, noise : array and float, optional
        Uncertainty of motion and sensing, see :class:`Simulator`.
    seed : int or Generator
        Of the random numbers that the policy may draw.
    progress : callable, optional
        Called as ``progress(robots done, N)``.

    Returns
    -------
    Navigation

    Raises
    ------
    TypeError, ValueError
        If the policy's actions are not N whole numbers 0 to 5, or an argument is out of bounds.

    Examples
    --------
    >>> from robonav.robot import navigate, random_worlds, straight
    >>> navigate(straight, random_worlds(3, obstacles=0, seed=1)).outcome.tolist()
    ['arrived', 'arrived', 'arrived']
    """
    if not callable(policy):
        raise TypeError(
            f"policy must be callable as policy(sensing, rng), got {type(policy).__name__}"
        )
    if reflex is not None and not callable(reflex):
        raise TypeError(
            f"reflex must be callable as reflex(sensing, speed), or None, got {reflex!r}"
        )
    choose = follow_policy(policy, check_generator("seed", seed))
    simulator = Simulator(worlds, speed, slip=slip, noise=noise, max_steps=max_steps)
    n = len(worlds)
    robots = np.arange(n)
    outcome, steps = np.zeros(n, dtype=np.int8), np.zeros(n, dtype=np.int64)
    track = [(robots, simulator.poses.copy())]
    for transition in drive(simulator, choose, reflex=reflex):
        if record_paths:
            track.append((robots, simulator.poses.copy()))
        ended = transition.outcome != RUNNING
        if ended.any():
            outcome[robots[ended]] = transition.outcome[ended]
            steps[robots[ended]] = simulator.steps[ended]
            robots = robots[~ended]
            simulator.keep(~ended)
        if progress is not None:
            progress(n - len(robots), n)
    return Navigation(
        OUTCOMES[outcome], steps, _paths(track, n) if record_paths else None
    )


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
