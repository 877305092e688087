"""Outcome rates: how episodes end, in per cent."""

from __future__ import annotations

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
