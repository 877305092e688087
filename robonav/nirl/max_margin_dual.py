"""The fast twin of ``maximum_margin``: the largest margin from the dual of its quadratic program.

The problem is min ||w||^2 subject to w . g_j >= 1, with the gaps g_j = mu_E - mu_j and w = theta / margin: the
least-distance problem of Lawson and Hanson (1974, chapter 23). Its dual has one unknown lambda_j >= 0 for each policy,
and is a least-squares problem, which scipy solves in one call:

    min over lambda >= 0 of  || sum_j lambda_j g_j ||^2 + (1 - sum_j lambda_j)^2.

Let d be the distance from the origin to the hull of the gaps, which is the margin. At the solution the sum of lambda is
1 / (1 + d^2), so that the residual of the last equation is d^2 / (1 + d^2). The residual of the others points from the
expert to the hull: it is -theta times d / (1 + d^2).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

Floats = NDArray[np.float64]

NO_MARGIN = 1e-7
"""A margin below this share of the largest gap counts as 0."""


def largest_margin(gaps: Floats) -> tuple[Floats, float]:
    """The weights theta (K,) with the largest margin, and this margin; zeros if there is none.

    Parameters
    ----------
    gaps : (n, K) array
        mu_E - mu_j for each of n policies.

    Returns
    -------
    weights : (K,) array
    margin : float

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl.max_margin_dual import largest_margin
    >>> largest_margin(np.array([[3.0, 4.0]]))
    (array([0.6, 0.8]), 5.0)
    """
    nothing = np.zeros(gaps.shape[1]), 0.0
    scale = np.linalg.norm(gaps, axis=1).max()
    if scale == 0:
        return nothing
    # K equations sum_j lambda_j g_j = 0, and one sum_j lambda_j = 1
    matrix = np.vstack([gaps.T / scale, np.ones(len(gaps))])
    target = np.zeros(len(matrix))
    target[-1] = 1.0
    multipliers, _ = nnls(matrix, target, maxiter=30 * len(gaps) + 100)
    residual = target - matrix @ multipliers  # (-d theta, d^2) / (1 + d^2)
    length = np.linalg.norm(residual[:-1])
    # with d at most 1 in these units, only rounding makes length smaller than d^2
    if length <= NO_MARGIN * residual[-1] or residual[-1] <= NO_MARGIN**2:
        return nothing
    weights = -residual[:-1] / length
    return weights, max(float((gaps @ weights).min()), 0.0)
