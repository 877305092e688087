# Exercise 3.3: Backpropagation with a softmax. 8 points, exercise, about 60 minutes.
# Check it with: robonav check 3.3
"""Backpropagation through the network of exercise 3.1: one hidden layer or more of hyperbolic tangents, softmax at the
end, and the mean cross-entropy with weight decay on everything but the biases,

$$J = -\\frac{1}{m} \\sum_{i=1}^{m} \\log p_{y_i}(x_i) + \\frac{\\lambda}{2 m} \\sum_l \\lVert W^{(l)} \\rVert^2.$$

Two things change against the chapter: the slope of a hidden unit is $1 - h^2$, and the thesis's Eq. (3.27) has
$\\lambda$ where its Eq. (3.22) gives $\\lambda / m$. A good answer agrees with the slope measured by changing a
weight a little.
"""

import numpy as np
from numpy.typing import NDArray


def gradients(
    weights: list[NDArray[np.float64]], inputs: NDArray[np.float64], labels: NDArray[np.int64], decay: float
) -> list[NDArray[np.float64]]:
    """Derivatives of the cost by every weight.

    Parameters
    ----------
    weights : one array a layer, (units, units before + 1), the bias in column 0; two layers or more.
    inputs : (M, n), one state a row, without the bias unit.
    labels : (M,), the index of the right output.
    decay : the lambda above, at least 0.

    Returns
    -------
    A list of arrays with the shapes of ``weights``.
    """
    raise NotImplementedError("gradients is yours to write")
