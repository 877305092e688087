"""The multilayer perceptron by hand: forward pass, backpropagation, gradient descent (sections 3.3 and 3.4).

In the notation of the thesis, layer l has s_l units with activations a(l). The weights W(l) and the biases b(l) lead
to layer l + 1. Python counts from 0, so that ``weights[0]`` is W(1) and ``a[0]`` is a(1) = x. Examples are rows: with
m examples, a(l) is (m, s_l) and stands on the left of the transposed weights. One step of learning is

1. forward: ``a, z = propagate(weights, biases, x)``;
2. error of the output layer, the derivative of the cost by z: ``delta = a[-1] - y`` for the cross-entropy;
3. backward: ``backpropagate(weights, a, delta)`` sums the gradient over the examples;
4. downhill: ``descend(network, gradient, gradient_step)``.

:func:`robonav.networks.gradient_descent` repeats these steps.
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

from robonav.validation import check_array, check_generator, check_integer, check_real

from ._checks import checked, checked_layers
from ._fast.stacks import propagate_stack

Array = NDArray[np.float64]


def sigmoid(z: Array) -> Array:
    """Sigmoid activation function, Eq. (3.4).

    Its values lie between 0 and 1. (The thesis's text has ]-1, +1[, which is the range of tanh.)

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

    The errors of the output layer are carried back through the network, for all examples at once. The bias unit of a
    hidden layer has no incoming weights and therefore no error (the thesis lets j start at 0 in the equation for the
    hidden layer's errors).

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
        # By W(l): delta(l+1) a(l)^T; by b(l): delta(l+1); both summed over the examples.
        dW = delta.T @ a[layer]  # Eqs. (3.15), (3.25) and (3.26)
        gradient.weights.insert(0, dW)
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
    """
    pairs = zip(network.weights, total.weights, strict=True)
    dW = [dw / m + decay * W for W, dw in pairs]  # Eqs. (3.9) and (3.27)
    return Gradient(dW, [db / m for db in total.biases])


@checked
def squared_error_gradient(
    network: Network, x: Array, y: Array, *, regularisation: float = 0.0
) -> Gradient:
    """Gradient of the squared-error cost, from the output errors of Eq. (3.13).

    Parameters and errors are those of :func:`squared_error_cost`.

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

    The weights decay by lambda / m, which is the derivative of the cost. (The thesis writes lambda alone.) Parameters
    and errors are those of :func:`squared_error_cost`.

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


def descend(network: Network, gradient: Gradient, gradient_step: float) -> Network:
    """One step of gradient descent, Eqs. (3.8) and (3.28).

    Parameters
    ----------
    network : Network
        A single network.
    gradient : Gradient
        The derivatives of the cost by its weights and biases.
    gradient_step : float
        alpha, which the thesis calls the learning rate.

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
    weights = [W - gradient_step * dW for W, dW in pairs]  # Eqs. (3.8) and (3.28)
    pairs = zip(network.biases, gradient.biases, strict=True)
    biases = [b - gradient_step * db for b, db in pairs]
    return Network(tuple(weights), tuple(biases))


@dataclass(frozen=True, eq=False)
class Network:
    """A fully connected network with sigmoid units, or a stack of networks of one shape.

    The weights of layer ``l`` carry its activations to layer ``l + 1``, as in the thesis: ``weights[0]`` is
    :math:`W^{(1)}`, and entry ``[i, j]`` joins unit ``j`` to unit ``i`` of the next layer. (Eq. (3.18) writes the bias
    as column 0 of the same matrix.) Leading dimensions, the same for every array, stack networks: over seeds, or over
    the iterations of a training.

    Parameters
    ----------
    weights : tuple of (..., s[l + 1], s[l]) arrays
        One for each layer but the last.
    biases : tuple of (..., s[l + 1]) arrays
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
        weights, biases = checked_layers(self.weights, self.biases)
        object.__setattr__(self, "weights", weights)
        object.__setattr__(self, "biases", biases)

    @property
    def sizes(self) -> tuple[int, ...]:
        """Units of each layer, without bias units: (11, 8, 5)."""
        return (
            self.weights[0].shape[-1],
            *(weight.shape[-2] for weight in self.weights),
        )

    @property
    def stack(self) -> tuple[int, ...]:
        """The leading dimensions; () for a single network."""
        return self.weights[0].shape[:-2]

    def __getitem__(self, index: Any) -> Network:
        """Some of a stack of networks, indexed over its leading dimensions."""
        if not self.stack:
            raise TypeError("a single network has no stack to index")
        return Network(
            tuple(weight[index] for weight in self.weights),
            tuple(bias[index] for bias in self.biases),
        )

    def activations(self, x: ArrayLike) -> list[Array]:
        """Return the activations of every layer, the input first and the output last.

        Parameters
        ----------
        x : (s[0],), (m, s[0]) or (..., m, s[0]) array
            Inputs. Leading dimensions broadcast with the stack.
        """
        return self._propagate(x)[0]

    def logits(self, x: ArrayLike) -> Array:
        """Return the weighted sums z (..., m, s[-1]) of the output layer, before its sigmoid."""
        return self._propagate(x)[1]

    def forward(self, x: ArrayLike) -> Array:
        """Outputs h(x) of the network, Eq. (3.2): (..., m, s[-1]) numbers between 0 and 1."""
        return self.activations(x)[-1]  # Eq. (3.2)

    def decide(self, x: ArrayLike) -> NDArray[np.intp]:
        """Return the largest output unit (..., m) for each input, compared before the sigmoid rounds to 1."""
        return self.logits(x).argmax(axis=-1)

    def _propagate(self, x: ArrayLike) -> tuple[list[Array], Array]:
        inputs = check_array("x", x)
        if inputs.ndim == 0 or inputs.shape[-1] != self.sizes[0]:
            raise ValueError(
                f"x must hold {self.sizes[0]} inputs along its last axis, got shape {inputs.shape}"
            )
        forward = propagate_stack if self.stack else propagate
        if inputs.ndim > 1:
            return forward(self.weights, self.biases, inputs)
        a, z = forward(self.weights, self.biases, inputs[None])  # a batch of one
        return [layer[..., 0, :] for layer in a], z[..., 0, :]


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
    units = [check_integer("sizes", size, at_least=1) for size in sizes]
    if len(units) < 2:
        raise ValueError(
            f"sizes must name at least an input and an output layer, got {units}"
        )
    rng = check_generator("seed", seed)
    weights, biases = [], []
    for inputs, outputs in pairwise(units):
        bound = (
            math.sqrt(6 / (inputs + outputs))
            if spread is None
            else check_real("spread", spread, at_least=0)
        )
        weights.append(rng.uniform(-bound, bound, (outputs, inputs)))
        biases.append(rng.uniform(-bound, bound, outputs))
    return Network(tuple(weights), tuple(biases))


def stacked(networks: Sequence[Network]) -> Network:
    """Stack networks of one shape along a new first dimension.

    Parameters
    ----------
    networks : sequence of Network

    Returns
    -------
    Network

    Raises
    ------
    ValueError
        If there is no network, or they differ in shape.

    Examples
    --------
    >>> from robonav.networks import random_network, stacked
    >>> stacked([random_network((2, 1), seed=seed) for seed in range(3)]).stack
    (3,)
    """
    if (
        not networks
        or len({(network.stack, network.sizes) for network in networks}) != 1
    ):
        raise ValueError("networks must be at least one, all of the same sizes")
    return Network(
        tuple(
            np.stack(layers)
            for layers in zip(*(network.weights for network in networks), strict=True)
        ),
        tuple(
            np.stack(layers)
            for layers in zip(*(network.biases for network in networks), strict=True)
        ),
    )
