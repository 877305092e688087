"""Figures of experiments: bars with intervals, bands over seeds, and the thesis's numbers."""

from __future__ import annotations

import importlib
import math
import textwrap
from collections.abc import Mapping
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from robonav import atomic, style
from robonav.benchmark import display_name
from robonav.experiments import Results

OURS, THESIS = style.BLUE, style.ORANGE
GROUPS = (style.BLUE, style.ORANGE, style.GREEN, style.PURPLE)
LABEL_WIDTH = 26  # characters of a line of a label


def case_labels(results: Results) -> list[str]:
    """Return one label for each case, in order: the settings that vary among the cases."""
    cases = results.experiment.cases
    varied = [
        key for key in cases[0] if len({case[key] for case in cases}) > 1
    ] or list(cases[0])
    return [
        ", ".join(setting_label(key, case[key]) for key in varied) for case in cases
    ]


def setting_label(key: str, value: str | float) -> str:
    """Return the label of a setting: a text without its key, a number with it, and a method with its display name.

    Obstacles are counted, as in "20 obstacles", and no caution is called so.

    Parameters
    ----------
    key : str
        The setting's name.
    value : str or float
        Its value.

    Returns
    -------
    str

    Examples
    --------
    >>> setting_label("obstacles", 20), setting_label("expert", "human")
    ('20 obstacles', 'human')
    """
    if isinstance(value, str):
        return display_name(value) if key == "method" else value
    if key == "obstacles":
        return f"{value} {key}"
    return "no caution" if (key, value) == ("caution", 0) else f"{key} {value}"


def draw_bars(results: Results, metric: str, label: str) -> Figure:
    """Draw one bar for each case with its 95 % interval over seeds, and a diamond for the number of the thesis."""
    cases = range(len(results.experiment.cases))
    labels = [textwrap.fill(text, LABEL_WIDTH) for text in case_labels(results)]
    lines = sum(text.count("\n") + 1 for text in labels)
    height = 0.14 * len(cases) + 0.165 * lines + 1.1
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, height))
    thesis = results.experiment.thesis.get(metric, [None] * len(cases))
    for case in cases:
        summary = results.summary(metric, case)
        axes.barh(case, summary.mean, height=0.62, color=OURS, alpha=0.85)
        if not math.isnan(summary.low):
            axes.plot(
                [summary.low, summary.high],
                [case, case],
                color=style.INK,
                linewidth=2.5,
            )
        number = thesis[case]
        if number is not None:
            axes.plot(number, case, marker="D", color=THESIS, markersize=7)
    axes.set(yticks=list(cases), yticklabels=labels, xlabel=label)
    axes.set_ylim(len(cases) - 0.5, -0.5)  # the first case on top
    if any(number is not None for number in thesis):
        axes.plot([], [], "D", color=THESIS, label="thesis")
        axes.plot([], [], color=OURS, linewidth=6, label="ours, 95 % interval")
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2)
    axes.grid(axis="y", visible=False)
    return figure


def draw_grouped_runs(
    axes: Axes, rows: Mapping[str, Mapping[str, ArrayLike]], label: str
) -> None:
    """Draw each run as a dot and the mean of a group as a line, with a row for each name and a colour for each group.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    rows : mapping of str to mapping of str to (S,) array
        The runs of each group, by row and by the group's name. A group with a single number has a dot alone.
    label : str
        What the numbers are.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> rows = {"NIRL": {"with": [97, 98], "without": [90]}}
    >>> draw_grouped_runs(axes, rows, "success (%)")
    >>> [text.get_text() for text in axes.get_legend().get_texts()]
    ['with', 'without']
    """
    groups = list(dict.fromkeys(group for runs in rows.values() for group in runs))
    colours = dict(zip(groups, GROUPS, strict=False))
    apart = 0.72 / len(groups)
    for row, runs in enumerate(rows.values()):
        for group, values in runs.items():
            dots = np.sort(np.asarray(values, dtype=float))
            place = row + apart * (groups.index(group) - (len(groups) - 1) / 2)
            # a fixed spread, so that dots do not overlap
            heights = place + 0.2 * apart * np.sin(2.4 * np.arange(len(dots)))
            axes.plot(
                dots, heights, ".", color=colours[group], alpha=0.65, markersize=6
            )
            if len(dots) > 1:
                ends = [place - 0.42 * apart, place + 0.42 * apart]
                axes.plot([dots.mean()] * 2, ends, color=colours[group], linewidth=2.5)
    for group in groups:
        axes.plot([], [], ".", color=colours[group], markersize=9, label=group)
    names = [textwrap.fill(name, LABEL_WIDTH) for name in rows]
    axes.set(yticks=range(len(rows)), yticklabels=names, xlabel=label)
    axes.set_ylim(len(rows) - 0.5, -0.5)  # the first row on top
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2)
    axes.grid(axis="y", visible=False)


def draw_points_lost(results: Results) -> Figure:
    """Draw how many points of success each policy loses where its reflex knows only the sector of the target.

    One row for each policy of a chapter, with 95 % intervals over seeds: policies that were trained with exact
    directions, or not at all, above those that were trained with sectors.
    """
    cases = results.experiment.cases
    names = list(dict.fromkeys((case["chapter"], case["method"]) for case in cases))
    figure, axes = plt.subplots(figsize=(5.2, 0.42 * len(names) + 1.6))
    for place, case in enumerate(cases):
        if case["reflex in test"] == "exact":
            continue
        summary = results.summary("points lost", place)
        too = case["reflex in training"] == "sector"
        row = names.index((case["chapter"], case["method"])) + (0.14 if too else -0.14)
        colour = THESIS if too else OURS
        axes.plot([summary.low, summary.high], [row, row], color=colour, linewidth=2.5)
        axes.plot(summary.mean, row, "s" if too else "o", color=colour, markersize=6)
    axes.axvline(0, color=style.INK, linewidth=1)
    axes.set(
        yticks=range(len(names)),
        yticklabels=[
            f"{display_name(str(method))}, chapter {chapter}"
            for chapter, method in names
        ],
        xlabel="points of success lost",
    )
    axes.plot([], [], "o", color=OURS, label="not trained with sectors")
    axes.plot([], [], "s", color=THESIS, label="trained with sectors, too")
    axes.legend(loc="lower center", bbox_to_anchor=(0.4, 1.0), ncols=2)
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    return figure


def draw_board(results: Results, metric: str) -> Figure:
    """Draw the leaderboard: one cell for each method and setting, dark where the percentage is high."""
    cases = results.experiment.cases
    methods = list(dict.fromkeys(str(case["method"]) for case in cases))
    settings = list(dict.fromkeys(str(case["setting"]) for case in cases))
    means = np.reshape(
        [results.summary(metric, place).mean for place in range(len(cases))],
        (len(methods), -1),
    )
    height = 0.36 * len(methods) + 2.3
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, height))
    axes.imshow(means, cmap="Blues", vmin=0, vmax=110, aspect="auto")
    for (row, column), mean in np.ndenumerate(means):
        axes.text(
            column,
            row,
            f"{mean:.0f}",
            ha="center",
            va="center",
            color="white" if mean > 60 else "black",
        )
    axes.set(
        xticks=range(len(settings)),
        yticks=range(len(methods)),
        yticklabels=list(map(display_name, methods)),
    )
    axes.set_xticklabels(settings, rotation=90, va="bottom")
    axes.tick_params(top=True, bottom=False, labeltop=True, labelbottom=False, length=0)
    axes.grid(False)
    return figure


def draw(results: Results) -> Figure | None:
    """Draw the figure that an experiment names (:class:`~robonav.experiments.Plot`). Return None if it names none."""
    plot = results.experiment.plot
    if isinstance(plot, str):
        return None
    module, function = plot.function.split(".")
    draw_it = getattr(importlib.import_module(f"robonav.plots.{module}"), function)
    figure: Figure = draw_it(results, **plot.options)
    return figure


def save_figure(results: Results, folder: Path) -> None:
    """Write the figure of an experiment, if it has one, to ``NAME.svg`` and ``NAME.png``.

    Equal results give equal bytes.
    """
    name = results.experiment.name
    with mpl.rc_context(style.STYLE | {"svg.hashsalt": name}):
        figure = draw(results)
        if figure is None:
            return
        for kind, silent in (("svg", "Date"), ("png", "Software")):
            with atomic.atomic_write(folder / f"{name}.{kind}") as file:
                figure.savefig(file, format=kind, metadata={silent: None})
        plt.close(figure)
