"""L-BFGS on the cost of Eq. (3.22), by torch in double precision, its gradients by autograd."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import torch
from torch.nn.functional import binary_cross_entropy_with_logits

from .multilayer_perceptron import Array, Network, propagate
from .training_history import Iterate, fraction_correct

MEMORY = 10  # pairs of steps and gradient changes that stand for the curvature
LINE_SEARCH = 25  # evaluations a line search may take
FLAT = 1e-9  # largest entry of a gradient that counts as zero


def lbfgs_iterates(
    network: Network, x: Array, y: Array, *, regularisation: float, iterations: int
) -> Iterator[Iterate]:
    """The states that L-BFGS goes through, the first as it finds it; ends early where no step lowers the cost.

    Parameters
    ----------
    network : where to start.
    x : inputs (m, s[0]).
    y : labels (m, s[-1]) in [0, 1].
    regularisation : lambda.
    iterations : steps at most.
    """
    weights = [torch.tensor(weight, requires_grad=True) for weight in network.weights]
    biases = [torch.tensor(bias, requires_grad=True) for bias in network.biases]
    parameters = [*weights, *biases]
    inputs, labels = torch.tensor(x), torch.tensor(y)
    optimiser = torch.optim.LBFGS(
        parameters,
        max_iter=1,
        max_eval=1
        + LINE_SEARCH,  # else one iteration leaves the line search a single evaluation, and it stalls
        history_size=MEMORY,
        tolerance_grad=FLAT,
        tolerance_change=0,
        line_search_fn="strong_wolfe",
    )
    z = torch.empty_like(labels)
    value = torch.tensor(torch.nan)
    evaluated = torch.full_like(_vector(parameters), torch.nan)

    def cost() -> torch.Tensor:
        """Eq. (3.22) here; each iteration first asks again where the last one ended, which is not computed twice."""
        nonlocal z, value, evaluated
        here = _vector(parameters)
        if not torch.equal(here, evaluated):
            _, z = propagate(weights, biases, inputs, torch.sigmoid)
            error = binary_cross_entropy_with_logits(z, labels, reduction="sum")
            decay = (
                regularisation
                / 2
                * torch.stack([weight.square().sum() for weight in weights]).sum()
            )
            value, evaluated = (error + decay) / len(inputs), here
            for parameter, slope in zip(
                parameters, torch.autograd.grad(value, parameters), strict=True
            ):
                parameter.grad = slope
        return value.detach()

    def state() -> Iterate:
        reached = Network(tuple(map(_numbers, weights)), tuple(map(_numbers, biases)))
        return Iterate(reached, float(cost()), fraction_correct(z, labels))

    with _one_thread():
        yield state()
        for _ in range(iterations):
            before = _vector(parameters)
            optimiser.step(cost)
            if torch.equal(_vector(parameters), before):
                return
            yield state()


@contextmanager
def _one_thread() -> Iterator[None]:
    """Small matrices: more threads are slower, and would add up the examples in another order on another machine."""
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(threads)


def _vector(parameters: list[torch.Tensor]) -> torch.Tensor:
    return torch.cat([parameter.detach().ravel() for parameter in parameters])


def _numbers(parameter: torch.Tensor) -> Array:
    return parameter.detach().numpy()
