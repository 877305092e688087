"""S networks side by side, one a seed: asked together, trained together, each as if it were alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from robonav.networks.multilayer_perceptron import Network, propagate

from . import _fast

if TYPE_CHECKING:
    import torch

Array = NDArray[np.float64]
Rows = NDArray[np.int64]


class Networks(Protocol):
    """What training needs of S networks with n inputs, one hidden layer and A outputs, wherever their numbers lie."""

    def logits(self, rows: Rows, x: Array) -> Array:
        """Logits (K, m, A) by the networks ``rows`` (K,), each for m inputs of its own: ``x`` (K, m, n)."""

    def descend(
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
        """Stochastic gradient descent on the cross-entropy, Eq. (4.11) and (4.12), for the networks ``rows`` (K,).

        Network ``rows[k]`` goes through the pairs ``first[k]`` to ``last[k]`` of its memory, rows of ``x`` (S, L, n)
        and ``y`` (S, L, A), one at a time with step ``gradient_step[k]``: at most ``passes`` times, and until the mean
        cost moves by less than ``tolerance`` from one pass to the next.
        """

    def slopes(
        self,
        rows: Rows,
        x: Array,
        actions: NDArray[np.int64],
        targets: Array,
        *,
        linear: bool,
    ) -> tuple[Array, Array]:
        """Slopes (K, P) by the parameters, and costs (K,), of m examples of each of ``rows`` (K,).

        Only the outputs of ``actions`` (K, m) for inputs ``x`` (K, m, n) are to be as ``targets`` (K, m). The cost is
        the mean cross-entropy of sigmoid outputs, or the mean Huber loss of ``linear`` ones.
        """

    def subtract(self, rows: Rows, steps: Array) -> None:
        """Take ``steps`` (K, P) off the parameters of ``rows`` (K,)."""

    def parameters(self) -> Array:
        """All parameters (S, P), copied; :func:`packed` says in which order."""

    def load(self, rows: Rows, parameters: Array) -> None:
        """Give ``rows`` (K,) these parameters (K, P)."""


class CompiledNetworks:
    """:class:`Networks` in a NumPy array, run by compiled kernels."""

    def __init__(self, network: Network) -> None:
        self._parameters, self._outputs = packed(network), network.sizes[-1]

    def logits(self, rows: Rows, x: Array) -> Array:
        z = np.empty((*x.shape[:2], self._outputs))
        _fast.logits(self._parameters, rows, x, z)
        return z

    def descend(
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
        _fast.descend(
            self._parameters, rows, x, y, first, last, gradient_step, passes, tolerance
        )

    def slopes(
        self,
        rows: Rows,
        x: Array,
        actions: NDArray[np.int64],
        targets: Array,
        *,
        linear: bool,
    ) -> tuple[Array, Array]:
        slope, costs = (
            np.empty((len(rows), self._parameters.shape[1])),
            np.empty(len(rows)),
        )
        _fast.slopes(
            self._parameters,
            rows,
            x,
            actions,
            targets,
            self._outputs,
            linear,
            slope,
            costs,
        )
        return slope, costs

    def subtract(self, rows: Rows, steps: Array) -> None:
        self._parameters[rows] -= steps

    def parameters(self) -> Array:
        return self._parameters.copy()

    def load(self, rows: Rows, parameters: Array) -> None:
        self._parameters[rows] = parameters


class TorchNetworks:
    """:class:`Networks` in a torch tensor, on whatever device torch has: the same steps, to rounding.

    What comes in goes :meth:`_there`, what goes out comes :meth:`_back_here`; in between nothing leaves the device.

    Raises
    ------
    ValueError : if torch has no such device, or none that computes in double precision.
    """

    def __init__(self, network: Network, device: str) -> None:
        import torch

        try:
            self._parameters = torch.tensor(packed(network), device=device)
        except (RuntimeError, AssertionError, TypeError) as error:
            reason = str(error).partition("\n")[0]
            raise ValueError(
                f"device must be one that torch has, got {device!r}: {reason}"
            ) from None
        self._sizes = network.sizes

    def logits(self, rows: Rows, x: Array) -> Array:
        _, z = self._propagate(rows, self._there(x))
        return self._back_here(z)

    def descend(
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
        going, before, counts = (
            np.arange(len(rows)),
            np.full(len(rows), np.inf),
            last - first,
        )
        for _ in range(passes):
            cost = np.zeros(len(rows))
            for step in range(int(counts[going].max(initial=0))):
                k = going[step < counts[going]]
                at = (rows[k], first[k] + step)
                cost[k] += self._step(
                    rows[k], self._there(x[at]), self._there(y[at]), gradient_step[k]
                )
            cost /= np.maximum(counts, 1)
            going = going[np.abs(before - cost)[going] >= tolerance]
            before = cost

    def _step(
        self, rows: Rows, x: torch.Tensor, y: torch.Tensor, gradient_step: Array
    ) -> Array:
        """One step of Eq. (4.12) for each of ``rows``; the costs (K,) before it."""
        import torch

        (_, hidden, q), z = self._propagate(rows, x[:, None])
        self._parameters[rows] -= self._there(gradient_step)[:, None] * self._slopes(
            rows, x[:, None], hidden, q - y[:, None]
        )
        return self._back_here(
            (torch.nn.functional.softplus(z[:, 0]) - y * z[:, 0]).sum(dim=1)
        )

    def slopes(
        self,
        rows: Rows,
        x: Array,
        actions: NDArray[np.int64],
        targets: Array,
        *,
        linear: bool,
    ) -> tuple[Array, Array]:
        import torch

        inputs, taken, wanted = (
            self._there(x),
            self._there(actions)[..., None],
            self._there(targets)[..., None],
        )
        (_, hidden, q), z = self._propagate(rows, inputs)
        answer, logit = (z if linear else q).gather(2, taken), z.gather(2, taken)
        huber = torch.nn.functional.huber_loss(answer, wanted, reduction="none")
        costs = (
            huber if linear else torch.nn.functional.softplus(logit) - wanted * logit
        )
        error = (answer - wanted).clamp(-1, 1) / x.shape[1]
        slope = self._slopes(
            rows, inputs, hidden, torch.zeros_like(z).scatter(2, taken, error)
        )
        return self._back_here(slope), self._back_here(costs.mean(dim=(1, 2)))

    def _slopes(
        self, rows: Rows, x: torch.Tensor, hidden: torch.Tensor, d2: torch.Tensor
    ) -> torch.Tensor:
        """Backpropagation, Eq. (3.14), (3.15): slopes (K, P) from the errors ``d2`` (K, m, A) of the outputs."""
        import torch

        _, _, w2, _ = self._unpacked(rows)
        d1 = d2 @ w2.mT * hidden * (1 - hidden)
        parts = (x.mT @ d1, d1.sum(dim=1), hidden.mT @ d2, d2.sum(dim=1))
        return torch.cat([part.flatten(1) for part in parts], dim=1)

    def subtract(self, rows: Rows, steps: Array) -> None:
        self._parameters[rows] -= self._there(steps)

    def parameters(self) -> Array:
        return self._back_here(self._parameters).copy()

    def load(self, rows: Rows, parameters: Array) -> None:
        self._parameters[rows] = self._there(parameters)

    def _propagate(
        self, rows: Rows, x: torch.Tensor
    ) -> tuple[list[torch.Tensor], torch.Tensor]:
        import torch

        w1, b1, w2, b2 = self._unpacked(rows)
        return propagate([w1.mT, w2.mT], [b1, b2], x, torch.sigmoid)

    def _unpacked(self, rows: Rows) -> tuple[torch.Tensor, ...]:
        n, h, a = self._sizes
        w1, b1, w2, b2 = self._parameters[rows].split([n * h, h, h * a, a], dim=1)
        return w1.reshape(-1, n, h), b1, w2.reshape(-1, h, a), b2

    def _there(self, array: NDArray) -> torch.Tensor:
        import torch

        return torch.as_tensor(array, device=self._parameters.device)

    def _back_here(self, tensor: torch.Tensor) -> Array:
        array: Array = tensor.cpu().numpy()
        return array


def packed(network: Network) -> Array:
    """A stack (S,) of networks as rows (S, P): w1 (n, H), b1 (H,), w2 (H, A), b2 (A,), one after the other.

    Weights lie transposed, with the unit they come from first: inner loops then run along memory.
    """
    pairs = zip(network.weights, network.biases, strict=True)
    parts = [part for weight, bias in pairs for part in (weight.swapaxes(-1, -2), bias)]
    return np.concatenate([part.reshape(len(part), -1) for part in parts], axis=1)


def network_of(parameters: Array, sizes: tuple[int, ...]) -> Network:
    """The networks of rows of parameters (..., P), in a stack (...): :func:`packed` undone.

    Parameters
    ----------
    sizes : n, H, A.
    """
    n, h, a = sizes
    stack = parameters.shape[:-1]
    w1, b1, w2, b2 = np.split(parameters, np.cumsum([n * h, h, h * a]), axis=-1)
    weights = (
        w1.reshape(*stack, n, h).swapaxes(-1, -2),
        w2.reshape(*stack, h, a).swapaxes(-1, -2),
    )
    return Network(weights, (b1, b2))
