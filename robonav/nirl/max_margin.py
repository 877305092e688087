"""Max-margin: the reward by which the expert is better than every policy found so far, by most.

Two ways to the same weights: as a quadratic program, and by subgradient steps (Ratliff et al. 2006).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import nnls

from robonav.validation import check_array, check_integer

Floats = NDArray[np.float64]

TOUCHING = 1e-7  # of the largest contrast: a smaller margin is none


@dataclass(frozen=True)
class Margin:
    """``weights`` (K,) in the unit ball, and by how much they set the expert apart: ``margin`` >= 0."""

    weights: Floats
    margin: float


def contrasts(expert: ArrayLike, others: ArrayLike) -> Floats:
    """mu_E - mu_j of n policies, (n, K), from mu_E (K,) and mu_j (n, K).

    Raises
    ------
    ValueError : if shapes do not fit or there is no policy.
    """
    mu = check_array("expert", expert, shape=("K",))
    found = check_array("others", others, shape=("n", len(mu)))
    if len(found) == 0:
        raise ValueError(
            "others must hold the feature expectations of at least one policy, got none"
        )
    return mu - found


def maximum_margin(expert: ArrayLike, others: ArrayLike) -> Margin:
    """The weights theta, ||theta|| <= 1, that make the least of theta . (mu_E - mu_j) largest (Abbeel and Ng 2004).

    A quadratic program. Written as min ||w||^2 with w . (mu_E - mu_j) >= 1, it is the least-distance problem of Lawson
    and Hanson (1974, chapter 23), whose dual scipy's non-negative least squares solves exactly.

    Parameters
    ----------
    expert : feature expectations mu_E of the expert, (K,).
    others : of n policies, (n, K).

    Returns
    -------
    Margin; with margin 0 and weights 0 where the expert is a mixture of the others, which no reward sets it above.
    """
    apart = contrasts(expert, others)
    scale = np.linalg.norm(apart, axis=1).max()
    if scale == 0:
        return Margin(np.zeros(apart.shape[1]), 0.0)
    stacked = np.vstack([apart.T / scale, np.ones(len(apart))])
    wanted = np.zeros(len(stacked))
    wanted[-1] = 1.0
    shares, _ = nnls(stacked, wanted, maxiter=30 * len(apart) + 100)
    residual = wanted - stacked @ shares
    reach = np.linalg.norm(residual[:-1])
    if reach <= TOUCHING * residual[-1] or residual[-1] <= TOUCHING**2:
        return Margin(np.zeros(apart.shape[1]), 0.0)
    weights = -residual[:-1] / reach
    return Margin(weights, max(float((apart @ weights).min()), 0.0))


def maximum_margin_subgradient(
    expert: ArrayLike, others: ArrayLike, *, iterations: int = 10_000
) -> Margin:
    """The same by projected subgradient ascent: step towards the closest rival's contrast, back into the unit ball.

    Slower and less exact than :func:`maximum_margin`; it needs nothing but the one worst policy at a time, which is what
    makes it usable where the policies are found by learning.

    Parameters
    ----------
    iterations : steps; the k-th is 1 / sqrt(k) of the largest contrast's length.
    """
    apart = contrasts(expert, others)
    scale = np.linalg.norm(apart, axis=1).max()
    best = Margin(np.zeros(apart.shape[1]), 0.0)
    if scale == 0:
        return best
    weights = best.weights
    for k in range(1, check_integer("iterations", iterations, at_least=1) + 1):
        advantage = apart @ weights
        worst = int(advantage.argmin())
        if advantage[worst] > best.margin:
            best = Margin(weights, float(advantage[worst]))
        weights = project_to_unit_ball(weights + apart[worst] / (scale * np.sqrt(k)))
    return best


def project_to_unit_ball(weights: Floats) -> Floats:
    """The nearest weights with ||theta|| <= 1."""
    length = np.linalg.norm(weights)
    return weights / length if length > 1 else weights
