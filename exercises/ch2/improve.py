# Exercise 2.2: Improvement where actions tie.
# 4 points, warm-up, about 10 minutes.
# Check it with: robonav check 2.2
"""If two actions are equally good, policy improvement that takes any best action may
exchange them in every sweep. The policy then never stays the same, and policy iteration
never stops. Write an improvement step that keeps the current action unless another one
is better by *more than* a tolerance. Where it changes the action, it takes the best
one, and the one with the lowest index if several are best.
"""

import numpy as np
from numpy.typing import NDArray


def improve(
    q: NDArray[np.float64],
    policy: NDArray[np.int64],
    tolerance: float,
) -> NDArray[np.int64]:
    """The improved policy.

    Parameters
    ----------
    q : (S, A), value of each action in each state.
    policy : (S,), the current action in each state.
    tolerance : the gain that an action must exceed to replace the current one; at least
        0.

    Returns
    -------
    (S,), the new action in each state.
    """
    raise NotImplementedError("improve is yours to write")
