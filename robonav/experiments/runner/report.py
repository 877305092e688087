"""Results as text, as Markdown tables and as a dictionary for JSON."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from robonav.benchmark import display_name

from .experiment import Results
from .statistics import Summary


def as_text(results: Results) -> str:
    """Return a title, a line for each case and metric (mean, interval, worst, best, the thesis's number), the note."""
    experiment = results.experiment
    seeds = experiment.seeds[results.scale]
    heading = [results.scale, "1 run a case" if seeds == 1 else f"{seeds} runs a case"]
    if experiment.shortened and results.scale == "quick":
        heading.append(f"{experiment.shortened}: not to be compared")
    lines = [f"{experiment.name}: {experiment.title} ({', '.join(heading)})"]
    for place, case in enumerate(experiment.cases):
        label = ", ".join(f"{key} {value}" for key, value in case.items())
        for metric in results.scalars(place):
            number = thesis_number(results, metric, place)
            beside = "" if number is None else f"; thesis {number:g}"
            summary = _long(results.summary(metric, place))
            lines.append(f"  {label}: {metric} {summary}{beside}")
    return "\n".join([*lines, *([f"  {experiment.note}"] if experiment.note else [])])


def as_table(
    results: Results,
    metric: str,
    *,
    rows: str,
    columns: str,
    among: Sequence[str] | None = None,
) -> str:
    """Return a Markdown table of mean and interval of a metric, with one line for each value of a setting.

    Parameters
    ----------
    results : Results
        Of one experiment.
    metric : str
        The metric.
    rows : str
        The setting with a line for each of its values.
    columns : str
        The setting with a column for each of its values.
    among : sequence of str, optional
        Only these columns.

    Returns
    -------
    str

    Examples
    --------
    >>> from robonav.experiments import Experiment, Results
    >>> cases = [{"dice": n, "sides": sides} for n in (1, 2) for sides in (4, 6)]
    >>> dice = Experiment("dice", "Dice", cases, dict, {"quick": 1, "thesis": 1})
    >>> results = Results.from_rows(dice, "quick", [(k, 0, "mean", 0, k + 1.0) for k in range(4)])
    >>> print(as_table(results, "mean", rows="dice", columns="sides"))
    | dice   | 4    | 6    |
    |:-------|:-----|:-----|
    | 1      | 1.00 | 2.00 |
    | 2      | 3.00 | 4.00 |
    """
    cells = _settings(results)[[rows, columns]].assign(cell=_cells(results, metric))
    table = cells.pivot_table(
        index=rows, columns=columns, values="cell", aggfunc="first", sort=False
    )
    table = table if among is None else table[list(among)]
    return _markdown(table.reset_index())


def as_markdown(results: Results, metrics: Sequence[str]) -> str:
    """Return a Markdown table with one line for each case.

    A line has the settings of the case, mean and interval of each metric, and the thesis's numbers.

    Parameters
    ----------
    results : Results
        Of one experiment.
    metrics : sequence of str
        The metrics.

    Returns
    -------
    str

    Examples
    --------
    >>> from robonav.experiments import Experiment, Results
    >>> dice = Experiment("dice", "Dice", [{"sides": 6}], dict, {"quick": 1, "thesis": 1})
    >>> results = Results.from_rows(dice, "quick", [(0, 0, "mean", 0, 3.5)])
    >>> print(as_markdown(results, ["mean"]))
    | sides   | mean   |
    |:--------|:-------|
    | 6       | 3.50   |
    """
    places = range(len(results.experiment.cases))
    table = _settings(results)
    varied = [key for key in table if table[key].nunique() > 1]
    table = table[varied or list(table)]
    for metric in metrics:
        table[metric] = _cells(results, metric)
    for metric in metrics:
        numbers = [thesis_number(results, metric, place) for place in places]
        if any(number is not None for number in numbers):
            table[f"{metric}, thesis"] = ["" if n is None else f"{n:g}" for n in numbers]  # fmt: skip
    return _markdown(table)


def _settings(results: Results) -> Any:
    """Return a data frame with the settings of each case as text. Methods have their names on pages."""
    import pandas as pd

    table = pd.DataFrame(list(results.experiment.cases)).astype(str)
    if "method" in table:
        table["method"] = table["method"].map(display_name)
    return table


def thesis_number(results: Results, metric: str, case: int) -> float | None:
    """Return the number that the thesis reports for a metric of a case, or None."""
    numbers = results.experiment.thesis.get(metric)
    return None if numbers is None else numbers[case]


def number_of_runs(results: Results) -> str:
    """Return a sentence with the number of runs of each case, and the experiment's note.

    Parameters
    ----------
    results : Results
        Of one experiment.

    Returns
    -------
    str

    Examples
    --------
    >>> from robonav.experiments import Experiment, Results
    >>> dice = Experiment("dice", "Dice", [{"sides": 6}], dict, {"quick": 1, "thesis": 1})
    >>> number_of_runs(Results.from_rows(dice, "quick", [(0, 0, "mean", 0, 3.5)]))
    'One run a case.'
    """
    runs = results.experiment.seeds[results.scale]
    number = (
        "One run a case."
        if runs == 1
        else f"{runs} runs a case; mean and 95 % interval over runs."
    )
    return f"{number} {results.experiment.note}".strip()


def usual_format(summary: Summary) -> str:
    """Return the format of a number in few characters: the larger its mean, the fewer digits."""
    size = abs(summary.mean)
    return ".1f" if size >= 10 else ".2f" if size >= 1 else ".3f"


def short(summary: Summary, form: str | None = None) -> str:
    """Return mean and interval in few characters: ``97.3 [96.8, 97.7]``."""
    form = form or usual_format(summary)
    low, high = format(summary.low, form), format(summary.high, form)
    interval = "" if math.isnan(summary.low) else f" [{low}, {high}]"
    return f"{summary.mean:{form}}{interval}"


def as_json(several: Sequence[Results]) -> list[dict[str, Any]]:
    """Return every experiment with its cases, each metric's statistics and the thesis's number. NaN becomes null."""
    return [
        {
            "name": results.experiment.name,
            "title": results.experiment.title,
            "scale": results.scale,
            "cases": [
                {
                    "case": dict(case),
                    "metrics": {
                        metric: _without_nan(results.summary(metric, place))
                        for metric in results.scalars(place)
                    },
                    "thesis": {
                        metric: numbers[place]
                        for metric, numbers in results.experiment.thesis.items()
                    },
                }
                for place, case in enumerate(results.experiment.cases)
            ],
        }
        for results in several
    ]


def _cells(results: Results, metric: str) -> list[str]:
    """Return mean and interval of a metric for every case, and the empty string for a case without it."""
    return [
        short(results.summary(metric, place)) if metric in results.scalars(place) else ""
        for place in range(len(results.experiment.cases))
    ]  # fmt: skip


def _markdown(table: Any) -> str:
    """Return a data frame of text as a Markdown table."""
    text: str = table.to_markdown(index=False, tablefmt="pipe", disable_numparse=True)
    return text


def _long(summary: Summary) -> str:
    interval = (
        "" if math.isnan(summary.low) else f" [{summary.low:.4g}, {summary.high:.4g}]"
    )
    rest = {
        "interquartile mean": summary.interquartile_mean,
        "worst": summary.worst,
        "best": summary.best,
    }
    return ", ".join(
        [
            f"{summary.mean:.4g}{interval}",
            *(f"{name} {value:.4g}" for name, value in rest.items()),
        ]
    )


def _without_nan(summary: Summary) -> dict[str, Any]:
    return {
        key: None if isinstance(v, float) and math.isnan(v) else v
        for key, v in asdict(summary).items()
    }
