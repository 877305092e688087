"""The choice of a policy, by how well each policy predicts the demonstrations (end of section 5.5.4)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from robonav.validation import ArrayArgument

from ._arguments import checked
from .reward_update import inverse_frequency_weights

Score = Callable[[NDArray[np.int64], NDArray[np.int64]], float]
"""``score(predicted, actions)``: how well a policy predicts the demonstrated actions; the best policy is chosen."""


@checked
def accuracy(predicted: ArrayArgument, actions: ArrayArgument) -> float:
    """The share of demonstrated decisions that are predicted: the thesis's measure.

    Most decisions are to go forward, so a policy that always goes forward scores well and collides.

    Parameters
    ----------
    predicted, actions : (M,) array of int
        A policy's actions and the expert's.

    Returns
    -------
    float

    Examples
    --------
    >>> from robonav.nirl import accuracy
    >>> accuracy([0, 0, 0, 0], [0, 0, 0, 1])
    0.75
    """
    return float((predicted == actions).mean())


@checked
def balanced_accuracy(predicted: ArrayArgument, actions: ArrayArgument) -> float:
    """The mean over demonstrated actions of the share of their decisions that are predicted.

    A policy that always takes the same action scores 1 / (number of actions demonstrated).

    Parameters
    ----------
    predicted, actions : (M,) array of int
        A policy's actions and the expert's.

    Returns
    -------
    float

    Examples
    --------
    >>> from robonav.nirl import balanced_accuracy
    >>> balanced_accuracy([0, 0, 0, 0], [0, 0, 0, 1])
    0.5
    """
    weights = inverse_frequency_weights(actions, int(actions.max()) + 1)
    return float(weights @ (predicted == actions))
