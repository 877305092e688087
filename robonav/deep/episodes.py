"""PPO on whole episodes: before each update, robots act in a new simulator until their episodes have ended."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from robonav.networks.policy import NetworkPolicy
from robonav.networks.torch_lbfgs import one_thread
from robonav.networks.torch_module import as_module, as_network
from robonav.nnql.task import ACTIONS, EXPLORING, REPLAYING, WORLDS, make_rng
from robonav.robot import (
    Encoder,
    Outcome,
    Simulator,
    Transition,
    follow_policy,
    run_episodes,
)
from robonav.robot.environment_settings import arrival_or_collision
from robonav.robot.rollout import ReflexRule

from ._arguments import checked
from .gradient_ascent import adam, ascend
from .networks import ActorCritic, random_actor_critic
from .ppo import Rollout, batch_of, minibatches, objective

Draw = Callable[[np.random.Generator], Simulator]
"""``draw(rng)`` returns a simulator whose robots are at their start."""


@checked
@one_thread()
def ppo_on_rollouts(
    policy: torch.nn.Module,
    value: torch.nn.Module,
    act: Callable[[int], Sequence[Rollout]],
    updates: int,
    *,
    epochs: int = 4,
    batches: int = 16,
    clip: float = 0.2,
    discount: float = 0.99,
    trace_decay: float = 0.95,
    gradient_step: float = 0.01,
    value_weight: float = 0.5,
    entropy_weight: float = 0.03,
    seed: int,
) -> None:
    """Improve two networks in place by PPO on what robots did before each update.

    Parameters
    ----------
    policy, value : torch.nn.Module
        The networks that learn: logits of the actions, and one value.
    act : callable
        ``act(update)`` returns the steps of each robot, in which it acted by the policy.

    Returns
    -------
    None

    Examples
    --------
    >>> import torch
    >>> from robonav.deep import ppo_on_rollouts
    >>> from robonav.deep.ppo import Rollout
    >>> policy, value = (torch.nn.Linear(1, outputs) for outputs in (2, 1))
    >>> ones, no = torch.ones(4, 1), torch.zeros(4) > 0
    >>> actions = torch.tensor([0, 1, 0, 1])
    >>> steps = Rollout(ones, actions, actions.float(), ones, ~no, ~no, ~no)  # action 1 earns 1
    >>> ppo_on_rollouts(policy, value, lambda update: [steps], updates=30, batches=1, seed=0)
    >>> policy(torch.ones(1)).argmax()
    tensor(1)
    """
    optimiser = adam(gradient_step, policy, value)
    weights = clip, value_weight, entropy_weight
    for update in range(updates):
        rollouts = act(update)
        batch = batch_of(rollouts, policy, value, discount, trace_decay)  # Eq. (11)
        rng = make_rng(seed, REPLAYING, update)
        for rows in minibatches(len(batch), epochs, batches, rng):
            ascend(optimiser, objective(policy, value, batch[rows], *weights))


@checked
def ppo_on_episodes(
    draw: Draw,
    updates: int,
    *,
    reflex: ReflexRule | None,
    after: Callable[[Simulator], None],
    hidden: Sequence[int] = (32,),
    seed: int,
    **settings: Any,
) -> ActorCritic:
    """Train one policy by PPO for all robots of a simulator; each update draws a new simulator.

    Each robot is an actor of :func:`robonav.deep.ppo`, with its settings. All share the networks.

    Parameters
    ----------
    draw : callable
        ``draw(rng)`` returns a simulator whose robots are at their start.
    reflex : callable or None
        What a robot does before the policy is asked.
    after : callable
        Called as ``after(simulator)`` with the simulator of each update, when its episodes have ended.
    hidden : sequence of int
        Units of each hidden layer.
    **settings : Any
        Other keyword arguments of :func:`ppo_on_rollouts`, which also has their defaults.

    Examples
    --------
    >>> from robonav.deep import ppo_on_episodes
    >>> from robonav.robot import REFLEX, Simulator, random_worlds
    >>> ended = []
    >>> learned = ppo_on_episodes(
    ...     lambda rng: Simulator(random_worlds(3, obstacles=10, seed=rng), max_steps=99),
    ...     updates=2, reflex=REFLEX, after=lambda simulator: ended.append(len(simulator)), seed=0,
    ... )
    >>> learned.policy.sizes, ended
    ((12, 32, 5), [3, 3])
    """
    encoder = Encoder()
    start = random_actor_critic(encoder.size, hidden, ACTIONS, seed)
    policy, value = as_module(start.policy), as_module(start.value)

    def act(update: int) -> list[Rollout]:
        """Let the robots of a new simulator act by the policy as it is now."""
        simulator = draw(make_rng(seed, WORLDS, update))
        acting = NetworkPolicy(as_network(policy), encoder, temperature=1.0)
        exploring = make_rng(seed, EXPLORING, update)
        rollouts = act_together(simulator, acting, reflex, exploring)
        after(simulator)
        return rollouts

    ppo_on_rollouts(policy, value, act, updates, seed=seed, **settings)
    return ActorCritic(as_network(policy), as_network(value))


def act_together(
    simulator: Simulator,
    policy: NetworkPolicy,
    reflex: ReflexRule | None,
    rng: np.random.Generator,
) -> list[Rollout]:
    """Let all robots act until their episodes have ended, and return the steps of each."""
    seconds = list(run_episodes(simulator, follow_policy(policy, rng), reflex=reflex))
    robots = np.concatenate([second.robots for second in seconds])
    rows = [learned_from(second, policy.encoder) for second in seconds]
    return by_robot(robots, rows, len(simulator))


def by_robot(
    robots: NDArray[np.int64], rows: Sequence[tuple[NDArray[Any], ...]], n: int
) -> list[Rollout]:
    """Sort the columns of simulated seconds, one row for each robot in it, by the N robots."""
    columns = zip(*rows, strict=True)
    order = np.argsort(robots, kind="stable")  # robot by robot, each in time
    cuts = np.cumsum(np.bincount(robots, minlength=n))[:-1].tolist()
    parts = [
        torch.as_tensor(np.concatenate(column)[order]).tensor_split(cuts)
        for column in columns
    ]
    return [Rollout(*own) for own in zip(*parts, strict=True)]


def learned_from(second: Transition, encoder: Encoder) -> tuple[NDArray[Any], ...]:
    """Return one simulated second in the columns of a :class:`robonav.deep.ppo.Rollout`."""
    return columns_of(second, encoder(second.sensing), encoder(second.next_sensing))


def columns_of(
    second: Transition, states: NDArray[Any], next_states: NDArray[Any]
) -> tuple[NDArray[Any], ...]:
    """Return one simulated second in the columns of a rollout, with what the networks read before and after it."""
    outcome = second.outcome
    return (
        states,
        np.where(second.asked, second.actions, 0),
        arrival_or_collision(second.sensing, second.next_sensing, outcome),
        next_states,
        (outcome == Outcome.ARRIVED) | (outcome == Outcome.COLLIDED),
        outcome != Outcome.RUNNING,
        second.asked,
    )
