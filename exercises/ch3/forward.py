# Exercise 3.1: A network whose outputs are probabilities.
# 4 points, warm-up, about 15 minutes.
# Check it with: robonav check 3.1
r"""Each output of the chapter's network has a sigmoid of its own, so its five outputs
need not add up to one. Write the forward pass of a network whose outputs are
probabilities: hidden layers with the hyperbolic tangent, and in the last layer the
softmax

$$p_k = \frac{e^{z_k}}{\sum_j e^{z_j}}.$$

The weights have the bias in their first column, as in Eq. (3.18). Inputs may be large,
and nothing may overflow.
"""

import numpy as np
from numpy.typing import NDArray


def forward(
    weights: list[NDArray[np.float64]],
    inputs: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return the probabilities of the actions.

    Parameters
    ----------
    weights : one array for each layer, (units, units before + 1), with the bias in
        column 0; any number of layers.
    inputs : (M, n), one state in each row, without the bias unit.

    Returns
    -------
    (M, K), probabilities; each row sums to one.
    """
    raise NotImplementedError("forward is yours to write")
