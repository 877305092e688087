"""The network as the thesis writes it before it turns to matrices: sums over units, one input at a time (section 3.3).

Slow, and written to be read beside the equations. The functions of :mod:`robonav.networks.multilayer_perceptron`
compute the same with matrices.
"""

from __future__ import annotations

import math

import numpy as np

from .multilayer_perceptron import Array, Gradient, Network, sigmoid, sigmoid_slope


def forward_by_units(network: Network, x: Array) -> list[float]:
    """Forward propagation of one input, unit by unit, Eq. (3.1).

    Slow, and written to be read: :func:`propagate` computes the same with matrices.

    Parameters
    ----------
    network : Network
        A single network.
    x : (s[0],) array
        The input.

    Returns
    -------
    list of float
        The activations of the output layer.

    Examples
    --------
    >>> from robonav.networks import forward_by_units, random_network
    >>> forward_by_units(random_network((3, 3, 1), seed=0, spread=0), [1, 2, 3])
    [0.5]
    """
    a = list(map(float, x))
    for W, b in zip(network.weights, network.biases, strict=True):
        z = [
            sum(W[i, j] * a[j] for j in range(len(a))) + b[i]  # Eq. (3.1)
            for i in range(len(b))
        ]
        a = [1 / (1 + math.exp(-weighted_sum)) for weighted_sum in z]
    return a


def backpropagate_by_units(network: Network, x: Array, y: Array) -> Gradient:
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
    Gradient
        Of the squared error of this example.

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
        delta[last][i] = -(y[i] - a[last][i]) * slope[last][i]  # Eq. (3.10)
    for n in range(last - 1, 0, -1):  # 3
        for i in range(s[n]):
            back = sum(W[n][j, i] * delta[n + 1][j] for j in range(s[n + 1]))
            delta[n][i] = back * slope[n][i]  # Eq. (3.11)
    dW, db = [np.zeros_like(w) for w in W], delta[1:]
    for n in range(last):  # 4
        for i in range(s[n + 1]):
            for j in range(s[n]):
                dW[n][i, j] = a[n][j] * delta[n + 1][i]  # Eq. (3.12)
    return Gradient(dW, db)


def action_probabilities(network: Network, x: Array) -> Array:
    """Outputs of a network with one hidden layer, Eqs. (3.19), (3.20) and (3.21).

    These are the three steps of :meth:`Network.forward` for the network of section 3.4.2.

    Parameters
    ----------
    network : Network
        A single network with one hidden layer.
    x : (..., s[0]) array
        States, as the encoder gives them.

    Returns
    -------
    (..., A) array
        One number between 0 and 1 for each action. They do not add up to 1.

    Examples
    --------
    >>> from robonav.networks import action_probabilities, random_network
    >>> action_probabilities(random_network((2, 8, 5), seed=0, spread=0), [1, 2]).tolist()
    [0.5, 0.5, 0.5, 0.5, 0.5]
    """
    (w1, w2), (b1, b2) = network.weights, network.biases
    h = sigmoid(x @ w1.T + b1)  # Eq. (3.19)
    z = h @ w2.T + b2  # Eq. (3.20)
    return sigmoid(z)  # Eq. (3.21)
