r"""In the chapter value iteration stops when the largest change of a value is small.
MacQueen (1966) used the smallest change as well. Suppose that one sweep changed every
value by at least $m$ and at most $M$; both may be negative. Two facts about the backup
of value iteration tell how far all later sweeps together can still move the values.
Larger values before a sweep never give smaller values after it. And a constant $c$ that
is added to all values before a sweep adds $\gamma c$ to all values after it. Derive
the bounds on a sheet of paper: what can the next sweep change, what the one after it,
and what do all of them add up to? Then write a function that computes a lower and an
upper bound on the optimal values from two successive value tables, as tight as this
argument makes them. If all values change by nearly the same amount, the bounds are
close to each other long before the values have converged.
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
    ### BEGIN SOLUTION
    change = discount / (1 - discount) * (values - previous)
    return values + change.min(), values + change.max()
    ### END SOLUTION
