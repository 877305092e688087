"""The history of a training, iteration by iteration."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from robonav.progress import Progress

from ._checks import checked_examples
from .multilayer_perceptron import Array, Network, stacked


@dataclass(frozen=True, eq=False)
class TrainingHistory:
    """A trained network and its history; row 0 is the network before training.

    Attributes
    ----------
    network : Network
        The network after the last iteration.
    costs : (iterations + 1,) array
        Cost of the training examples.
    accuracies : (iterations + 1,) array
        Fraction of the training examples whose largest output is the labelled one.
    networks : Network, optional
        A stack (iterations + 1,) of the networks of every iteration, if recorded.

    Examples
    --------
    >>> from robonav.networks import fit
    >>> from robonav.networks.toy_datasets import disc
    >>> history = fit(*disc(50, seed=0), iterations=5)
    >>> history.iterations, history.costs.shape
    (5, (6,))
    """

    network: Network
    costs: Array
    accuracies: Array
    networks: Network | None = None

    @property
    def iterations(self) -> int:
        """Number of iterations made: fewer than asked for if the cost could not fall further."""
        return len(self.costs) - 1


class Iterate(NamedTuple):
    """A network on its way through an optimiser, with its cost and its accuracy on the training examples."""

    network: Network
    cost: float
    accuracy: float


def run_optimiser(
    iterates: Iterator[Iterate],
    iterations: int,
    *,
    record: bool,
    progress: Progress | None,
) -> TrainingHistory:
    """Run an optimiser, given as an iterator over its iterates, and keep the history."""
    costs, accuracies, networks = [], [], []
    for done, iterate in enumerate(iterates):
        costs.append(iterate.cost)
        accuracies.append(iterate.accuracy)
        if record:
            networks.append(iterate.network)
        if progress is not None:
            progress(done, iterations)
    return TrainingHistory(
        iterate.network,
        np.array(costs),
        np.array(accuracies),
        stacked(networks) if record else None,
    )


def accuracy(network: Network, x: ArrayLike, y: ArrayLike) -> float:
    """Return the fraction of examples whose largest output is the labelled one.

    A network with a single output says yes where it is above 1/2.

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
    float

    Examples
    --------
    >>> from robonav.networks import accuracy, random_network
    >>> accuracy(random_network((2, 1), seed=0, spread=0), [[0, 0], [1, 1]], [[0], [1]])
    0.5
    """
    inputs, labels = checked_examples(network, x, y)
    return fraction_correct(network.logits(inputs), labels)


def fraction_correct(z: Any, y: Any) -> float:
    """Return the fraction of logits ``z`` (m, K) that agree with the labels ``y`` (m, K), in NumPy or torch."""
    right = (z > 0) == (y > 0.5) if z.shape[1] == 1 else z.argmax(1) == y.argmax(1)
    return float(right.sum()) / len(z)
