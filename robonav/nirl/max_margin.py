"""Maximum margin: the reward under which the expert's lead over the best of the other policies is largest.

For the gaps mu_E - mu_j between the feature expectations of the expert and of other policies, the margin of a reward
theta is the least of the leads theta . (mu_E - mu_j). Two methods find the theta of length 1 at most with the largest
margin: a quadratic program, and subgradient steps (Ratliff et al. 2006).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from robonav.validation import ArrayArgument

from ._arguments import checked
from .max_margin_dual import NO_MARGIN, largest_margin
from .twins import runs

Floats = NDArray[np.float64]


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


def by_dual(expert: ArrayArgument, others: ArrayArgument) -> Margin:
    """The twin of :func:`maximum_margin`: the same result from the dual problem, faster and to more digits."""
    return Margin(*largest_margin(expert - others))


@checked
@runs(by_dual)
def maximum_margin(expert: ArrayArgument, others: ArrayArgument) -> Margin:
    """The weights theta, ||theta|| <= 1, with the largest margin min_j theta . (mu_E - mu_j) (Abbeel and Ng 2004).

    This is a quadratic program in theta and the margin t:

        max t  subject to  theta . (mu_E - mu_j) >= t for all j,  and  ||theta||^2 <= 1.

    Here a general solver for constrained problems, SLSQP, finds the solution. What runs is a twin that solves the dual
    problem (``max_margin_dual.py``); ``inspect.unwrap`` gives the function as written.

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
    gaps = expert - others  # (n, K): row j is mu_E - mu_j

    def leads(x: Floats) -> Floats:  # x holds theta (K,), and the margin t at its end
        return gaps @ x[:-1] - x[-1]  # theta . (mu_E - mu_j) - t

    def room(x: Floats) -> float:
        return 1 - float(x[:-1] @ x[:-1])  # 1 - ||theta||^2

    found = minimize(
        lambda x: -x[-1],  # maximise t
        np.zeros(gaps.shape[1] + 1),
        method="SLSQP",
        constraints=[{"type": "ineq", "fun": part} for part in (leads, room)],  # >= 0
        options={"maxiter": 1000, "ftol": 1e-12},
    )
    theta, margin = found.x[:-1], float(found.x[-1])
    if margin <= NO_MARGIN * abs(gaps).max():  # the expert is a mixture of the others
        return Margin(np.zeros_like(theta), 0.0)
    return Margin(theta, margin)


@checked
def maximum_margin_subgradient(
    expert: ArrayArgument, others: ArrayArgument, *, iterations: int = 10_000
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
    gaps = expert - others
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
