"""The two costs of chapter 3: squared error (section 3.3.1) and cross-entropy (section 3.4.3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ._checks import checked
from .multilayer_perceptron import (
    Array,
    Gradient,
    Network,
    cross_entropy_gradient,
    squared_error_gradient,
)


def squared_error(output: Array, label: Array) -> Array:
    """Squared-error cost of one example, Eq. (3.6).

    Parameters
    ----------
    output, label : (..., K) arrays
        Outputs of the network, and what they should have been.

    Returns
    -------
    (...) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import squared_error
    >>> float(squared_error(np.array([0.5, 1.0]), np.array([1.0, 1.0])))
    0.125
    """
    cost: Array = ((output - label) ** 2).sum(axis=-1) / 2  # Eq. (3.6)
    return cost


def squared_weights(network: Network) -> float:
    """Return the sum of all squared weights; the biases are left out."""
    return float(sum((weight**2).sum() for weight in network.weights))


@checked
def squared_error_cost(
    network: Network, x: Array, y: Array, *, regularisation: float = 0.0
) -> float:
    """Mean squared-error cost with weight decay, Eq. (3.7).

    Parameters
    ----------
    network : Network
        A single network.
    x : (m, s[0]) array
        Inputs.
    y : (m, s[-1]) array
        Labels in [0, 1].
    regularisation : float
        lambda, at least 0. It acts on the weights, never on the biases.

    Returns
    -------
    float

    Raises
    ------
    ValueError
        If a shape does not fit, there is no example, or a label lies outside [0, 1].

    Examples
    --------
    >>> from robonav.networks import random_network, squared_error_cost
    >>> network = random_network((2, 1), seed=0, spread=0)  # its output is 1/2
    >>> squared_error_cost(network, [[0, 0], [1, 1]], [[0], [1]])
    0.125
    """
    error = squared_error(network.forward(x), y).mean()
    return float(error + regularisation / 2 * squared_weights(network))  # Eq. (3.7)


@checked
def cross_entropy_cost(
    network: Network, x: Array, y: Array, *, regularisation: float = 0.0
) -> float:
    """Mean cross-entropy cost with weight decay, Eq. (3.22).

    Parameters and errors are those of :func:`squared_error_cost`.

    Examples
    --------
    >>> from robonav.networks import cross_entropy_cost, random_network
    >>> network = random_network((2, 1), seed=0, spread=0)  # its output is 1/2
    >>> round(cross_entropy_cost(network, [[0, 0], [1, 1]], [[0], [1]]), 6)
    0.693147
    """
    # Where z > 37, the output p = 1 / (1 + exp(-z)) rounds to 1, and log(1 - p) fails.
    # But -y log p - (1 - y) log(1 - p) is log(1 + exp(z)) - y z, and logaddexp(0, z)
    # computes log(exp(0) + exp(z)) for a z of any size.
    z = network.logits(x)
    error = (np.logaddexp(0, z) - y * z).sum()
    decay = regularisation / 2 * squared_weights(network)
    return float((error + decay) / len(x))  # Eq. (3.22)


@dataclass(frozen=True)
class Objective:
    """A cost to minimise, and its gradient.

    Attributes
    ----------
    cost, gradient : callable
        Functions of (network, x, y, regularisation=), such as :func:`squared_error_cost` and
        :func:`squared_error_gradient`.

    Examples
    --------
    >>> from robonav.networks import CROSS_ENTROPY
    >>> CROSS_ENTROPY.cost.__name__
    'cross_entropy_cost'
    """

    cost: Callable[..., float]
    gradient: Callable[..., Gradient]


SQUARED_ERROR = Objective(squared_error_cost, squared_error_gradient)
CROSS_ENTROPY = Objective(cross_entropy_cost, cross_entropy_gradient)
