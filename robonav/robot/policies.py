"""Baseline policies: rules that have learned nothing, beside which every table shows what learning gains."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .simulator import Action, Sensing

CLEAR_AHEAD = 6.0  # metres


def straight(sensing: Sensing, rng: np.random.Generator) -> NDArray[np.int64]:
    """Always go forward.

    Parameters
    ----------
    sensing : Sensing
        What N robots perceive.
    rng : numpy.random.Generator
        Not used; every policy is handed one.

    Returns
    -------
    (N,) int array
        ``Action.F`` for every robot.

    Examples
    --------
    >>> from robonav.robot import navigate, random_worlds, straight
    >>> float(navigate(straight, random_worlds(100, obstacles=10, seed=1)).success.mean())
    0.34
    """
    return np.full(len(sensing), Action.F)


def turn_to_clearer_side(
    sensing: Sensing, rng: np.random.Generator
) -> NDArray[np.int64]:
    """If something is nearer than 6 m ahead, turn 60 degrees to the side with more room; else go forward.

    A learned policy has to beat this rule of three lines. Its name on the leaderboard is ``freer-side``.

    Parameters
    ----------
    sensing : Sensing
        What N robots perceive.
    rng : numpy.random.Generator
        Not used; every policy is handed one.

    Returns
    -------
    (N,) int array
        Actions.

    Examples
    --------
    >>> from robonav.robot import navigate, random_worlds, turn_to_clearer_side
    >>> worlds = random_worlds(100, obstacles=10, seed=1)
    >>> float(navigate(turn_to_clearer_side, worlds).success.mean())
    0.99
    """
    left = sensing.ranges[:, 1:3].min(axis=1)
    right = sensing.ranges[:, 7:9].min(axis=1)
    turn = np.where(left > right, Action.L60, Action.R60)
    return np.where(sensing.ranges[:, 0] < CLEAR_AHEAD, turn, Action.F)
