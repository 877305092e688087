# Exercise 5.3: Which policy to draw.
# 4 points, exercise, about 20 minutes.
# Check it with: robonav check 5.3
"""Apprenticeship learning by projection keeps one point: the feature expectations of a
mixture of the policies found so far, as near to the expert's as possible. When a new
policy is found, the point moves along the segment towards the new policy's feature
expectations, to the place that is nearest to the expert's. But a robot cannot drive a
point. What it can do is draw one of the policies before each episode, each with its own
probability; the feature expectations of this mixture are the weighted mean of the
policies'. Find the probabilities after a new policy was found.

Features have different units: divide each by its scale before you measure a distance.
If the feature expectations of the new policy are those of the mixture so far, the new
policy gets the probability zero.
"""

import numpy as np
from numpy.typing import NDArray


def projected(
    weights: NDArray[np.float64],
    found: NDArray[np.float64],
    expert: NDArray[np.float64],
    scale: NDArray[np.float64],
) -> tuple[NDArray[np.float64], float]:
    """The mixture after a new policy was found.

    Parameters
    ----------
    weights : (n,), probability of each policy in the mixture so far; they sum to one.
    found : (n + 1, k), feature expectations of these policies, and of the new one in
        the last row.
    expert : (k,), feature expectations of the expert.
    scale : (k,), what each feature is divided by before distances are taken, positive.

    Returns
    -------
    (n + 1,) probabilities of the policies, and the distance that remains between the
    new mixture and the expert, in scaled features.
    """
    raise NotImplementedError("projected is yours to write")
