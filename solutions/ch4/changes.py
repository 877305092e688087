"""The thesis's Figure 4.3 sums the signed changes of all weights over an episode, and
the thesis takes a sum near zero as a sign of convergence. Show why this is wrong. From
the weights at the beginning and after each episode, compute three measures of change:
the signed sum, in which changes can cancel; the sum of the absolute changes; and the
largest absolute change.
"""

import numpy as np
from numpy.typing import NDArray


def changes(weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Three measures of change for each episode.

    Parameters
    ----------
    weights : (E + 1, n), all weights in a row, before the first episode and after each.

    Returns
    -------
    (E, 3): signed sum, sum of absolute values, largest absolute value of the changes in
    each episode.
    """
    ### BEGIN SOLUTION
    change = np.diff(weights, axis=0)
    return np.column_stack(
        [change.sum(axis=1), np.abs(change).sum(axis=1), np.abs(change).max(axis=1)]
    )
    ### END SOLUTION
