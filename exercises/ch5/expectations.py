# Exercise 5.1: Feature expectations that can be compared.
# 5 points, exercise, about 20 minutes.
# Check it with: robonav check 5.1
r"""Equation (5.13) adds up discounted features. If these are not negative, a longer
trajectory has larger feature expectations, and two experts with trajectories of
different lengths cannot be compared. Compute the discounted *mean* instead. In each
trajectory the weights are $\gamma^t$, $t = 0, 1, \ldots$, divided by their sum. Then
take the mean over the trajectories, with equal weights. A feature that is always 1 must
have the expectation 1.
"""

import numpy as np
from numpy.typing import NDArray


def expectations(
    trajectories: list[NDArray[np.float64]],
    discount: float,
) -> NDArray[np.float64]:
    """Mean features of an expert.

    Parameters
    ----------
    trajectories : one array (T_i, k) each, the features of its steps; none is empty.
    discount : discount factor in [0, 1], 1 included.

    Returns
    -------
    (k,), the discounted mean features.
    """
    raise NotImplementedError("expectations is yours to write")
