"""Training of many seeds of PPO at once, on the navigation task."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from robonav.networks.network_stack import NetworkStack, stacked
from robonav.networks.policy import NetworkPolicy
from robonav.networks.torch_lbfgs import one_thread
from robonav.nnql.task import ACTIONS, REPLAYING, NavigationTask, make_rng
from robonav.nnql.training import check_seeds
from robonav.progress import Progress
from robonav.robot import Encoder
from robonav.robot.environment_settings import arrival_or_collision
from robonav.robot.worlds import START, TARGET
from robonav.validation import check_argument, check_instance

from ._arguments import RULES, check_batches
from ._fast import Actors, StackedModule, batch_of
from .gradient_ascent import adam, ascend
from .networks import random_actor_critic
from .ppo import Rollout, minibatches, objective, ppo


def navigation_task(**changes: Any) -> NavigationTask:
    """The task on which PPO trains: the worlds of the leaderboard, where an arrival gives 1 and a collision -1.

    Parameters
    ----------
    **changes
        Other attributes of :class:`robonav.nnql.NavigationTask`.

    Returns
    -------
    NavigationTask

    Examples
    --------
    >>> from robonav.deep import navigation_task
    >>> navigation_task(obstacles=20).speed
    2.0
    """
    usual: dict[str, Any] = {
        "speed": 2.0,
        "max_steps": 300,
        "starts": (START,),
        "targets": (TARGET,),
        "encoder": Encoder(),
        "reward": arrival_or_collision,
    }
    return NavigationTask(**(usual | changes))


@dataclass(frozen=True, eq=False)
class PPOResult:
    """S trained policies and how their training went, over U updates.

    Attributes
    ----------
    seeds : (S,) tuple of int
        The seeds.
    policy, value : NetworkStack
        Stacks (S,) of the trained networks.
    encoder : Encoder
        Turns what is sensed into the networks' inputs.
    ended, arrived : (S, U) int arrays
        How many episodes ended while the actors acted for an update, and how many of them at the target.
    settings : dict
        The settings, by name.

    Examples
    --------
    >>> from robonav.deep import train_ppo
    >>> result = train_ppo(seeds=2, updates=3, actors=4, steps=16)
    >>> result.ended.shape, len(result.policies)
    ((2, 3), 2)
    """

    seeds: tuple[int, ...]
    policy: NetworkStack
    value: NetworkStack
    encoder: Encoder
    ended: NDArray[np.int64]
    arrived: NDArray[np.int64]
    settings: dict[str, Any]

    @cached_property
    def policies(self) -> tuple[NetworkPolicy, ...]:
        """The policy of each seed, which draws its actions as it did in training."""
        return tuple(
            NetworkPolicy(self.policy[row], self.encoder, temperature=1.0)
            for row in range(len(self.seeds))
        )


@one_thread()
def train_ppo(
    seeds: int | Sequence[int] = 16,
    updates: int = 50,
    *,
    actors: int = 16,
    task: NavigationTask | None = None,
    hidden: Sequence[int] = (32,),
    start: PPOResult | None = None,
    progress: Progress | None = None,
    **settings: Any,
) -> PPOResult:
    """Train one policy for each seed by PPO.

    The policies train at once, each as :func:`ppo` trains it in as many environments ``task.environment()`` as there
    are actors. All robots step in one simulator.

    Parameters
    ----------
    seeds : int or sequence of int
        A number S for the seeds 0 to S - 1, or the seeds themselves.
    updates : int
        How often the actors act, and the networks learn from it.
    actors : int
        N, the robots of each seed.
    task : NavigationTask, optional
        What to train on; by default :func:`navigation_task`.
    hidden : sequence of int
        Units of each hidden layer.
    start : PPOResult, optional
        An earlier training of as many seeds, whose networks go on to learn; ``hidden`` is then not used. Take other
        seeds than it had, so that the robots meet other worlds.
    progress : callable, optional
        Called as ``progress(updates done, updates)``.
    **settings
        Keyword arguments of :func:`ppo`, which also has their defaults.

    Returns
    -------
    PPOResult
        With ``policies``, one for each seed.

    Raises
    ------
    ValueError, TypeError
        If an argument is out of bounds.

    Examples
    --------
    >>> from robonav.deep import train_ppo
    >>> train_ppo(seeds=2, updates=1, actors=4, steps=16).policy.sizes
    (12, 32, 5)

    Two seeds learn among 10 obstacles, and then go on among 30:

    >>> from robonav.deep import navigation_task
    >>> easy = train_ppo(seeds=[0, 1], updates=1, actors=4, steps=16)
    >>> hard = navigation_task(obstacles=30)
    >>> train_ppo(seeds=[2, 3], updates=1, actors=4, steps=16, task=hard, start=easy).seeds
    (2, 3)
    """
    training = Training.checked(seeds, updates, actors, task, hidden, settings)
    return train_seeds(training, progress, start=start)


@dataclass(frozen=True, eq=False)
class Training:
    """A training of several seeds at once, with checked arguments; :func:`train_ppo` says what they mean."""

    seeds: tuple[int, ...]
    updates: int
    actors: int
    task: NavigationTask
    hidden: tuple[int, ...]
    settings: dict[str, Any]

    @classmethod
    def checked(
        cls,
        seeds: int | Sequence[int],
        updates: int,
        actors: int,
        task: NavigationTask | None,
        hidden: Sequence[int],
        settings: dict[str, Any],
    ) -> Training:
        """Check the arguments, and fill in what was left out."""
        seeds = check_seeds(seeds)
        task = navigation_task() if task is None else task
        check_instance("task", task, NavigationTask)
        given = {"updates": updates, "actors": actors, "hidden": hidden}
        updates, actors, hidden = (
            check_argument(RULES, "train_ppo", name, value)
            for name, value in given.items()
        )
        options = ppo_settings(settings)
        check_batches(options["batches"], actors * options["steps"])
        return cls(seeds, updates, actors, task, tuple(hidden), options)


Rewards = Callable[[Rollout, Sequence[np.random.Generator]], Rollout]
"""Gives the steps of an update their rewards. The generators are those of the seeds for this update."""


def rewards_of_task(rollout: Rollout, rngs: Sequence[np.random.Generator]) -> Rollout:
    """Leave the rewards that the task gave."""
    return rollout


def first_networks(
    training: Training, start: PPOResult | None
) -> tuple[NetworkStack, NetworkStack]:
    """Return the policies and the value functions to start from: random ones, or those of an earlier training."""
    size = training.task.encoder.size
    if start is None:
        drawn = [
            random_actor_critic(size, training.hidden, ACTIONS, seed)
            for seed in training.seeds
        ]
        policies = stacked([one.policy for one in drawn])
        return policies, stacked([one.value for one in drawn])
    check_instance("start", start, PPOResult)
    if len(start.seeds) != len(training.seeds) or start.policy.sizes[0] != size:
        raise ValueError(
            f"start must be a training of {len(training.seeds)} seeds with {size} inputs, "
            f"got {len(start.seeds)} seeds with {start.policy.sizes[0]}"
        )
    return start.policy, start.value


def train_seeds(
    training: Training,
    progress: Progress | None,
    rewards: Rewards = rewards_of_task,
    start: PPOResult | None = None,
) -> PPOResult:
    """Train all seeds by PPO."""
    seeds, task, options = training.seeds, training.task, training.settings
    policy, value = map(StackedModule, first_networks(training, start))
    robots = Actors(task, seeds, training.actors)
    optimiser = adam(options["gradient_step"], policy, value)
    ended, arrived = np.zeros((2, len(seeds), training.updates), np.int64)
    for update in range(training.updates):
        rollout = robots.act(policy, options["steps"])
        ended[:, update], arrived[:, update] = robots.ended, robots.arrived
        rngs = [make_rng(seed, REPLAYING, update) for seed in seeds]
        learn(policy, value, optimiser, rewards(rollout, rngs), rngs, options)
        if progress is not None:
            progress(update + 1, training.updates)
    learned = policy.stack()
    about = {
        "updates": training.updates,
        "actors": training.actors,
        "hidden": learned.sizes[1:-1],
    }
    return PPOResult(
        seeds, learned, value.stack(), task.encoder, ended, arrived, options | about
    )


def learn(
    policy: StackedModule,
    value: StackedModule,
    optimiser: torch.optim.Optimizer,
    rollout: Rollout,
    rngs: Sequence[np.random.Generator],
    options: dict[str, Any],
) -> None:
    """One update of all seeds: some epochs of minibatches."""
    batch = batch_of(
        rollout, policy, value, options["discount"], options["trace_decay"]
    )
    orders = [
        minibatches(len(batch), options["epochs"], options["batches"], rng)
        for rng in rngs
    ]
    own = np.arange(len(rngs))[:, None]
    for rows in zip(*orders, strict=True):
        gains = objective(
            policy, value, batch[own, np.stack(rows)], options["clip"],
            options["value_weight"], options["entropy_weight"],
        )  # fmt: skip
        ascend(optimiser, gains)


def ppo_settings(given: dict[str, Any]) -> dict[str, Any]:
    """The settings of :func:`ppo`: those given, checked, and its defaults."""
    parameters = inspect.signature(ppo).parameters.values()
    defaults = {p.name: p.default for p in parameters if p.default is not p.empty}
    for name in given:
        if name not in defaults:
            raise TypeError(f"the settings are {', '.join(defaults)}, got {name}")
    return {
        name: check_argument(RULES, "train_ppo", name, value)
        for name, value in (defaults | given).items()
    }
