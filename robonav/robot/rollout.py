"""One loop that lets robots act: sense, ask the reflex, ask the policy, move.

It is the batched twin of :func:`robonav.nnql.navigate_greedily`, Algorithm 9, and takes any policy.

:func:`run_episodes` is that loop. :func:`navigate`, demonstrations, Q-learning and the episodes of inverse
reinforcement learning stand on it. So does DAgger (:mod:`robonav.lfd.dagger`), where the expert labels each state while
another policy acts.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import wraps
from typing import ParamSpec, Protocol, TypeVar, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.progress import Progress
from robonav.validation import check_callable, check_generator

from ._fast import NO_REFLEX, RUNNING
from .simulator import OUTCOMES, Reflex, Sensing, Simulator, check_actions
from .worlds import Worlds

P = ParamSpec("P")
R = TypeVar("R")

Policy = Callable[[Sensing, np.random.Generator], ArrayLike]
"""``policy(sensing, rng) -> (N,)`` indices of actions, for any number N of robots."""

ActionSelector = Callable[[Simulator, Sensing, NDArray[np.int64]], ArrayLike]
"""``select_actions(simulator, sensing, robots) -> (K,)`` the actions of the robots with these indices (K,).

``sensing`` has K rows: what these robots sense."""


@runtime_checkable
class PolicyWithMemory(Protocol):
    """A policy that remembers something of its episode, or knows more than what the robot senses now.

    ``begin`` makes a new selector at the start of the episodes, which holds what is remembered.

    Examples
    --------
    >>> from robonav.robot import PolicyWithMemory, follow_policy, navigate, random_worlds, straight
    >>> class Straight:
    ...     def begin(self, simulator, rng):
    ...         return follow_policy(straight, rng)
    >>> isinstance(Straight(), PolicyWithMemory), isinstance(straight, PolicyWithMemory)
    (True, False)
    >>> navigate(Straight(), random_worlds(3, obstacles=0, seed=0)).success
    array([ True,  True,  True])
    """

    def begin(self, simulator: Simulator, rng: np.random.Generator) -> ActionSelector:
        """Return a selector for the robots of a simulator, whose episodes begin.

        Parameters
        ----------
        simulator : Simulator
            Its N robots are driven.
        rng : numpy.random.Generator
            Of the random numbers.

        Returns
        -------
        callable
            ``select_actions(simulator, sensing, robots)`` returns the actions (K,) of the robots ``robots`` (K,).

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.robot import Simulator, follow_policy, random_worlds, straight
        >>> class Straight:
        ...     def begin(self, simulator, rng):
        ...         return follow_policy(straight, rng)
        >>> simulator, rng = Simulator(random_worlds(3, seed=1)), np.random.default_rng(0)
        >>> select_actions, robots = Straight().begin(simulator, rng), np.array([0, 2])
        >>> select_actions(simulator, simulator.sense(robots), robots)
        array([0, 0])
        """


ReflexRule = Callable[[Sensing, float], NDArray[np.int64]]
"""``reflex(sensing, speed) -> (N,)`` actions, -1 where the policy decides; see :class:`Reflex`."""

REFLEX = Reflex()


@dataclass(frozen=True, eq=False)
class Transition:
    """One simulated second of the K robots that were running.

    Attributes
    ----------
    robots : (K,) int array
        Indices of these robots in the simulator, ascending.
    sensing : Sensing
        What they perceived before they acted.
    actions : (K,) int array
        What they were told to do, by the reflex or by the policy.
    executed : (K,) int array
        What they did: ``actions``, or another action where a robot slipped.
    asked : (K,) bool array
        Whether the policy chose the action; elsewhere the reflex did.
    poses : (K, 3) array
        x and y in metres and the heading in radians, before they acted.
    next_sensing : Sensing
        What they perceived afterwards.
    outcome : (K,) int array
        How their episodes stand afterwards: codes into ``OUTCOMES``, 0 for those that go on.

    Examples
    --------
    >>> from robonav.robot import Simulator, run_episodes, follow_policy, random_worlds, straight
    >>> simulator = Simulator(random_worlds(3, obstacles=10, seed=2))
    >>> second = next(run_episodes(simulator, follow_policy(straight, rng=0)))
    >>> second.robots.tolist(), second.poses.shape, len(second.next_sensing)
    ([0, 1, 2], (3, 3), 3)
    """

    robots: NDArray[np.int64]
    sensing: Sensing
    actions: NDArray[np.int64]
    executed: NDArray[np.int64]
    asked: NDArray[np.bool_]
    poses: NDArray[np.float64]
    next_sensing: Sensing
    outcome: NDArray[np.int8]


def asks_for_valid_actions(run: Callable[P, R]) -> Callable[P, R]:
    """Decorate a loop of (simulator, select_actions, ...): it checks each answer of ``select_actions``.

    TypeError or ValueError unless they are whole numbers 0 to 5, one for each robot.
    """
    signature = inspect.signature(run)

    @wraps(run)
    def checked(*args: P.args, **kwargs: P.kwargs) -> R:
        """Run the loop with a selector that also checks the actions."""
        call = signature.bind(*args, **kwargs)
        select_actions = call.arguments["select_actions"]

        def valid(
            simulator: Simulator, sensing: Sensing, robots: NDArray[np.int64]
        ) -> NDArray[np.int64]:
            """Ask the selector, and check its actions."""
            actions = select_actions(simulator, sensing, robots)
            return check_actions(actions, (len(robots),))

        call.arguments["select_actions"] = valid
        return run(*call.args, **call.kwargs)

    return checked


@asks_for_valid_actions
def run_episodes(
    simulator: Simulator,
    select_actions: ActionSelector,
    *,
    reflex: ReflexRule | None = REFLEX,
) -> Iterator[Transition]:
    """Let the robots of a simulator act until none is running; one transition a simulated second.

    A robot leaves when its episode ends. Between two transitions the caller may end an episode
    (:meth:`Simulator.stop`) or begin a new one (:meth:`Simulator.restart`); the loop then
    continues with all robots that are running.

    Parameters
    ----------
    simulator : Simulator
        N robots, one in each world.
    select_actions : callable
        ``select_actions(simulator, sensing, robots)`` returns the actions of K ``robots`` whose reflex does not decide;
        :func:`follow_policy` makes one of a policy.
    reflex : callable, optional
        What a robot does before ``select_actions`` is asked. None leaves every step to ``select_actions``.

    Yields
    ------
    Transition
        Its arrays are copies, which later seconds do not change.

    Raises
    ------
    TypeError, ValueError
        If the actions chosen are not whole numbers 0 to 5, one for each robot.

    Examples
    --------
    >>> from robonav.robot import Simulator, run_episodes, follow_policy, random_worlds, straight
    >>> simulator = Simulator(random_worlds(3, obstacles=10, seed=2))
    >>> seconds = list(run_episodes(simulator, follow_policy(straight, rng=0)))
    >>> seconds[0].robots.tolist(), seconds[-1].robots.tolist()
    ([0, 1, 2], [0])
    """
    reflex = reflex or undecided
    robots = np.flatnonzero(simulator.outcome == RUNNING)
    sensing = simulator.sense(robots)
    while len(robots):
        actions = reflex(sensing, simulator.speed)
        asked = actions == NO_REFLEX
        if asked.any():
            actions[asked] = select_actions(simulator, sensing[asked], robots[asked])
        poses = simulator.poses[robots]
        executed = simulator.step(actions, robots)
        outcome, after = simulator.outcome[robots], simulator.sense(robots)
        yield Transition(
            robots, sensing, actions, executed, asked, poses, after, outcome
        )
        left = simulator.outcome[robots] != RUNNING
        robots = np.flatnonzero(simulator.outcome == RUNNING)
        if not simulator.steps[robots].all():  # the caller has restarted a robot
            sensing = simulator.sense(robots)
        else:
            sensing = after[~left] if left.any() else after


def undecided(sensing: Sensing, speed: float) -> NDArray[np.int64]:
    """The reflex of a robot that has none: -1 (N,), the policy decides everywhere."""
    return np.full(len(sensing), NO_REFLEX)


def follow_policy(policy: Policy, rng: np.random.Generator | int) -> ActionSelector:
    """Return the selector for :func:`run_episodes` that asks a policy, which gets only what the robots sense.

    Parameters
    ----------
    policy : callable
        ``policy(sensing, rng)`` returns one action (0 to 5) for each row of ``sensing``.
    rng : numpy.random.Generator or int
        What the policy draws random numbers from.

    Returns
    -------
    callable
        ``select_actions(simulator, sensing, robots)`` returns the policy's actions.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot import Simulator, follow_policy, random_worlds, straight
    >>> simulator, robots = Simulator(random_worlds(3, seed=1)), np.array([0, 2])
    >>> follow_policy(straight, rng=0)(simulator, simulator.sense(robots), robots)
    array([0, 0])
    """
    generator = check_generator("rng", rng)
    return lambda simulator, sensing, robots: policy(sensing, generator)


@dataclass(frozen=True, eq=False)
class Navigation:
    """How N episodes ended.

    Attributes
    ----------
    outcome : (N,) str array
        "arrived", "collided" or "out of steps".
    steps : (N,) int array
        How many seconds each episode took.
    paths : tuple of (steps + 1, 3) arrays, optional
        x, y and heading of each robot over time, if recorded; else None.

    Examples
    --------
    >>> from robonav.robot import navigate, random_worlds, straight
    >>> result = navigate(straight, random_worlds(3, obstacles=0, seed=0))
    >>> result.outcome.tolist(), result.success.mean().item()
    (['arrived', 'arrived', 'arrived'], 1.0)
    """

    outcome: NDArray[np.str_]
    steps: NDArray[np.int64]
    paths: tuple[NDArray[np.float64], ...] | None = None

    @property
    def success(self) -> NDArray[np.bool_]:
        """Which robots arrived, (N,)."""
        return self.outcome == "arrived"

    @property
    def collision(self) -> NDArray[np.bool_]:
        """Which robots collided, (N,)."""
        return self.outcome == "collided"


def navigate(
    policy: Policy | PolicyWithMemory,
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
    """Let a policy steer one robot through each of N worlds.

    Parameters
    ----------
    policy : callable or PolicyWithMemory
        ``policy(sensing, rng) -> (K,)`` actions, asked about the K robots whose reflex does not decide; or a policy
        that has a memory.
    worlds : Worlds
        A batch of N.
    speed : float
        Of the robots, in m/s; positive.
    max_steps : int
        An episode ends as "out of steps" after this many seconds.
    record_paths : bool
        Whether to keep the poses.
    reflex : callable, optional
        What a robot does before the policy is asked; None leaves every step to the policy.
    slip : (6, 6) array, optional
        Uncertainty of motion, see :class:`Simulator`.
    noise : float
        Uncertainty of sensing, in metres, see :class:`Simulator`.
    seed : int or numpy.random.Generator
        Seed of the generator that the policy is handed.
    progress : callable, optional
        ``progress(done, total)``, called each second with the number of episodes that have ended.

    Returns
    -------
    Navigation
        How the episodes ended.

    Raises
    ------
    TypeError, ValueError
        If the policy's actions are not whole numbers 0 to 5, one for each robot, or if an argument is out of bounds.

    Examples
    --------
    >>> from robonav.robot import navigate, random_worlds, turn_to_clearer_side
    >>> result = navigate(turn_to_clearer_side, random_worlds(100, obstacles=10, seed=1))
    >>> int(result.success.sum()), int(result.collision.sum())
    (99, 0)
    """
    if not isinstance(policy, PolicyWithMemory):
        check_callable("policy", policy, "policy(sensing, rng)")
    if reflex is not None and not callable(reflex):
        raise TypeError(
            f"reflex must be callable as reflex(sensing, speed), or None, got {reflex!r}"
        )
    rng = check_generator("seed", seed)
    simulator = Simulator(worlds, speed, slip=slip, noise=noise, max_steps=max_steps)
    return navigate_in(
        policy, simulator, record_paths, reflex=reflex, seed=rng, progress=progress
    )


def navigate_in(
    policy: Policy | PolicyWithMemory,
    simulator: Simulator,
    record_paths: bool = False,
    *,
    reflex: ReflexRule | None = REFLEX,
    seed: int | np.random.Generator = 0,
    progress: Progress | None = None,
) -> Navigation:
    """Let a policy steer the robots of a simulator until their episodes have ended.

    Parameters
    ----------
    policy : callable or PolicyWithMemory
        As in :func:`navigate`.
    simulator : Simulator
        N robots at their starts, for instance with bodies, :class:`robonav.body.BodySimulator`.
    record_paths : bool
        Whether to keep the poses.
    reflex : callable, optional
        What a robot does before the policy is asked; None leaves every step to the policy.
    seed : int or numpy.random.Generator
        Seed of the generator that the policy is handed.
    progress : callable, optional
        ``progress(done, total)``, called each second with the number of episodes that have ended.

    Returns
    -------
    Navigation
        How the episodes ended.

    Examples
    --------
    >>> from robonav.robot import Simulator, navigate_in, random_worlds, turn_to_clearer_side
    >>> simulator = Simulator(random_worlds(100, obstacles=10, seed=1), max_steps=500)
    >>> int(navigate_in(turn_to_clearer_side, simulator).success.sum())
    99
    """
    select_actions = selector_of(policy, simulator, check_generator("seed", seed))
    n, ended = len(simulator), 0
    track: list[tuple[NDArray[np.int64], NDArray[np.float64]]] = []
    for second in run_episodes(simulator, select_actions, reflex=reflex):
        if record_paths:
            track.append((second.robots, second.poses))
        ended += int((second.outcome != RUNNING).sum())
        if progress is not None:
            progress(ended, n)
    track.append((np.arange(n), simulator.poses))
    return Navigation(
        OUTCOMES[simulator.outcome],
        simulator.steps,
        by_robot(track, n) if record_paths else None,
    )


def selector_of(
    policy: Policy | PolicyWithMemory, simulator: Simulator, rng: np.random.Generator
) -> ActionSelector:
    """Return the selector of a policy with or without a memory."""
    if isinstance(policy, PolicyWithMemory):
        return policy.begin(simulator, rng)
    return follow_policy(policy, rng)


def by_robot(
    track: list[tuple[NDArray[np.int64], NDArray[np.float64]]], n: int
) -> tuple[NDArray[np.float64], ...]:
    """Return the path of each of N robots, from the robots and poses of each second."""
    owners = np.concatenate([owner for owner, _ in track])
    poses = np.concatenate([pose for _, pose in track])
    order = np.argsort(owners, kind="stable")
    ends = np.cumsum(np.bincount(owners, minlength=n))
    return tuple(np.split(poses[order], ends)[:-1])
