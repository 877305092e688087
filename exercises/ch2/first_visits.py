# Exercise 2.6: Returns after first visits. 5 points, exercise, about 30 minutes.
# Check it with: robonav check 2.6
"""Monte Carlo prediction averages the returns that followed a state. Taken at its first visit in each episode only,
the returns of different episodes are independent, and their mean is unbiased. Write first-visit prediction from
recorded episodes; say for each state how many episodes visited it, too, and leave the value of an unvisited one at
zero.
"""

import numpy as np
from numpy.typing import NDArray


def first_visits(
    states: list[list[int]], rewards: list[list[float]], discount: float, size: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Mean return after the first visit to each state.

    Parameters
    ----------
    states : for each episode the states it went through, in order; the last one, where nothing was done, is left out.
    rewards : for each episode the reward on leaving each of these states.
    discount : discount factor in [0, 1].
    size : number of states S.

    Returns
    -------
    (S,) mean discounted return from the first visit on, and (S,) number of episodes that visited the state.
    """
    raise NotImplementedError("first_visits is yours to write")
