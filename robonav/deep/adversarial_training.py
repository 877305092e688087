"""Training of many seeds of GAIL at once, on the navigation task: the batched twin of :func:`robonav.deep.gail`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import torch

from robonav.lfd import Demonstrations
from robonav.networks.network_stack import NetworkStack, stacked
from robonav.networks.torch_lbfgs import one_thread
from robonav.nnql.task import ACTIONS, NavigationTask
from robonav.progress import Progress
from robonav.validation import check_callable, check_instance

from ._fast import StackedModule, by_seed
from .gail import (
    Reward,
    deceiving_reward,
    discriminator_loss,
    first_discriminator,
    minibatch_pairs,
    pairs,
)
from .gradient_ascent import adam, ascend
from .ppo import Rollout
from .training import PPOResult, Training, train_seeds


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
    check_callable("reward", reward, "reward(logits)")
    training = Training.checked(seeds, updates, actors, task, hidden, settings)
    judges = Judges(training, demonstrations, reward)
    trained = train_seeds(training, progress, judges.reward)
    of_ppo = {part.name: getattr(trained, part.name) for part in fields(trained)}
    return GAILResult(**of_ppo, discriminator=judges.networks.stack())


class Judges:
    """The discriminators of all seeds, which learn in each update before they give its rewards.

    Parameters
    ----------
    training : Training
        What is trained.
    demonstrations : Demonstrations or sequence of Demonstrations
        Of the expert, for all seeds or one set for each.
    reward : callable
        Turns logits into rewards.
    """

    def __init__(
        self,
        training: Training,
        demonstrations: Demonstrations | Sequence[Demonstrations],
        reward: Reward,
    ) -> None:
        self.settings, self.rewards = training.settings, reward
        task, seeds = training.task, training.seeds
        self.experts = [
            expert_pairs(own, task) for own in one_each(demonstrations, len(seeds))
        ]
        size, hidden = task.encoder.size, training.hidden
        self.networks = StackedModule(
            stacked(
                [first_discriminator(size, ACTIONS, hidden, seed) for seed in seeds]
            )
        )
        self.optimiser = adam(self.settings["gradient_step"], self.networks)

    def reward(self, rollout: Rollout, rngs: Sequence[np.random.Generator]) -> Rollout:
        """Improve on the steps of all seeds, and return these steps with their rewards."""
        own = pairs(by_seed(rollout.states), by_seed(rollout.actions), ACTIONS)
        self._improve(own, by_seed(rollout.decided), rngs)
        steps, *shape = rollout.actions.shape
        with torch.no_grad():
            logits = self.networks(own)[..., 0].reshape(*shape, steps).movedim(-1, 0)
        return replace(rollout, rewards=rollout.decided * self.rewards(logits))

    def _improve(
        self,
        own: torch.Tensor,
        decided: torch.Tensor,
        rngs: Sequence[np.random.Generator],
    ) -> None:
        """Go through the pairs in some epochs of minibatches, as :func:`robonav.deep.gail.discriminate` does."""
        seeds = np.arange(len(rngs))[:, None]
        epochs, batches = self.settings["epochs"], self.settings["batches"]
        orders = [
            minibatch_pairs(own.shape[1], len(expert), epochs, batches, rng)
            for expert, rng in zip(self.experts, rngs, strict=True)
        ]
        for each in zip(*orders, strict=True):
            chosen = np.stack([rows for rows, _ in each])
            drawn = [expert[rows] for expert, (_, rows) in zip(self.experts, each, strict=True)]  # fmt: skip
            of_learner = self.networks(own[seeds, chosen])[..., 0]
            of_expert = self.networks(torch.stack(drawn))[..., 0]
            loss = discriminator_loss(of_learner, of_expert, decided[seeds, chosen])
            ascend(self.optimiser, -loss)


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
