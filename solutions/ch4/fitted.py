r"""A larger project: fitted Q iteration, the idea of NFQ (Riedmiller, 2005), with costs
in place of rewards and a linear regression in place of a network, $Q(s, a) = w_a \cdot
\phi(s)$. Every iteration uses all recorded steps. Compute the target of each step with
the weights of the last iteration: its cost plus the discounted *smallest* value of the
next state; the cost alone if the goal was reached; and exactly 1, the largest cost, if
the robot failed. Then fit the weights of each action to the targets of its steps by
ridge regression, which minimises $\sum (w \cdot \phi - \text{target})^2 + \rho
\lVert w \rVert^2$. The weights of an action that was never taken stay zero, and its
value 0 counts like any other.
"""

import numpy as np
from numpy.typing import NDArray


def fitted(
    features: NDArray[np.float64],
    actions: NDArray[np.int64],
    costs: NDArray[np.float64],
    next_features: NDArray[np.float64],
    outcomes: NDArray[np.int64],
    number: int,
    discount: float,
    ridge: float,
    iterations: int,
) -> NDArray[np.float64]:
    """The weights after some iterations.

    Parameters
    ----------
    features, next_features : (N, k), features of the states before and after each step.
    actions, costs : (N,), action and cost of each step.
    outcomes : (N,), 0 if the episode went on after the step, 1 if the goal was reached,
        -1 if the robot failed.
    number : of actions A.
    discount : discount factor in [0, 1].
    ridge : the weight rho of the penalty, positive.
    iterations : how often to compute targets and fit; the weights before the first are
        zero.

    Returns
    -------
    (A, k), one row of weights for each action.
    """
    ### BEGIN SOLUTION
    weights = np.zeros((number, features.shape[1]))
    for _ in range(iterations):
        following = (next_features @ weights.T).min(axis=1)
        targets = np.select(
            [outcomes == 1, outcomes == -1], [costs, 1.0], costs + discount * following
        )
        new = np.zeros_like(weights)
        for action in range(number):
            x, y = features[actions == action], targets[actions == action]
            new[action] = np.linalg.solve(x.T @ x + ridge * np.eye(x.shape[1]), x.T @ y)
        weights = new
    return weights
    ### END SOLUTION
