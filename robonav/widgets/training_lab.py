"""Training lab: learning runs in every setting, replayed step by step. With a kernel, new trainings run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from robonav.validation import check_array

from .kernel_training import KernelTraining, Report
from .shared import front_end, menus, packed, style_sheet


@dataclass(frozen=True, eq=False)
class Curve:
    """One measure over a training.

    Attributes
    ----------
    steps : (T,) array
        The iterations or episodes of the measurements, in ascending order.
    values : (T,) or (S, T) array
        The measurements, of one seed or of S seeds. For several seeds the page draws the mean and the range.
    """

    steps: ArrayLike
    values: ArrayLike


Curves = Mapping[str, Curve]
Trainer = Callable[[tuple[str, ...]], Iterator[tuple[int, int, Curves]]]
"""``train(choices)`` trains in small parts and yields the number of finished steps, of all steps, and the curves."""


class TrainingLab(KernelTraining):
    """Choose settings, step through a training, and keep one run to compare. With a kernel, train, watch and cancel."""

    _esm = front_end("training_lab")
    _css = style_sheet("training_lab")

    def __init__(self, data: dict[str, Any], train: Trainer | None) -> None:
        super().__init__(data)
        self._train = train

    def uses_kernel(self) -> bool:
        return self._train is not None

    def train(self, request: dict[str, Any], report: Report) -> str:
        """Train with the chosen settings."""
        assert self._train is not None
        choices = tuple(str(choice) for choice in request["choices"])
        for done, total, curves in self._train(choices):
            due = report.due(done, total)
            report(done, total, **(_packed(curves) if due else {}))
        return "Trained."


def training_lab(
    controls: Mapping[str, Sequence[str]],
    runs: Mapping[tuple[str, ...], Curves],
    *,
    step: str,
    measures: Mapping[str, str],
    start: Sequence[str] = (),
    train: Trainer | None = None,
) -> TrainingLab:
    """Make the lab for trainings in every combination of some settings.

    Parameters
    ----------
    controls : mapping of str to sequence of str
        The names of the settings, and their choices.
    runs : mapping of tuple to mapping of str to Curve
        A curve of each measure for each combination of choices.
    step : str
        The name of a step of the training, such as "iteration".
    measures : mapping of str to str
        The label of the axis of each measure, with its unit: ``{"accuracy": "right answers (%)"}``.
    start : sequence of str, optional
        The choices at first; by default the first of each setting.
    train : callable, optional
        A function of the chosen settings that trains in small parts; it needs a kernel.

    Returns
    -------
    TrainingLab

    Raises
    ------
    ValueError
        If a combination or a measure is missing, or a curve has another number of values than steps.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.widgets.training_lab import Curve, training_lab
    >>> curve = Curve(np.arange(3), np.array([50.0, 70.0, 80.0]))
    >>> runs = {("8",): {"accuracy": curve}}
    >>> lab = training_lab(
    ...     {"hidden units": ["8"]}, runs, step="iteration", measures={"accuracy": "right answers (%)"})
    >>> len(lab.data) > 0
    True
    """
    combinations = list(product(*controls.values()))
    first = tuple(start) or combinations[0]
    for combination in (*combinations, first):
        if combination not in runs or set(runs[combination]) != set(measures):
            raise ValueError(
                f"runs must hold for {combination} the curves {', '.join(measures)}"
            )
    return TrainingLab(
        {
            "controls": menus(controls, first),
            "step": step,
            "measures": [
                {"name": name, "label": label} for name, label in measures.items()
            ],
            "runs": [_packed(runs[combination]) for combination in combinations],
        },
        train,
    )


def _packed(curves: Curves) -> dict[str, Any]:
    """Pack curves for the page: mean, least and largest over the seeds, in single precision."""
    return {name: _drawn(name, curve) for name, curve in curves.items()}


def _drawn(name: str, curve: Curve) -> dict[str, Any]:
    steps = check_array(f"steps of {name}", curve.steps, shape=("T",))
    values = np.atleast_2d(np.asarray(curve.values, dtype=float))
    seeds = check_array(f"values of {name}", values, shape=("S", len(steps)))
    shown = (seeds.mean(axis=0), seeds.min(axis=0), seeds.max(axis=0))
    return {
        "seeds": len(seeds),
        "steps": packed(steps, np.float32),
        **{
            part: packed(line, np.float32)
            for part, line in zip(("mean", "low", "high"), shown, strict=True)
        },
    }
