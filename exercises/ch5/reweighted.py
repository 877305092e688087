# Exercise 5.5: Samples of another policy.
# 6 points, exercise, about 30 minutes.
# Check it with: robonav check 5.5
r"""Relative-entropy IRL estimates feature expectations under one policy from samples of
another, with the weights $p(\tau) / q(\tau)$. A few very large weights can dominate
the estimate. Make it robust: scale the weights so that their mean is one; clip those
that are larger than a given limit; scale them to sum to one; average the features. Also
return the effective sample size $1 / \sum w_i^2$ of the final weights. Only logarithms
of the probabilities are given, and their absolute values can be large.
"""

import numpy as np
from numpy.typing import NDArray


def reweighted(
    log_p: NDArray[np.float64],
    log_q: NDArray[np.float64],
    features: NDArray[np.float64],
    most: float,
) -> tuple[NDArray[np.float64], float]:
    """Estimate under p from samples of q.

    Parameters
    ----------
    log_p, log_q : (N,), logarithm of each sample's probability under the one policy and
        the other, up to a constant.
    features : (N, k), each sample's features.
    most : what larger weights are lowered to, where the mean weight is one; at least 1.

    Returns
    -------
    (k,) the estimate, and the effective sample size.
    """
    raise NotImplementedError("reweighted is yours to write")
