"""Boundary lab: networks of two inputs, trained in every setting, and what they answer all over the plane."""

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
    """Choose a problem, a network and a way to train; step through the training; probe the answer anywhere."""

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
    """The lab for trainings in every combination of some settings.

    Parameters
    ----------
    controls : names of the settings and their choices; the first setting is the problem.
    runs : a recorded training for each combination of choices.
    examples : x (m, 2) and y (m, 1) of each problem.
    frames : iterations to show; a training that ended earlier stays at its end.
    start : the choices shown at first; by default the first of each.

    Raises
    ------
    ValueError : if a combination or a problem's examples are missing, or a training has no record of its networks.
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
    """One training as the page reads it; single precision is more than a picture shows."""
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
