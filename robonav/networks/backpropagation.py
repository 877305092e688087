"""The two costs of chapter 3 and their gradients, by hand: backpropagation in matrix form (sections 3.3.1, 3.4.3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from robonav.validation import check_array, check_real

from .multilayer_perceptron import Array, Network, sigmoid_slope


def backpropagate(network: Network, a: list[Array], delta: Array) -> Network:
    """Carry the errors of the output layer back through the network: Eq. (3.14), (3.15); by unit, Eq. (3.11), (3.12).

    Summed over the examples, this is also Eq. (3.24)-(3.26). The bias unit of a hidden layer has no incoming weights,
    hence no error of its own (the thesis lets j start at 0 in Eq. (3.24)).

    Parameters
    ----------
    network : a single network.
    a : activations (m, s[l]) of every layer, from :meth:`Network.activations`.
    delta : errors (m, s[-1]) of the output layer: the cost's derivative by its weighted sums z.

    Returns
    -------
    The sums over the examples of the derivatives by weights and biases, in the shape of a network.
    """
    weights, biases = [], []
    for layer in reversed(range(len(network.weights))):
        weights.append(delta.T @ a[layer])
        biases.append(delta.sum(axis=0))
        if layer > 0:
            delta = (delta @ network.weights[layer]) * sigmoid_slope(a[layer])
    return Network(tuple(reversed(weights)), tuple(reversed(biases)))


def mean_gradient(network: Network, total: Network, m: int, *, decay: float) -> Network:
    """The gradient, Eq. (3.9), from the sums over m examples; the weights decay, the biases do not."""
    return Network(
        tuple(
            dw / m + decay * w
            for dw, w in zip(total.weights, network.weights, strict=True)
        ),
        tuple(db / m for db in total.biases),
    )


def squared_error_cost(
    network: Network, x: ArrayLike, y: ArrayLike, *, regularisation: float = 0.0
) -> float:
    """Half the squared error, averaged over the examples, plus lambda / 2 times the squared weights: Eq. (3.6), (3.7).

    Parameters
    ----------
    network : a single network.
    x : inputs (m, s[0]).
    y : labels (m, s[-1]) in [0, 1].
    regularisation : lambda, at least 0; acts on the weights, never on the biases.
    """
    inputs, labels = examples(network, x, y)
    error = ((network.forward(inputs) - labels) ** 2).sum() / 2
    return float(
        error / len(inputs) + _decay(regularisation) / 2 * _squared_weights(network)
    )


def squared_error_gradient(
    network: Network, x: ArrayLike, y: ArrayLike, *, regularisation: float = 0.0
) -> Network:
    """The gradient of :func:`squared_error_cost`, Eq. (3.9), by backpropagation from Eq. (3.10), (3.13) on."""
    inputs, labels = examples(network, x, y)
    a = network.activations(inputs)
    delta = -(labels - a[-1]) * sigmoid_slope(a[-1])  # Eq. (3.13)
    return mean_gradient(
        network,
        backpropagate(network, a, delta),
        len(inputs),
        decay=_decay(regularisation),
    )


def cross_entropy_cost(
    network: Network, x: ArrayLike, y: ArrayLike, *, regularisation: float = 0.0
) -> float:
    """Cross-entropy of the output units, averaged over the m examples, plus lambda / 2m times the squared weights.

    That is Eq. (3.22). With z the logit of p, ``-y log p - (1 - y) log(1 - p)`` is ``log(1 + exp(z)) - y z``,
    which never takes the logarithm of a zero. Parameters as in :func:`squared_error_cost`.
    """
    inputs, labels = examples(network, x, y)
    z = network.logits(inputs)
    error = (np.logaddexp(0, z) - labels * z).sum()
    return float(
        (error + _decay(regularisation) / 2 * _squared_weights(network)) / len(inputs)
    )


def cross_entropy_gradient(
    network: Network, x: ArrayLike, y: ArrayLike, *, regularisation: float = 0.0
) -> Network:
    """The gradient of :func:`cross_entropy_cost`, Eq. (3.23)-(3.27), where the weights decay by lambda / m.

    Eq. (3.27) has lambda alone, which is not the derivative of Eq. (3.22).
    """
    inputs, labels = examples(network, x, y)
    a = network.activations(inputs)
    delta = a[-1] - labels  # Eq. (3.23): the slope of the sigmoid cancels
    return mean_gradient(
        network,
        backpropagate(network, a, delta),
        len(inputs),
        decay=_decay(regularisation) / len(inputs),
    )


@dataclass(frozen=True)
class Objective:
    """A cost to make small, and its gradient."""

    cost: Callable[..., float]
    gradient: Callable[..., Network]


SQUARED_ERROR = Objective(squared_error_cost, squared_error_gradient)
CROSS_ENTROPY = Objective(cross_entropy_cost, cross_entropy_gradient)


def examples(network: Network, x: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
    """Training examples that fit a single network: inputs (m, s[0]) and labels (m, s[-1]) in [0, 1].

    Raises
    ------
    ValueError : if a shape does not fit, there is no example, or a label lies outside [0, 1].
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


def _squared_weights(network: Network) -> float:
    return float(sum((weight**2).sum() for weight in network.weights))


def _decay(regularisation: float) -> float:
    return check_real("regularisation", regularisation, at_least=0)
