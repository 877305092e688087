"""The batched twin of :func:`robonav.deep.ppo`: S seeds train at once, each with N actors.

The S N robots step in one simulator, and the networks of all seeds are computed in one call: their parameters have a
leading dimension S. A seed's worlds and its random numbers depend on the seed alone, so that it trains as it would
without the others.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import torch
from numpy.typing import NDArray

from robonav.networks.network_stack import NetworkStack
from robonav.networks.policy import sample_actions
from robonav.nnql.task import EXPLORING, NavigationTask, make_rng
from robonav.robot import Simulator
from robonav.robot._fast import ARRIVED, COLLIDED, NO_REFLEX, RUNNING

from .ppo import Batch, Rollout, actor_seed, advantages, standardised

Rows = NDArray[np.int64]


class StackedModule(torch.nn.Module):
    """S networks of one shape as a torch module: states (S, m, n) in, logits (S, m, outputs) out.

    Parameters
    ----------
    networks : NetworkStack
        Stack (S,) of networks, the first parameters.
    """

    def __init__(self, networks: NetworkStack) -> None:
        super().__init__()
        layers = zip(networks.weights, networks.biases, strict=True)
        self.layers = torch.nn.ParameterList(
            torch.tensor(part) for layer in layers for part in layer
        )

    def forward(self, states: torch.Tensor) -> torch.Tensor:
        """Compute the logits of each network for its own states."""
        weights, biases = self.layers[::2], self.layers[1::2]
        for depth, (weight, bias) in enumerate(zip(weights, biases, strict=True)):
            states = torch.sigmoid(states) if depth else states
            states = torch.baddbmm(bias[:, None], states, weight.mT)
        return states

    def stack(self) -> NetworkStack:
        """Copy the parameters into a stack of networks."""
        parts = [part.detach().numpy().copy() for part in self.layers]
        return NetworkStack(tuple(parts[::2]), tuple(parts[1::2]))


class Actors:
    """N robots for each of S seeds, whose episodes go on from update to update; robot s N + i is actor i of seed s.

    Parameters
    ----------
    task : NavigationTask
        Worlds, robots, reward and encoder.
    seeds : (S,) sequence of int
        The seeds.
    number : int
        N.

    Attributes
    ----------
    ended, arrived : (S,) int arrays
        How many episodes have ended since the last :meth:`act` began, and how many of them at the target.
    """

    def __init__(self, task: NavigationTask, seeds: Sequence[int], number: int) -> None:
        pairs = [(seed, actor) for seed in seeds for actor in range(number)]
        self.task, self.shape = task, (len(seeds), number)
        self.rngs = [make_rng(seed, EXPLORING, actor) for seed, actor in pairs]
        self.world_seeds = [actor_seed(seed, actor) for seed, actor in pairs]
        self.episode = np.zeros(len(pairs), np.int64)
        worlds = task.worlds_at(self.world_seeds, self.episode)
        self.simulator = Simulator(worlds, task.speed, max_steps=task.max_steps)
        self.sensing = self.simulator.sense()

    def act(self, policy: StackedModule, steps: int) -> Rollout:
        """Make T steps with actions drawn from the policies; axes (S, N) follow that of the steps."""
        uniforms = np.array([rng.random(steps) for rng in self.rngs])
        self.ended, self.arrived = np.zeros((2, self.shape[0]), np.int64)
        made = [self._step(policy, uniforms[:, t]) for t in range(steps)]
        parts = (np.array(part) for part in zip(*made, strict=True))
        return Rollout(
            *(
                torch.as_tensor(part.reshape(steps, *self.shape, *part.shape[2:]))
                for part in parts
            )
        )

    def _step(self, policy: StackedModule, uniforms: NDArray[np.float64]) -> tuple:
        """One step of all robots: what :class:`Rollout` holds of it."""
        task, before = self.task, self.sensing
        states = task.encoder(before)
        with torch.no_grad():
            logits = policy(torch.as_tensor(states.reshape(*self.shape, -1)))
        actions = sample_actions(
            logits.softmax(dim=-1).numpy().reshape(len(states), -1), uniforms
        )
        reflexes = np.full(len(states), NO_REFLEX)
        if task.reflex is not None:
            reflexes = task.reflex(before, task.speed)
        decided = reflexes == NO_REFLEX
        after = self.simulator.second(np.where(decided, actions, reflexes))
        outcome = self.simulator.outcome.copy()
        rewards = np.asarray(task.reward(before, after, outcome), dtype=float)
        next_states = task.encoder(after)
        ended = outcome != RUNNING
        self.sensing = after
        if ended.any():
            self._begin(np.flatnonzero(ended), outcome)
        terminal = (outcome == ARRIVED) | (outcome == COLLIDED)
        return states, actions, rewards, next_states, terminal, ended, decided

    def _begin(self, rows: Rows, outcome: NDArray[np.int8]) -> None:
        """Count the episodes of the robots ``rows`` that have ended, and begin their next ones."""
        seeds = rows // self.shape[1]
        np.add.at(self.ended, seeds, 1)
        np.add.at(self.arrived, seeds, outcome[rows] == ARRIVED)
        self.episode[rows] += 1
        worlds = self.task.worlds_at(
            [self.world_seeds[row] for row in rows], self.episode[rows]
        )
        self.simulator.restart(rows, worlds)
        for name, read in vars(self.simulator.sense(rows)).items():
            getattr(self.sensing, name)[rows] = read


def batch_of(
    rollout: Rollout,
    policy: StackedModule,
    value: StackedModule,
    discount: float,
    trace_decay: float,
) -> Batch:
    """Put the steps of each seed in one row (S, N T), one actor after the other."""
    steps, *shape = rollout.actions.shape
    states, next_states = by_seed(rollout.states), by_seed(rollout.next_states)
    actions, decided = by_seed(rollout.actions), by_seed(rollout.decided)
    with torch.no_grad():
        values, next_values = (
            value(seen)[..., 0].reshape(*shape, steps).movedim(-1, 0)
            for seen in (states, next_states)
        )
        found = advantages(
            rollout.rewards, values, next_values, rollout.terminal, rollout.ended,
            discount, trace_decay,
        )  # fmt: skip
        log_policy = policy(states).log_softmax(dim=-1)
        taken = log_policy.gather(-1, actions[..., None])[..., 0]
    return Batch(
        states,
        actions,
        taken,
        standardised(by_seed(found), decided),
        by_seed(found + values),
        decided,
    )


def by_seed(part: torch.Tensor) -> torch.Tensor:
    """Bring (T, S, N, ...) into the order (S, N T, ...)."""
    return part.movedim(0, 2).flatten(1, 2).contiguous()
