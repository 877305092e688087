"""Trying things out, less and less: the Boltzmann policy and falling schedules (section 4.4.3)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array, check_real

Array = NDArray[np.float64]

Schedule = float | tuple[float, float]
"""A number, or what it is at the start and at the end of training."""


def softmax_policy(q: ArrayLike, temperature: ArrayLike) -> Array:
    """Probabilities of the actions, Eq. (4.7): ``exp(Q / T)`` over its sum.

    The largest Q is subtracted first, which leaves the quotient as it is and every exponential within 1.
    At temperature 0 the best action, or equally good ones, take all: Eq. (4.8).

    Parameters
    ----------
    q : values (..., A) of the actions.
    temperature : T, at least 0; a number or (...).

    Raises
    ------
    ValueError : if a temperature is negative, or a number not finite.
    """
    values, t = check_array("q", q), check_array("temperature", temperature)
    if t.size and t.min() < 0:
        raise ValueError(f"temperature must be at least 0, got {t.min():g}")
    behind = values - values.max(axis=-1, keepdims=True)
    t = np.broadcast_to(t, values.shape[:-1])[..., None]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        weights = np.where(
            behind == 0, 1.0, np.exp(behind / t)
        )  # 0 / 0 at temperature 0 is a best action
    return weights / weights.sum(axis=-1, keepdims=True)


def geometric_schedule(span: Schedule, fraction: ArrayLike) -> Array:
    """A quantity that falls by the same factor each episode: ``start (end / start)^fraction``.

    Parameters
    ----------
    span : start and end, both positive; or one number that stays.
    fraction : (...) how much of the training is over, 0 to 1.
    """
    start, end = span if isinstance(span, tuple) else (span, span)
    return start * (end / start) ** np.asarray(fraction, dtype=float)


def check_schedule(name: str, value: Any, *, at_most: float = np.inf) -> Schedule:
    """A positive number, or a pair of them, as start and end."""
    if isinstance(value, tuple | list):
        if len(value) != 2:
            raise ValueError(
                f"{name} must be a number, or its start and end, got {len(value)} numbers"
            )
        start, end = (
            check_real(name, part, above=0, at_most=at_most) for part in value
        )
        return start, end
    return check_real(name, value, above=0, at_most=at_most)
