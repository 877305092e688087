# Exercise 2.4: A belief with missing and wrong readings.
# 6 points, exercise, about 30 minutes.
# Check it with: robonav check 2.4
"""A robot's sensor sometimes gives no reading, and sometimes a wrong one. Compute the
belief over a whole episode. In each step the robot moves, and then reads its sensor. A
reading of $-1$ means that there is none: the belief is then the prediction from the
move. If a reading has probability zero in all states that the belief allows, Bayes'
rule would divide by zero. Such a reading is wrong: ignore it.
"""

import numpy as np
from numpy.typing import NDArray


def track(
    belief: NDArray[np.float64],
    transitions: NDArray[np.float64],
    observations: NDArray[np.float64],
    actions: NDArray[np.int64],
    readings: NDArray[np.int64],
) -> NDArray[np.float64]:
    """The belief after an episode.

    Parameters
    ----------
    belief : (S,), probability of each state before the first step.
    transitions : (A, S, S), probability of each next state after an action in a state.
    observations : (A, S, O), probability of each reading in the state after an action.
    actions : (T,), the action of each step.
    readings : (T,), the reading after each step, -1 for none.

    Returns
    -------
    (S,), probability of each state after the last step.
    """
    raise NotImplementedError("track is yours to write")
