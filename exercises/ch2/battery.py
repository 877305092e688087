# Exercise 2.7: Planning to the end of a charge. 6 points, exercise, about 40 minutes.
# Check it with: robonav check 2.7
"""A robot with a battery plans to the end of its charge. Every action uses up a whole number of units, at least one;
an action that needs more than is left cannot be taken, and when none can be taken the run is over. Nothing is
discounted: the horizon is finite, but it is the charge that counts down, not the time. Compute the largest expected
sum of rewards from every state with every charge.
"""

import numpy as np
from numpy.typing import NDArray


def battery(
    transitions: NDArray[np.float64], rewards: NDArray[np.float64], costs: NDArray[np.int64], charge: int
) -> NDArray[np.float64]:
    """Optimal values by charge and state.

    Parameters
    ----------
    transitions : (A, S, S), probability of each next state after an action in a state.
    rewards : (S, A), reward of each action in each state.
    costs : (A,), units of charge that each action uses, at least 1.
    charge : a full battery's units C.

    Returns
    -------
    (C + 1, S), row c for c units left.
    """
    raise NotImplementedError("battery is yours to write")
