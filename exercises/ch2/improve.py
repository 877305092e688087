# Exercise 2.2: Improvement where actions tie. 4 points, warm-up, about 10 minutes.
# Check it with: robonav check 2.2
"""Policy improvement that takes any best action can go round in circles when two actions are equally good: each sweep
swaps them for one another, and "the policy did not change" never comes true. Write an improvement step that keeps
the action in hand unless another one is better by *more than* a tolerance. Where it does change, it takes the best
action, the one with the lowest index if several are best.
"""

import numpy as np
from numpy.typing import NDArray


def improve(q: NDArray[np.float64], policy: NDArray[np.int64], tolerance: float) -> NDArray[np.int64]:
    """The improved policy.

    Parameters
    ----------
    q : (S, A), value of each action in each state.
    policy : (S,), the action in hand in each state.
    tolerance : least gain that is worth a change, not counted itself; at least 0.

    Returns
    -------
    (S,), the new action in each state.
    """
    raise NotImplementedError("improve is yours to write")
