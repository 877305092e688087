"""Training of many seeds of GAIL at once, on the navigation task: the batched twin of :func:`robonav.deep.gail`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import torch

from robonav.lfd import Demonstrations
from robonav.networks.network_stack import NetworkStack, stacked
from robonav.networks.torch_lbfgs import one_thread
from robonav.nnql.task import ACTIONS, REPLAYING, NavigationTask, make_rng
from robonav.nnql.training import check_seeds
from robonav.progress import Progress
from robonav.validation import check_argument, check_callable, check_instance

from ._arguments import RULES, check_batches
from ._fast import Actors, StackedModule, by_seed
from .gail import (
    Reward,
    adam,
    ascend,
    deceiving_reward,
    discriminator_loss,
    first_discriminator,
    minibatch_pairs,
    pairs,
)
from .networks import random_actor_critic
from .ppo import Rollout
from .training import PPOResult, learn, navigation_task, ppo_settings


@dataclass(frozen=True, eq=False)
class GAILResult(PPOResult):
    """S policies trained by GAIL, with their discriminators, and how their training went, over U updates.

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
    discriminator : NetworkStack
        Stack (S,) of the discriminators.

    Examples
    --------
    >>> from robonav.deep import train_gail
    >>> from robonav.lfd import demonstrate
    >>> from robonav.robot import random_worlds
    >>> shown = demonstrate(random_worlds(3, obstacles=10, seed=1))
    >>> train_gail(shown, seeds=2, updates=1, actors=4, steps=16).discriminator.sizes
    (17, 32, 1)
    """

    discriminator: NetworkStack


@one_thread()
def train_gail(
    demonstrations: Demonstrations | Sequence[Demonstrations],
    seeds: int | Sequence[int] = 16,
    updates: int = 50,
    *,
    actors: int = 16,
    task: NavigationTask | None = None,
    hidden: Sequence[int] = (32,),
    reward: Reward = deceiving_reward,
    progress: Progress | None = None,
    **settings: Any,
) -> GAILResult:
    """Train one policy for each seed by GAIL, each as :func:`gail` trains it. All robots step in one simulator.

    Parameters
    ----------
    demonstrations : Demonstrations or sequence of Demonstrations
        Of the expert: the same for all seeds, or one set for each seed. Steps in which a reflex acted are left out.
    seeds : int or sequence of int
        A number S for the seeds 0 to S - 1, or the seeds themselves.
    updates : int
        How often the actors act, and the networks learn from it.
    actors : int
        N, the robots of each seed.
    task : NavigationTask, optional
        Worlds and robots; by default :func:`navigation_task`. Its reward is not used.
    hidden : sequence of int
        Units of each hidden layer.
    reward : callable
        Turns the discriminator's logits into rewards.
    progress : callable, optional
        Called as ``progress(updates done, updates)``.
    **settings
        Keyword arguments of :func:`gail` that :func:`ppo` has, too.

    Returns
    -------
    GAILResult
        With ``policies``, one for each seed.

    Raises
    ------
    ValueError, TypeError
        If an argument is out of bounds.

    Examples
    --------
    >>> from robonav.deep import train_gail
    >>> from robonav.lfd import demonstrate
    >>> from robonav.robot import random_worlds
    >>> shown = demonstrate(random_worlds(3, obstacles=10, seed=1))
    >>> len(train_gail(shown, seeds=2, updates=1, actors=4, steps=16).policies)
    2
    """
    seeds = check_seeds(seeds)
    task = navigation_task() if task is None else task
    check_instance("task", task, NavigationTask)
    check_callable("reward", reward, "reward(logits)")
    checked = {"updates": updates, "actors": actors, "hidden": hidden}
    updates, actors, hidden = (
        check_argument(RULES, "train_gail", name, value)
        for name, value in checked.items()
    )
    options = ppo_settings(settings)
    check_batches(options["batches"], actors * options["steps"])
    experts = [expert_pairs(own, task) for own in one_each(demonstrations, len(seeds))]
    size = task.encoder.size
    started = [random_actor_critic(size, hidden, ACTIONS, seed) for seed in seeds]
    policy = StackedModule(stacked([one.policy for one in started]))
    value = StackedModule(stacked([one.value for one in started]))
    judge = StackedModule(
        stacked([first_discriminator(size, ACTIONS, hidden, seed) for seed in seeds])
    )
    robots = Actors(task, seeds, actors)
    step = options["gradient_step"]
    optimiser, judging = adam(step, policy, value), adam(step, judge)
    ended, arrived = np.zeros((2, len(seeds), updates), np.int64)
    for update in range(updates):
        rollout = robots.act(policy, options["steps"])
        ended[:, update], arrived[:, update] = robots.ended, robots.arrived
        rngs = [make_rng(seed, REPLAYING, update) for seed in seeds]
        discriminate_all(judge, judging, rollout, experts, rngs, options)
        rollout = rewarded(rollout, judge, reward)
        learn(policy, value, optimiser, rollout, rngs, options)
        if progress is not None:
            progress(update + 1, updates)
    about = options | {"updates": updates, "actors": actors, "hidden": hidden}
    return GAILResult(
        seeds, policy.stack(), value.stack(), task.encoder, ended, arrived, about,
        judge.stack(),
    )  # fmt: skip


def one_each(
    demonstrations: Demonstrations | Sequence[Demonstrations], seeds: int
) -> Sequence[Demonstrations]:
    """Return the demonstrations of each seed."""
    if not isinstance(demonstrations, Sequence):
        check_instance("demonstrations", demonstrations, Demonstrations)
        return [demonstrations] * seeds
    if len(demonstrations) != seeds:
        raise ValueError(
            f"demonstrations must be one set or one for each of {seeds} seeds, got {len(demonstrations)}"
        )
    return [
        check_instance("demonstrations", own, Demonstrations) for own in demonstrations
    ]


def expert_pairs(demonstrations: Demonstrations, task: NavigationTask) -> torch.Tensor:
    """What the discriminator reads of the expert's decisions."""
    chosen = demonstrations[demonstrations.actions < ACTIONS]
    if not len(chosen):
        raise ValueError("demonstrations must have at least one step without a reflex")
    return pairs(task.encoder(chosen.sensing), chosen.actions, ACTIONS)


def discriminate_all(
    judge: StackedModule,
    judging: torch.optim.Optimizer,
    rollout: Rollout,
    experts: Sequence[torch.Tensor],
    rngs: Sequence[np.random.Generator],
    options: dict[str, Any],
) -> None:
    """Improve the discriminators of all seeds in some epochs of minibatches."""
    own = pairs(by_seed(rollout.states), by_seed(rollout.actions), ACTIONS)
    decided = by_seed(rollout.decided)
    seeds = np.arange(len(rngs))[:, None]
    orders = [
        minibatch_pairs(
            own.shape[1], len(expert), options["epochs"], options["batches"], rng
        )
        for expert, rng in zip(experts, rngs, strict=True)
    ]
    for each in zip(*orders, strict=True):
        chosen = np.stack([rows for rows, _ in each])
        drawn = [expert[rows] for expert, (_, rows) in zip(experts, each, strict=True)]
        of_learner = judge(own[seeds, chosen])[..., 0]
        of_expert = judge(torch.stack(drawn))[..., 0]
        ascend(
            judging, -discriminator_loss(of_learner, of_expert, decided[seeds, chosen])
        )


def rewarded(rollout: Rollout, judge: StackedModule, reward: Reward) -> Rollout:
    """Return the rollout of all seeds with the rewards that their discriminators give."""
    own = pairs(by_seed(rollout.states), by_seed(rollout.actions), ACTIONS)
    steps, *shape = rollout.actions.shape
    with torch.no_grad():
        logits = judge(own)[..., 0].reshape(*shape, steps).movedim(-1, 0)
    return replace(rollout, rewards=rollout.decided * reward(logits))
