"""In DAgger the learner acts, the expert labels the states that the learner visits, and
the learner is trained on all data aggregated so far. Write the aggregation for a robot
with limited memory. Three rules apply. The expert does not label every state: a label
of $-1$ means that there is none, and such a visit changes nothing in the data. If a
state is visited that is in the data already, its newest label replaces the older one,
and the pair counts as the newest. If there are more pairs than fit into the memory, the
oldest are removed.
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
    """Return the data after one more round.

    Parameters
    ----------
    states : (N, k), the states in the data, oldest first, all different.
    labels : (N,), the expert's action in each of them.
    visited : (M, k), the states that the learner visited, in order; a state may occur
        more than once.
    advice : (M,), the expert's label for each of them: an action, or -1 for none.
    capacity : the largest number of pairs to keep, at least 1.

    Returns
    -------
    (n, k) states and (n,) labels, oldest first.
    """
    ### BEGIN SOLUTION
    kept = {
        tuple(state): label for state, label in zip(states.tolist(), labels.tolist())
    }
    for state, label in zip(visited.tolist(), advice.tolist()):
        if label >= 0:
            kept.pop(tuple(state), None)
            kept[tuple(state)] = label
    newest = list(kept.items())[-capacity:]
    gathered = np.array([state for state, _ in newest], dtype=int).reshape(
        -1, states.shape[1]
    )
    return gathered, np.array([label for _, label in newest], dtype=int)
    ### END SOLUTION
