# Exercise 2.7: Planning to the end of a charge.
# 6 points, exercise, about 40 minutes.
# Check it with: robonav check 2.7
"""A robot plans until its battery is empty. The horizon is finite, but it is the charge
that counts down, and not the time. Every action uses a whole number of units of charge,
at least one. An action that needs more units than are left is not possible. The robot
cannot stop of its own accord: the episode ends when no action is possible, and not
before, even if all rewards are negative. Rewards are not discounted. After the end the
value is 0. Compute the largest expected sum of rewards from every state with every
charge.
"""

import numpy as np
from numpy.typing import NDArray


def battery(
    transitions: NDArray[np.float64],
    rewards: NDArray[np.float64],
    costs: NDArray[np.int64],
    charge: int,
) -> NDArray[np.float64]:
    """Optimal values by charge and state.

    Parameters
    ----------
    transitions : (A, S, S), probability of each next state after an action in a state.
    rewards : (S, A), reward of each action in each state.
    costs : (A,), units of charge that each action uses, at least 1.
    charge : units C of a full battery.

    Returns
    -------
    (C + 1, S), row c for c units left.
    """
    raise NotImplementedError("battery is yours to write")
