"""Exploration: epsilon-greedy choice, and rates that fall with experience."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_integer, check_positive, check_real

from ._arguments import checked
from .episodes import UniformNumbers

Schedule = Callable[[int], float]
"""A rate as a function of the number of earlier events: 0, 1, 2, ..."""


def constant(value: float) -> Schedule:
    """Keep the same rate. Values then never converge, but they can follow an environment that changes."""
    _rate("value", value)
    return partial(_constant, value)


def linear_decay(start: float, end: float, over: int) -> Schedule:
    """Fall (or rise) in equal steps from ``start`` to ``end``, which is reached after ``over`` events and kept.

    Parameters
    ----------
    start, end : float
        The first rate and the last.
    over : int
        Number of events until the last rate is reached.

    Returns
    -------
    callable
        The rate of the n-th event, ``rate(n)``, counted from 0.

    Examples
    --------
    >>> from robonav.mdp import linear_decay
    >>> [linear_decay(1.0, 0.0, over=4)(n) for n in range(6)]
    [1.0, 0.75, 0.5, 0.25, 0.0, 0.0]
    """
    _rate("start", start), _rate("end", end)
    check_integer("over", over, at_least=1)
    return partial(_linear, start, end, over)


def exponential_decay(start: float, end: float, half_life: float) -> Schedule:
    """Move from ``start`` towards ``end``; the gap halves every ``half_life`` events.

    Parameters
    ----------
    start, end : float
        The first rate, and the one that the rates tend to.
    half_life : float
        Number of events in which the gap halves.

    Returns
    -------
    callable
        The rate of the n-th event, ``rate(n)``, counted from 0.

    Examples
    --------
    >>> from robonav.mdp import exponential_decay
    >>> [exponential_decay(1.0, 0.0, half_life=1)(n) for n in range(4)]
    [1.0, 0.5, 0.25, 0.125]
    """
    _rate("start", start), _rate("end", end)
    check_positive("half_life", half_life)
    return partial(_exponential, start, end, half_life)


def harmonic_decay(start: float = 1.0, half_life: float = 1.0) -> Schedule:
    """Fall as ``start * h / (h + n)``: the rate is halved after ``half_life`` = h events.

    The sum of the rates is infinite and the sum of their squares is finite, as the convergence of Q-learning requires
    (Watkins and Dayan 1992). With the defaults the rates are 1, 1/2, 1/3, ...: the plain average.

    Parameters
    ----------
    start : float
        The first rate.
    half_life : float
        Number of events after which the rate is half the first.

    Returns
    -------
    callable
        The rate of the n-th event, ``rate(n)``, counted from 0.

    Examples
    --------
    >>> from robonav.mdp import harmonic_decay
    >>> [harmonic_decay()(n) for n in (0, 1, 3)]
    [1.0, 0.5, 0.25]
    """
    _rate("start", start)
    check_positive("half_life", half_life)
    return partial(_harmonic, start, half_life)


def polynomial_decay(power: float) -> Schedule:
    """Fall as ``1 / (1 + n) ** power``. A ``power`` in (1/2, 1] makes Q-learning converge, faster below 1.

    With a power of 1 the first, wrong targets weigh as much as the last ones, which slows learning down greatly for a
    discount near 1. Even-Dar and Mansour (2003) find that about 0.77 is best.

    Parameters
    ----------
    power : float
        Positive.

    Returns
    -------
    callable
        The rate of the n-th event, ``rate(n)``, counted from 0.

    Examples
    --------
    >>> from robonav.mdp import polynomial_decay
    >>> [polynomial_decay(0.5)(n) for n in (0, 3)]
    [1.0, 0.5]
    """
    check_real("power", power, above=0)
    return partial(_polynomial, power)


# The rates themselves. Functions of a module can be pickled, and so sent to other processes; functions made inside
# another function cannot.


def _constant(value: float, n: int) -> float:
    return value


def _linear(start: float, end: float, over: int, n: int) -> float:
    return start + (end - start) * min(n / over, 1.0)


def _exponential(start: float, end: float, half_life: float, n: int) -> float:
    return end + (start - end) * 0.5 ** (n / half_life)


def _harmonic(start: float, half_life: float, n: int) -> float:
    return start * half_life / (half_life + n)


def _polynomial(power: float, n: int) -> float:
    return (1 + n) ** -power


def schedule(name: str, value: float | Schedule | None) -> Schedule:
    """A schedule whose rates, all in [0, 1], are checked when used; a number becomes a constant schedule."""
    if not callable(value):
        return constant(_rate(name, value))

    def checked(n: int) -> float:
        """The rate of an event, checked."""
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


@checked
def epsilon_greedy(q: ArrayLike, epsilon: float) -> NDArray[np.float64]:
    """Epsilon-greedy policy: with probability ``epsilon`` a random action, otherwise one of the best.

    Parameters
    ----------
    q : (..., A) array
        Action values; actions of exactly equal value share their probability.
    epsilon : float
        In [0, 1]: 0 is the greedy policy, 1 chooses at random.

    Returns
    -------
    (..., A) array
        The probability of each action.

    Examples
    --------
    >>> from robonav.mdp import epsilon_greedy
    >>> epsilon_greedy([1.0, 3.0], epsilon=0.2)
    array([0.1, 0.9])
    """
    values = np.asarray(q)
    best = values == values.max(axis=-1, keepdims=True)
    return epsilon / values.shape[-1] + (1 - epsilon) * best / best.sum(
        axis=-1, keepdims=True
    )


def epsilon_greedy_action(
    q: Sequence[float], epsilon: float, rng: UniformNumbers
) -> int:
    """Draw an action: with probability ``epsilon`` any of them, otherwise one of the best.

    It follows the probabilities of :func:`epsilon_greedy`.

    Parameters
    ----------
    q : list of A floats
        Action values of one state.
    epsilon : float
        In [0, 1].
    rng : UniformNumbers or numpy.random.Generator
        Its ``random()`` decides whether to explore, and then draws the random action or one of several best actions.

    Returns
    -------
    int

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.mdp.exploration import epsilon_greedy_action
    >>> epsilon_greedy_action([1.0, 3.0, 2.0], 0.0, np.random.default_rng(0))
    1
    """
    if rng.random() < epsilon:
        return int(rng.random() * len(q))
    best = max(q)
    if q.count(best) == 1:
        return q.index(best)
    ties = [action for action, value in enumerate(q) if value == best]
    return ties[int(rng.random() * len(ties))]
