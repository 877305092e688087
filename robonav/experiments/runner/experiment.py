"""An experiment as data: its cases, its runs, the numbers that it computes, and those that the thesis reports."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array, check_one_of

from .statistics import Summary, summarise

if TYPE_CHECKING:
    import pandas as pd

Case = Mapping[str, str | float | int]
"""The settings of one case of an experiment, such as ``{"method": "nnql", "obstacles": 10}``."""

Numbers = Mapping[str, ArrayLike]
"""The numbers of one run by metric: one number, or one number for each step (T,)."""

Row = tuple[int, int, str, int, float]
"""One number of a run: case (its place), seed, metric, step, value."""

SCALES = ("quick", "thesis")
COLUMNS = ("case", "seed", "metric", "step", "value")


class Plot:
    """A function of ``robonav.plots`` with its options, named here and imported when a figure is drawn.

    Parameters
    ----------
    function : str
        Module and function, such as ``"nnql.plot_rates"``. The function takes results and the options.
    **options
        Keyword arguments of the function.

    Examples
    --------
    >>> bars = Plot("experiments.draw_bars", metric="success")
    >>> bars.function, bars.options
    ('experiments.draw_bars', {'metric': 'success'})
    """

    def __init__(self, function: str, **options: Any) -> None:
        self.function, self.options = function, options


SUCCESS_BARS = Plot(
    "experiments.draw_bars", metric="success", label="episodes that arrive (%)"
)
"""One bar for each case with the share of episodes that arrive: the figure of most experiments."""


@dataclass(frozen=True, eq=False)
class Experiment:
    """A table or figure of the thesis, or one of our own.

    Parameters
    ----------
    name : str
        The name on the command line, such as ``table-4.3`` or ``figure-5.10``.
    title : str
        One line.
    cases : sequence of mappings
        The settings that the experiment varies. All cases have the same keys.
    run : callable
        ``run(case, seed, scale)`` returns numbers by metric: one number, or one number a step (T,). The numbers must
        depend on these three arguments alone.
    seeds : mapping
        The number of runs of each case at each scale. The scale "quick" takes less than a minute for all cases. The
        scale "thesis" has at least as many runs as the thesis.
    thesis : mapping
        The numbers that the thesis reports: for each metric one number for each case, or None where it has none.
    settings : mapping
        Other settings that a reader needs to know. They are written to the file of the results.
    shortened : str
        How a quick run shortens the training. The numbers of such a run cannot be compared with those at the thesis's
        scale. If the string is empty, a quick run only has fewer seeds and fewer navigations.
    note : str
        A sentence that readers need to compare the cases. It stands below the table.
    plot : Plot or str
        The function that draws the results, or the reason why there is no figure.

    Examples
    --------
    >>> dice = Experiment(
    ...     name="dice",
    ...     title="Mean of a die",
    ...     cases=[{"sides": 6}],
    ...     run=lambda case, seed, scale: {"mean": (case["sides"] + 1) / 2},
    ...     seeds={"quick": 1, "thesis": 10},
    ... )
    >>> dice.run(dice.cases[0], 0, "quick")
    {'mean': 3.5}
    """

    name: str
    title: str
    cases: Sequence[Case]
    run: Callable[[Case, int, str], Numbers]
    seeds: Mapping[str, int]
    thesis: Mapping[str, Sequence[float | None]] = field(default_factory=dict)
    settings: Mapping[str, Any] = field(default_factory=dict)
    shortened: str = ""
    note: str = ""
    plot: Plot | str = ""

    def __post_init__(self) -> None:
        if not self.cases or any(
            set(case) != set(self.cases[0]) for case in self.cases
        ):
            raise ValueError(
                f"cases of {self.name} must be at least one, all with the same keys"
            )
        if taken := set(self.cases[0]) & set(COLUMNS):
            raise ValueError(
                f"cases of {self.name} must not have the keys {', '.join(COLUMNS)}, got {sorted(taken)}"
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


@dataclass(frozen=True, eq=False)
class Results:
    """All numbers of an experiment.

    Attributes
    ----------
    experiment : Experiment
        The experiment that gave the numbers.
    scale : str
        "quick" or "thesis".
    frame : pandas.DataFrame
        One number a line, ordered by case, seed, metric and step. Columns: ``case`` (place among the experiment's
        cases), ``seed``, ``metric``, ``step`` (0 for a single number), ``value``.

    Examples
    --------
    >>> dice = Experiment("dice", "Dice", [{"sides": 6}], dict, {"quick": 2, "thesis": 2})
    >>> results = Results.from_rows(dice, "quick", [(0, 0, "mean", 0, 3.0), (0, 1, "mean", 0, 4.0)])
    >>> results.values("mean", 0)
    array([3., 4.])
    >>> results.summary("mean", 0).mean
    3.5
    """

    experiment: Experiment
    scale: str
    frame: pd.DataFrame

    @classmethod
    def from_rows(
        cls, experiment: Experiment, scale: str, rows: Iterable[Row]
    ) -> Results:
        """Make results from rows, which :func:`rows_of` returns.

        Parameters
        ----------
        experiment : Experiment
            The experiment that gave the numbers.
        scale : str
            "quick" or "thesis".
        rows : iterable of tuple
            Case, seed, metric, step and value of each number.

        Returns
        -------
        Results

        Examples
        --------
        >>> dice = Experiment("dice", "Dice", [{"sides": 6}], dict, {"quick": 2, "thesis": 2})
        >>> Results.from_rows(dice, "quick", [(0, 0, "mean", 0, 3.0)]).frame.value.tolist()
        [3.0]
        """
        import pandas as pd

        return cls(experiment, scale, pd.DataFrame(list(rows), columns=list(COLUMNS)))

    @cached_property
    def _rows(self) -> dict[tuple[int, str], pd.DataFrame]:
        """Return the rows of each case and metric."""
        return dict(iter(self.frame.groupby(["case", "metric"], sort=False)))

    @cached_property
    def _tables(self) -> dict[tuple[int, str], NDArray[np.float64]]:
        """Return the tables that were asked for, because making one takes longer than reading it."""
        return {}

    def _table(self, case: int, metric: str) -> NDArray[np.float64]:
        """Return the table of a case and a metric: one row for each seed, one column for each step."""
        key = case, metric
        if key not in self._tables:
            table = self._rows[key].pivot(index="seed", columns="step", values="value")
            self._tables[key] = table.to_numpy()
        return self._tables[key]

    def metrics(self, case: int) -> list[str]:
        """Return the metrics of a case, sorted by name.

        Parameters
        ----------
        case : int
            The case's place among the experiment's cases.

        Returns
        -------
        list of str

        Examples
        --------
        >>> dice = Experiment("dice", "Dice", [{"sides": 6}], dict, {"quick": 2, "thesis": 2})
        >>> rows = [(0, 0, "mean", 0, 3.0), (0, 0, "throws", 0, 2.0), (0, 0, "throws", 1, 4.0)]
        >>> Results.from_rows(dice, "quick", rows).metrics(case=0)
        ['mean', 'throws']
        """
        return sorted(metric for place, metric in self._rows if place == case)

    def scalars(self, case: int) -> list[str]:
        """Return the metrics of a case that have one number in each run.

        Parameters
        ----------
        case : int
            The case's place among the experiment's cases.

        Returns
        -------
        list of str

        Examples
        --------
        >>> dice = Experiment("dice", "Dice", [{"sides": 6}], dict, {"quick": 2, "thesis": 2})
        >>> rows = [(0, 0, "mean", 0, 3.0), (0, 0, "throws", 0, 2.0), (0, 0, "throws", 1, 4.0)]
        >>> Results.from_rows(dice, "quick", rows).scalars(case=0)
        ['mean']
        """
        return [m for m in self.metrics(case) if self._table(case, m).shape[1] == 1]

    def values(self, metric: str, case: int) -> NDArray[np.float64]:
        """Return the values of a metric in one case, one row for each seed.

        Parameters
        ----------
        metric : str
            One of :meth:`metrics`.
        case : int
            The case's place among the experiment's cases.

        Returns
        -------
        (S,) or (S, T) array
            One number for each of S seeds, or the numbers of T steps for each.

        Raises
        ------
        ValueError
            If the case has no such metric.

        Examples
        --------
        >>> dice = Experiment("dice", "Dice", [{"sides": 6}], dict, {"quick": 2, "thesis": 2})
        >>> rows = [(0, 0, "throws", 0, 2.0), (0, 0, "throws", 1, 4.0)]
        >>> Results.from_rows(dice, "quick", rows).values("throws", case=0)
        array([[2., 4.]])
        """
        check_one_of("metric", metric, dict.fromkeys(self.metrics(case)))
        table = self._table(case, metric)
        return table[:, 0] if table.shape[1] == 1 else table

    def summary(self, metric: str, case: int) -> Summary:
        """Return the statistics over the seeds of a case.

        Parameters
        ----------
        metric : str
            One of :meth:`scalars`.
        case : int
            The case's place among the experiment's cases.

        Returns
        -------
        Summary

        Examples
        --------
        >>> dice = Experiment("dice", "Dice", [{"sides": 6}], dict, {"quick": 2, "thesis": 2})
        >>> rows = [(0, 0, "mean", 0, 3.0), (0, 1, "mean", 0, 4.0)]
        >>> Results.from_rows(dice, "quick", rows).summary("mean", case=0).best
        4.0
        """
        return summarise(self.values(metric, case))


def rows_of(case: int, seed: int, numbers: Numbers) -> list[Row]:
    """Return the numbers of one run as rows. Raise a ValueError for values that are not finite numbers."""
    rows: list[Row] = []
    for metric in sorted(numbers):
        series = check_array(
            metric,
            np.atleast_1d(np.asarray(numbers[metric], dtype=float)),
            shape=("steps",),
        )
        rows += [
            (case, seed, metric, step, float(value))
            for step, value in enumerate(series)
        ]
    return rows
