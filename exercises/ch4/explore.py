# Exercise 4.1: A temperature for a given share.
# 5 points, exercise, about 25 minutes.
# Check it with: robonav check 4.1
"""A temperature says little by itself: 0.4 is cold for Q-values in the hundreds, and
hot for values between 0 and 1. For each robot you are given something that can be
imagined, the probability with which it takes *a best action*. Find the temperature at
which the softmax policy of Eq. (4.7) does so, and return the policy's probabilities.
Some actions may not be allowed, and have the probability zero.

There is no formula for this temperature, so think first. How does the share of the best
actions change when the temperature rises? What is it at temperature zero, and what for
ever higher temperatures? If the given share cannot be reached, take the policy that
comes nearest to it; a share of 1 is the greedy policy of Eq. (4.8), which divides the
probability equally among the best actions. Q-values may be in the thousands.
"""

import numpy as np
from numpy.typing import NDArray


def explore(
    q: NDArray[np.float64],
    share: NDArray[np.float64],
    allowed: NDArray[np.bool_],
) -> NDArray[np.float64]:
    """Probability of each action.

    Parameters
    ----------
    q : (N, A), action values of N robots.
    share : (N,), probability of all best allowed actions together, above 0, at most 1.
    allowed : (N, A), which actions each robot may take, one at least.

    Returns
    -------
    (N, A), probabilities, exact to 1e-6.
    """
    raise NotImplementedError("explore is yours to write")
