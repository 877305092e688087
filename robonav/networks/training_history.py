"""What a training goes through, iteration by iteration."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from robonav.progress import Progress

from .backpropagation import examples
from .multilayer_perceptron import Array, Network, stacked


@dataclass(frozen=True, eq=False)
class TrainingHistory:
    """A trained network and how it came about; row 0 is the network before training.

    Parameters
    ----------
    network : what the last iteration left.
    costs : cost (iterations + 1,) of the training examples.
    accuracies : fraction (iterations + 1,) of the training examples answered as labelled.
    networks : stack (iterations + 1,) of the networks of every iteration, where it was asked for.
    """

    network: Network
    costs: Array
    accuracies: Array
    networks: Network | None = None

    @property
    def iterations(self) -> int:
        """Iterations made; fewer than asked for if the cost could not fall further."""
        return len(self.costs) - 1


class Iterate(NamedTuple):
    """Where an optimiser stands."""

    network: Network
    cost: float
    accuracy: float


def run_optimiser(
    states: Iterator[Iterate],
    iterations: int,
    *,
    record: bool,
    progress: Progress | None,
) -> TrainingHistory:
    """Run an optimiser, given as the states it goes through, and keep its history."""
    costs, accuracies, networks = [], [], []
    for done, state in enumerate(states):
        costs.append(state.cost)
        accuracies.append(state.accuracy)
        if record:
            networks.append(state.network)
        if progress is not None:
            progress(done, iterations)
    return TrainingHistory(
        state.network,
        np.array(costs),
        np.array(accuracies),
        stacked(networks) if record else None,
    )


def accuracy(network: Network, x: ArrayLike, y: ArrayLike) -> float:
    """The fraction of examples whose strongest output is the labelled one; a single output says yes above 1/2.

    Parameters
    ----------
    network : a single network.
    x : inputs (m, s[0]).
    y : labels (m, s[-1]) in [0, 1].
    """
    inputs, labels = examples(network, x, y)
    return fraction_correct(network.logits(inputs), labels)


def fraction_correct(z: Any, y: Any) -> float:
    """The fraction of logits (m, K), NumPy or torch, that say what the labels (m, K) say."""
    right = (z > 0) == (y > 0.5) if z.shape[1] == 1 else z.argmax(1) == y.argmax(1)
    return float(right.sum()) / len(z)
