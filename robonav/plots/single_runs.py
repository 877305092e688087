"""Figures whose panels are single episodes, plans and demonstrations (:mod:`robonav.experiments.single_runs`)."""

from __future__ import annotations

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from robonav import style
from robonav.experiments import Results
from robonav.experiments.single_runs import world_of

from .robot import draw_paths


def plot_paths(results: Results, columns: int = 2) -> Figure:
    """Plot one map for each case with its path. Dots are the nodes that a search visited."""
    cases = results.experiment.cases
    columns = min(len(cases), columns)
    rows = -(-len(cases) // columns)
    figure, panels = plt.subplots(
        rows, columns, figsize=(2.6 * columns, 2.9 * rows), squeeze=False
    )
    for place, (case, axes) in enumerate(zip(cases, panels.flat, strict=True)):
        metrics = set(results.metrics(place))
        if "visited x" in metrics:
            visited = [results.values(f"visited {letter}", place)[0] for letter in "xy"]
            axes.plot(*visited, ".", color=style.SKY, markersize=1.5, zorder=0)
        path = np.column_stack([results.values(letter, place)[0] for letter in "xy"])
        draw_paths(axes, world_of(case), [path])
        axes.set(
            xticks=[],
            yticks=[],
            xlabel="",
            ylabel="",
            title=_title(results, place, metrics),
        )
    return figure


def plot_gaps(results: Results) -> Figure:
    """Plot both gaps of Fig. 2.4 after each half step, with one panel for each case."""
    cases = results.experiment.cases
    figure, panels = plt.subplots(
        len(cases), figsize=(style.FIGURE_WIDTH, 2.4 * len(cases)), sharex=True
    )
    for place, (case, axes) in enumerate(zip(cases, panels, strict=True)):
        for metric, colour in (
            ("evaluation gap", style.BLUE),
            ("improvement gap", style.ORANGE),
        ):
            axes.semilogy(
                results.values(metric, place)[0] + 1e-12, color=colour, label=metric
            )
        axes.set(title=f"{case['sweeps']} sweeps", ylim=(1e-8, None))
    panels[-1].set(xlabel="half step")
    panels[0].legend()
    return figure


def _title(results: Results, place: int, metrics: set[str]) -> str:
    """Return the title of a panel: the settings that vary among the cases, and the outcome."""
    cases = results.experiment.cases
    varies = [
        key
        for key in cases[0]
        if key != "world" and len({case[key] for case in cases}) > 1
    ]
    chosen = {key: cases[place][key] for key in varies}
    said = [
        value if isinstance(value, str) else f"{key} {value}"
        for key, value in chosen.items()
    ]
    if "success" in metrics:
        said.append("arrived" if results.values("success", place)[0] else "failed")
    return ", ".join(said)
