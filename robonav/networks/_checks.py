"""Checks of the arrays of a network and of its training examples."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial, wraps
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.documentation import documents
from robonav.validation import (
    check_array,
    check_generator,
    check_integer,
    check_real,
    checks,
)

Array = NDArray[np.float64]
P = ParamSpec("P")
R = TypeVar("R")


def checked_layers(
    weights: Sequence[ArrayLike], biases: Sequence[ArrayLike]
) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
    """Check that the shapes of each layer fit those of the next, and return copies that cannot be changed.

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
            f"weights and biases must have one array for each layer, got {len(kept_weights)} and {len(kept_biases)}"
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


def keep_layers(network: Any, *, stacked: bool = False) -> None:
    """Check the arrays of a network that is being made, and let it hold copies of them.

    Raises
    ------
    ValueError
        As :func:`checked_layers` says, or if they are a stack of networks and ``stacked`` does not allow one.
    """
    weights, biases = checked_layers(network.weights, network.biases)
    if weights[0].ndim > 2 and not stacked:
        raise ValueError(
            f"weights[0] must have shape (outputs, inputs), got {weights[0].shape}; "
            "NetworkStack holds several networks"
        )
    object.__setattr__(network, "weights", weights)
    object.__setattr__(network, "biases", biases)


def checked_inputs(x: ArrayLike, units: int) -> Array:
    """Return inputs (..., units) of a network as an array of float."""
    inputs = check_array("x", x)
    if inputs.ndim == 0 or inputs.shape[-1] != units:
        raise ValueError(
            f"x must hold {units} inputs along its last axis, got shape {inputs.shape}"
        )
    return inputs


def takes_inputs(
    propagate: Callable[[Any, Array], R],
) -> Callable[[Any, ArrayLike], R]:
    """Decorate a network's pass over inputs (..., m, s[0]): it checks them, and takes a single input (s[0],) too."""

    @wraps(propagate)
    def checked(network: Any, x: ArrayLike) -> R:
        """Make the pass; a single input is a batch of one."""
        inputs = checked_inputs(x, network.sizes[0])
        if inputs.ndim > 1:
            return propagate(network, inputs)
        return _first_row(propagate(network, inputs[None]))

    return checked


def _first_row(rows: Any) -> Any:
    """The first row of an array (..., m, s), or of each array in a list or tuple."""
    if isinstance(rows, list | tuple):
        return type(rows)(_first_row(part) for part in rows)
    return rows[..., 0, :]


def _checked_sizes(name: str, sizes: Any) -> list[int]:
    units = [check_integer(name, size, at_least=1) for size in sizes]
    if len(units) < 2:
        raise ValueError(
            f"sizes must name at least an input and an output layer, got {units}"
        )
    return units


checked_random = checks(
    {
        "sizes": _checked_sizes,
        "seed": check_generator,
        "spread": partial(check_real, at_least=0),
    }
)
"""Decorate a function of (sizes, seed, spread) so that its arguments are checked before it runs."""


def check_single(network: Any) -> None:
    """Raise ValueError if a network is a stack of several."""
    stack = network.weights[0].shape[:-2]
    if stack:
        raise ValueError(f"network must be a single one, got a stack of shape {stack}")


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
    check_single(network)
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


DOCUMENTATION = {
    "network": """Network
    A single network.""",
    "x": """(m, s[0]) array
    Inputs.""",
    "y": """(m, s[-1]) array
    Labels in [0, 1].""",
    "gradient_step": """float
    alpha, which the thesis calls the learning rate.""",
    "regularisation": """float
    lambda, at least 0. It acts on the weights, never on the biases.""",
    "iterations": """int
    The most iterations to make.""",
    "record": """bool
    Keep the network of every iteration.""",
    "progress": """callable, optional
    Called as ``progress(done, iterations)`` after every iteration.""",
}
BAD_EXAMPLES = """ValueError
    If a shape does not fit, there is no example, or a label lies outside [0, 1]."""

documented = documents(DOCUMENTATION, raises=BAD_EXAMPLES)
"""Decorate a function of (network, x, y, ...): its docstring gets what it leaves out of parameters and errors."""

checked_arguments = checks(
    {"regularisation": partial(check_real, at_least=0)}, together=check_examples
)


def checked(function: Callable[P, R]) -> Callable[P, R]:
    """Decorate a function of (network, x, y, regularisation): it checks its arguments and documents them."""
    return documented(checked_arguments(function))
