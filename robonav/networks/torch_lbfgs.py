"""L-BFGS on the cost of Eq. (3.22), by torch in double precision with gradients by autograd."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import torch
from torch.nn.functional import binary_cross_entropy_with_logits

from .multilayer_perceptron import Array, Network, propagate
from .training_history import Iterate, fraction_correct

MEMORY = 10  # pairs of steps and gradient changes that approximate the curvature
LINE_SEARCH = 25  # evaluations that a line search may take
FLAT = 1e-9  # the largest entry of a gradient that counts as zero


def lbfgs_iterates(
    network: Network, x: Array, y: Array, *, regularisation: float, iterations: int
) -> Iterator[Iterate]:
    """Minimise the cross-entropy cost by L-BFGS (Liu and Nocedal 1989), one iterate after the other.

    Parameters
    ----------
    network : Network
        Where to start.
    x : (m, s[0]) array
        Inputs.
    y : (m, s[-1]) array
        Labels in [0, 1].
    regularisation : float
        lambda.
    iterations : int
        The most iterations to make.

    Yields
    ------
    Iterate
        The first is the network as it came. The iteration ends early where no step lowers the cost.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import random_network
    >>> from robonav.networks.torch_lbfgs import lbfgs_iterates
    >>> x, y = np.array([[0.0], [1.0]]), np.array([[0.0], [1.0]])
    >>> start = random_network((1, 1), seed=0)
    >>> costs = [iterate.cost for iterate in lbfgs_iterates(start, x, y, regularisation=0.1, iterations=5)]
    >>> costs == sorted(costs, reverse=True)
    True
    """
    cost = CrossEntropy(network, x, y, regularisation)
    optimiser = torch.optim.LBFGS(
        cost.parameters,
        max_iter=1,
        max_eval=1 + LINE_SEARCH,  # with fewer evaluations the line search stalls
        history_size=MEMORY,
        tolerance_grad=FLAT,
        tolerance_change=0,
        line_search_fn="strong_wolfe",
    )
    with one_thread():
        yield cost.iterate()
        for _ in range(iterations):
            before = cost.position()
            optimiser.step(cost)
            if torch.equal(cost.position(), before):
                return
            yield cost.iterate()


class CrossEntropy:
    """The cross-entropy cost as a torch function without arguments, which also sets the gradients.

    Each iteration of L-BFGS first asks for the cost where the last one ended. That cost is not computed again.

    Parameters
    ----------
    network, x, y, regularisation
        As in :func:`lbfgs_iterates`.
    """

    def __init__(
        self, network: Network, x: Array, y: Array, regularisation: float
    ) -> None:
        self.weights = [torch.tensor(w, requires_grad=True) for w in network.weights]
        self.biases = [torch.tensor(b, requires_grad=True) for b in network.biases]
        self.parameters = [*self.weights, *self.biases]
        self.inputs, self.labels = torch.tensor(x), torch.tensor(y)
        self.regularisation = regularisation
        self._logits = torch.empty_like(self.labels)
        self._value = torch.tensor(torch.nan)
        self._evaluated = torch.full_like(self.position(), torch.nan)

    def position(self) -> torch.Tensor:
        """Return all parameters as one vector."""
        return torch.cat([parameter.detach().ravel() for parameter in self.parameters])

    def __call__(self) -> torch.Tensor:
        here = self.position()
        if not torch.equal(here, self._evaluated):
            self._value, self._evaluated = self._compute(), here
            slopes = torch.autograd.grad(self._value, self.parameters)
            for parameter, slope in zip(self.parameters, slopes, strict=True):
                parameter.grad = slope
        return self._value.detach()

    def _compute(self) -> torch.Tensor:
        _, z = propagate(self.weights, self.biases, self.inputs, torch.sigmoid)
        self._logits = z
        error = binary_cross_entropy_with_logits(z, self.labels, reduction="sum")
        squares = torch.stack([weight.square().sum() for weight in self.weights]).sum()
        return (error + self.regularisation / 2 * squares) / len(self.inputs)

    def iterate(self) -> Iterate:
        """Return the network as it is now, its cost and its accuracy."""
        weights = tuple(weight.detach().numpy() for weight in self.weights)
        biases = tuple(bias.detach().numpy() for bias in self.biases)
        cost = float(self())
        accuracy = fraction_correct(self._logits, self.labels)
        return Iterate(Network(weights, biases), cost, accuracy)


@contextmanager
def one_thread() -> Iterator[None]:
    """Let torch use one thread.

    The matrices are small, so that more threads would be slower. They would also add up the examples in another order
    on another machine.
    """
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(threads)
