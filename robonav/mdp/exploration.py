"""Exploring or exploiting: epsilon-greedy choice, and rates that fall as experience grows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array, check_integer, check_positive, check_real

from .episodes import uniform_stream

Schedule = Callable[[int], float]
"""A rate as a function of how often something has happened before: 0, 1, 2, ..."""


def constant(value: float) -> Schedule:
    """The same rate for ever. Values then never settle, but they can follow a world that changes."""
    _rate("value", value)
    return lambda n: value


def linear_decay(start: float, end: float, over: int) -> Schedule:
    """In equal steps from ``start`` to ``end``, reached at ``over`` and kept."""
    _rate("start", start), _rate("end", end)
    check_integer("over", over, at_least=1)
    return lambda n: start + (end - start) * min(n / over, 1.0)


def exponential_decay(start: float, end: float, half_life: float) -> Schedule:
    """From ``start`` towards ``end``, the gap halving every ``half_life``."""
    _rate("start", start), _rate("end", end)
    check_positive("half_life", half_life)
    return lambda n: end + (start - end) * 0.5 ** (n / half_life)


def harmonic_decay(start: float = 1.0, half_life: float = 1.0) -> Schedule:
    """``start * h / (h + n)``: halved after ``half_life`` = h, and never done falling.

    Its sum is infinite and the sum of its squares is not, which is what the convergence of Q-learning asks of a
    learning rate (Watkins and Dayan 1992). With the defaults it is 1, 1/2, 1/3, ...: the plain average.
    """
    _rate("start", start)
    check_positive("half_life", half_life)
    return lambda n: start * half_life / (half_life + n)


def polynomial_decay(power: float) -> Schedule:
    """``1 / (1 + n) ** power``; a ``power`` in (1/2, 1] makes Q-learning converge, and below 1 it does so sooner.

    With 1 the first, wrong targets weigh as much as the last ones, and a discount near 1 makes that endless; Even-Dar
    and Mansour (2003) find that about 0.77 does best.
    """
    check_real("power", power, above=0)
    return lambda n: (1 + n) ** -power


def schedule(name: str, value: float | Schedule) -> Schedule:
    """A schedule whose rates are checked as they come, or a number as a constant one: all from 0 to 1."""
    if not callable(value):
        return constant(_rate(name, value))

    def checked(n: int) -> float:
        rate = value(n)
        return (
            rate
            if isinstance(rate, float) and 0.0 <= rate <= 1.0
            else _rate(f"{name}({n})", rate)
        )

    return checked


def _rate(name: str, value: Any) -> float:
    """A number from 0 to 1."""
    return check_real(name, value, at_least=0, at_most=1)


def epsilon_greedy(q: ArrayLike, epsilon: float) -> NDArray[np.float64]:
    """The policy, probabilities of shape (..., A): with probability ``epsilon`` any action, else one of the best.

    Parameters
    ----------
    q : action values (..., A); actions of exactly equal value share.
    epsilon : in [0, 1]; 0 is the greedy policy, 1 chooses blindly.
    """
    values = check_array("q", q)
    check_real("epsilon", epsilon, at_least=0, at_most=1)
    best = values == values.max(axis=-1, keepdims=True)
    return epsilon / values.shape[-1] + (1 - epsilon) * best / best.sum(
        axis=-1, keepdims=True
    )


class EpsilonGreedy:
    """Draws actions from :func:`epsilon_greedy`, quickly: ``choose(values)`` with one state's action values (A,).

    ``epsilon`` is a number or a schedule over episodes; :meth:`begin` tells which episode it is.
    """

    def __init__(self, epsilon: float | Schedule, rng: np.random.Generator) -> None:
        self._schedule = schedule("epsilon", epsilon)
        self._draw = uniform_stream(rng).__next__
        self.epsilon = 1.0

    def begin(self, episode: int) -> None:
        """Take the epsilon of this episode."""
        self.epsilon = self._schedule(episode)

    def __call__(self, values: Sequence[Any]) -> int:
        if self._draw() < self.epsilon:
            return int(self._draw() * len(values))
        best = max(values)
        if values.count(best) == 1:
            return values.index(best)
        ties = [action for action, value in enumerate(values) if value == best]
        return ties[int(self._draw() * len(ties))]

    def expected(self, values: Sequence[float]) -> float:
        """The mean of the values under the policy: what SARSA's target is on average."""
        return self.epsilon * sum(values) / len(values) + (1 - self.epsilon) * max(
            values
        )
