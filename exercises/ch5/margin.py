# Exercise 5.4: Max margin as a game. 10 points, project, about 120 minutes.
# Check it with: robonav check 5.4
"""An evening's project: max margin with weights that one can read. Of all rewards $r = \\theta \\cdot f$ whose weights
are not negative and sum to one, find one that makes the expert beat the policies found so far by most: the
$\\theta$ for which the least of $\\theta \\cdot (\\mu_E - \\mu_j)$ over the policies $j$ is greatest. This is a
game of two players, the one choosing weights, the other a policy, and it can be solved by letting both learn:
multiplicative weights, for instance, or a linear program written out by hand. There may be several best $\\theta$;
any of them will do, and the margin may fall short of the best by a hundredth of the largest number in the
differences.
"""

import numpy as np
from numpy.typing import NDArray


def margin(expert: NDArray[np.float64], found: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weights of the reward with the greatest margin.

    Parameters
    ----------
    expert : (k,), the expert's feature expectations.
    found : (n, k), those of the policies found so far, one at least.

    Returns
    -------
    (k,), weights of the features, not negative and with sum one.
    """
    raise NotImplementedError("margin is yours to write")
