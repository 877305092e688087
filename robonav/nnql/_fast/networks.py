"""S networks side by side, one for each seed: evaluated together and trained together, each as if it were alone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robonav.networks.network_stack import NetworkStack

from . import kernels

Array = NDArray[np.float64]
Rows = NDArray[np.int64]


class BatchedNetworks:
    """S networks with n inputs, one hidden layer and A outputs, as rows of one array, run by compiled kernels.

    Parameters
    ----------
    network : Network
        A stack (S,) of networks.
    """

    def __init__(self, network: NetworkStack) -> None:
        self._parameters = parameters_to_vectors(network)
        self._outputs = network.sizes[-1]

    def logits(self, rows: Rows, x: Array) -> Array:
        """Logits (K, m, A) of the networks ``rows`` (K,), each for m inputs of its own: ``x`` (K, m, n)."""
        z = np.empty((*x.shape[:2], self._outputs))
        kernels.logits(self._parameters, rows, x, z)
        return z

    def sgd(
        self,
        rows: Rows,
        x: Array,
        y: Array,
        first: Rows,
        last: Rows,
        *,
        gradient_step: Array,
        passes: int,
        tolerance: float,
    ) -> None:
        """Stochastic gradient descent of the networks ``rows`` (K,), as in :func:`robonav.nnql.train_on_pairs`.

        Network ``rows[k]`` goes through the pairs ``first[k]`` to ``last[k] - 1`` of its own: rows of ``x`` (S, L, n)
        and ``y`` (S, L, A), with the step ``gradient_step[k]``. It does so at most ``passes`` times, and stops when the
        mean cost changes by less than ``tolerance`` from one pass to the next.
        """
        kernels.sgd(
            self._parameters, rows, x, y, first, last, gradient_step, passes, tolerance
        )

    def gradients(
        self,
        rows: Rows,
        x: Array,
        actions: NDArray[np.int64],
        targets: Array,
        *,
        linear: bool,
    ) -> tuple[Array, Array]:
        """Gradients (K, P) and costs (K,) of m examples of each of the networks ``rows`` (K,).

        Only the outputs of ``actions`` (K, m) for the inputs ``x`` (K, m, n) count, and should be ``targets`` (K, m).
        The cost is the mean cross-entropy of sigmoid outputs, or the mean Huber loss of ``linear`` ones.
        """
        gradients = np.empty((len(rows), self._parameters.shape[1]))
        costs = np.empty(len(rows))
        kernels.gradients(
            self._parameters, rows, x, actions, targets, self._outputs, linear, gradients, costs,
        )  # fmt: skip
        return gradients, costs

    def apply_update(self, rows: Rows, update: Array) -> None:
        """Subtract ``update`` (K, P) from the parameters of the networks ``rows`` (K,)."""
        self._parameters[rows] -= update

    def parameters(self) -> Array:
        """A copy of all parameters (S, P), in the order of :func:`parameters_to_vectors`."""
        return self._parameters.copy()

    def load(self, rows: Rows, parameters: Array) -> None:
        """Set the parameters of the networks ``rows`` (K,) to ``parameters`` (K, P)."""
        self._parameters[rows] = parameters


def parameters_to_vectors(network: NetworkStack) -> Array:
    """A stack (S,) of networks as rows (S, P): w1 (n, H), b1 (H,), w2 (H, A), b2 (A,), one after the other.

    The weights are transposed, with the unit they come from first, so that inner loops run along memory.
    """
    pairs = zip(network.weights, network.biases, strict=True)
    parts = [part for weight, bias in pairs for part in (weight.swapaxes(-1, -2), bias)]
    return np.concatenate([part.reshape(len(part), -1) for part in parts], axis=1)


def vectors_to_parameters(parameters: Array, sizes: tuple[int, ...]) -> NetworkStack:
    """The inverse of :func:`parameters_to_vectors`: networks (...) with ``sizes`` n, H, A from rows (..., P)."""
    n, h, a = sizes
    stack = parameters.shape[:-1]
    w1, b1, w2, b2 = np.split(parameters, np.cumsum([n * h, h, h * a]), axis=-1)
    weights = (
        w1.reshape(*stack, n, h).swapaxes(-1, -2),
        w2.reshape(*stack, h, a).swapaxes(-1, -2),
    )
    return NetworkStack(weights, (b1, b2))
