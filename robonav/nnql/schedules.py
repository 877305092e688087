"""Exploring less and less: the softmax policy, its greedy limit, the schedule of its temperature (section 4.4.3)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robonav.validation import ArrayArgument

from ._arguments import Schedule, checked, checked_arguments

Array = NDArray[np.float64]


@checked
def softmax_policy(q: ArrayArgument, temperature: ArrayArgument) -> Array:
    """The probabilities of the actions in a state, Eq. (4.7): a softmax, or Boltzmann, policy.

    The largest Q-value is subtracted first. This leaves the quotient as it is and keeps every exponential at 1 or
    below. Chapter 5 has the same policy with the inverse temperature eta = 1 / T in place of T, Eq. (5.10), in
    :func:`robonav.nirl.boltzmann_policy`. Both functions exist because the thesis numbers both equations.

    Parameters
    ----------
    q : (..., A) array
        Q-values of the actions.
    temperature : float or (...) array
        The thesis's T, positive.

    Returns
    -------
    (..., A) array
        Probabilities.

    Raises
    ------
    ValueError
        If a temperature is not positive, or a number is not finite.

    Examples
    --------
    >>> from robonav.nnql import softmax_policy
    >>> softmax_policy([0.9, 0.8, 0.1], 0.1).round(3)
    array([0.731, 0.269, 0.   ])
    """
    behind = q - q.max(axis=-1, keepdims=True)
    with np.errstate(over="ignore"):  # near temperature 0: exp(-inf) is 0
        weights = np.exp(behind / temperature[..., None])
    return weights / weights.sum(axis=-1, keepdims=True)  # Eq. (4.7)


@checked
def greedy_policy(q: ArrayArgument) -> Array:
    """The limit of the softmax policy at temperature 0, Eq. (4.8): the best actions share the probability equally.

    Parameters
    ----------
    q : (..., A) array
        Q-values of the actions.

    Returns
    -------
    (..., A) array
        Probabilities.

    Examples
    --------
    >>> from robonav.nnql import greedy_policy
    >>> greedy_policy([0.9, 0.9, 0.1])
    array([0.5, 0.5, 0. ])
    """
    best = q == q.max(axis=-1, keepdims=True)  # Eq. (4.8)
    return best / best.sum(axis=-1, keepdims=True)


@checked_arguments
def geometric_schedule(schedule: Schedule, fraction: ArrayArgument) -> Array:
    """A quantity that is multiplied by the same factor each episode: ``start (end / start)^fraction``.

    Parameters
    ----------
    schedule : float or pair of floats
        The start and the end, both positive; or one number that stays.
    fraction : float or (...) array
        How much of the training is over, 0 to 1.

    Returns
    -------
    (...) array
        The quantity.

    Raises
    ------
    ValueError, TypeError
        If the start or the end is not positive, or a fraction is not between 0 and 1.

    Examples
    --------
    >>> from robonav.nnql import geometric_schedule
    >>> geometric_schedule((0.8, 0.2), [0.0, 0.5, 1.0])
    array([0.8, 0.4, 0.2])
    """
    start, end = np.broadcast_to(schedule, 2)  # one number stays
    return start * (end / start) ** fraction
