# Exercise 3.5: What is worth learning from. 3 points, warm-up, about 15 minutes.
# Check it with: robonav check 3.5
"""Most of a demonstration is easy going: nothing in sight, the robot makes for its target. The chapter keeps only the
*effective* pairs, those where a sensor detects something. Go one step further. A robot that follows a wall repeats
itself: of effective pairs that come one right after another and are equal in state and action, keep the first. Do
this within the effective pairs, after the others are gone.
"""

import numpy as np
from numpy.typing import NDArray


def effective(states: NDArray[np.int64], actions: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The effective pairs without repeats.

    Parameters
    ----------
    states : (T, 11), states of one demonstration as in Eq. (3.17): nine degrees of danger, then region and target seen.
    actions : (T,), the action taken in each.

    Returns
    -------
    (n, 11) states and (n,) actions, in their order.
    """
    raise NotImplementedError("effective is yours to write")
