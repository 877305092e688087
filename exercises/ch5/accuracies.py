# Exercise 5.6: The accuracy trap. 3 points, warm-up, about 10 minutes.
# Check it with: robonav check 5.6
"""Three quarters of an expert's actions are "forward". A policy that always goes forward agrees with three quarters of
the demonstrations, and hits the first wall. Compute two measures of agreement: the plain accuracy; and the balanced
one, where each action that the expert did take counts alike, as the mean over those actions of how often the policy
took them when the expert did.
"""

import numpy as np
from numpy.typing import NDArray


def accuracies(shown: NDArray[np.int64], chosen: NDArray[np.int64], number: int) -> tuple[float, float]:
    """Plain and balanced accuracy.

    Parameters
    ----------
    shown : (N,), the expert's actions, 0 to ``number`` - 1; one at least.
    chosen : (N,), the policy's actions in the same states.
    number : of actions there are. An action that the expert never took counts in neither measure.

    Returns
    -------
    The plain and the balanced accuracy, each from 0 to 1.
    """
    raise NotImplementedError("accuracies is yours to write")
