"""Sparse linear equations solved to rounding, by elimination or by a Krylov method."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse import linalg

Floats = NDArray[np.float64]

DIRECT_SOLVE = 1000  # up to this many equations, elimination is fast for any pattern


def solve(equations: sp.csr_array, right: Floats, guess: Floats) -> Floats:
    """Solve a sparse system to rounding: elimination for few equations, else a Krylov method with refinement.

    Elimination fills the matrix where states lead anywhere. The Krylov method does not, and its residual shows how
    well it did. Where it fails, elimination is the last resort.

    Examples
    --------
    >>> import numpy as np
    >>> import scipy.sparse as sp
    >>> from robonav.mdp.linear_solver import solve
    >>> solve(sp.csr_array([[2.0, 0.0], [0.0, 4.0]]), np.array([2.0, 2.0]), np.zeros(2))
    array([1. , 0.5])
    """
    if right.size <= DIRECT_SOLVE:
        return linalg.spsolve(equations.tocsc(), right) if right.size else right
    solution = guess
    for _ in range(6):
        missing = right - equations @ solution
        rounding = np.finfo(float).eps * max(abs(solution).max(), abs(right).max())
        if abs(missing).max() <= 16 * rounding:
            return solution
        step, _ = linalg.bicgstab(
            equations, missing, rtol=1e-10, atol=4 * rounding, maxiter=1000
        )
        if not np.isfinite(step).all():
            break
        solution = solution + step
    return linalg.spsolve(equations.tocsc(), right)


def solve_differences(
    transitions: sp.csr_array, rewards: Floats, discount: float, values: Floats
) -> tuple[Floats, Floats]:
    """Solve V = r + gamma T V up to a constant that all states share, refining ``values`` (S,).

    Near discount 1 values are large, because all states share the mean reward over 1 - gamma. The differences that
    matter then drown in the rounding of the shared part, which is left out here. Rows of ``transitions`` are assumed
    to sum to one exactly.

    Returns
    -------
    differences : (S,) array
        V minus a constant.
    step : (S,) array
        The change that the last refinement still made: the size of the rounding error.
    """
    equations = sp.eye_array(rewards.size, format="csr") - discount * transitions
    differences, step = _centred(values), values
    for _ in range(3):
        missing = _centred(rewards - equations @ differences)
        step = _centred(solve(equations, missing, np.zeros_like(missing)))
        differences = differences + step
    return differences, step


def _centred(numbers: Floats) -> Floats:
    """Numbers around 0: minus the middle between the least and the largest."""
    return numbers - (numbers.min() + numbers.max()) / 2
