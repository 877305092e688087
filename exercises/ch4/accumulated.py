# Exercise 4.4: An episode of NNQL by hand. 8 points, exercise, about 45 minutes.
# Check it with: robonav check 4.4
"""What sets the chapter's NNQL apart is that after each step it trains on all pairs of the episode so far, with the
targets as they were computed when each pair was new (Algorithm 8). Follow one recorded episode with a learner
simple enough to check by hand: linear, $Q(s, a) = w_a \\cdot \\phi(s)$, with weights zero at first. After each step
compute the new pair's target, the reward plus the discounted best value of the next state under the weights as they
are. Then go once through all pairs so far, oldest first, and move each pair's $w_a$ by
$\\sigma \\, (\\text{target} - w_a \\cdot \\phi(s)) \\, \\phi(s)$.
"""

import numpy as np
from numpy.typing import NDArray


def accumulated(
    features: NDArray[np.float64],
    actions: NDArray[np.int64],
    rewards: NDArray[np.float64],
    ended: bool,
    number: int,
    discount: float,
    gradient_step: float,
) -> NDArray[np.float64]:
    """The weights after an episode.

    Parameters
    ----------
    features : (T + 1, k), features of each state before a step, and of the one after the last.
    actions, rewards : (T,), action and reward of each step.
    ended : whether nothing follows the last step.
    number : of actions A.
    discount : discount factor in [0, 1].
    gradient_step : the step size sigma.

    Returns
    -------
    (A, k), one row of weights for each action.
    """
    raise NotImplementedError("accumulated is yours to write")
