"""Many networks of one shape in one object: over seeds, or over the iterations of a training."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._checks import keep_layers, takes_inputs
from ._fast.stacks import propagate_stack
from .multilayer_perceptron import Array, Network


@dataclass(frozen=True, eq=False)
class NetworkStack(Network):
    """A stack of networks of one shape.

    Leading dimensions, the same for every array, stack the networks. An index over them gives one network, or a smaller
    stack. Inputs have the stack's dimensions before their own, or go to all its networks.

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
    >>> from robonav.networks import random_network, stacked
    >>> networks = stacked([random_network((2, 1), seed=seed) for seed in range(3)])
    >>> networks.forward([[0, 1], [1, 0]]).shape
    (3, 2, 1)
    >>> networks[0].forward([[0, 1], [1, 0]]).shape
    (2, 1)
    """

    def __post_init__(self) -> None:
        keep_layers(self, stacked=True)

    @property
    def stack(self) -> tuple[int, ...]:
        """The leading dimensions."""
        return self.weights[0].shape[:-2]

    def __getitem__(self, index: Any) -> Any:
        """One :class:`Network`, or a smaller stack, by an index over the leading dimensions."""
        return network_of(
            [weight[index] for weight in self.weights],
            [bias[index] for bias in self.biases],
        )

    @takes_inputs
    def forward(self, x: Array) -> Array:
        """Outputs of each network.

        Parameters
        ----------
        x : (..., m, s[0]) array
            Inputs.

        Returns
        -------
        (..., m, s[-1]) array

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.networks import random_network, stacked
        >>> two = stacked([random_network((3, 2, 1), seed=seed) for seed in (0, 1)])
        >>> two.forward(np.ones((2, 4, 3))).shape
        (2, 4, 1)
        """
        return propagate_stack(self.weights, self.biases, x)[0][-1]

    @takes_inputs
    def activations(self, x: Array) -> list[Array]:
        """Return the activations of every layer of each network, the input first and the output last.

        Parameters
        ----------
        x : (..., m, s[0]) array
            Inputs.

        Returns
        -------
        list of (..., m, s[l]) arrays

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.networks import random_network, stacked
        >>> two = stacked([random_network((3, 2, 1), seed=seed) for seed in (0, 1)])
        >>> [layer.shape for layer in two.activations(np.ones((2, 4, 3)))]
        [(2, 4, 3), (2, 4, 2), (2, 4, 1)]
        """
        return propagate_stack(self.weights, self.biases, x)[0]

    @takes_inputs
    def logits(self, x: Array) -> Array:
        """Return the weighted sums z of each network's output layer, before its sigmoid.

        Parameters
        ----------
        x : (..., m, s[0]) array
            Inputs.

        Returns
        -------
        (..., m, s[-1]) array

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.networks import random_network, stacked
        >>> two = stacked([random_network((3, 2, 1), seed=seed) for seed in (0, 1)])
        >>> two.logits(np.ones((2, 4, 3))).shape
        (2, 4, 1)
        """
        return propagate_stack(self.weights, self.biases, x)[1]


def network_of(weights: Sequence[Array], biases: Sequence[Array]) -> Network:
    """Make a network of the arrays of one, or a stack of those of several.

    Parameters
    ----------
    weights, biases : sequences of arrays
        As :class:`Network` or :class:`NetworkStack` takes them.

    Returns
    -------
    Network
        A :class:`NetworkStack` where there are leading dimensions.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks.network_stack import network_of
    >>> type(network_of([np.ones((5, 1, 2))], [np.ones((5, 1))])).__name__
    'NetworkStack'
    """
    one = not weights or np.ndim(weights[0]) <= 2
    return (Network if one else NetworkStack)(tuple(weights), tuple(biases))


def stacked(networks: Sequence[Network]) -> NetworkStack:
    """Stack networks of one shape along a new first dimension.

    Parameters
    ----------
    networks : sequence of Network

    Returns
    -------
    NetworkStack

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
    shapes = {tuple(weight.shape for weight in each.weights) for each in networks}
    if len(shapes) != 1:
        raise ValueError("networks must be at least one, all of the same sizes")
    return NetworkStack(
        tuple(
            np.stack(w) for w in zip(*(each.weights for each in networks), strict=True)
        ),
        tuple(
            np.stack(b) for b in zip(*(each.biases for each in networks), strict=True)
        ),
    )
