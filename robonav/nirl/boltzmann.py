"""The stochastic policy over action values, Eq. (5.10)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array, check_real

Floats = NDArray[np.float64]


def boltzmann(action_values: ArrayLike, eta: float) -> Floats:
    """P(a | s) in proportion to exp(eta Q(s, a)), (..., A): Eq. (5.10).

    eta = 0 takes every action alike; the larger eta, the surer the best one. Eq. (5.10) writes the sum over the
    action values of the state taken; it runs over the actions. Chapter 4's temperature is 1 / eta.

    Parameters
    ----------
    action_values : (..., A).
    eta : at least 0.
    """
    z = check_real("eta", eta, at_least=0) * check_array("action_values", action_values)
    weights = np.exp(z - z.max(axis=-1, keepdims=True))
    return weights / weights.sum(axis=-1, keepdims=True)
