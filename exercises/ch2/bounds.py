# Exercise 2.3: Two bounds from one sweep. 4 points, exercise, about 20 minutes.
# Check it with: robonav check 2.3
"""Value iteration stops in the chapter when the largest change of a value is small. MacQueen (1966) saw that the
smallest change says something too: if one sweep moved every value by at least $m$ and at most $M$, then all later
sweeps together move them by at least $\\frac{\\gamma}{1 - \\gamma} m$ and at most $\\frac{\\gamma}{1 - \\gamma} M$.
Write a function that turns two successive value tables into a lower and an upper bound on the optimal values. Where
all values move alike, the bounds meet long before the values have settled.
"""

import numpy as np
from numpy.typing import NDArray


def bounds(
    previous: NDArray[np.float64], values: NDArray[np.float64], discount: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Bounds on the optimal values after a sweep of value iteration.

    Parameters
    ----------
    previous : (S,), values before the sweep.
    values : (S,), values after it.
    discount : discount factor in [0, 1).

    Returns
    -------
    (S,) lower bounds and (S,) upper bounds.
    """
    raise NotImplementedError("bounds is yours to write")
