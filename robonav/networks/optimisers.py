"""Training a network: batch gradient descent by hand (section 3.3.1), then L-BFGS with torch (section 3.4.3)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike

from robonav.progress import Progress
from robonav.validation import check_array, check_integer, check_positive, check_real

from .backpropagation import SQUARED_ERROR, Objective, examples
from .multilayer_perceptron import Array, Network, random_network
from .training_history import Iterate, TrainingHistory, accuracy, run_optimiser

MOST_ITERATIONS = 100_000  # minutes of work; more is a slip of the pen


def one_hot(actions: ArrayLike, count: int) -> Array:
    """Labels (m, count) with a 1 at each example's action, 0 elsewhere (section 3.4.1)."""
    indices = check_array("actions", actions, shape=("m",), dtype=np.intp)
    width = check_integer("count", count, at_least=1)
    if len(indices) and not 0 <= indices.min() <= indices.max() < width:
        raise ValueError(
            f"actions must lie in 0..{width - 1}, got {indices.min()}..{indices.max()}"
        )
    return np.eye(width)[indices]


def gradient_descent(
    network: Network,
    x: ArrayLike,
    y: ArrayLike,
    *,
    gradient_step: float,
    iterations: int,
    regularisation: float = 0.0,
    objective: Objective = SQUARED_ERROR,
    record: bool = False,
    progress: Progress | None = None,
) -> TrainingHistory:
    """Batch gradient descent, Eq. (3.8), (3.16), (3.28): all examples, one step against the gradient, and again.

    Parameters
    ----------
    network : where to start.
    x : inputs (m, s[0]).
    y : labels (m, s[-1]) in [0, 1].
    gradient_step : the learning rate alpha, positive; too large, and the cost rises or jumps about.
    iterations : steps to take, at most 100,000.
    regularisation : lambda, at least 0.
    objective : ``SQUARED_ERROR``, Eq. (3.7), or ``CROSS_ENTROPY``, Eq. (3.22).
    record : keep the network of every iteration.
    progress : called as ``progress(done, iterations)``.

    Raises
    ------
    ValueError : if shapes do not fit, an argument lies outside its range, or the weights grow out of all bounds.
    """
    alpha = check_positive("gradient_step", gradient_step)
    steps = check_integer("iterations", iterations, at_least=0, at_most=MOST_ITERATIONS)

    def state(current: Network) -> Iterate:
        return Iterate(
            current,
            objective.cost(current, x, y, regularisation=regularisation),
            accuracy(current, x, y),
        )

    def descend() -> Iterator[Iterate]:
        current = network
        yield state(current)
        for _ in range(steps):
            slope = objective.gradient(current, x, y, regularisation=regularisation)
            current = Network(
                tuple(
                    w - alpha * dw
                    for w, dw in zip(current.weights, slope.weights, strict=True)
                ),
                tuple(
                    b - alpha * db
                    for b, db in zip(current.biases, slope.biases, strict=True)
                ),
            )
            yield state(current)

    return run_optimiser(descend(), steps, record=record, progress=progress)


def lbfgs(
    network: Network,
    x: ArrayLike,
    y: ArrayLike,
    *,
    regularisation: float = 1.0,
    iterations: int = 300,
    record: bool = False,
    progress: Progress | None = None,
) -> TrainingHistory:
    """Minimise the cost of Eq. (3.22) by L-BFGS (Liu and Nocedal, 1989), from ``network`` on.

    The thesis's fminunc is of the same quasi-Newton family. Ends early where no step lowers the cost any more.
    Parameters, and what is raised, as in :func:`gradient_descent`.
    """
    inputs, labels = examples(network, x, y)
    decay = check_real("regularisation", regularisation, at_least=0)
    steps = check_integer("iterations", iterations, at_least=0, at_most=MOST_ITERATIONS)
    from .torch_lbfgs import (
        lbfgs_iterates,  # brings torch, which planning can do without
    )

    iterates = lbfgs_iterates(
        network, inputs, labels, regularisation=decay, iterations=steps
    )
    return run_optimiser(iterates, steps, record=record, progress=progress)


def fit(
    x: ArrayLike,
    y: ArrayLike,
    *,
    hidden: int | Sequence[int] = 8,
    regularisation: float = 1.0,
    iterations: int = 300,
    seed: int | np.random.Generator = 0,
    record: bool = False,
    progress: Progress | None = None,
) -> TrainingHistory:
    """Train a new network on examples, as Algorithm 3 does (step 7): random weights, then L-BFGS on Eq. (3.22).

    Parameters
    ----------
    x : inputs (m, n).
    y : labels (m, K) in [0, 1], such as :func:`one_hot` actions.
    hidden : units of the hidden layer, or of several; () for none.
    regularisation : lambda, at least 0.
    iterations : of L-BFGS, at most; itself at most 100,000.
    seed : of the initial weights.
    record : keep the network of every iteration.
    progress : called as ``progress(done, iterations)``.

    Raises
    ------
    ValueError : if shapes do not fit, or an argument lies outside its range.
    """
    inputs = check_array("x", x, shape=("m", "n"))
    labels = check_array("y", y, shape=("m", "K"))
    layers = hidden if isinstance(hidden, Sequence) else (hidden,)
    for units in layers:
        check_integer("hidden", units, at_least=1)
    start = random_network((inputs.shape[1], *layers, labels.shape[1]), seed=seed)
    return lbfgs(
        start,
        inputs,
        labels,
        regularisation=regularisation,
        iterations=iterations,
        record=record,
        progress=progress,
    )
