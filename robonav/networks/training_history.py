"""The history of a training, iteration by iteration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from robonav.progress import Progress

from ._checks import checked_examples
from .multilayer_perceptron import Array, Network
from .network_stack import NetworkStack, stacked


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
    networks : NetworkStack, optional
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
    networks: NetworkStack | None = None

    @property
    def iterations(self) -> int:
        """Number of iterations made: fewer than asked for if the cost could not fall further."""
        return len(self.costs) - 1


class Iterate(NamedTuple):
    """A network on its way through an optimiser, with its cost and its accuracy on the training examples."""

    network: Network
    cost: float
    accuracy: float


class Recorder:
    """Keeps the history of a training while it runs.

    Parameters
    ----------
    iterations : int
        How many there will be, at most.
    record : bool
        Whether to keep the network of every iteration.
    progress : callable, optional
        Called as ``progress(done, iterations)``.
    """

    def __init__(
        self, iterations: int, *, record: bool, progress: Progress | None
    ) -> None:
        self.iterations, self.record, self.progress = iterations, record, progress
        self._costs: list[float] = []
        self._accuracies: list[float] = []
        self._networks: list[Network] = []  # of every iteration, or of the last

    def add(self, network: Network, cost: float, accuracy: float) -> None:
        """Keep an iteration; the first is the network as it came."""
        if not self.record:
            self._networks.clear()
        self._networks.append(network)
        self._costs.append(cost)
        self._accuracies.append(accuracy)
        if self.progress is not None:
            self.progress(len(self._costs) - 1, self.iterations)

    def history(self) -> TrainingHistory:
        """Return what was kept."""
        return TrainingHistory(
            self._networks[-1],
            np.array(self._costs),
            np.array(self._accuracies),
            stacked(self._networks) if self.record else None,
        )


def network_accuracy(network: Network, x: ArrayLike, y: ArrayLike) -> float:
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
    >>> from robonav.networks import network_accuracy, random_network
    >>> network_accuracy(random_network((2, 1), seed=0, spread=0), [[0, 0], [1, 1]], [[0], [1]])
    0.5
    """
    inputs, labels = checked_examples(network, x, y)
    return fraction_correct(network.logits(inputs), labels)


def fraction_correct(z: Any, y: Any) -> float:
    """Return the fraction of logits ``z`` (m, K) that agree with the labels ``y`` (m, K), in NumPy or torch.

    Examples
    --------
    >>> fraction_correct(np.array([[2.0, 1.0], [0.0, 3.0]]), np.array([[1, 0], [1, 0]]))
    0.5
    """
    right = (z > 0) == (y > 0.5) if z.shape[1] == 1 else z.argmax(1) == y.argmax(1)
    return float(right.sum()) / len(z)
