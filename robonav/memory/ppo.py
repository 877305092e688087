"""PPO for a policy that sees the last k steps.

To PPO the window is the state: :func:`robonav.deep.ppo` needs no change to learn with a memory that is a part of the
state. What differs is that a robot carries its window along while it acts.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from robonav.deep import ppo_on_rollouts
from robonav.deep.episodes import by_robot, columns_of
from robonav.deep.ppo import Rollout
from robonav.networks import random_network
from robonav.networks.policy import draw_actions
from robonav.networks.torch_module import as_module
from robonav.nnql.task import EXPLORING, INITIAL, WORLDS, make_rng
from robonav.robot import Sensing, Simulator, run_episodes
from robonav.validation import check_instance, checks

from .networks import WindowNetwork
from .policies import Actions, Memories, MemoryPolicy


def check_window(name: str, value: Any) -> MemoryPolicy:
    """A policy whose network has a window."""
    policy = check_instance(name, value, MemoryPolicy)
    check_instance(f"{name}.network", policy.network, WindowNetwork)
    return policy


@checks({"policy": check_window})
def ppo_with_window(
    policy: MemoryPolicy,
    draw: Callable[[np.random.Generator], Simulator],
    updates: int,
    *,
    hidden: int = 32,
    seed: int,
    **settings: Any,
) -> MemoryPolicy:
    """Go on to train a policy that sees the last k steps, by PPO. The robots have no reflex.

    Parameters
    ----------
    policy : MemoryPolicy
        What to start from: a window network, untrained or trained by DAgger. It stays as it is.
    draw : callable
        ``draw(rng)`` returns a simulator whose robots are at their start. Each update draws a new one.
    updates : int
        How often the robots act, and the networks learn from it.
    hidden : int
        Hidden units of the value function, which reads the window as well.
    seed : int
        Of the worlds, the actions, the minibatches and the value function.
    **settings
        Other keyword arguments of :func:`robonav.deep.ppo_on_rollouts`.

    Returns
    -------
    MemoryPolicy
        The trained policy.

    Raises
    ------
    ValueError, TypeError
        If an argument is out of bounds.

    Examples
    --------
    >>> from robonav.memory import MemoryPolicy, WindowNetwork, ppo_with_window
    >>> from robonav.robot import Encoder, Simulator, crossing_worlds
    >>> policy = MemoryPolicy(WindowNetwork(Encoder().size, k=2, hidden=8, seed=0))
    >>> draw = lambda rng: Simulator(crossing_worlds(4, seed=int(rng.integers(99))), max_steps=30)
    >>> ppo_with_window(policy, draw, updates=2, seed=0).network.k
    2
    """
    network = cast(WindowNetwork, deepcopy(policy.network))
    first = random_network((network.seen, hidden, 1), seed=make_rng(seed, INITIAL))
    learner = replace(policy, network=network, temperature=1.0)

    def act(update: int) -> list[Rollout]:
        """Let the robots of a new simulator act by the policy as it is now."""
        simulator = draw(make_rng(seed, WORLDS, update))
        return act_with_window(simulator, learner, make_rng(seed, EXPLORING, update))

    value = as_module(first)
    ppo_on_rollouts(network.layers, value, act, updates, seed=seed, **settings)
    return replace(policy, network=network)


def act_with_window(
    simulator: Simulator, policy: MemoryPolicy, rng: np.random.Generator
) -> list[Rollout]:
    """Let all robots act until their episodes have ended. A state of the rollouts is a window."""
    memories = Memories(policy.network, policy.encoder, len(simulator))

    def select_actions(
        simulator: Simulator, sensing: Sensing, robots: Actions
    ) -> NDArray[np.int64]:
        """Put what K robots sense into their windows, and draw their actions."""
        _, logits = memories.read(sensing, robots)
        actions = draw_actions(logits, policy.temperature, rng)
        memories.acted(robots, actions)
        return actions

    robots, rows = [], []
    for second in run_episodes(simulator, select_actions, reflex=None):
        before = memories.kept[second.robots]
        after = memories.with_next(second.next_sensing, second.robots)
        seen = (part.flatten(1)[:, : policy.network.seen] for part in (before, after))
        robots.append(second.robots)
        rows.append(columns_of(second, *(part.numpy() for part in seen)))
    return by_robot(np.concatenate(robots), rows, len(simulator))
