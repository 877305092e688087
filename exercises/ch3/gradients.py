# Exercise 3.3: Backpropagation with a softmax.
# 8 points, exercise, about 60 minutes.
# Check it with: robonav check 3.3
r"""Write backpropagation through the network of exercise 3.1. It has one or more hidden
layers with the hyperbolic tangent and a softmax in the last layer. Its cost is the mean
cross-entropy with weight decay on all weights but the biases,

$$J = -\frac{1}{m} \sum_{i=1}^{m} \log p_{y_i}(x_i)
+ \frac{\lambda}{2 m} \sum_l \lVert W^{(l)} \rVert^2.$$

The chapter's network has a sigmoid in every unit and a cost that is a sum over its
outputs. Work out first, on paper, what the derivative of this cost with respect to
$z_k$ is, and what the derivative of a hidden unit is. You can check your answer: change
one weight a little, and compare the change of the cost with your derivative. As a
replacement for backpropagation such differences are too slow: a network of 4,000
weights and a thousand examples must take less than five seconds.
"""

import numpy as np
from numpy.typing import NDArray


def gradients(
    weights: list[NDArray[np.float64]],
    inputs: NDArray[np.float64],
    labels: NDArray[np.int64],
    decay: float,
) -> list[NDArray[np.float64]]:
    """Return the derivatives of the cost with respect to all weights.

    Parameters
    ----------
    weights : one array for each layer, (units, units before + 1), with the bias in
        column 0; two layers or more.
    inputs : (M, n), one state in each row, without the bias unit.
    labels : (M,), the index of the correct output for each state.
    decay : lambda in the cost, at least 0.

    Returns
    -------
    A list of arrays with the shapes of ``weights``.
    """
    raise NotImplementedError("gradients is yours to write")
