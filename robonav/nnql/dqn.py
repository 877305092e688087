"""What came after: the deep Q-network (Mnih et al. 2015) with the double estimator (van Hasselt et al. 2016)."""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy
from functools import partial
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_integer, check_positive, check_real

from .agents import Agent, Transitions
from .networks import Array, Networks, Rows
from .replay_buffer import ReplayBuffer
from .schedules import Schedule
from .trainer import REPLAYING, NavigationTask, make_rng
from .training import Common, TrainingResult, run_training

_MOMENTS = (0.9, 0.999)  # Adam's, as Kingma and Ba (2015) have them


class DQNAgent(Agent):
    """Trains, after each step, on steps drawn from all that were ever made; its outputs are linear.

    Parameters
    ----------
    networks, target : of S seeds; ``target`` is a copy, which stands still between refreshes.
    seeds : (S,).
    inputs : n.
    discount : gamma.
    gradient_step : of Adam.
    batch_size : steps drawn for an update.
    target_update_interval : updates after which the target network becomes the network.
    """

    def __init__(
        self,
        networks: Networks,
        target: Networks,
        seeds: tuple[int, ...],
        inputs: int,
        *,
        discount: float,
        gradient_step: float,
        batch_size: int,
        target_update_interval: int,
    ) -> None:
        super().__init__(networks)
        self.target, self.seeds = target, seeds
        (
            self.discount,
            self.gradient_step,
            self.batch_size,
            self.target_update_interval,
        ) = discount, gradient_step, batch_size, target_update_interval
        self.memory = ReplayBuffer(len(seeds), inputs)
        self.first, self.second = (
            np.zeros_like(networks.parameters()) for _ in range(2)
        )
        self.episodes = np.zeros(len(seeds), np.int64)
        self.draws = [make_rng(seed, REPLAYING, 0) for seed in seeds]

    def values(self, rows: Rows, x: Array) -> Array:
        return self.networks.logits(rows, x[:, None])[:, 0]

    def observe(self, rows: Rows, steps: Transitions) -> None:
        self.memory.append(rows, steps)
        ready = rows[self.memory.count[rows] >= self.batch_size]
        if len(ready):
            updates = self.memory.count[ready] - self.batch_size + 1
            self._update(ready, updates)
            due = ready[updates % self.target_update_interval == 0]
            if len(due):
                self.target.load(due, self.networks.parameters()[due])

    def close(self, rows: Rows, episodes: Rows) -> None:
        """Draw anew, so that training can go on from here without knowing what was drawn before."""
        self.episodes[rows] = episodes
        for row in rows:
            self.draws[row] = make_rng(
                self.seeds[row], REPLAYING, int(self.episodes[row])
            )

    def _update(self, rows: Rows, number: NDArray[np.int64]) -> None:
        """Update ``number`` (K,) of each of ``rows`` (K,): a step of Adam on a batch of its own."""
        drawn = [
            self.draws[row].integers(self.memory.count[row], size=self.batch_size)
            for row in rows
        ]
        x, actions, rewards, reached, terminal = self.memory.draw(rows, np.array(drawn))
        following = double_estimate(self.networks, self.target, rows, reached)
        targets = rewards + self.discount * np.where(terminal, 0.0, following)
        slope, _ = self.networks.slopes(rows, x, actions, targets, linear=True)
        step, self.first[rows], self.second[rows] = adam(
            slope, self.first[rows], self.second[rows], number[:, None]
        )
        self.networks.subtract(rows, self.gradient_step * step)

    def state(self) -> dict[str, NDArray]:
        more = {"target": self.target.parameters()}
        more |= {
            name: getattr(self, name).copy() for name in ("first", "second", "episodes")
        }
        return super().state() | self.memory.state() | more

    def restore(self, state: dict[str, NDArray]) -> None:
        super().restore(state)
        self.memory.restore(state)
        everyone = np.arange(len(self.seeds))
        self.target.load(everyone, state["target"])
        self.first, self.second = state["first"].copy(), state["second"].copy()
        self.close(everyone, state["episodes"])


def double_estimate(
    networks: Networks, target: Networks, rows: Rows, x: Array
) -> Array:
    """What states are worth (K, m) by two networks: one chooses the action, the other says its value.

    A single network that does both takes the maximum of its own errors, and overestimates.

    Parameters
    ----------
    networks, target : the one that chooses and the one that values.
    rows : (K,) which of them.
    x : inputs (K, m, n).
    """
    best = networks.logits(rows, x).argmax(axis=2)
    worth: Array = np.take_along_axis(target.logits(rows, x), best[..., None], axis=2)[
        ..., 0
    ]
    return worth


def adam(
    slope: Array, first: Array, second: Array, number: ArrayLike
) -> tuple[Array, Array, Array]:
    """The direction of Adam (Kingma and Ba 2015, Algorithm 1).

    Parameters
    ----------
    slope : (...) of the cost.
    first, second : (...) moments before this step.
    number : of this step, from 1 on; broadcasts with the slope.

    Returns
    -------
    What to take off the parameters, times the step of gradient descent; both moments after this step.
    """
    (a, b), count = _MOMENTS, np.asarray(number, dtype=float)
    first, second = a * first + (1 - a) * slope, b * second + (1 - b) * slope**2
    return (
        first / (1 - a**count) / (np.sqrt(second / (1 - b**count)) + 1e-8),
        first,
        second,
    )


def dqn(
    seeds: int | Sequence[int] = 16,
    episodes: int = 300,
    *,
    discount: float = 0.7,
    gradient_step: float = 0.003,
    temperature: Schedule = (0.9, 0.1),
    batch_size: int = 32,
    target_update_interval: int = 1000,
    **common: Unpack[Common],
) -> TrainingResult:
    """Deep Q-learning: after each step, one update on a batch drawn from all steps ever made.

    Three things set it apart from online Q-learning: replay, a target network that stands still between refreshes,
    and the double estimator, in which the network chooses the next action and the target network values it. Outputs
    are linear, so that Q needs no rescaling; the loss is Huber's.

    Parameters
    ----------
    seeds : S, or the seeds themselves.
    episodes : E, each in a new world.
    discount : gamma.
    gradient_step : of Adam.
    temperature : T of the Boltzmann policy, Eq. (4.7); a number, or its start and end.
    batch_size : steps drawn for an update.
    target_update_interval : updates between two refreshes of the target network.
    common : see :class:`Common`.

    Raises
    ------
    ValueError, TypeError : if an argument is out of bounds.
    """
    settings: dict[str, Any] = {
        "discount": check_real("discount", discount, at_least=0, at_most=1),
        "gradient_step": check_positive("gradient_step", gradient_step),
        "batch_size": check_integer("batch_size", batch_size, at_least=1),
        "target_update_interval": check_integer(
            "target_update_interval", target_update_interval, at_least=1
        ),
    }
    make = partial(_replaying, settings=settings)
    return run_training(
        "dqn",
        make,
        seeds,
        episodes,
        temperature=temperature,
        settings=settings,
        **common,
    )


def _replaying(
    networks: Networks,
    seeds: tuple[int, ...],
    task: NavigationTask,
    *,
    settings: dict[str, Any],
) -> DQNAgent:
    return DQNAgent(networks, deepcopy(networks), seeds, task.encoder.size, **settings)
