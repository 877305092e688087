"""Apprenticeship learning by projection keeps one point, the mixture of the policies
found so far that is nearest to the expert, and moves it towards each new policy.
Features have different units, so divide every feature by its scale before you compute
distances. Find the point nearest to the expert on the *segment* between the mixture and
the new policy, and the share of the new policy in it. If the two ends of the segment
are the same point, the share is zero.
"""

import numpy as np
from numpy.typing import NDArray


def projected(
    mixture: NDArray[np.float64],
    found: NDArray[np.float64],
    expert: NDArray[np.float64],
    scale: NDArray[np.float64],
) -> tuple[NDArray[np.float64], float]:
    """The mixture after a new policy was found.

    Parameters
    ----------
    mixture, found, expert : (k,), feature expectations of the mixture so far, of the
        new policy, and of the expert.
    scale : (k,), what each feature is divided by before distances are taken, positive.

    Returns
    -------
    (k,) feature expectations of the new mixture, in the features' own units, and the
    new policy's share in it, 0 to 1.
    """
    ### BEGIN SOLUTION
    along, to_expert = (found - mixture) / scale, (expert - mixture) / scale
    length = along @ along
    share = 0.0 if length == 0 else float(np.clip(along @ to_expert / length, 0.0, 1.0))
    return mixture + share * (found - mixture), share
    ### END SOLUTION
