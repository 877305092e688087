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
    ### BEGIN SOLUTION
    in_hand = q[np.arange(len(q)), policy]
    better = q.max(axis=1) - in_hand > tolerance
    return np.where(better, q.argmax(axis=1), policy)
    ### END SOLUTION
