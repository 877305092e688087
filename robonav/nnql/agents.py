"""What a method makes of a step: in this alone the methods of this chapter differ."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit

from .networks import Array, Networks, Rows
from .schedules import Schedule, geometric_schedule
from .targets import RESCALE, q_targets


@dataclass(frozen=True)
class Transitions:
    """What K robots went through in a step that their policy decided.

    Attributes
    ----------
    inputs, reached : (K, n) what the network reads before and after.
    values : (K, A) Q-values before.
    actions, rewards : (K,) taken and received.
    terminal : (K,) whether the robot has arrived or collided.
    fraction : (K,) how much of the training was over when the episode began, 0 to 1.
    """

    inputs: Array
    values: Array
    actions: NDArray[np.int64]
    rewards: Array
    reached: Array
    terminal: NDArray[np.bool_]
    fraction: Array


class Agent:
    """S networks that learn, or do not: this one does not.

    The networks' outputs, between 0 and 1, are the Q-values.
    """

    def __init__(self, networks: Networks) -> None:
        self.networks = networks

    def values(self, rows: Rows, x: Array) -> Array:
        """Q-values (K, A) by the networks ``rows`` (K,), each for one input of ``x`` (K, n)."""
        q: Array = expit(self.networks.logits(rows, x[:, None])[:, 0])
        return q

    def observe(self, rows: Rows, steps: Transitions) -> None:
        """Learn from one step of each of ``rows``."""

    def close(self, rows: Rows, episodes: Rows) -> None:
        """Learn at the end of an episode: each of ``rows`` has now finished ``episodes`` of them."""

    def state(self) -> dict[str, NDArray]:
        """Copies, by name, of all arrays that training goes on from between episodes."""
        return {"parameters": self.networks.parameters()}

    def restore(self, state: dict[str, NDArray]) -> None:
        """Go on from a :meth:`state`."""
        self.networks.load(np.arange(len(state["parameters"])), state["parameters"])


class NNQLAgent(Agent):
    """Online Q-learning that trains, after each step, on the pairs that this episode has gathered (Algorithm 8).

    Parameters
    ----------
    networks : of S seeds.
    shape : (S, L, n, A): seeds, steps an episode lasts at most, inputs, actions.
    pairs : how many of the latest pairs to train on; 1 is one-step online Q-learning, L is NNQL.
    learning_rate, discount : learning rate and discount of Eq. (4.9).
    gradient_step : sigma of Eq. (4.12).
    rescale : "clip" or "shift", see :data:`robonav.nnql.targets.RESCALE`.
    passes, tolerance : of gradient descent, see :meth:`Networks.descend`.
    """

    def __init__(
        self,
        networks: Networks,
        shape: tuple[int, int, int, int],
        *,
        pairs: int,
        learning_rate: Schedule,
        discount: float,
        gradient_step: Schedule,
        rescale: str,
        passes: int,
        tolerance: float,
    ) -> None:
        super().__init__(networks)
        seeds, steps, inputs, actions = shape
        self.inputs, self.targets = (
            np.empty((seeds, steps, inputs)),
            np.empty((seeds, steps, actions)),
        )
        self.count = np.zeros(seeds, np.int64)
        self.pairs, self.learning_rate, self.discount, self.gradient_step = (
            pairs,
            learning_rate,
            discount,
            gradient_step,
        )
        self.rescale, self.passes, self.tolerance = RESCALE[rescale], passes, tolerance

    def observe(self, rows: Rows, steps: Transitions) -> None:
        """Lines 13 to 16 of Algorithm 8: update the value of the action taken, rescale, keep the pair, train."""
        following = np.where(
            steps.terminal, 0.0, self.values(rows, steps.reached).max(axis=1)
        )
        learning_rate = geometric_schedule(self.learning_rate, steps.fraction)
        q = q_targets(
            steps.values,
            steps.actions,
            steps.rewards,
            following,
            learning_rate=learning_rate,
            discount=self.discount,
        )
        self.inputs[rows, self.count[rows]] = steps.inputs
        self.targets[rows, self.count[rows]] = self.rescale(q)
        self.count[rows] += 1
        last = self.count[rows]
        self.networks.descend(
            rows, self.inputs, self.targets, np.maximum(last - self.pairs, 0), last,
            gradient_step=geometric_schedule(self.gradient_step, steps.fraction),
            passes=self.passes, tolerance=self.tolerance,
        )  # fmt: skip

    def close(self, rows: Rows, episodes: Rows) -> None:
        """Line 6: the next episode gathers its own pairs."""
        self.count[rows] = 0
