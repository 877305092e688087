"""What makes arrays a network, and what makes arrays its examples."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array, check_real, checks

Array = NDArray[np.float64]


def checked_layers(
    weights: Sequence[ArrayLike], biases: Sequence[ArrayLike]
) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
    """Return copies of the arrays, which cannot be changed, if the shapes of each layer fit those of the next.

    Raises
    ------
    ValueError
        If the shapes do not fit each other, or a number is not finite.
    """
    kept_weights = tuple(
        _copied(f"weights[{layer}]", array) for layer, array in enumerate(weights)
    )
    kept_biases = tuple(
        _copied(f"biases[{layer}]", array) for layer, array in enumerate(biases)
    )
    if not kept_weights or len(kept_weights) != len(kept_biases):
        raise ValueError(
            f"weights and biases must be as many, at least one each, got {len(kept_weights)} and {len(kept_biases)}"
        )
    for layer, (weight, bias) in enumerate(zip(kept_weights, kept_biases, strict=True)):
        if weight.ndim < 2 or 0 in weight.shape:
            raise ValueError(
                f"weights[{layer}] must have shape (..., outputs, inputs), got {weight.shape}"
            )
        stack, units = weight.shape[:-2], weight.shape[-1]
        if layer > 0:
            *before, units_before = kept_weights[layer - 1].shape[:-1]
            if (*stack, units) != (*before, units_before):
                raise ValueError(
                    f"weights[{layer}] must take the {units_before} units of the layer before it "
                    f"and share its stack {tuple(before)}, got shape {weight.shape}"
                )
        if bias.shape != weight.shape[:-1]:
            raise ValueError(
                f"biases[{layer}] must have shape {weight.shape[:-1]}, got {bias.shape}"
            )
    return kept_weights, kept_biases


def _copied(name: str, value: ArrayLike) -> Array:
    """Copy the caller's array, so that later changes to it do not change the network."""
    array = check_array(name, value).copy()
    array.flags.writeable = False
    return array


def checked_examples(network: Any, x: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
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
    arguments["x"], arguments["y"] = checked_examples(
        arguments["network"], arguments["x"], arguments["y"]
    )


checked = checks(
    {"regularisation": partial(check_real, at_least=0)}, together=check_examples
)
"""Decorate a function of (network, x, y, regularisation) so that its arguments are checked before it runs."""
