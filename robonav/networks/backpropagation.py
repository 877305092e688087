"""The two costs of chapter 3 and their gradients by backpropagation (sections 3.3.1 and 3.4.3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from robonav.validation import check_array, check_real, checks

from .multilayer_perceptron import Array, Network, sigmoid_slope


def examples(network: Network, x: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
    """Check training examples for a network and return them as arrays.

    Parameters
    ----------
    network : Network
        A single network.
    x : (m, s[0]) array
        Inputs.
    y : (m, s[-1]) array
        Labels in [0, 1].

    Returns
    -------
    x, y : arrays of float

    Raises
    ------
    ValueError
        If a shape does not fit, there is no example, or a label lies outside [0, 1].
    """
    if network.stack:
        raise ValueError(
            f"network must be a single one, got a stack of shape {network.stack}"
        )
    inputs = check_array("x", x, shape=("m", network.sizes[0]))
    labels = check_array("y", y, shape=(len(inputs), network.sizes[-1]))
    if len(inputs) == 0:
        raise ValueError("x must hold at least one example, got none")
    if labels.min() < 0 or labels.max() > 1:
        raise ValueError(
            f"y must lie in [0, 1], got values from {labels.min():g} to {labels.max():g}"
        )
    return inputs, labels


def check_examples(function: str, arguments: dict[str, Any]) -> None:
    """Check the training examples ``x`` and ``y`` of a function for its network."""
    arguments["x"], arguments["y"] = examples(
        arguments["network"], arguments["x"], arguments["y"]
    )


checked = checks(
    {"regularisation": partial(check_real, at_least=0)}, together=check_examples
)
"""Decorate a function of (network, x, y, regularisation) so that its arguments are checked before it runs."""


def backpropagate_by_units(network: Network, x: ArrayLike, y: ArrayLike) -> Network:
    """Backpropagation for one example, unit by unit, Eqs. (3.10), (3.11) and (3.12).

    Slow, and written to be read: :func:`backpropagate` computes the same with matrices for all examples at once.

    Parameters
    ----------
    network : Network
        A single network.
    x : (s[0],) array
        The input.
    y : (s[-1],) array
        The label.

    Returns
    -------
    Network
        The derivatives of the squared error by each weight and bias, in the shape of a network.

    Examples
    --------
    >>> from robonav.networks import backpropagate_by_units, random_network
    >>> network = random_network((2, 3, 1), seed=0)
    >>> backpropagate_by_units(network, [0.5, -1.0], [1.0]).weights[0].shape
    (3, 2)
    """
    W, a = network.weights, network.activations(x)  # 1
    s, last = network.sizes, len(network.weights)
    slope = [sigmoid_slope(layer) for layer in a]
    delta = [np.zeros(units) for units in s]
    for i in range(s[last]):  # 2
        delta[last][i] = -(np.asarray(y)[i] - a[last][i]) * slope[last][i]  # Eq. (3.10)
    for n in range(last - 1, 0, -1):  # 3
        for i in range(s[n]):
            back = sum(W[n][j, i] * delta[n + 1][j] for j in range(s[n + 1]))
            delta[n][i] = back * slope[n][i]  # Eq. (3.11)
    dW, db = [np.zeros_like(w) for w in W], delta[1:]
    for n in range(last):  # 4
        for i in range(s[n + 1]):
            for j in range(s[n]):
                dW[n][i, j] = a[n][j] * delta[n + 1][i]  # Eq. (3.12)
    return Network(tuple(dW), tuple(db))


def backpropagate(network: Network, a: list[Array], delta: Array) -> Network:
    """Backpropagation with matrices, Eqs. (3.14), (3.15), (3.24), (3.25) and (3.26).

    The errors of the output layer are carried back through the network, for all examples at once. The bias unit of a
    hidden layer has no incoming weights and therefore no error (the thesis lets j start at 0 in the equation for the
    hidden layer's errors).

    Parameters
    ----------
    network : Network
        A single network.
    a : list of (m, s[l]) arrays
        Activations of every layer, from :meth:`Network.activations`.
    delta : (m, s[-1]) array
        Errors of the output layer: the derivative of the cost by its weighted sums z.

    Returns
    -------
    Network
        The sums over the examples of the derivatives by weights and biases, in the shape of a network.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import backpropagate, random_network
    >>> network, x = random_network((2, 3, 1), seed=0), np.ones((4, 2))
    >>> a = network.activations(x)
    >>> backpropagate(network, a, a[-1] - 1).biases[1].shape
    (1,)
    """
    weights, biases = [], []
    for layer in reversed(range(len(network.weights))):
        weights.append(delta.T @ a[layer])  # Eqs. (3.15), (3.25) and (3.26)
        biases.append(delta.sum(axis=0))
        if layer > 0:
            back = delta @ network.weights[layer]
            delta = back * sigmoid_slope(a[layer])  # Eqs. (3.14) and (3.24)
    return Network(tuple(reversed(weights)), tuple(reversed(biases)))


def mean_gradient(network: Network, total: Network, m: int, *, decay: float) -> Network:
    """Gradient of a cost with weight decay, Eqs. (3.9) and (3.27).

    Parameters
    ----------
    network : Network
        A single network.
    total : Network
        Sums over the examples, from :func:`backpropagate`.
    m : int
        Number of examples.
    decay : float
        What the weights are multiplied by. The biases do not decay.

    Returns
    -------
    Network
        The gradient, in the shape of a network.
    """
    pairs = zip(total.weights, network.weights, strict=True)
    weights = [dw / m + decay * w for dw, w in pairs]  # Eqs. (3.9) and (3.27)
    biases = [db / m for db in total.biases]
    return Network(tuple(weights), tuple(biases))


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
def squared_error_gradient(
    network: Network, x: Array, y: Array, *, regularisation: float = 0.0
) -> Network:
    """Gradient of the squared-error cost, from the output errors of Eq. (3.13).

    Parameters and errors are those of :func:`squared_error_cost`.

    Returns
    -------
    Network
        The derivatives by weights and biases, in the shape of a network.

    Examples
    --------
    >>> from robonav.networks import random_network, squared_error_gradient
    >>> network = random_network((2, 1), seed=0, spread=0)
    >>> squared_error_gradient(network, [[1, 2]], [[1]]).weights[0].tolist()
    [[-0.125, -0.25]]
    """
    a = network.activations(x)
    delta = -(y - a[-1]) * sigmoid_slope(a[-1])  # Eq. (3.13)
    total = backpropagate(network, a, delta)
    return mean_gradient(network, total, len(x), decay=regularisation)


@checked
def cross_entropy_cost(
    network: Network, x: Array, y: Array, *, regularisation: float = 0.0
) -> float:
    """Mean cross-entropy cost with weight decay, Eq. (3.22).

    With p the output and z its logit, ``-y log p - (1 - y) log(1 - p)`` equals ``log(1 + exp(z)) - y z``. This form
    never takes the logarithm of zero. Parameters and errors are those of :func:`squared_error_cost`.

    Examples
    --------
    >>> from robonav.networks import cross_entropy_cost, random_network
    >>> network = random_network((2, 1), seed=0, spread=0)  # its output is 1/2
    >>> round(cross_entropy_cost(network, [[0, 0], [1, 1]], [[0], [1]]), 6)
    0.693147
    """
    z = network.logits(x)
    error = (np.logaddexp(0, z) - y * z).sum()
    decay = regularisation / 2 * squared_weights(network)
    return float((error + decay) / len(x))  # Eq. (3.22)


@checked
def cross_entropy_gradient(
    network: Network, x: Array, y: Array, *, regularisation: float = 0.0
) -> Network:
    """Gradient of the cross-entropy cost, from the output errors of Eq. (3.23).

    The weights decay by lambda / m, which is the derivative of the cost. (The thesis writes lambda alone.) Parameters
    and errors are those of :func:`squared_error_cost`.

    Returns
    -------
    Network
        The derivatives by weights and biases, in the shape of a network.

    Examples
    --------
    >>> from robonav.networks import cross_entropy_gradient, random_network
    >>> network = random_network((2, 1), seed=0, spread=0)
    >>> cross_entropy_gradient(network, [[1, 2]], [[1]]).weights[0].tolist()
    [[-0.5, -1.0]]
    """
    a = network.activations(x)
    delta = a[-1] - y  # Eq. (3.23): the slope of the sigmoid cancels
    total = backpropagate(network, a, delta)
    return mean_gradient(network, total, len(x), decay=regularisation / len(x))


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
    gradient: Callable[..., Network]


SQUARED_ERROR = Objective(squared_error_cost, squared_error_gradient)
CROSS_ENTROPY = Objective(cross_entropy_cost, cross_entropy_gradient)
