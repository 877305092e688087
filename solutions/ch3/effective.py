"""In most steps of a demonstration nothing is in range, and the robot goes to its
target by reflex. The chapter keeps only the *effective* pairs, those in which a sensor
detects something. Here, repetitions are removed as well. (The chapter also leaves out
the steps in which the reflex steps back. Here there are none.) A robot that follows a
wall, for example, has the same state and action many times in a row. First select the
effective pairs. Then, of several effective pairs in a row with equal state and action,
keep only the first. Steps that are not effective may lie between them.
"""

import numpy as np
from numpy.typing import NDArray


def effective(
    states: NDArray[np.int64],
    actions: NDArray[np.int64],
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the effective pairs without repetitions.

    Parameters
    ----------
    states : (T, 11), states of one demonstration as in Eq. (3.17): nine degrees of
        danger, then region and target seen.
    actions : (T,), the action taken in each state.

    Returns
    -------
    (n, 11) states and (n,) actions, in their original order.
    """
    ### BEGIN SOLUTION
    near = (states[:, :9] > 0).any(axis=1)
    states, actions = states[near], actions[near]
    same = (states[1:] == states[:-1]).all(axis=1) & (actions[1:] == actions[:-1])
    kept = np.concatenate([[True], ~same])[: len(states)]
    return states[kept], actions[kept]
    ### END SOLUTION
