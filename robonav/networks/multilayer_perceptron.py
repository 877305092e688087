"""The multilayer sigmoid network, by hand: neurons, layers, forward propagation (section 3.3)."""

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


def forward_by_units(network: Network, x: ArrayLike) -> list[float]:
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
    a = [float(number) for number in np.asarray(x)]
    for W, b in zip(network.weights, network.biases, strict=True):
        z = [
            sum(W[i, j] * a[j] for j in range(len(a))) + b[i]  # Eq. (3.1)
            for i in range(len(b))
        ]
        a = [1 / (1 + math.exp(-weighted_sum)) for weighted_sum in z]
    return a


def propagate(
    weights: Sequence[Any],
    biases: Sequence[Any],
    x: Any,
    f: Callable[[Any], Any] = sigmoid,
) -> tuple[list[Any], Any]:
    """Forward propagation from layer to layer, Eq. (3.3).

    Examples are rows, so that W acts from the right, transposed. The code serves NumPy arrays and torch tensors.

    Parameters
    ----------
    weights, biases : sequences of arrays
        As in :class:`Network`. Leading dimensions stack networks.
    x : (..., m, s[0]) array
        Inputs.
    f : callable
        The activation function; ``torch.sigmoid`` for tensors.

    Returns
    -------
    a : list of (..., m, s[l]) arrays
        Activations of each layer, the input first.
    z : (..., m, s[-1]) array
        Weighted sums of the output layer.

    Examples
    --------
    >>> from robonav.networks import propagate, random_network
    >>> network = random_network((3, 4, 2), seed=0)
    >>> a, z = propagate(network.weights, network.biases, [[1.0, 2.0, 3.0]])
    >>> [layer.shape for layer in a[1:]], z.shape
    ([(1, 4), (1, 2)], (1, 2))
    """
    a = [x]
    for weight, bias in zip(weights, biases, strict=True):
        z = a[-1] @ weight.swapaxes(-1, -2) + bias[..., None, :]
        a.append(f(z))  # Eq. (3.3)
    return a, z


def action_probabilities(network: Network, x: ArrayLike) -> Array:
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
    h = sigmoid(np.asarray(x) @ w1.T + b1)  # Eq. (3.19)
    z = h @ w2.T + b2  # Eq. (3.20)
    return sigmoid(z)  # Eq. (3.21)


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
        weights = tuple(
            _kept(f"weights[{layer}]", array)
            for layer, array in enumerate(self.weights)
        )
        biases = tuple(
            _kept(f"biases[{layer}]", array) for layer, array in enumerate(self.biases)
        )
        if not weights or len(weights) != len(biases):
            raise ValueError(
                f"weights and biases must be as many, at least one each, got {len(weights)} and {len(biases)}"
            )
        for layer, (weight, bias) in enumerate(zip(weights, biases, strict=True)):
            if weight.ndim < 2 or 0 in weight.shape:
                raise ValueError(
                    f"weights[{layer}] must have shape (..., outputs, inputs), got {weight.shape}"
                )
            before = (
                weights[layer - 1].shape[:-1]
                if layer
                else (*weight.shape[:-2], weight.shape[-1])
            )
            if (*weight.shape[:-2], weight.shape[-1]) != before:
                raise ValueError(
                    f"weights[{layer}] must take the {before[-1]} units of the layer before it "
                    f"and share its stack {before[:-1]}, got shape {weight.shape}"
                )
            if bias.shape != weight.shape[:-1]:
                raise ValueError(
                    f"biases[{layer}] must have shape {weight.shape[:-1]}, got {bias.shape}"
                )
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
        if inputs.ndim > 1:
            return propagate(self.weights, self.biases, inputs)
        a, z = propagate(self.weights, self.biases, inputs[None])
        return [layer[..., 0, :] for layer in a], z[..., 0, :]


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


def random_network(
    sizes: Sequence[int],
    *,
    seed: int | np.random.Generator,
    spread: float | None = None,
) -> Network:
    """Draw a network whose weights and biases are small random numbers, so that no two hidden units start alike.

    Parameters
    ----------
    sizes : sequence of int
        Units of each layer, without bias units; at least two layers.
    seed : int or Generator
        Of the random numbers.
    spread : float, optional
        Parameters are uniform in [-spread, spread]; 0 is the trap of section 3.3.1. By default
        sqrt(6 / (inputs + outputs)) of each layer (Glorot and Bengio 2010).

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


def _kept(name: str, value: ArrayLike) -> Array:
    """Copy the caller's array, so that later changes to it do not change the network."""
    array = check_array(name, value).copy()
    array.flags.writeable = False
    return array
