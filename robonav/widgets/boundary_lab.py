"""Boundary lab: networks of two inputs trained in every setting, and their outputs over the plane."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

import anywidget
import numpy as np
import traitlets

from robonav.networks.toy_datasets import EXTENT
from robonav.networks.training_history import TrainingHistory

from .shared import front_end, packed, packed_network, style_sheet


class BoundaryLab(anywidget.AnyWidget):
    """Choose a problem, a network and a training, step through the training, and read the output at any point."""

    _esm = front_end("boundary_lab")
    _css = style_sheet("boundary_lab")
    data = traitlets.Dict().tag(sync=True)


def boundary_lab(
    controls: Mapping[str, Sequence[str]],
    runs: Mapping[tuple[str, ...], TrainingHistory],
    examples: Mapping[str, tuple[np.ndarray, np.ndarray]],
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
    """
    combinations = list(product(*controls.values()))
    first = tuple(start) or combinations[0]
    for combination in (*combinations, first):
        if combination not in runs:
            raise ValueError(f"runs must hold a training for {combination}")
    return BoundaryLab(
        data={
            "controls": [
                {
                    "label": label,
                    "options": list(options),
                    "value": list(options).index(choice),
                }
                for (label, options), choice in zip(
                    controls.items(), first, strict=True
                )
            ],
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
        }
    )


def _run(
    combination: tuple[str, ...], training: TrainingHistory, frames: Sequence[int]
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
