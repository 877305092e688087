"""DAgger lets the learner drive, asks the expert what it would have done in the states that came up, and learns from
everything gathered so far. Write the gathering for a robot with little memory. The expert is not always there:
advice of $-1$ is none, and teaches nothing. When a state comes up that is in the data already, the newest advice on
it is the one to keep, and it counts as new. When the data outgrow the memory, the oldest go.
"""

import numpy as np
from numpy.typing import NDArray


def aggregate(
    states: NDArray[np.int64],
    labels: NDArray[np.int64],
    visited: NDArray[np.int64],
    advice: NDArray[np.int64],
    capacity: int,
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The data after one more round.

    Parameters
    ----------
    states : (N, k), states in the data, oldest first, all different.
    labels : (N,), the expert's action in each.
    visited : (M, k), states that the learner came through, in order; they may repeat.
    advice : (M,), the expert's action in each, -1 for none.
    capacity : most pairs to keep, at least 1.

    Returns
    -------
    (n, k) states and (n,) labels, oldest first.
    """
    ### BEGIN SOLUTION
    kept = {tuple(state): label for state, label in zip(states.tolist(), labels.tolist())}
    for state, label in zip(visited.tolist(), advice.tolist()):
        if label >= 0:
            kept.pop(tuple(state), None)
            kept[tuple(state)] = label
    newest = list(kept.items())[-capacity:]
    gathered = np.array([state for state, _ in newest], dtype=int).reshape(-1, states.shape[1])
    return gathered, np.array([label for _, label in newest], dtype=int)
    ### END SOLUTION
