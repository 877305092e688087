"""The forward pass of many networks at once, which differ in their weights but not in their shape."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit

Array = NDArray[np.float64]


def propagate_stack(
    weights: Sequence[Array], biases: Sequence[Array], x: Array
) -> tuple[list[Array], Array]:
    """Forward propagation of a stack of networks; :func:`robonav.networks.propagate` is that of one network.

    Parameters
    ----------
    weights : sequence of (..., s[l + 1], s[l]) arrays
        The leading dimensions are those of the stack.
    biases : sequence of (..., s[l + 1]) arrays
        Of every layer but the input layer.
    x : (..., m, s[0]) array
        Inputs of each network, or (m, s[0]) inputs for all of them.

    Returns
    -------
    a : list of (..., m, s[l]) arrays
        Activations of each layer, the input first.
    z : (..., m, s[-1]) array
        Weighted sums of the output layer.
    """
    a = [x]
    for W, b in zip(weights, biases, strict=True):
        z = a[-1] @ W.swapaxes(-1, -2) + b[..., None, :]
        a.append(expit(z))
    return a, z
