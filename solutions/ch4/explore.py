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
    ### BEGIN SOLUTION
    values = np.where(allowed, q, -np.inf)
    below = values - values.max(axis=1, keepdims=True)
    best = below == 0
    size = np.abs(np.where(allowed, below, 0.0)).max(axis=1)
    size[size == 0] = 1.0
    low, high = np.log(size) - 60, np.log(size) + 60  # of the logarithm of T
    for _ in range(200):
        middle = (low + high) / 2
        shares = np.exp(below / np.exp(middle)[:, None])
        too_cold = best.sum(axis=1) / shares.sum(axis=1) > share
        low, high = np.where(too_cold, middle, low), np.where(too_cold, high, middle)
    shares = np.exp(below / np.exp(high)[:, None])
    shares[share == 1] = best[share == 1]
    return shares / shares.sum(axis=1, keepdims=True)
    ### END SOLUTION
