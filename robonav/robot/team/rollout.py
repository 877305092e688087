"""Let policies drive the robots of teams."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_generator

from ..rollout import (
    REFLEX,
    ActionSelector,
    Policy,
    PolicyWithMemory,
    ReflexRule,
    by_robot,
    run_episodes,
    selector_of,
)
from ..simulator import OUTCOMES, Sensing, Simulator
from .simulator import TeamSimulator
from .teams import Teams

AnyPolicy = Policy | PolicyWithMemory


@dataclass(frozen=True, eq=False)
class TeamNavigation:
    """How the episodes of R robots on each of N maps ended.

    Attributes
    ----------
    outcome : (N, R) str array
        "arrived", "collided" or "out of steps".
    met : (N, R) bool array
        Which robots collided with another robot.
    steps : (N, R) int array
        How many seconds each robot took.
    paths : tuple of (steps + 1, 3) arrays, optional
        x, y and heading of each robot over time, map by map, if recorded; else None.

    Examples
    --------
    >>> from robonav.robot import turn_to_clearer_side
    >>> from robonav.robot.team import navigate_team, random_teams
    >>> result = navigate_team(turn_to_clearer_side, random_teams(100, robots=8, seed=1))
    >>> result.success.shape
    (100, 8)
    """

    outcome: NDArray[np.str_]
    met: NDArray[np.bool_]
    steps: NDArray[np.int64]
    paths: tuple[NDArray[np.float64], ...] | None = None

    @property
    def success(self) -> NDArray[np.bool_]:
        """Which robots arrived, (N, R)."""
        return self.outcome == "arrived"

    @property
    def collision(self) -> NDArray[np.bool_]:
        """Which robots collided, (N, R), with a robot or with anything else."""
        return self.outcome == "collided"


def navigate_team(
    policy: AnyPolicy | Sequence[AnyPolicy],
    teams: Teams,
    speed: float = 2.0,
    max_steps: int = 500,
    record_paths: bool = False,
    *,
    reflex: ReflexRule | None = REFLEX,
    slip: ArrayLike | None = None,
    noise: float = 0.0,
    seed: int | np.random.Generator = 0,
) -> TeamNavigation:
    """Let policies steer the robots of each of N maps.

    Parameters
    ----------
    policy : callable or PolicyWithMemory or sequence
        The policy of all robots, or one for each robot of a map.
    teams : Teams
        N maps with R robots.
    speed : float
        Of the robots, in m/s; positive.
    max_steps : int
        An episode ends as "out of steps" after this many seconds.
    record_paths : bool
        Whether to keep the poses.
    reflex : callable, optional
        What a robot does before its policy is asked; None leaves every step to the policy.
    slip : (6, 6) array, optional
        Uncertainty of motion, see :class:`TeamSimulator`.
    noise : float
        Uncertainty of sensing, in metres, see :class:`TeamSimulator`.
    seed : int or numpy.random.Generator
        Seed of the generator that the policies are handed.

    Returns
    -------
    TeamNavigation
        How the episodes ended.

    Raises
    ------
    TypeError, ValueError
        If a policy's actions are not whole numbers 0 to 5, one for each robot, or if an argument is out of bounds.

    Examples
    --------
    >>> from robonav.robot import turn_to_clearer_side
    >>> from robonav.robot.team import navigate_team, random_teams
    >>> result = navigate_team(turn_to_clearer_side, random_teams(100, robots=8, seed=1))
    >>> float(result.success.mean().round(2)), float(result.met.mean().round(2))
    (0.51, 0.47)
    """
    simulator = TeamSimulator(teams, speed, slip=slip, noise=noise, max_steps=max_steps)
    select_actions = team_selector(policy, simulator, check_generator("seed", seed))
    track: list[tuple[NDArray[np.int64], NDArray[np.float64]]] = []
    for second in run_episodes(simulator, select_actions, reflex=reflex):
        if record_paths:
            track.append((second.robots, second.poses))
    track.append((np.arange(len(simulator)), simulator.poses))
    shape = teams.starts.shape[:2]
    return TeamNavigation(
        OUTCOMES[simulator.outcome].reshape(shape),
        simulator.met.reshape(shape),
        simulator.steps.reshape(shape),
        by_robot(track, len(simulator)) if record_paths else None,
    )


def team_selector(
    policy: AnyPolicy | Sequence[AnyPolicy],
    simulator: TeamSimulator,
    rng: np.random.Generator,
) -> ActionSelector:
    """Return the selector of one policy for all robots, or of one policy for each robot of a map.

    Parameters
    ----------
    policy : callable or PolicyWithMemory or sequence
        See :func:`navigate_team`: one, or one for each robot of a map.
    simulator : TeamSimulator
        Its robots are driven.
    rng : numpy.random.Generator
        What the policies draw random numbers from.

    Returns
    -------
    callable
        ``select_actions(simulator, sensing, robots)``, as :func:`robonav.robot.run_episodes` takes it.

    Raises
    ------
    ValueError
        If there are not as many policies as robots on a map.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot import straight, turn_to_clearer_side
    >>> from robonav.robot.team import TeamSimulator, random_teams, team_selector
    >>> simulator, robots = TeamSimulator(random_teams(2, robots=2, seed=1)), np.arange(4)
    >>> select = team_selector([straight, turn_to_clearer_side], simulator, np.random.default_rng(0))
    >>> select(simulator, simulator.sense(), robots).shape
    (4,)
    """
    if not isinstance(policy, Sequence):
        return selector_of(policy, simulator, rng)
    team = simulator.teams.robots
    if len(policy) != team:
        raise ValueError(
            f"policy must be one policy, or one for each of {team} robots, got {len(policy)}"
        )
    selectors = [selector_of(one, simulator, rng) for one in policy]

    def select_actions(
        simulator: Simulator, sensing: Sensing, robots: NDArray[np.int64]
    ) -> NDArray[np.int64]:
        """Ask the policy of each robot."""
        actions = np.empty(len(robots), dtype=np.int64)
        for number, select in enumerate(selectors):
            own = robots % team == number
            if own.any():
                actions[own] = select(simulator, sensing[own], robots[own])
        return actions

    return select_actions
