"""The multilayer perceptron from random weights to trained ones, by hand in NumPy (sections 3.3 and 3.4).

A network learns the exclusive or of two bits in three lines:

>>> x, y = np.array([[0, 0], [0, 1], [1, 0], [1, 1]]), np.array([[0], [1], [1], [0]])
>>> network = random_network((2, 4, 1), seed=0)
>>> network = batch_gradient_descent(network, x, y, gradient_step=5, iterations=1000)
>>> network.forward(x).round(1).tolist()
[[0.0], [1.0], [1.0], [0.0]]

Read the file from top to bottom, as the network learns:

1. a :class:`Network` is its weights and biases, and :func:`random_network` draws the first ones;
2. forward: :func:`propagate` computes the activations of every layer from the input;
3. cost: :func:`squared_error_cost` or :func:`cross_entropy_cost` says how wrong the outputs are;
4. backward: :func:`backpropagate` carries the errors of the output layer back, which gives the gradient of the cost;
5. downhill: :func:`descend` takes one step against the gradient;
6. the loop: :func:`batch_gradient_descent` repeats 2 to 5 with all examples in each step, and
   :func:`stochastic_gradient_descent` with a few of them.

Layer l has s_l units with activations a(l). The weights W(l) and the biases b(l) lead to layer l + 1. Python counts
from 0, so that ``weights[0]`` is W(1) and ``a[0]`` is a(1) = x. Examples are rows: with m examples, a(l) is (m, s_l)
and stands on the left of the transposed weights. Functions marked ``@checked`` first check their arguments, and
``help`` explains those that they share: ``network``, ``x`` (inputs), ``y`` (labels) and ``regularisation`` (lambda).
The numbers of equations are those of the thesis. The book's page "A neural network, by hand" derives them in the same
order.
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

from ._checks import checked, checked_inputs, checked_random, keep_layers

Array = NDArray[np.float64]

# 1. The network


@dataclass(frozen=True, eq=False)
class Network:
    """A fully connected network with sigmoid units.

    ``weights[l][i, j]`` joins unit ``j`` of layer ``l`` to unit ``i`` of the next layer. (Eq. (3.18) writes the bias as
    column 0 of the same matrix.) The arrays cannot be changed: a step of learning makes a new network.
    :class:`robonav.networks.NetworkStack` holds many networks of one shape.

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
    >>> import numpy as np
    >>> from robonav.networks import Network
    >>> network = Network((np.ones((1, 2)),), (np.zeros(1),))
    >>> network.sizes, network.logits([3.0, 4.0])
    ((2, 1), array([7.]))
    """

    weights: tuple[Array, ...]
    biases: tuple[Array, ...]

    def __post_init__(self) -> None:
        keep_layers(self)

    @property
    def sizes(self) -> tuple[int, ...]:
        """Units of each layer, without bias units: (11, 8, 5)."""
        return (
            self.weights[0].shape[-1],
            *(weight.shape[-2] for weight in self.weights),
        )

    def forward(self, x: ArrayLike) -> Array:
        """Outputs h(x) of the network, Eq. (3.2): (..., m, s[-1]) numbers between 0 and 1."""
        return self.activations(x)[-1]  # Eq. (3.2)

    def decide(self, x: ArrayLike) -> NDArray[np.intp]:
        """Return the largest output unit (..., m) for each input, compared before the sigmoid rounds to 1."""
        return self.logits(x).argmax(axis=-1)

    def activations(self, x: ArrayLike) -> list[Array]:
        """Return the activations of every layer, the input (s[0],) or (..., m, s[0]) first and the output last."""
        return self._propagate(x)[0]

    def logits(self, x: ArrayLike) -> Array:
        """Return the weighted sums z (..., m, s[-1]) of the output layer, before its sigmoid."""
        return self._propagate(x)[1]

    def _propagate(self, x: ArrayLike) -> tuple[list[Array], Array]:
        inputs = checked_inputs(x, self.sizes[0])
        if inputs.ndim > 1:
            return propagate(self.weights, self.biases, inputs)
        a, z = propagate(self.weights, self.biases, inputs[None])  # a batch of one
        return [layer[0] for layer in a], z[0]


@checked_random
def random_network(
    sizes: Sequence[int],
    *,
    seed: int | np.random.Generator,
    spread: float | None = None,
) -> Network:
    """Draw a network with small random weights and biases.

    Hidden units that start with equal weights stay equal. Random numbers make them differ.

    Parameters
    ----------
    sizes : sequence of int
        Units of each layer, without bias units; at least two layers.
    seed : int or Generator
        Of the random numbers.
    spread : float, optional
        Weights and biases are uniform in [-spread, spread]. By default it is sqrt(6 / (inputs + outputs)) of each
        layer (Glorot and Bengio 2010). With 0 all hidden units are equal.

    Returns
    -------
    Network

    Raises
    ------
    ValueError
        If there are fewer than two layers, a layer is empty, or ``spread`` is negative.

    Examples
    --------
    >>> from robonav.networks import random_network
    >>> random_network((11, 8, 5), seed=0).sizes
    (11, 8, 5)
    """
    rng = np.random.default_rng(seed)
    weights, biases = [], []
    for inputs, outputs in pairwise(sizes):
        bound = math.sqrt(6 / (inputs + outputs)) if spread is None else spread
        weights.append(rng.uniform(-bound, bound, (outputs, inputs)))
        biases.append(rng.uniform(-bound, bound, outputs))
    return Network(tuple(weights), tuple(biases))


# 2. The forward pass


def sigmoid(z: Array) -> Array:
    """Sigmoid activation function, Eq. (3.4).

    Its values lie between 0 and 1.

    Parameters
    ----------
    z : array
        Weighted sums, of any size: ``1 / (1 + exp(-z))`` is computed without overflow.

    Returns
    -------
    array
        Of the same shape.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import sigmoid
    >>> sigmoid(np.array([-1000.0, 0.0, 1000.0])).tolist()
    [0.0, 0.5, 1.0]
    """
    return expit(z)  # Eq. (3.4): 1 / (1 + exp(-z))


def sigmoid_slope(a: Array) -> Array:
    """Derivative of the sigmoid, Eq. (3.5).

    Parameters
    ----------
    a : array
        Activations ``f(z)``, which the forward pass has computed already.

    Returns
    -------
    array
        The derivatives ``f'(z)``.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import sigmoid_slope
    >>> sigmoid_slope(np.array([0.0, 0.5])).tolist()
    [0.0, 0.25]
    """
    return a * (1 - a)  # Eq. (3.5)


def propagate(
    weights: Sequence[Any],
    biases: Sequence[Any],
    x: Any,
    f: Callable[[Any], Any] = sigmoid,
) -> tuple[list[Any], Any]:
    """Forward propagation from layer to layer, Eq. (3.3).

    The code serves NumPy arrays and torch tensors.

    Parameters
    ----------
    weights, biases : sequences of (s[l + 1], s[l]) and (s[l + 1],) arrays
        Of one network.
    x : (m, s[0]) array
        Inputs.
    f : callable
        The activation function; ``torch.sigmoid`` for tensors.

    Returns
    -------
    a : list of (m, s[l]) arrays
        Activations of each layer, the input first.
    z : (m, s[-1]) array
        Weighted sums of the output layer.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import propagate, random_network
    >>> network = random_network((3, 4, 2), seed=0)
    >>> a, z = propagate(network.weights, network.biases, np.ones((5, 3)))
    >>> [layer.shape for layer in a], z.shape
    ([(5, 3), (5, 4), (5, 2)], (5, 2))
    """
    a = [x]
    for W, b in zip(weights, biases, strict=True):
        z = a[-1] @ W.T + b  # Eq. (3.3): z(l+1) = W(l) a(l) + b(l)
        a.append(f(z))  # a(l+1) = f(z(l+1))
    return a, z


# 3. The cost


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
    """Return the sum of all squared weights; the biases are left out.

    Examples
    --------
    >>> squared_weights(Network((np.array([[3.0, 4.0]]),), (np.zeros(1),)))
    25.0
    """
    return float(sum((weight**2).sum() for weight in network.weights))


@checked
def squared_error_cost(
    network: Network, x: Array, y: Array, *, regularisation: float = 0.0
) -> float:
    """Mean squared-error cost with weight decay, Eq. (3.7).

    Returns
    -------
    float

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

    Returns
    -------
    float

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


# 4. The backward pass


@dataclass(frozen=True, eq=False)
class Gradient:
    """The derivatives of a cost by the weights and the biases of a network.

    Attributes
    ----------
    weights : list of (s[l + 1], s[l]) arrays
        Derivatives by the weights of each layer but the last.
    biases : list of (s[l + 1],) arrays
        Derivatives by the biases.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import Gradient
    >>> Gradient([np.zeros((2, 3))], [np.zeros(2)]).weights[0].shape
    (2, 3)
    """

    weights: list[Array]
    biases: list[Array]


def backpropagate(weights: Sequence[Array], a: list[Array], delta: Array) -> Gradient:
    """Backpropagation with matrices, Eqs. (3.14), (3.15), (3.24), (3.25) and (3.26).

    The error delta(l) of a layer is the derivative of the cost by its weighted sums z(l). From the output layer on, the
    chain rule gives the error of each layer from that of the next one, for all examples at once. The derivative by a
    weight is the error of the unit that it leads to times the activation of the unit that it comes from.

    Parameters
    ----------
    weights : sequence of (s[l + 1], s[l]) arrays
        Of one network.
    a : list of (m, s[l]) arrays
        Activations of every layer, from :func:`propagate`.
    delta : (m, s[-1]) array
        Errors of the output layer: the derivative of the cost by its weighted sums z.

    Returns
    -------
    Gradient
        Summed over the examples.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import backpropagate, propagate, random_network
    >>> network, x = random_network((2, 3, 1), seed=0), np.ones((4, 2))
    >>> a, z = propagate(network.weights, network.biases, x)
    >>> backpropagate(network.weights, a, a[-1] - 1).biases[1].shape
    (1,)
    """
    gradient = Gradient([], [])
    for layer in reversed(range(len(weights))):
        # By W(l): delta(l+1) a(l)^T; by b(l): delta(l+1); summed over the examples.
        dW = delta.T @ a[layer]  # Eqs. (3.15), (3.25) and (3.26)
        gradient.weights.insert(0, dW)  # in front of those of the later layers
        gradient.biases.insert(0, delta.sum(axis=0))
        if layer > 0:  # delta(l) = (W(l)^T delta(l+1)) * f'(z(l))
            back = delta @ weights[layer]
            delta = back * sigmoid_slope(a[layer])  # Eqs. (3.14) and (3.24)
    return gradient


def mean_gradient(
    network: Network, total: Gradient, m: int, *, decay: float
) -> Gradient:
    """Gradient of a cost with weight decay, Eqs. (3.9) and (3.27).

    Parameters
    ----------
    network : Network
        A single network.
    total : Gradient
        Summed over the examples, from :func:`backpropagate`.
    m : int
        Number of examples.
    decay : float
        What the weights are multiplied by. The biases do not decay.

    Returns
    -------
    Gradient

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import Gradient, Network
    >>> network = Network((np.array([[2.0]]),), (np.array([0.0]),))
    >>> total = Gradient([np.array([[6.0]])], [np.array([4.0])])
    >>> mean_gradient(network, total, 2, decay=0.5).weights
    [array([[4.]])]
    """
    pairs = zip(network.weights, total.weights, strict=True)
    dW = [dw / m + decay * W for W, dw in pairs]  # Eqs. (3.9) and (3.27)
    return Gradient(dW, [db / m for db in total.biases])


@checked
def squared_error_gradient(
    network: Network, x: Array, y: Array, *, regularisation: float = 0.0
) -> Gradient:
    """Gradient of the squared-error cost, from the output errors of Eq. (3.13).

    Returns
    -------
    Gradient

    Examples
    --------
    >>> from robonav.networks import random_network, squared_error_gradient
    >>> network = random_network((2, 1), seed=0, spread=0)
    >>> squared_error_gradient(network, [[1, 2]], [[1]]).weights[0].tolist()
    [[-0.125, -0.25]]
    """
    a, _ = propagate(network.weights, network.biases, x)
    delta = -(y - a[-1]) * sigmoid_slope(a[-1])  # Eq. (3.13)
    total = backpropagate(network.weights, a, delta)
    return mean_gradient(network, total, len(x), decay=regularisation)


@checked
def cross_entropy_gradient(
    network: Network, x: Array, y: Array, *, regularisation: float = 0.0
) -> Gradient:
    """Gradient of the cross-entropy cost, from the output errors of Eq. (3.23).

    The weights decay by lambda / m, which is the derivative of the cost.

    Returns
    -------
    Gradient

    Examples
    --------
    >>> from robonav.networks import cross_entropy_gradient, random_network
    >>> network = random_network((2, 1), seed=0, spread=0)
    >>> cross_entropy_gradient(network, [[1, 2]], [[1]]).weights[0].tolist()
    [[-0.5, -1.0]]
    """
    a, _ = propagate(network.weights, network.biases, x)
    delta = a[-1] - y  # Eq. (3.23): the slope of the sigmoid cancels
    total = backpropagate(network.weights, a, delta)
    return mean_gradient(network, total, len(x), decay=regularisation / len(x))


# 5. A step, and 6. the loops


def descend(
    network: Network, gradient: Gradient, gradient_step: float | Array
) -> Network:
    """One step of gradient descent, Eqs. (3.8), (3.28) and (4.12).

    Parameters
    ----------
    network : Network
        A single network.
    gradient : Gradient
        The derivatives of the cost by its weights and biases.
    gradient_step : float
        alpha, which the thesis calls the learning rate; sigma in chapter 4.

    Returns
    -------
    Network
        One step further down.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import Gradient, Network, descend
    >>> network = Network((np.array([[3.0]]),), (np.array([1.0]),))
    >>> descend(network, Gradient([np.array([[4.0]])], [np.array([0.0])]), 0.5).weights
    (array([[1.]]),)
    """
    pairs = zip(network.weights, gradient.weights, strict=True)
    weights = [W - gradient_step * dW for W, dW in pairs]  # Eqs. (3.8), (3.28), (4.12)
    pairs = zip(network.biases, gradient.biases, strict=True)
    biases = [b - gradient_step * db for b, db in pairs]
    return Network(tuple(weights), tuple(biases))


@checked
def batch_gradient_descent(
    network: Network,
    x: Array,
    y: Array,
    *,
    gradient_step: float,
    iterations: int,
    regularisation: float = 0.0,
    cost_gradient: Callable[..., Gradient] = squared_error_gradient,
    after_step: Callable[[Network], None] | None = None,
) -> Network:
    """Batch gradient descent, Eq. (3.16): every step uses all examples.

    :func:`robonav.networks.gradient_descent` does the same and keeps the history of the cost.

    Parameters
    ----------
    network : Network
        Where to start.
    x, y : (m, s[0]) and (m, s[-1]) arrays
        Inputs, and labels in [0, 1].
    gradient_step : float
        alpha. With too large a step the cost rises or jumps.
    iterations : int
        Steps to take.
    cost_gradient : callable
        ``squared_error_gradient`` or ``cross_entropy_gradient``.
    after_step : callable, optional
        Called with the network after every step.

    Returns
    -------
    Network
        The trained one.

    Raises
    ------
    ValueError
        If shapes do not fit, a label lies outside [0, 1], or the weights grow beyond all bounds.

    Examples
    --------
    >>> from robonav.networks import batch_gradient_descent, random_network, squared_error_cost
    >>> from robonav.networks.toy_datasets import disc
    >>> (x, y), start = disc(50, seed=0), random_network((2, 4, 1), seed=0)
    >>> trained = batch_gradient_descent(start, x, y, gradient_step=1, iterations=20)
    >>> squared_error_cost(trained, x, y) < squared_error_cost(start, x, y)
    True
    """
    for _ in range(iterations):
        gradient = cost_gradient(network, x, y, regularisation=regularisation)
        network = descend(network, gradient, gradient_step)  # Eq. (3.16)
        if after_step is not None:
            after_step(network)
    return network


@checked
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
    """Stochastic gradient descent: every step uses the next ``batch_size`` examples in a random order.

    An epoch goes through all examples once. Steps are cheaper than those of :func:`batch_gradient_descent`, and
    their directions are right only on average.

    Parameters
    ----------
    gradient_step : float
        Positive. Each step is the gradient times this number.
    epochs : int
        How often to go through the examples.
    batch_size : int
        Examples in each step; the last step of an epoch may have fewer.
    seed : int or Generator
        Of the random orders.
    cost_gradient : callable
        Computes the gradient of the cost from network, inputs and labels.

    Returns
    -------
    Network
        The trained one.

    Examples
    --------
    >>> from robonav.networks import random_network, squared_error_cost, stochastic_gradient_descent
    >>> from robonav.networks.toy_datasets import disc
    >>> (x, y), start = disc(50, seed=0), random_network((2, 4, 1), seed=0)
    >>> trained = stochastic_gradient_descent(start, x, y, gradient_step=1, epochs=5, batch_size=10, seed=0)
    >>> squared_error_cost(trained, x, y) < squared_error_cost(start, x, y)
    True
    """
    rng = np.random.default_rng(seed)
    for _ in range(epochs):
        order = rng.permutation(len(x))
        for first in range(0, len(x), batch_size):
            batch = order[first : first + batch_size]
            gradient = cost_gradient(network, x[batch], y[batch])
            network = descend(network, gradient, gradient_step)
    return network
