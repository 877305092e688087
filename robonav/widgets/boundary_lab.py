"""Boundary lab: networks of two inputs trained in every setting, and their outputs over the plane."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.networks import CROSS_ENTROPY, Network, gradient_descent, random_network
from robonav.networks.network_stack import stacked
from robonav.networks.toy_datasets import EXTENT
from robonav.networks.training_history import Iterate, TrainingHistory
from robonav.validation import check_integer, check_one_of, check_real

from .kernel_training import KernelTraining, Report
from .shared import front_end, menus, packed, packed_network, style_sheet

Examples = tuple[NDArray[np.float64], NDArray[np.float64]]


class BoundaryLab(KernelTraining):
    """Choose a problem, a network and a training, step through the training, and read the output at any point.

    With a kernel, Python trains a network with any other settings.
    """

    _esm = front_end(
        "learning/worker",
        "learning/training_panel",
        "learning/kernel_panel",
        "boundary_lab",
    )
    _css = style_sheet("learning/training_panel", "boundary_lab")

    def __init__(self, data: dict[str, Any], examples: Sequence[Examples]) -> None:
        super().__init__(data)
        self._examples = examples

    def train(self, request: dict[str, Any], report: Report) -> dict[str, Any]:
        """Train a network on the chosen problem, and return it at the iterations that the page shows."""
        settings, frames = request["settings"], self.data["frames"]
        x, y = self._examples[request["problem"]]
        network = random_network(
            (2, check_integer("hidden", settings["hidden"], at_least=1), 1),
            seed=check_integer("seed", settings["seed"], at_least=0),
            spread=check_real("spread", settings["spread"], at_least=0),
        )
        iterates: list[Iterate] = []
        for iterate in _ITERATES[check_one_of("method", request["method"], _ITERATES)](
            network, x, y, settings, frames[-1]
        ):
            report(
                len(iterates),
                frames[-1],
                at=len(iterates),
                cost=iterate.cost,
                right=100 * iterate.accuracy,
            )
            iterates.append(iterate)
        report(frames[-1], frames[-1])
        last = iterates[-1]
        history = TrainingHistory(
            last.network,
            np.array([each.cost for each in iterates]),
            np.array([each.accuracy for each in iterates]),
            stacked([each.network for each in iterates]),
        )
        self.trainings = [history]
        return {
            "sentence": f"The cost is {last.cost:.3f}, and {100 * last.accuracy:.0f} % of the examples are right.",
            "run": _run("the settings", history, frames),
        }


def _gradient_iterates(
    network: Network, x: Any, y: Any, settings: dict[str, Any], iterations: int
) -> Iterator[Iterate]:
    """Gradient descent, step by step; the first iterate is the network as it came."""
    for steps in (0, *[1] * iterations):
        made = gradient_descent(
            network,
            x,
            y,
            gradient_step=settings["step"],
            iterations=steps,
            regularisation=settings["regularisation"],
            objective=CROSS_ENTROPY,
        )
        network = made.network
        yield Iterate(network, float(made.costs[-1]), float(made.accuracies[-1]))


def _lbfgs_iterates(
    network: Network, x: Any, y: Any, settings: dict[str, Any], iterations: int
) -> Iterator[Iterate]:
    """L-BFGS, step by step."""
    # It loads torch, which a page without a training does not need.
    from robonav.networks.torch_lbfgs import lbfgs_iterates

    yield from lbfgs_iterates(
        network, x, y, regularisation=settings["regularisation"], iterations=iterations
    )


_ITERATES = {"gradient descent": _gradient_iterates, "L-BFGS": _lbfgs_iterates}


def boundary_lab(
    controls: Mapping[str, Sequence[str]],
    runs: Mapping[tuple[str, ...], TrainingHistory],
    examples: Mapping[str, Examples],
    *,
    frames: Sequence[int],
    start: Sequence[str] = (),
) -> BoundaryLab:
    """Make the lab for trainings in every combination of some settings.

    Parameters
    ----------
    controls : mapping of str to sequence of str
        The names of the settings and their choices. The first setting is the problem.
    runs : mapping of tuple to TrainingHistory
        A recorded training for each combination of choices.
    examples : mapping of str to (array, array)
        The examples of each problem: x (m, 2) and y (m, 1).
    frames : sequence of int
        The iterations to show. A training that ended earlier shows its last network.
    start : sequence of str, optional
        The choices at first; by default the first of each setting.

    Returns
    -------
    BoundaryLab

    Raises
    ------
    ValueError
        If a combination or the examples of a problem are missing, or a training has no record of its networks.

    Examples
    --------
    >>> from robonav.networks import lbfgs, random_network
    >>> from robonav.networks.toy_datasets import disc
    >>> from robonav.widgets.boundary_lab import boundary_lab
    >>> x, y = disc(20, seed=0)
    >>> training = lbfgs(random_network((2, 3, 1), seed=0), x, y, iterations=5, record=True)
    >>> lab = boundary_lab(
    ...     {"problem": ["disc"]}, {("disc",): training}, {"disc": (x, y)}, frames=[0, 5])
    >>> len(lab.data) > 0
    True
    """
    combinations = list(product(*controls.values()))
    first = tuple(start) or combinations[0]
    for combination in (*combinations, first):
        if combination not in runs:
            raise ValueError(f"runs must hold a training for {combination}")
    return BoundaryLab(
        {
            "controls": menus(controls, first),
            "runs": [
                _run(combination, runs[combination], frames)
                for combination in combinations
            ],
            "examples": [
                {
                    "x": np.round(examples[problem][0], 4).tolist(),
                    "y": examples[problem][1][:, 0].tolist(),
                }
                for problem in next(iter(controls.values()))
            ],
            "frames": list(frames),
            "extent": EXTENT,
        },
        [examples[problem] for problem in next(iter(controls.values()))],
    )


def _run(
    combination: object, training: TrainingHistory, frames: Sequence[int]
) -> dict[str, Any]:
    """Pack one training for the page, in single precision, which is sufficient for a picture."""
    if training.networks is None:
        raise ValueError(
            f"runs[{combination}] must hold the network of every iteration: train with record=True"
        )
    shown = np.minimum(frames, training.iterations)
    return {
        "networks": packed_network(training.networks[shown], np.float32),
        "costs": packed(training.costs[shown], np.float32),
        "accuracies": packed(training.accuracies[shown], np.float32),
    }
