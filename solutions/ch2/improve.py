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
    ### BEGIN SOLUTION
    current = q[np.arange(len(q)), policy]
    better = q.max(axis=1) - current > tolerance
    return np.where(better, q.argmax(axis=1), policy)
    ### END SOLUTION
