"""Extend the softmax policy of Eq. (4.7). Some actions may not be allowed, and have
probability zero. The temperature falls over time, differently for each robot, and in
the end it is exactly zero. Eq. (4.8) then divides the probability equally among the
best allowed actions. Q-values in the thousands at a temperature of a thousandth must
not overflow.
"""

import numpy as np
from numpy.typing import NDArray


def explore(
    q: NDArray[np.float64],
    temperature: NDArray[np.float64],
    allowed: NDArray[np.bool_],
) -> NDArray[np.float64]:
    """Probability of each action.

    Parameters
    ----------
    q : (N, A), action values of N robots.
    temperature : (N,), the temperature of each, at least 0.
    allowed : (N, A), which actions each may take, one at least.

    Returns
    -------
    (N, A), probabilities.
    """
    ### BEGIN SOLUTION
    values = np.where(allowed, q, -np.inf)
    below = values - values.max(axis=1, keepdims=True)
    cold = temperature == 0
    shares = np.exp(below / np.where(cold, 1.0, temperature)[:, None])
    shares[cold] = below[cold] == 0
    return shares / shares.sum(axis=1, keepdims=True)
    ### END SOLUTION
