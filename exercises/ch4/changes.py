# Exercise 4.6: When changes cancel.
# 3 points, warm-up, about 10 minutes.
# Check it with: robonav check 4.6
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
    raise NotImplementedError("changes is yours to write")
