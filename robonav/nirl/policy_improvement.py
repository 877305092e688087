"""Neural policy iteration: a network that learns what its own actions are worth under a reward (section 5.5.3)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from robonav.networks.backpropagation import cross_entropy_cost, cross_entropy_gradient
from robonav.networks.multilayer_perceptron import Network
from robonav.validation import check_integer, check_positive, check_real

from .transitions import Floats, Steps, joined

SURVIVAL_BONUS = (0.0, 1.0)
"""A collision ends it all with the worst there is, any other end with the best: a reward for survival."""
ZERO_TERMINAL_VALUES = (0.0, 0.0)
"""Whatever ends a drive, nothing more is to be had. With rewards of at least 0 this too rewards survival."""
NEUTRAL_TERMINAL_VALUES = (0.5, 0.5)
"""Any end is worth what the mean reward for ever would be: how a drive ended teaches nothing."""


class Improved(NamedTuple):
    """The network after an improvement, and the cost (5.15) met on the way."""

    network: Network
    cost: float


class Improver(Protocol):
    """Step 10 of Algorithm 10: a better network for a reward, from the drives made so far."""

    def __call__(
        self,
        network: Network,
        drives: Sequence[Steps],
        weights: Floats,
        fraction: float,
        rng: np.random.Generator,
    ) -> Improved:
        """The next network and the cost on the way; ``fraction`` of the training is over."""


def transition_rewards(weights: ArrayLike, steps: Steps) -> Floats:
    """r(s_t, a_t) = theta . f(s_t, a_t), (M,), for weights (A, k + 1): Eq. (5.2) with the blocks of Eq. (5.5)."""
    theta = np.asarray(weights, dtype=float)
    return np.einsum("mk,mk->m", steps.features, theta[steps.actions])


def scale_to_unit_interval(rewards: ArrayLike, *, percentile: float = 95.0) -> Floats:
    """Rewards in [0, 1], with 1/2 where they were 0: divided by a percentile of their size, clipped, shifted.

    An increasing affine map but for the clipping, so that with NEUTRAL_TERMINAL_VALUES ends it changes no preference. All zeros become
    all 1/2.
    """
    r = np.asarray(rewards, dtype=float)
    scale = np.percentile(abs(r), percentile) if r.size else 0.0
    return (np.clip(r / scale, -1, 1) + 1) / 2 if scale > 0 else np.full(r.shape, 0.5)


def sarsa_targets(
    q: ArrayLike,
    rewards: ArrayLike,
    following: ArrayLike,
    *,
    alpha: float,
    discount: float,
) -> Floats:
    """Q(s_t, a_t) + alpha [r + gamma Q(s_t+1, a_t+1) - Q(s_t, a_t)], Eq. (5.16), (M,).

    Parameters
    ----------
    q : values of the actions taken, (M,).
    rewards : r_theta(s_t, a_t), (M,).
    following : Q(s_t+1, a_t+1), (M,); what is left to be had where a drive ended.
    """
    values = np.asarray(q, dtype=float)
    return values + alpha * (
        np.asarray(rewards) + discount * np.asarray(following) - values
    )


@dataclass(frozen=True)
class ReplaySGD:
    """Many small steps an iteration, each for one decision drawn from the last few iterations' drives.

    The network's output is y = (1 - gamma) Q, which lies in [0, 1] when rewards do: nothing is cut off, and the target
    (5.16) becomes y + alpha [(1 - gamma) r + gamma y' - y].

    Attributes
    ----------
    discount : gamma, in [0, 1).
    alpha : of Eq. (5.16).
    rate : sigma at the first and at the last iteration, falling by the same factor each.
    samples : decisions drawn an iteration.
    replay : iterations whose drives are remembered.
    ends : what is left to be had after a collision and after any other end, in [0, 1]: see ``SURVIVAL_BONUS``, ``NEUTRAL_TERMINAL_VALUES``.
    """

    discount: float = 0.65
    alpha: float = 0.8
    rate: tuple[float, float] = (0.4, 0.1)
    samples: int = 9600
    replay: int = 20
    ends: tuple[float, float] = SURVIVAL_BONUS

    def __post_init__(self) -> None:
        check_real("discount", self.discount, at_least=0, below=1)
        check_real("alpha", self.alpha, above=0, at_most=1)
        for rate in self.rate:
            check_positive("rate", rate)
        check_integer("samples", self.samples, at_least=1)
        check_integer("replay", self.replay, at_least=1)
        for end in self.ends:
            check_real("ends", end, at_least=0, at_most=1)

    def __call__(
        self,
        network: Network,
        drives: Sequence[Steps],
        weights: Floats,
        fraction: float,
        rng: np.random.Generator,
    ) -> Improved:
        """The network after ``samples`` steps; ``fraction`` (0 to 1) says how much of the training is over."""
        from . import _fast

        steps = joined(drives[-self.replay :])
        if len(steps) == 0:
            return Improved(network, np.nan)
        rewards = (1 - self.discount) * scale_to_unit_interval(
            transition_rewards(weights, steps)
        )
        ends = np.where(steps.failed[steps.trajectory], *self.ends)
        w1, w2 = (weight.T.copy(order="C") for weight in network.weights)
        b1, b2 = (bias.copy() for bias in network.biases)
        order = rng.integers(len(steps), size=self.samples)
        start, end = self.rate
        cost = _fast.descend(
            w1, b1, w2, b2, steps.inputs, steps.actions, rewards, steps.after, ends, order,
            self.alpha, self.discount, start * (end / start) ** fraction,
        )  # fmt: skip
        return Improved(Network((w1.T, w2.T), (b1, b2)), cost)


@dataclass(frozen=True)
class SingleGradientStep:
    """Algorithm 10 to the letter: one gradient step on the cost (5.15) an iteration, over its own drives alone.

    Targets are (5.16) as it stands, cut off at 0 and 1; nothing follows the last decision of a drive.
    Attributes as in :class:`ReplaySGD`; ``regularisation`` is lambda of Eq. (5.15).
    """

    discount: float = 0.65
    alpha: float = 0.8
    rate: float = 0.4
    regularisation: float = 0.0

    def __call__(
        self,
        network: Network,
        drives: Sequence[Steps],
        weights: Floats,
        fraction: float,
        rng: np.random.Generator,
    ) -> Improved:
        """The network after one step of ``rate`` against the gradient."""
        steps = drives[-1]
        if len(steps) == 0:
            return Improved(network, np.nan)
        outputs, row = network.forward(steps.inputs), np.arange(len(steps))
        q = outputs[row, steps.actions]
        following = np.where(steps.after >= 0, q[steps.after], 0.0)
        targets = outputs.copy()
        targets[row, steps.actions] = sarsa_targets(
            q,
            transition_rewards(weights, steps),
            following,
            alpha=self.alpha,
            discount=self.discount,
        ).clip(0, 1)
        decay = self.regularisation
        slope = cross_entropy_gradient(
            network, steps.inputs, targets, regularisation=decay
        )
        stepped = Network(
            tuple(
                w - self.rate * dw
                for w, dw in zip(network.weights, slope.weights, strict=True)
            ),
            tuple(
                b - self.rate * db
                for b, db in zip(network.biases, slope.biases, strict=True)
            ),
        )
        return Improved(
            stepped,
            cross_entropy_cost(network, steps.inputs, targets, regularisation=decay),
        )
