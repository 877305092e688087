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
    """``f(z) = 1 / (1 + exp(-z))``, Eq. (3.4), element by element; any size of ``z`` without overflow.

    Its values lie between 0 and 1 (the thesis's text has ]-1, +1[, which is the range of tanh).
    """
    return expit(z)


def sigmoid_slope(a: Array) -> Array:
    """``f'(z) = f(z) (1 - f(z))``, Eq. (3.5), from the activation ``a = f(z)`` already at hand."""
    return a * (1 - a)


def propagate(
    weights: Sequence[Any],
    biases: Sequence[Any],
    x: Any,
    f: Callable[[Any], Any] = sigmoid,
) -> tuple[list[Any], Any]:
    """The activations of every layer and the weighted sums of the last: ``z = W a + b``, ``a = f(z)``, Eq. (3.3).

    Examples are rows, so that W acts from the right, transposed. Written for NumPy arrays and torch tensors alike
    (for these hand in ``torch.sigmoid``).

    Parameters
    ----------
    weights, biases : as in :class:`Network`; leading dimensions stack networks.
    x : inputs (..., m, s[0]).
    f : the activation function.

    Returns
    -------
    Activations (..., m, s[l]) of each layer, the input first; weighted sums (..., m, s[-1]) of the output layer.
    """
    a = [x]
    for weight, bias in zip(weights, biases, strict=True):
        z = a[-1] @ weight.swapaxes(-1, -2) + bias[..., None, :]
        a.append(f(z))
    return a, z


@dataclass(frozen=True, eq=False)
class Network:
    """A fully connected network with sigmoid units, or a stack of networks of one shape.

    The weights of layer ``l`` carry its activations to layer ``l + 1``, as in the thesis: ``weights[0]`` is
    :math:`W^{(1)}`, and entry ``[i, j]`` joins unit ``j`` to unit ``i`` of the next layer. (Eq. (3.18) writes the bias
    as a column 0 of the same matrix.) Leading dimensions, the
    same for every array, stack networks: over seeds, or over the iterations of a training.

    Parameters
    ----------
    weights : one array (..., s[l + 1], s[l]) a layer.
    biases : one array (..., s[l + 1]) a layer.

    Raises
    ------
    ValueError : if shapes do not chain, or a number is not finite.
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
        """``a`` of every layer, the input first and the output last: forward propagation, Eq. (3.3).

        Parameters
        ----------
        x : inputs (s[0],), (m, s[0]), or (..., m, s[0]) with leading dimensions that broadcast with the stack.
        """
        return self._propagate(x)[0]

    def logits(self, x: ArrayLike) -> Array:
        """``z`` of the output layer, before its sigmoid: (..., m, s[-1])."""
        return self._propagate(x)[1]

    def forward(self, x: ArrayLike) -> Array:
        """The hypothesis ``h(x)``, Eq. (3.1), (3.2), (3.19)-(3.21): outputs (..., m, s[-1]) between 0 and 1."""
        return self._propagate(x)[0][-1]

    def decide(self, x: ArrayLike) -> NDArray[np.intp]:
        """The output unit that answers strongest to each input, (..., m); compared before the sigmoid rounds to 1."""
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
    """Networks of one shape as one stack, along a new first dimension."""
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
    """A network whose weights and biases are small random numbers, so that no two hidden units start alike.

    Parameters
    ----------
    sizes : units of each layer, without bias units; at least two layers.
    seed : a whole number, or a generator to draw from.
    spread : parameters are uniform in [-spread, spread]; 0 is the trap of section 3.3.1. By default
        sqrt(6 / (inputs + outputs)) of each layer (Glorot and Bengio, 2010).

    Raises
    ------
    ValueError : if there are fewer than two layers, a layer is empty, or ``spread`` is negative.
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
    """The caller's array, copied so that nobody changes it behind a network's back."""
    array = check_array(name, value).copy()
    array.flags.writeable = False
    return array
