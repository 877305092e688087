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
    ### BEGIN SOLUTION
    means = []
    for features in trajectories:
        weights = discount ** np.arange(len(features))
        means.append(weights @ features / weights.sum())
    return np.mean(means, axis=0)
    ### END SOLUTION
