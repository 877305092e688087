"""An experiment as data: what it varies, how often, what it computes, what the thesis has."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array, check_one_of

from .statistics import Summary, summarise

Case = Mapping[str, str | float | int]
"""One setting of what an experiment varies, such as ``{"method": "nnql", "obstacles": 10}``."""

SCALES = ("quick", "thesis")


@dataclass(frozen=True)
class Experiment:
    """A table or figure of the thesis, or one of ours.

    Parameters
    ----------
    name : as on the command line: ``table-4.3``, ``figure-5.10``.
    title : one line.
    cases : what it varies; all with the same keys.
    run : ``run(case, seed, scale)`` gives numbers by metric, each a single one or one a step (T,); nothing else may
        decide them.
    seeds : number of runs of each case, by scale: "quick" (under a minute in all), "thesis" (its number, or more).
    thesis : what the thesis has: metric to one number a case, None where it has none.
    settings : what else a reader needs to know, for the metadata.
    shortened : what a quick run leaves out of the training, if anything; its numbers then foretell nothing. All others
        are runs as at the thesis's scale, only fewer, with fewer drives.
    """

    name: str
    title: str
    cases: Sequence[Case]
    run: Callable[[Case, int, str], Mapping[str, ArrayLike]]
    seeds: Mapping[str, int]
    thesis: Mapping[str, Sequence[float | None]] = field(default_factory=dict)
    settings: Mapping[str, Any] = field(default_factory=dict)
    shortened: str = ""

    def __post_init__(self) -> None:
        if not self.cases or any(
            set(case) != set(self.cases[0]) for case in self.cases
        ):
            raise ValueError(
                f"cases of {self.name} must be at least one, all with the same keys"
            )
        if set(self.seeds) != set(SCALES):
            raise ValueError(
                f"seeds of {self.name} must be given for {', '.join(SCALES)}, got {sorted(self.seeds)}"
            )
        for metric, numbers in self.thesis.items():
            if len(numbers) != len(self.cases):
                raise ValueError(
                    f"thesis of {self.name} must have one number a case for {metric}, got {len(numbers)}"
                )


@dataclass(frozen=True)
class Row:
    """One number: of a case (by its place), a seed, a metric, a step."""

    case: int
    seed: int
    metric: str
    step: int
    value: float


@dataclass(frozen=True)
class Results:
    """All numbers of an experiment, ordered by case, seed, metric and step."""

    experiment: Experiment
    scale: str
    rows: tuple[Row, ...]

    def values(self, metric: str, case: int) -> NDArray[np.float64]:
        """One row a seed: (S,) of a metric with one number a run, (S, T) of one with a number a step."""
        check_one_of("metric", metric, {row.metric: None for row in self.rows})
        by_seed: dict[int, list[float]] = {}
        for row in self.rows:
            if row.case == case and row.metric == metric:
                by_seed.setdefault(row.seed, []).append(row.value)
        table = np.array([by_seed[seed] for seed in sorted(by_seed)])
        return table[:, 0] if table.shape[1] == 1 else table

    def summary(self, metric: str, case: int) -> Summary:
        """Mean, interval and the rest over the seeds of a case."""
        return summarise(self.values(metric, case))


def rows_of(case: int, seed: int, numbers: Mapping[str, ArrayLike]) -> list[Row]:
    """The numbers of one run as rows; ValueError for one that is neither a number nor a list of finite numbers."""
    rows = []
    for metric in sorted(numbers):
        series = check_array(
            metric,
            np.atleast_1d(np.asarray(numbers[metric], dtype=float)),
            shape=("steps",),
        )
        rows += [
            Row(case, seed, metric, step, float(value))
            for step, value in enumerate(series)
        ]
    return rows
