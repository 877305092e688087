"""Which of all policies found to keep, by how well they predict the demonstrations (end of section 5.5.4)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from robonav.validation import check_array

from .reward_update import balance


def accuracy(predicted: ArrayLike, shown: ArrayLike) -> float:
    """The share of decisions (M,) that are predicted: the thesis's measure.

    Most of what is shown is to go forward, so that a policy which always does so scores well, and drives into things.
    """
    return float((np.asarray(predicted) == _shown(shown)).mean())


def balanced_accuracy(predicted: ArrayLike, shown: ArrayLike) -> float:
    """The mean, over the actions that were shown, of the share of their decisions (M,) that are predicted.

    One action for everything scores no more than 1 / (number of actions shown).
    """
    own = _shown(shown)
    return float(balance(own, int(own.max()) + 1) @ (np.asarray(predicted) == own))


def _shown(shown: ArrayLike) -> np.ndarray:
    own = check_array("shown", shown, shape=("M",), dtype=np.int64)
    if len(own) == 0:
        raise ValueError("shown must hold at least one decision, got none")
    return own
