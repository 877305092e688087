"""Results for people and for programs: a table of text, and a dictionary for JSON."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from .experiment import Results
from .statistics import Summary


def scalars(results: Results, case: int) -> list[str]:
    """The metrics of a case with one number a run."""
    rows = [row for row in results.rows if row.case == case]
    return sorted(
        {row.metric for row in rows} - {row.metric for row in rows if row.step > 0}
    )


def as_text(results: Results) -> str:
    """Title and one line a case: mean, interval, best and worst of each metric, the thesis's number beside it."""
    experiment = results.experiment
    seeds = experiment.seeds[results.scale]
    heading = [results.scale, "1 run a case" if seeds == 1 else f"{seeds} runs a case"]
    if experiment.shortened and results.scale == "quick":
        heading.append(f"{experiment.shortened}: not to be compared")
    lines = [f"{experiment.name}: {experiment.title} ({', '.join(heading)})"]
    for place, case in enumerate(experiment.cases):
        said = ", ".join(f"{key} {value}" for key, value in case.items())
        for metric in scalars(results, place):
            thesis = experiment.thesis.get(metric, [None] * len(experiment.cases))[
                place
            ]
            beside = "" if thesis is None else f"; thesis {thesis:g}"
            lines.append(
                f"  {said}: {metric} {_said(results.summary(metric, place))}{beside}"
            )
    return "\n".join(lines)


def as_table(results: Results, metric: str, *, rows: str, columns: str) -> str:
    """A Markdown table of a metric's mean and interval, one line a value of ``rows``, one column one of ``columns``."""
    cases = results.experiment.cases
    across = list(dict.fromkeys(str(case[columns]) for case in cases))
    lines = {str(case[rows]): dict.fromkeys(across, "") for case in cases}
    for place, case in enumerate(cases):
        if metric in scalars(results, place):
            lines[str(case[rows])][str(case[columns])] = short(
                results.summary(metric, place)
            )
    head = [rows, *across]
    table = [[name, *cells.values()] for name, cells in lines.items()]
    return "\n".join(
        "| " + " | ".join(line) + " |" for line in [head, ["---"] * len(head), *table]
    )


def as_markdown(results: Results, metrics: Sequence[str]) -> str:
    """A Markdown table, a line a case: what varies, each metric's mean and interval, the thesis's number beside it."""
    experiment = results.experiment
    cases = experiment.cases
    varied = [
        key for key in cases[0] if len({case[key] for case in cases}) > 1
    ] or list(cases[0])
    with_thesis = [
        metric
        for metric in metrics
        if any(v is not None for v in experiment.thesis.get(metric, ()))
    ]
    head = [*varied, *metrics, *(f"{metric}, thesis" for metric in with_thesis)]
    lines = [head, ["---"] * len(head)]
    for place, case in enumerate(cases):
        known = scalars(results, place)
        ours = [
            short(results.summary(metric, place)) if metric in known else ""
            for metric in metrics
        ]
        theirs = [experiment.thesis[metric][place] for metric in with_thesis]
        lines.append(
            [
                *(str(case[key]) for key in varied),
                *ours,
                *("" if v is None else f"{v:g}" for v in theirs),
            ]
        )
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def made(results: Results) -> str:
    """What stands behind a table, in a sentence."""
    runs = results.experiment.seeds[results.scale]
    return (
        "One run a case."
        if runs == 1
        else f"{runs} runs a case; mean and 95 % interval over runs."
    )


def short(summary: Summary) -> str:
    """Mean and interval in few characters: ``97.3 [96.8, 97.7]``."""
    digits = 1 if abs(summary.mean) >= 10 else 2 if abs(summary.mean) >= 1 else 3
    interval = (
        ""
        if math.isnan(summary.low)
        else f" [{summary.low:.{digits}f}, {summary.high:.{digits}f}]"
    )
    return f"{summary.mean:.{digits}f}{interval}"


def as_json(several: Sequence[Results]) -> list[dict[str, Any]]:
    """Every experiment with its cases, each metric's summary and the thesis's number; NaN becomes null."""
    return [
        {
            "name": results.experiment.name,
            "title": results.experiment.title,
            "scale": results.scale,
            "cases": [
                {
                    "case": dict(case),
                    "metrics": {
                        metric: _plain(results.summary(metric, place))
                        for metric in scalars(results, place)
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


def _said(summary: Summary) -> str:
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


def _plain(summary: Summary) -> dict[str, Any]:
    return {
        key: None if isinstance(v, float) and math.isnan(v) else v
        for key, v in asdict(summary).items()
    }
