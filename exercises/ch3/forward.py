# Exercise 3.1: A network whose outputs are probabilities. 4 points, warm-up, about 15 minutes.
# Check it with: robonav check 3.1
"""The chapter's network answers with five numbers that need not add up to one, each through a sigmoid of its own. Make
them probabilities: hidden layers with the hyperbolic tangent, and at the end the softmax

$$p_k = \\frac{e^{z_k}}{\\sum_j e^{z_j}}.$$

The weights have the bias in their first column, as in Eq. (3.18). Inputs may be large: nothing must overflow.
"""

import numpy as np
from numpy.typing import NDArray


def forward(weights: list[NDArray[np.float64]], inputs: NDArray[np.float64]) -> NDArray[np.float64]:
    """Probabilities of the actions.

    Parameters
    ----------
    weights : one array a layer, (units, units before + 1), the bias in column 0; any number of layers.
    inputs : (M, n), one state a row, without the bias unit.

    Returns
    -------
    (M, K), each row sums to one.
    """
    raise NotImplementedError("forward is yours to write")
