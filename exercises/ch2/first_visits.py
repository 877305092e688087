# Exercise 2.6: Returns after first visits.
# 5 points, exercise, about 30 minutes.
# Check it with: robonav check 2.6
"""Monte Carlo prediction averages the returns after visits to a state. First-visit
prediction uses only the first visit in each episode. These returns come from different
episodes, and each has the right mean, so their mean is unbiased. Write first-visit
prediction from recorded episodes. Also return for each state the number of episodes
that visited it. The value of a state that no episode visited is zero.
"""

import numpy as np
from numpy.typing import NDArray


def first_visits(
    states: list[list[int]], rewards: list[list[float]], discount: float, size: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Mean return after the first visit to each state.

    Parameters
    ----------
    states : for each episode its states in order, without the last one, in which no
        action was taken.
    rewards : for each episode the reward of the step from each of these states.
    discount : discount factor in [0, 1].
    size : number of states S.

    Returns
    -------
    (S,) mean discounted return from the first visit on, and (S,) number of episodes
    that visited the state.
    """
    raise NotImplementedError("first_visits is yours to write")
