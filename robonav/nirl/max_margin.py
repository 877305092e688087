"""Maximum margin: the reward under which the expert's lead over the best of the other policies is largest.

Two methods find the same weights: a quadratic program, and subgradient steps (Ratliff et al. 2006).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import nnls

from ._arguments import checked

Floats = NDArray[np.float64]

NO_MARGIN = 1e-7
"""A margin below this share of the largest gap counts as 0."""


@dataclass(frozen=True, eq=False)
class Margin:
    """A reward and the margin by which it prefers the expert.

    Attributes
    ----------
    weights : (K,) array
        theta in the unit ball.
    margin : float
        At least 0.

    Examples
    --------
    >>> from robonav.nirl import Margin, maximum_margin
    >>> isinstance(maximum_margin([1.0], [[0.0]]), Margin)
    True
    """

    weights: Floats
    margin: float


@checked
def maximum_margin(expert: ArrayLike, others: ArrayLike) -> Margin:
    """The weights theta, ||theta|| <= 1, with the largest margin min_j theta . (mu_E - mu_j) (Abbeel and Ng 2004).

    This is a quadratic program. In the form min ||w||^2 subject to w . (mu_E - mu_j) >= 1 it is the least-distance
    problem of Lawson and Hanson (1974, chapter 23). Its dual is a least-squares problem with one non-negative unknown,
    or multiplier, for each policy, which scipy solves. The residual of the solution is proportional to (-w, 1).

    Parameters
    ----------
    expert : (K,) array
        Feature expectations mu_E of the expert.
    others : (n, K) array
        Those of n policies, at least one.

    Returns
    -------
    Margin
        With margin 0 and weights 0 if the expert is a mixture of the others. No reward then prefers it to all of them.

    Examples
    --------
    >>> from robonav.nirl import maximum_margin
    >>> maximum_margin([3.0, 4.0], [[0.0, 0.0]])
    Margin(weights=array([0.6, 0.8]), margin=5.0)
    """
    gaps = np.asarray(expert) - np.asarray(others)
    scale = np.linalg.norm(gaps, axis=1).max()
    if scale == 0:
        return Margin(np.zeros(gaps.shape[1]), 0.0)
    matrix = np.vstack([gaps.T / scale, np.ones(len(gaps))])
    target = np.zeros(len(matrix))
    target[-1] = 1.0
    multipliers, _ = nnls(matrix, target, maxiter=30 * len(gaps) + 100)
    residual = target - matrix @ multipliers
    length = np.linalg.norm(residual[:-1])
    if length <= NO_MARGIN * residual[-1] or residual[-1] <= NO_MARGIN**2:
        return Margin(np.zeros(gaps.shape[1]), 0.0)
    weights = -residual[:-1] / length
    return Margin(weights, max(float((gaps @ weights).min()), 0.0))


@checked
def maximum_margin_subgradient(
    expert: ArrayLike, others: ArrayLike, *, iterations: int = 10_000
) -> Margin:
    """The weights with the largest margin, by projected subgradient ascent (Ratliff et al. 2006).

    Each step moves theta along the gap mu_E - mu_j to the policy with the least lead, and projects it into the unit
    ball. The method is slower and less exact than :func:`maximum_margin`. A step uses one policy only, so the method
    also works if the policies are found one after the other.

    Parameters
    ----------
    expert : (K,) array
        Feature expectations mu_E of the expert.
    others : (n, K) array
        Those of n policies, at least one.
    iterations : int
        Steps. The k-th is the gap divided by sqrt(k) times the length of the largest gap.

    Returns
    -------
    Margin
        The weights with the largest margin of all iterations.

    Examples
    --------
    >>> from robonav.nirl import maximum_margin_subgradient
    >>> maximum_margin_subgradient([3.0, 4.0], [[0.0, 0.0]], iterations=10)
    Margin(weights=array([0.6, 0.8]), margin=5.0)
    """
    gaps = np.asarray(expert) - np.asarray(others)
    scale = np.linalg.norm(gaps, axis=1).max()
    weights = np.zeros(gaps.shape[1])
    best = Margin(weights, 0.0)
    if scale == 0:
        return best
    for k in range(1, iterations + 1):
        leads = gaps @ weights
        rival = int(leads.argmin())
        if leads[rival] > best.margin:
            best = Margin(weights, float(leads[rival]))
        weights = project_to_unit_ball(weights + gaps[rival] / (scale * np.sqrt(k)))
    return best


def project_to_unit_ball(weights: Floats) -> Floats:
    """The nearest weights with ||theta|| <= 1.

    Parameters
    ----------
    weights : array
        theta, of any shape.

    Returns
    -------
    array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import project_to_unit_ball
    >>> project_to_unit_ball(np.array([3.0, 4.0]))
    array([0.6, 0.8])
    """
    length = np.linalg.norm(weights)
    return weights / length if length > 1 else weights
