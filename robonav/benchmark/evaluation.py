"""Outcome rates: how episodes end, in per cent."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.robot import Navigation, Reflex

OUTCOMES = {
    "success": "arrived",
    "collision": "collided",
    "out of steps": "out of steps",
}


EXACT_REFLEX = Reflex("exact")
"""The reflex with which the leaderboard and all committed results were made, whatever the package's default is."""


def outcome_rates(navigation: Navigation) -> dict[str, float]:
    """The share of episodes that arrive, that collide, and that run out of steps.

    Parameters
    ----------
    navigation : Navigation
        The result of :func:`robonav.robot.navigate`.

    Returns
    -------
    dict
        ``success``, ``collision`` and ``out of steps``, in per cent. They add up to 100.

    Examples
    --------
    >>> from robonav.robot import navigate, random_worlds, straight
    >>> outcome_rates(navigate(straight, random_worlds(4, 0, seed=0)))
    {'success': 100.0, 'collision': 0.0, 'out of steps': 0.0}
    """
    return {
        name: 100 * float((navigation.outcome == outcome).mean())
        for name, outcome in OUTCOMES.items()
    }


def pareto_front(points: ArrayLike) -> NDArray[np.bool_]:
    """Which points no other point beats in all criteria at once: the Pareto front.

    Parameters
    ----------
    points : (N, K) array
        K criteria of N methods. A greater number is better.

    Returns
    -------
    (N,) array of bool

    Examples
    --------
    A is best in the first criterion and B in the second; C is beaten by B:

    >>> pareto_front([[95, 70], [90, 80], [89, 75]])
    array([ True,  True, False])
    """
    points = np.asarray(points)
    beats = np.all(points[None] > points[:, None], axis=-1)  # [n, m]: m beats n
    return np.logical_not(np.any(beats, axis=1))
