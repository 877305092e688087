# Exercise 2.8: Optimism in the face of the unknown. 10 points, project, about 120 minutes.
# Check it with: robonav check 2.8
"""An evening's project: R-max (Brafman and Tennenholtz, 2002), learning that explores because it is optimistic. From
the steps seen so far, estimate a model by counting; believe it only for the pairs of state and action that were
tried often enough, and take every other pair to be as good as anything could be, worth $r_{max} / (1 - \\gamma)$.
Then plan in this model to the end. Whoever acts greedily on the result goes where the model is not known yet, until
it is.
"""

import numpy as np
from numpy.typing import NDArray


def explorer(
    steps: NDArray[np.int64],
    rewards: NDArray[np.float64],
    terminated: NDArray[np.bool_],
    size: tuple[int, int],
    enough: int,
    most: float,
    discount: float,
) -> NDArray[np.float64]:
    """Action values of the optimistic model.

    Parameters
    ----------
    steps : (N, 3), state, action and next state of each step seen.
    rewards : (N,), its reward.
    terminated : (N,), whether the episode ended with it; nothing follows then.
    size : numbers of states S and of actions A.
    enough : tries after which a pair counts as known, at least 1.
    most : the largest reward there is.
    discount : discount factor in [0, 1).

    Returns
    -------
    (S, A), values of the pairs in the model, exact to 1e-8: the mean of what was seen for known pairs,
    ``most / (1 - discount)`` for the others.
    """
    raise NotImplementedError("explorer is yours to write")
