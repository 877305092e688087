"""The navigation task of section 4.5, on which chapter 4 trains: batches of worlds, and a Gymnasium environment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from robonav.networks import random_network
from robonav.networks.multilayer_perceptron import Network
from robonav.robot import (
    NNQL_SENSORS,
    REFLEX,
    Encoder,
    ReflexRule,
    Worlds,
    draw_worlds,
    world_keys,
)
from robonav.robot.environment_settings import Reward
from robonav.robot.environments import NavigationEnv, as_sensing
from robonav.validation import check_integer, check_positive

from ._arguments import checked
from .reward import reward

STARTS = ((10.0, 10.0), (90.0, 10.0))
TARGETS = ((90.0, 90.0), (10.0, 90.0))
ACTIONS = 5  # F, L30, L60, R30, R60; the reflex alone steps back

INITIAL, EXPLORING, WORLDS, REPLAYING = range(4)
"""Purposes of a seed's random numbers; each purpose has its own generator."""


def make_rng(seed: int, purpose: int, *more: int) -> np.random.Generator:
    """The generator of one seed for one purpose, such as exploring in one episode.

    Examples
    --------
    >>> from robonav.nnql.task import EXPLORING, make_rng
    >>> make_rng(3, EXPLORING, 7).random() == make_rng(3, EXPLORING, 7).random()
    True
    """
    return np.random.default_rng([seed, purpose, *more])


def reflex_acted(info: dict[str, Any]) -> bool:
    """Whether the robot's reflex chose the last action of an environment, and not the policy.

    In a safe state the reflex turns the robot to its target, whatever action the policy chose (section 4.4). A learner
    skips such a step: its reward and its next state do not follow from the policy's action. Environments without a
    reflex have no such steps.

    Parameters
    ----------
    info : dict
        What ``env.step`` returned last.

    Returns
    -------
    bool

    Examples
    --------
    >>> from robonav.nnql import NavigationTask
    >>> from robonav.nnql.task import reflex_acted
    >>> env = NavigationTask().environment()
    >>> _ = env.reset(seed=0)
    >>> reflex_acted(env.step(0)[4])  # nothing in sensor range
    True
    """
    return bool(info.get("reflex", -1) >= 0)


@dataclass(frozen=True, eq=False)
class NavigationTask:
    """The task of section 4.5: worlds, speed, sensing and reward.

    Parameters
    ----------
    obstacles, moving : int
        Standing and moving obstacles in a world.
    speed : float
        Speed of the robot in m/s.
    max_steps : int
        Seconds that an episode lasts at most.
    starts, targets : sequences of (x, y)
        Where robots start and where they go, see :func:`robonav.robot.random_worlds`.
    encoder : Encoder
        Turns what is sensed into the network's inputs. By default these are the 16 numbers of Eq. (4.5), each divided
        by its largest value.
    reward : Reward
        The reward of a step, by default that of Table 4.1.
    reflex : Reflex
        What the robot does before the policy is asked.
    n_worlds : int, optional
        Number of different maps, through which the episodes of a seed go again and again. By default each episode has
        a new map.

    Examples
    --------
    >>> from robonav.nnql import NavigationTask
    >>> env = NavigationTask(obstacles=20).environment()
    >>> state, info = env.reset(seed=3)
    >>> state.shape, int(env.action_space.n)
    ((16,), 5)
    """

    obstacles: int = 10
    moving: int = 0
    speed: float = 2.5
    max_steps: int = 400
    starts: Sequence[tuple[float, float]] = STARTS
    targets: Sequence[tuple[float, float]] = TARGETS
    encoder: Encoder = field(
        default_factory=lambda: Encoder(NNQL_SENSORS, walls=True, target="number")
    )
    reward: Reward = reward
    reflex: ReflexRule | None = REFLEX
    n_worlds: int | None = None

    def __post_init__(self) -> None:
        check_positive("speed", self.speed)
        check_integer("max_steps", self.max_steps, at_least=1)
        if self.n_worlds is not None:
            check_integer("n_worlds", self.n_worlds, at_least=1)

    def worlds(self, seeds: Sequence[int], first: int, last: int) -> Worlds:
        """The worlds of episodes ``first`` to ``last - 1`` of each seed, one seed after the other.

        Parameters
        ----------
        seeds : sequence of int
            Seeds of trainings.
        first, last : int
            The first episode, and the one after the last.

        Returns
        -------
        Worlds

        Examples
        --------
        >>> from robonav.nnql import NavigationTask
        >>> len(NavigationTask().worlds([0, 1], first=0, last=3))
        6
        """
        episodes = np.arange(first, last)
        return self._drawn([self._keys(seed, episodes) for seed in seeds])

    def worlds_at(self, seeds: Sequence[int], episodes: NDArray[np.int64]) -> Worlds:
        """One world for each of K pairs of a seed and an episode.

        Parameters
        ----------
        seeds : (K,) sequence of int
            Seeds of trainings.
        episodes : (K,) int array
            One episode of each seed.

        Returns
        -------
        Worlds

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.nnql import NavigationTask
        >>> task = NavigationTask()
        >>> pair = task.worlds_at([4, 4], np.array([0, 2]))
        >>> bool((pair.centres[1] == task.worlds([4], 0, 3).centres[2]).all())
        True
        """
        pairs = zip(seeds, episodes, strict=True)
        return self._drawn([self._keys(seed, np.array([own])) for seed, own in pairs])

    def _keys(self, seed: int, episodes: NDArray[np.int64]) -> NDArray[np.uint32]:
        """The keys of the worlds of these episodes of a seed."""
        chosen = episodes if self.n_worlds is None else episodes % self.n_worlds
        own = int(make_rng(seed, WORLDS).integers(2**63))
        return world_keys(int(chosen.max()) + 1, own)[chosen]

    def _drawn(self, keys: Sequence[NDArray[np.uint32]]) -> Worlds:
        return draw_worlds(
            np.concatenate(keys), self.obstacles, self.moving, self.starts, self.targets
        )

    def environment(self) -> TrainingEnv:
        """The task as a Gymnasium environment with encoded observations and the five actions that are learned.

        Returns
        -------
        TrainingEnv

        Examples
        --------
        >>> from robonav.nnql import NavigationTask
        >>> NavigationTask().environment().observation_space.shape
        (16,)
        """
        return TrainingEnv(self)


class TrainingEnv(gymnasium.Wrapper):
    """``robonav/Navigation-v0`` with encoded observations, in the worlds of a training.

    ``reset(seed=s)`` starts in the first world of seed s, and each further ``reset()`` goes on to the next world.
    ``info["reflex"]`` is -1 where the given action was carried out; elsewhere the robot's reflex acted instead.

    Parameters
    ----------
    task : NavigationTask
        The worlds, the robot, its reward and its encoder.
    """

    def __init__(self, task: NavigationTask) -> None:
        super().__init__(
            NavigationEnv(
                speed=task.speed,
                reward=task.reward,
                reflex=task.reflex,
                max_episode_steps=task.max_steps,
            )
        )
        self.task, self._seed, self._episode = task, 0, -1
        size = task.encoder.size
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (size,), float)
        self.action_space = gymnasium.spaces.Discrete(ACTIONS)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float64], dict[str, Any]]:
        """Start the next episode, or with ``seed`` the first episode of that seed."""
        if seed is not None:
            self._seed, self._episode = seed, -1
        self._episode += 1
        world = self.task.worlds([self._seed], self._episode, self._episode + 1)
        observation, info = self.env.reset(
            seed=seed, options={"worlds": world} | (options or {})
        )
        return self._encoded(observation), info

    def step(
        self, action: int
    ) -> tuple[NDArray[np.float64], float, bool, bool, dict[str, Any]]:
        """One second with this action, unless the robot's reflex acts."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        return self._encoded(observation), float(reward), terminated, truncated, info

    def _encoded(self, observation: dict[str, Any]) -> NDArray[np.float64]:
        return self.task.encoder(as_sensing(observation))[0]


@checked
def q_network(env: gymnasium.Env, *, hidden: int = 8, seed: int) -> Network:
    """A network with random weights: one input for each number of the state, one output for each action (Fig. 4.1).

    Parameters
    ----------
    env : gymnasium.Env
        An environment with discrete actions; :func:`network_environment` says how many numbers its observations have.
    hidden : int
        Units of the hidden layer.
    seed : int
        Seed of the weights.

    Returns
    -------
    Network
        To be trained by :func:`nnql` and the other methods.

    Examples
    --------
    >>> import gymnasium
    >>> from robonav.nnql import q_network
    >>> q_network(gymnasium.make("CartPole-v1"), seed=0).sizes
    (4, 8, 2)
    """
    spaces = env.observation_space, env.action_space
    states, actions = (gymnasium.spaces.flatdim(space) for space in spaces)
    sizes = (states, hidden, actions)
    return random_network(sizes, seed=make_rng(seed, INITIAL))
