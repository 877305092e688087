"""Training with a history: batch gradient descent (section 3.3.1), and L-BFGS with torch (section 3.4.3)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from robonav.progress import Progress
from robonav.validation import check_array, check_integer, check_positive, check_real

from ._checks import checked_examples, documented
from ._interface import random_network
from .costs import SQUARED_ERROR, Objective
from .multilayer_perceptron import Array, Network, batch_gradient_descent
from .training_history import Recorder, TrainingHistory, network_accuracy

MOST_ITERATIONS = 100_000  # these take minutes; a larger number is a slip of the pen


def one_hot(actions: ArrayLike, count: int) -> Array:
    """Make labels (m, count) with a 1 at each example's action and 0 elsewhere (section 3.4.1).

    Parameters
    ----------
    actions : (m,) array of int
        In 0..count - 1.
    count : int
        Number of actions.

    Returns
    -------
    (m, count) array

    Raises
    ------
    ValueError
        If an action lies outside the range.

    Examples
    --------
    >>> from robonav.networks import one_hot
    >>> one_hot([2, 0], 3).tolist()
    [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    """
    indices = check_array("actions", actions, shape=("m",), dtype=np.intp)
    width = check_integer("count", count, at_least=1)
    if len(indices) and not 0 <= indices.min() <= indices.max() < width:
        raise ValueError(
            f"actions must lie in 0..{width - 1}, got {indices.min()}..{indices.max()}"
        )
    return np.eye(width)[indices]


@documented
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
    """Train a network by :func:`batch_gradient_descent`, and keep the history of the training.

    Parameters
    ----------
    network : Network
        Where to start.
    gradient_step : float
        The step alpha, positive; the thesis calls it the learning rate. With too large a step the cost rises or jumps.
    iterations : int
        Steps to take, at most 100,000.
    objective : Objective
        ``SQUARED_ERROR`` or ``CROSS_ENTROPY``.

    Returns
    -------
    TrainingHistory

    Raises
    ------
    ValueError
        If shapes do not fit, an argument lies outside its range, or the weights grow beyond all bounds.

    Examples
    --------
    >>> from robonav.networks import gradient_descent, random_network
    >>> from robonav.networks.toy_datasets import disc
    >>> x, y = disc(50, seed=0)
    >>> history = gradient_descent(random_network((2, 4, 1), seed=0), x, y, gradient_step=1, iterations=20)
    >>> bool(history.costs[-1] < history.costs[0])
    True
    """
    inputs, labels = checked_examples(network, x, y)
    step = check_positive("gradient_step", gradient_step)
    count = check_integer("iterations", iterations, at_least=0, at_most=MOST_ITERATIONS)
    recorder = Recorder(count, record=record, progress=progress)

    def keep(network: Network) -> None:
        cost = objective.cost(network, inputs, labels, regularisation=regularisation)
        recorder.add(network, cost, network_accuracy(network, inputs, labels))

    keep(network)
    for _ in range(count):
        network = batch_gradient_descent(
            network, inputs, labels, gradient_step=step, iterations=1, regularisation=regularisation,
            cost_gradient=objective.gradient,
        )  # fmt: skip
        keep(network)
    return recorder.history()


@documented
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
    """Train a network by L-BFGS (Liu and Nocedal 1989) on the cross-entropy cost.

    The thesis's fminunc belongs to the same quasi-Newton family. Training ends early where no step lowers the cost.

    Parameters
    ----------
    network : Network
        The network to start from.
    iterations : int
        Steps to take, at most 100,000.

    Returns
    -------
    TrainingHistory

    Raises
    ------
    ValueError
        If shapes do not fit, or an argument lies outside its range.

    Examples
    --------
    >>> from robonav.networks import lbfgs, random_network
    >>> from robonav.networks.toy_datasets import disc
    >>> x, y = disc(50, seed=0)
    >>> lbfgs(random_network((2, 4, 1), seed=0), x, y, regularisation=0.01, iterations=20).iterations
    20
    """
    inputs, labels = checked_examples(network, x, y)
    decay = check_real("regularisation", regularisation, at_least=0)
    count = check_integer("iterations", iterations, at_least=0, at_most=MOST_ITERATIONS)
    from .torch_lbfgs import lbfgs_iterates  # loads torch, which planning does not need

    recorder = Recorder(count, record=record, progress=progress)
    for iterate in lbfgs_iterates(
        network, inputs, labels, regularisation=decay, iterations=count
    ):
        recorder.add(*iterate)
    return recorder.history()


@documented
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
    """Train a new network on examples: random weights, then L-BFGS on the cross-entropy cost.

    Parameters
    ----------
    x : (m, n) array
        Inputs.
    y : (m, K) array
        Labels in [0, 1], such as :func:`one_hot` actions.
    hidden : int or sequence of int
        Units of the hidden layer, or of several; () for none.
    iterations : int
        The most iterations of L-BFGS, at most 100,000.
    seed : int or Generator
        Of the initial weights.

    Returns
    -------
    TrainingHistory

    Raises
    ------
    ValueError
        If shapes do not fit, or an argument lies outside its range.

    Examples
    --------
    >>> from robonav.networks import fit
    >>> from robonav.networks.toy_datasets import disc
    >>> fit(*disc(50, seed=0), hidden=3, iterations=5).network.sizes
    (2, 3, 1)
    """
    inputs = check_array("x", x, shape=("m", "n"))
    labels = check_array("y", y, shape=("m", "K"))
    layers = hidden if isinstance(hidden, Sequence) else (hidden,)
    for units in layers:
        check_integer("hidden", units, at_least=1)
    start = random_network((inputs.shape[1], *layers, labels.shape[1]), seed=seed)
    return lbfgs(
        start, inputs, labels, regularisation=regularisation, iterations=iterations,
        record=record, progress=progress,
    )  # fmt: skip
