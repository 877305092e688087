"""A multilayer perceptron by hand: forward pass, cost, backpropagation, gradient descent (sections 3.3 and 3.4).

A network learns the exclusive or of two bits:

>>> x, y = np.array([[0, 0], [0, 1], [1, 0], [1, 1]]), np.array([[0], [1], [1], [0]])
>>> network = random_network((2, 4, 1), seed=0)
>>> network = batch_gradient_descent(network, x, y, gradient_step=5, iterations=1000)
>>> network.forward(x).round(1).tolist()
[[0.0], [1.0], [1.0], [0.0]]

Layers count from 0 to L, and ``weights[l][i, j]`` leads from unit j of layer l to unit i of layer l + 1. With C for the
cost, f for the sigmoid, and delta[l] for the derivative of C by the weighted sums z[l]::

               m examples, one a row (this file)              one example, a column (the thesis)

    forward    z[l+1] = a[l] W[l]^T + b[l]                    z[l+1] = W[l] a[l] + b[l]
               a[l+1] = f(z[l+1]),  a[0] = x                  a[l+1] = f(z[l+1]),  a[0] = x
    backward   delta[l] = (delta[l+1] W[l]) * f'(z[l])        delta[l] = (W[l]^T delta[l+1]) * f'(z[l])
    gradient   dC/dW[l] = delta[l+1]^T a[l]                   dC/dW[l] = delta[l+1] a[l]^T
               dC/db[l] = sum of the rows of delta[l+1]       dC/db[l] = delta[l+1]

with f'(z[l]) = a[l] (1 - a[l]), element by element. The backward pass begins with delta[L] = (a[L] - y) f'(z[L]) for
the squared error, and with delta[L] = a[L] - y for the cross-entropy. The numbers at the ends of lines are those of the
thesis's equations.

A gradient can be checked without any of this: move one weight a little, and see how the cost changes.

>>> start = random_network((2, 4, 1), seed=0)
>>> def cost(weight):  # with this weight from input 1 to hidden unit 3
...     first = start.weights[0].copy()
...     first[3, 1] = weight
...     return squared_error_cost(Network((first, start.weights[1]), start.biases), x, y)
>>> weight, little = start.weights[0][3, 1], 1e-5
>>> slope = (cost(weight + little) - cost(weight - little)) / (2 * little)
>>> bool(np.isclose(slope, squared_error_gradient(start, x, y).weights[0][3, 1]))
True
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import expit

from ._checks import keep_layers, takes_inputs

Array = NDArray[np.float64]
Layers = Sequence[Any]  # one array for each layer but the last

# 1. Forward: from the inputs to the outputs, layer by layer.


def sigmoid(z: Array) -> Array:
    """Sigmoid activation function, Eq. (3.4). Its values lie between 0 and 1."""
    return expit(z)  # Eq. (3.4): 1 / (1 + exp(-z)), without overflow


def sigmoid_slope(a: Array) -> Array:
    """Derivative f'(z) of the sigmoid, Eq. (3.5), from the activation a = f(z)."""
    return a * (1 - a)  # Eq. (3.5)


def propagate(
    weights: Layers, biases: Layers, x: Any, f: Callable[[Any], Any] = sigmoid
) -> tuple[list[Any], Any]:
    """Forward propagation, Eq. (3.3): activations of all layers, and the sums z of the last one.

    (With ``f=torch.sigmoid`` the same lines serve torch tensors.)
    """
    a = [x]  # of the inputs (m, s[0])
    for W, b in zip(weights, biases, strict=True):
        z = a[-1] @ W.T + b  # (m, s[l + 1])  Eq. (3.3)
        a.append(f(z))
    return a, z


@dataclass(frozen=True, eq=False)
class Network:
    """A fully connected network of sigmoid units: its weights and biases.

    The arrays cannot be changed: a step of learning makes a new network.

    Parameters
    ----------
    weights : tuple of (s[l + 1], s[l]) arrays
        One for each layer but the last.
    biases : tuple of (s[l + 1],) arrays
        One for each layer but the last.

    Raises
    ------
    ValueError
        If the shapes do not fit each other, or a number is not finite.

    Examples
    --------
    >>> network = Network(weights=(np.ones((1, 2)),), biases=(np.zeros(1),))
    >>> network.sizes, network.logits([3.0, 4.0])
    ((2, 1), array([7.]))
    """

    weights: tuple[Array, ...]
    biases: tuple[Array, ...]

    def __post_init__(self) -> None:
        keep_layers(self)  # copies, whose shapes are checked

    @property
    def sizes(self) -> tuple[int, ...]:
        """Units of each layer: (11, 8, 5)."""
        inputs = self.weights[0].shape[-1]
        return inputs, *(weight.shape[-2] for weight in self.weights)

    @takes_inputs  # one row or many, as the next two
    def forward(self, x: Array) -> Array:
        """Outputs h(x) of the network, Eq. (3.2): numbers between 0 and 1."""
        a, _ = propagate(self.weights, self.biases, x)
        return a[-1]  # Eq. (3.2)

    @takes_inputs
    def activations(self, x: Array) -> list[Array]:
        """Return the activations of every layer, the input first and the output last."""
        a, _ = propagate(self.weights, self.biases, x)
        return a

    @takes_inputs
    def logits(self, x: Array) -> Array:
        """Return the weighted sums z of the output layer, before its sigmoid."""
        _, z = propagate(self.weights, self.biases, x)
        return z

    def decide(self, x: ArrayLike) -> NDArray[np.intp]:
        """Return the largest output unit for each input, compared before the sigmoid rounds to 1."""
        return self.logits(x).argmax(axis=-1)


def random_network(
    sizes: Sequence[int],
    *,
    seed: int | np.random.Generator,
    spread: float | None = None,
) -> Network:
    """Draw a network with small random weights: hidden units that start with equal weights would stay equal.

    With the bound sqrt(6 / (inputs + outputs)) the activations of all layers vary about equally, and so do the errors
    on the way back (Glorot and Bengio 2010).
    """
    rng = np.random.default_rng(seed)
    weights, biases = [], []
    for inputs, outputs in pairwise(sizes):
        bound = math.sqrt(6 / (inputs + outputs)) if spread is None else spread
        weights.append(rng.uniform(-bound, bound, (outputs, inputs)))
        biases.append(rng.uniform(-bound, bound, outputs))
    return Network(tuple(weights), tuple(biases))


# 2. Cost: how wrong the outputs are. Weight decay (lambda) keeps the weights small.


def squared_error(output: Array, label: Array) -> Array:
    """Squared-error cost of one example, Eq. (3.6); of each row, if there are several."""
    return ((output - label) ** 2).sum(axis=-1) / 2  # Eq. (3.6)


def squared_error_cost(
    network: Network, x: Array, y: Array, *, regularisation: float = 0.0
) -> float:
    """Mean squared-error cost with weight decay, Eq. (3.7): mean error + lambda / 2 * sum of W^2."""
    error = squared_error(network.forward(x), y).mean()
    squares = sum((W**2).sum() for W in network.weights)  # not of the biases
    return float(error + regularisation / 2 * squares)  # Eq. (3.7)


def cross_entropy_cost(
    network: Network, x: Array, y: Array, *, regularisation: float = 0.0
) -> float:
    """Mean cross-entropy cost with weight decay, Eq. (3.22): mean error + lambda / (2 m) * sum of W^2.

    As in the thesis, lambda is divided by the number m of examples here, and not in Eq. (3.7). The same lambda then
    matters less, the more examples there are.

    With p = sigmoid(z), the cost -y log p - (1 - y) log(1 - p) of an output equals log(1 + exp(z)) - y z. The second
    form stays finite where p rounds to 1 and log(1 - p) fails: ``logaddexp(0, z)`` is log(exp(0) + exp(z)) for any z.
    """
    z = network.logits(x)
    error = (np.logaddexp(0, z) - y * z).sum()
    squares = sum((W**2).sum() for W in network.weights)
    return float((error + regularisation / 2 * squares) / len(x))  # Eq. (3.22)


# 3. Backward: from the errors of the outputs to the gradient of the cost.


@dataclass(frozen=True, eq=False)
class Gradient:
    """Derivatives of a cost by the weights and the biases of a network, in lists of arrays of the same shapes."""

    weights: list[Array]
    biases: list[Array]


def backpropagate(weights: Layers, a: list[Array], delta: Array) -> Gradient:
    """Backpropagation with matrices, Eqs. (3.14), (3.15), (3.24), (3.25) and (3.26), summed over the examples.

    The error ``delta`` of a layer (m, s[l]) is the derivative of the cost by its sums z. The caller gives that of the
    outputs. The weights that carried the activations forward carry it back.
    """
    dW, db = [], []
    for layer in reversed(range(len(weights))):
        dW.append(delta.T @ a[layer])  # Eqs. (3.15), (3.25) and (3.26)
        db.append(delta.sum(axis=0))
        if layer > 0:  # inputs have no error
            back = delta @ weights[layer]
            delta = back * sigmoid_slope(a[layer])  # Eqs. (3.14) and (3.24)
    return Gradient(dW[::-1], db[::-1])  # the first layer first


def squared_error_gradient(
    network: Network, x: Array, y: Array, *, regularisation: float = 0.0
) -> Gradient:
    """Gradient of the squared-error cost with weight decay, Eqs. (3.9) and (3.13)."""
    a, _ = propagate(network.weights, network.biases, x)
    delta = -(y - a[-1]) * sigmoid_slope(a[-1])  # Eq. (3.13)
    total, m = backpropagate(network.weights, a, delta), len(x)
    layers = zip(network.weights, total.weights, strict=True)
    weights = [dW / m + regularisation * W for W, dW in layers]  # Eq. (3.9)
    return Gradient(weights, [db / m for db in total.biases])  # biases do not decay


def cross_entropy_gradient(
    network: Network, x: Array, y: Array, *, regularisation: float = 0.0
) -> Gradient:
    """Gradient of the cross-entropy cost with weight decay, Eqs. (3.23) and (3.27)."""
    a, _ = propagate(network.weights, network.biases, x)
    delta = a[-1] - y  # Eq. (3.23): the slope of the sigmoid cancels
    total, m = backpropagate(network.weights, a, delta), len(x)
    layers = zip(network.weights, total.weights, strict=True)
    weights = [dW / m + regularisation / m * W for W, dW in layers]  # Eq. (3.27)
    return Gradient(weights, [db / m for db in total.biases])


# 4. Downhill: one step against the gradient, and the two loops that repeat it.


def gradient_descent_step(
    network: Network, gradient: Gradient, gradient_step: float | Array
) -> Network:
    """One step of gradient descent, Eqs. (3.8), (3.28) and (4.12).

    The thesis numbers this step three times: for the two costs, and for the Q-network of chapter 4.
    """
    pairs = zip(network.weights, gradient.weights, strict=True)
    weights = [W - gradient_step * dW for W, dW in pairs]  # Eqs. (3.8), (3.28), (4.12)
    pairs = zip(network.biases, gradient.biases, strict=True)
    biases = [b - gradient_step * db for b, db in pairs]
    return Network(tuple(weights), tuple(biases))


def batch_gradient_descent(
    network: Network,
    x: Array,
    y: Array,
    *,
    gradient_step: float,
    iterations: int,
    regularisation: float = 0.0,
    cost_gradient: Callable[..., Gradient] = squared_error_gradient,
) -> Network:
    """Batch gradient descent, Eq. (3.16): every step uses all examples."""
    for _ in range(iterations):
        gradient = cost_gradient(network, x, y, regularisation=regularisation)
        network = gradient_descent_step(network, gradient, gradient_step)  # Eq. (3.16)
    return network


def stochastic_gradient_descent(
    network: Network,
    x: Array,
    y: Array,
    *,
    gradient_step: float,
    epochs: int,
    batch_size: int,
    seed: int | np.random.Generator,
    cost_gradient: Callable[..., Gradient] = squared_error_gradient,
) -> Network:
    """Stochastic gradient descent: every step uses a mini-batch, the next ``batch_size`` examples in a random order.

    A mini-batch costs less than all examples, and its gradient is right on average. An epoch uses each example once.
    There is no weight decay here.
    """
    rng = np.random.default_rng(seed)
    for _ in range(epochs):
        order = rng.permutation(len(x))
        for first in range(0, len(x), batch_size):
            batch = order[first : first + batch_size]
            gradient = cost_gradient(network, x[batch], y[batch])
            network = gradient_descent_step(network, gradient, gradient_step)
    return network
