"""Robots that learn together: PPO whose actors share one map, and one set of weights.

Each robot of a team acts by the same policy and learns from what all of them experience (parameter sharing; Tan 1993,
Gupta et al. 2017). To a robot the others are moving obstacles that get better while it learns. Its reward is its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.networks.policy import NetworkPolicy
from robonav.robot import REFLEX, Encoder, Outcome, Simulator
from robonav.robot.rollout import ReflexRule
from robonav.robot.team import TeamSimulator, random_teams
from robonav.validation import check_integer, check_positive, checks

from ._arguments import RULES
from .episodes import ppo_on_episodes
from .networks import ActorCritic

TEAM_RULES = RULES | {
    "robots": lambda name, value: check_integer(name, value, at_least=1),
    "n_worlds": lambda name, value: check_integer(name, value, at_least=1),
    "obstacles": lambda name, value: check_integer(name, value, at_least=0),
    "max_steps": lambda name, value: check_integer(name, value, at_least=1),
    "speed": check_positive,
}


@dataclass(frozen=True, eq=False)
class TeamTraining:
    """A policy that several robots learned together, and how its training went, over U updates.

    Attributes
    ----------
    networks : ActorCritic
        The trained networks.
    encoder : Encoder
        Turns what is sensed into the networks' inputs.
    arrived, met : (U,) arrays
        The share of the robots that arrived, and that collided with another robot, while they acted for an update.
    steps : (U,) int array
        How many steps all robots made for an update.

    Examples
    --------
    >>> from robonav.deep import train_team
    >>> train_team(robots=4, updates=2, n_worlds=2, seed=0).arrived.shape
    (2,)
    """

    networks: ActorCritic
    encoder: Encoder
    arrived: NDArray[np.float64]
    met: NDArray[np.float64]
    steps: NDArray[np.int64]

    @property
    def policy(self) -> NetworkPolicy:
        """The policy, which draws its actions as it did in training."""
        return NetworkPolicy(self.networks.policy, self.encoder, temperature=1.0)


@checks(TEAM_RULES)
def train_team(
    robots: int = 8,
    updates: int = 60,
    *,
    n_worlds: int = 8,
    obstacles: int = 10,
    speed: float = 2.0,
    max_steps: int = 300,
    reflex: ReflexRule | None = REFLEX,
    seed: int,
    **settings: Any,
) -> TeamTraining:
    """Train one policy for all robots by PPO with shared weights.

    Before each update, all robots of some new maps act until their episodes have ended. Each robot is an actor of
    :func:`robonav.deep.ppo`, and the policy learns from the steps of all. With one robot on each map, nobody meets
    anybody: the same training alone, to compare with.

    Parameters
    ----------
    robots : int
        R, on each map.
    updates : int
        How often the robots act, and the networks learn from it.
    n_worlds : int
        N, new ones for each update.
    obstacles : int
        Obstacles of a map that stand still.
    speed : float
        Of the robots, in m/s.
    max_steps : int
        A robot's episode ends as "out of steps" after this many seconds.
    reflex : callable, optional
        What a robot does before the policy is asked.
    seed : int
        Of the weights, the maps, the actions and the minibatches.
    **settings
        Other keyword arguments of :func:`ppo_on_episodes`, which also has their defaults.

    Returns
    -------
    TeamTraining
        With the networks, the policy, and how the training went.

    Raises
    ------
    ValueError, TypeError
        If an argument is out of bounds.

    Examples
    --------
    >>> from robonav.deep import train_team
    >>> train_team(robots=4, updates=1, n_worlds=2, seed=0).policy.network.sizes
    (12, 32, 5)
    """
    went = []

    def draw(rng: np.random.Generator) -> TeamSimulator:
        """Put teams at the start of new maps."""
        teams = random_teams(n_worlds, robots, obstacles, seed=rng)
        return TeamSimulator(teams, speed, max_steps=max_steps)

    def record(simulator: Simulator) -> None:
        """Note how the episodes of an update went."""
        assert isinstance(simulator, TeamSimulator)
        arrived = simulator.outcome == Outcome.ARRIVED
        went.append((arrived.mean(), simulator.met.mean(), simulator.steps.sum()))

    learned = ppo_on_episodes(
        draw, updates, reflex=reflex, after=record, seed=seed, **settings
    )
    arrived, met, steps = np.array(went).T
    return TeamTraining(learned, Encoder(), arrived, met, steps.astype(np.int64))
