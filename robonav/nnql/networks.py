"""S networks side by side, one a seed: asked together, trained together, each as if it were alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from robonav.lfd.network import Network, propagate

from . import kernels

if TYPE_CHECKING:
    import torch

Array = NDArray[np.float64]
Rows = NDArray[np.int64]
Arrays = tuple[Array, Array, Array, Array]


class Networks(Protocol):
    """What training needs of S networks with n inputs, one hidden layer and A outputs, wherever their numbers lie."""

    def logits(self, rows: Rows, x: Array) -> Array:
        """Logits (K, A) by the networks ``rows`` (K,), each for its own input of ``x`` (K, n)."""

    def descend(
        self, rows: Rows, x: Array, y: Array, first: Rows, last: Rows, *, rate: Array, passes: int, tolerance: float
    ) -> None:
        """Stochastic gradient descent on the cross-entropy, Eq. (4.11) and (4.12), for the networks ``rows`` (K,).

        Network ``rows[k]`` goes through the examples ``first[k]`` to ``last[k]`` of its memory, rows of ``x``
        (S, L, n) and ``y`` (S, L, A), one at a time with step ``rate[k]``: at most ``passes`` times, and until the
        mean cost moves by less than ``tolerance`` from one pass to the next.
        """

    def tensors(self) -> list[torch.Tensor]:
        """The parameters themselves: weights (S, from, to) and biases (S, to), layer by layer."""

    def arrays(self) -> Arrays:
        """A copy of the parameters, in the same order."""


class CompiledNetworks:
    """:class:`Networks` in NumPy arrays, run by compiled kernels."""

    def __init__(self, network: Network) -> None:
        self.parameters = parameters_of(network)

    def logits(self, rows: Rows, x: Array) -> Array:
        z = np.empty((len(rows), self.parameters[-1].shape[-1]))
        kernels.logits(rows, *self.parameters, x, z)
        return z

    def descend(
        self, rows: Rows, x: Array, y: Array, first: Rows, last: Rows, *, rate: Array, passes: int, tolerance: float
    ) -> None:
        kernels.descend(rows, *self.parameters, x, y, first, last, rate, passes, tolerance)

    def tensors(self) -> list[torch.Tensor]:
        import torch

        return [torch.from_numpy(array) for array in self.parameters]

    def arrays(self) -> Arrays:
        w1, b1, w2, b2 = (array.copy() for array in self.parameters)
        return w1, b1, w2, b2


class TorchNetworks:
    """:class:`Networks` in torch tensors, on whatever device torch has: the same steps, to rounding."""

    def __init__(self, network: Network, device: str) -> None:
        import torch

        self.parameters = [torch.tensor(array, device=device) for array in parameters_of(network)]

    def logits(self, rows: Rows, x: Array) -> Array:

        w1, b1, w2, b2 = (tensor[rows] for tensor in self.parameters)
        _, z = torch_propagate([w1, w2], [b1, b2], self._here(x)[:, None])
        return z[:, 0].cpu().numpy()

    def descend(
        self, rows: Rows, x: Array, y: Array, first: Rows, last: Rows, *, rate: Array, passes: int, tolerance: float
    ) -> None:

        going, before = np.arange(len(rows)), np.full(len(rows), np.inf)
        counts = last - first
        for _ in range(passes):
            cost = np.zeros(len(rows))
            for step in range(int(counts[going].max(initial=0))):
                k = going[step < counts[going]]
                at = (rows[k], first[k] + step)
                cost[k] += self._step(rows[k], self._here(x[at]), self._here(y[at]), self._here(rate[k]))
            cost /= np.maximum(counts, 1)
            going = going[np.abs(before - cost)[going] >= tolerance]
            before = cost

    def _step(self, rows: Rows, x: torch.Tensor, y: torch.Tensor, rate: torch.Tensor) -> Array:
        """One step of Eq. (4.12) for each of ``rows``; the costs (K,) before it."""
        import torch

        w1, b1, w2, b2 = (tensor[rows] for tensor in self.parameters)
        (_, hidden, q), z = torch_propagate([w1, w2], [b1, b2], x[:, None])
        h = hidden[:, 0]
        d2 = q[:, 0] - y
        d1 = (w2 @ d2[..., None])[..., 0] * h * (1 - h)
        steps = (x[:, :, None] * d1[:, None], d1, h[:, :, None] * d2[:, None], d2)
        for tensor, step in zip(self.parameters, steps, strict=True):
            tensor[rows] -= rate.reshape(-1, *[1] * (step.ndim - 1)) * step
        z = z[:, 0]
        return (torch.nn.functional.softplus(z) - y * z).sum(dim=1).cpu().numpy()

    def _here(self, array: Array) -> torch.Tensor:
        import torch

        return torch.as_tensor(array, device=self.parameters[0].device)

    def tensors(self) -> list[torch.Tensor]:
        return self.parameters

    def arrays(self) -> Arrays:
        w1, b1, w2, b2 = (tensor.cpu().numpy().copy() for tensor in self.parameters)
        return w1, b1, w2, b2


def parameters_of(network: Network) -> Arrays:
    """A stack (S,) of networks as ``w1`` (S, n, H), ``b1`` (S, H), ``w2`` (S, H, A), ``b2`` (S, A), copied.

    Weights lie transposed, with the unit they come from first: inner loops then run along memory.
    """
    w1, w2 = (np.ascontiguousarray(weight.swapaxes(-1, -2)) for weight in network.weights)
    b1, b2 = (bias.copy() for bias in network.biases)
    return w1, b1, w2, b2


def network_of(arrays: Arrays) -> Network:
    """The network, or stack of networks, with these parameters: the other way."""
    w1, b1, w2, b2 = arrays
    return Network((w1.swapaxes(-1, -2), w2.swapaxes(-1, -2)), (b1, b2))


def torch_propagate(weights: list[Any], biases: list[Any], x: Any) -> tuple[list[Any], Any]:
    """:func:`robonav.lfd.network.propagate` in torch, for weights (..., from, to)."""
    import torch

    return propagate([weight.swapaxes(-1, -2) for weight in weights], biases, x, torch.sigmoid)
