"""What a network is to answer: Q-learning's targets, their way into [0, 1], and the cost (section 4.4.4)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def q_targets(
    q: Array,
    actions: NDArray[np.int64],
    rewards: Array,
    next_values: Array,
    *,
    learning_rate: float | Array,
    discount: float,
) -> Array:
    """Q-values (N, A) after one update, Eq. (4.9): that of the action taken moves, the others stay.

    Parameters
    ----------
    q : values (N, A) in the states left.
    actions : (N,) taken there.
    rewards : (N,) received.
    next_values : (N,) greatest value in the states reached; 0 where the episode ended.
    learning_rate : learning rate, a number or (N,), 0 to 1.
    discount : gamma, 0 to 1.
    """
    updated, taken = q.copy(), (np.arange(len(q)), actions)
    updated[taken] += learning_rate * (rewards + discount * next_values - q[taken])
    return updated


def clip(q: Array) -> Array:
    """Q-values outside [0, 1] at the nearer end."""
    return q.clip(0.0, 1.0)


def shift(q: Array) -> Array:
    """Rows (N, A) of Q-values that leave [0, 1] shifted and divided until they fit; the order of actions stays."""
    low = np.minimum(q.min(axis=1, keepdims=True), 0.0)
    high = np.maximum(q.max(axis=1, keepdims=True), 1.0)
    return (q - low) / (high - low)


RESCALE: dict[str, Callable[[Array], Array]] = {"clip": clip, "shift": shift}
"""Two readings of the thesis's "rescale"."""


def cross_entropy(targets: ArrayLike, logits: ArrayLike) -> Array:
    """The cost J (...) of Eq. (4.11), with ``log(1 - Q)`` where the thesis prints ``1 - log Q``.

    From the logits z of Q, so that no logarithm meets a zero: ``log(1 + exp(z)) - target z``, summed over the actions.

    Parameters
    ----------
    targets : rescaled values (..., A) in [0, 1].
    logits : (..., A), before the sigmoid.
    """
    z = np.asarray(logits, dtype=float)
    return (np.logaddexp(0.0, z) - np.asarray(targets) * z).sum(axis=-1)
