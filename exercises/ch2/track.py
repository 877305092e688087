# Exercise 2.4: A belief through gaps and lies. 6 points, exercise, about 30 minutes.
# Check it with: robonav check 2.4
"""A robot's sensor drops out now and then, and once in a while it lies. Follow the belief over a whole run: in each
step the robot moves, then reads its sensor. A reading of $-1$ stands for none at all: the belief is then only what
the move makes of it. A reading that cannot be where the belief says the robot may be, so that Bayes' rule would
divide by zero, is a lie: treat it as none.
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
    """The belief after a run.

    Parameters
    ----------
    belief : (S,), probability of each state before the first step.
    transitions : (A, S, S), probability of each next state after an action in a state.
    observations : (A, S, O), probability of each reading in the state that an action led to.
    actions : (T,), the action of each step.
    readings : (T,), what was read after each step, -1 for nothing.

    Returns
    -------
    (S,), probability of each state after the last step.
    """
    raise NotImplementedError("track is yours to write")
