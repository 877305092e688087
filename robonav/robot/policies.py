"""Baseline policies that learn nothing: what a learned policy has to beat."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .simulator import Action, Sensing

NEAR = 6.0  # metres ahead at which the second baseline turns


def straight(sensing: Sensing, rng: np.random.Generator) -> NDArray[np.int64]:
    """Return the action F for every robot: the first baseline beside every table.

    Parameters
    ----------
    sensing : Sensing
        What N robots sense.
    rng : Generator
        Not used.

    Returns
    -------
    (N,) array of int

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot import random_worlds, Simulator, straight
    >>> straight(Simulator(random_worlds(2, seed=1)).sense(), np.random.default_rng(0))
    array([0, 0])
    """
    return np.full(len(sensing), Action.F)


def turn_to_clearer_side(
    sensing: Sensing, rng: np.random.Generator
) -> NDArray[np.int64]:
    """Turn 60 degrees to the side with more room if something is near ahead, else go forward: the second baseline.

    Parameters
    ----------
    sensing : Sensing
        What N robots sense.
    rng : Generator
        Not used.

    Returns
    -------
    (N,) array of int

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot import random_worlds, Simulator, turn_to_clearer_side
    >>> sensing = Simulator(random_worlds(2, obstacles=0, seed=1)).sense()
    >>> turn_to_clearer_side(sensing, np.random.default_rng(0))
    array([0, 0])
    """
    left = sensing.ranges[:, 1:3].min(axis=1)
    right = sensing.ranges[:, 7:9].min(axis=1)
    turn = np.where(left > right, Action.L60, Action.R60)
    return np.where(sensing.ranges[:, 0] < NEAR, turn, Action.F)
