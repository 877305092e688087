"""Plans, demonstrations and learned drives over their maps, and chapter 3's results (Fig. 3.4-3.10, Table 3.2, 3.3)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, to_rgba
from numpy.typing import ArrayLike, NDArray

from robonav import style
from robonav.experiments import Results
from robonav.lfd import Demonstrations, GridPlan, Plan
from robonav.robot import Worlds, obstacle_tracks
from robonav.robot.drawing import draw_robot, draw_world

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = style.METHODS | {
    "cloning": style.BLUE,
    "DAgger": style.GREEN,
    "1 neighbour": style.YELLOW,
    "5 neighbours": style.ORANGE,
    "15 neighbours": style.VERMILION,
}
CYCLE = (
    style.BLUE,
    style.GREEN,
    style.ORANGE,
    style.VERMILION,
    style.PURPLE,
    style.SKY,
)
ARRIVE = "drives that arrive (%)"
VISITED = LinearSegmentedColormap.from_list(
    "visited", [to_rgba(style.SKY, 0.75), to_rgba(style.PURPLE, 0.75)]
)


def draw_search(
    axes: Axes,
    world: Worlds,
    made: Plan | GridPlan,
    *,
    colour: str = style.METHODS["A*"],
) -> None:
    """A plan as stars and what its search visited as dots, light for early and dark for late (Fig. 3.4)."""
    draw_world(axes, world)
    if made.visited is not None:
        x, y = made.visited[:, 0], made.visited[:, 1]
        axes.scatter(
            x,
            y,
            c=np.arange(len(x)),
            cmap=VISITED,
            s=1.5,
            linewidths=0,
            rasterized=True,
        )
    axes.plot(*made.points.T, marker="*", markersize=4, linewidth=0.8, color=colour)


def draw_ways(
    axes: Axes,
    world: Worlds,
    ways: Mapping[str, ArrayLike],
    *,
    colours: Mapping[str, str] = style.METHODS,
) -> None:
    """Several ways (steps + 1, 2 or 3) over one map, named as in ``style.METHODS`` (Fig. 3.5, 3.9)."""
    draw_world(axes, world)
    for name, way in ways.items():
        x, y = np.asarray(way)[:, :2].T
        axes.plot(x, y, color=colours.get(name, style.BLUE), linewidth=1.6, label=name)


def draw_demonstrations(
    figure: Figure,
    demonstrations: Demonstrations,
    drives: Sequence[int],
    *,
    columns: int = 4,
) -> None:
    """Some drives over their maps; steps that are learned from stand out (Fig. 3.6)."""
    rows = -(-len(drives) // columns)
    for place, drive in enumerate(drives, start=1):
        axes = figure.add_subplot(rows, columns, place)
        draw_world(axes, demonstrations.worlds[drive])
        shown = demonstrations.select_trajectories([drive])
        axes.plot(*shown.poses[:, :2].T, color=style.GREY, linewidth=1)
        axes.plot(
            *shown.effective.poses[:, :2].T,
            color=style.METHODS["A*"],
            linestyle="none",
            marker=".",
            markersize=4,
        )
        axes.set(
            xticks=[],
            yticks=[],
            xlabel="",
            ylabel="",
            title=str(demonstrations.outcome[drive]),
        )


def draw_moments(
    figure: Figure,
    world: Worlds,
    path: NDArray[np.float64],
    moments: Sequence[int],
    *,
    colour: str = style.ROBOT,
) -> None:
    """A drive among moving obstacles at some moments: the robot, its way so far, the obstacles then (Fig. 3.10)."""
    tracks = obstacle_tracks(world, len(path) - 1)[0]
    for place, moment in enumerate(moments, start=1):
        axes = figure.add_subplot(1, len(moments), place)
        draw_world(axes, world, tracks[moment])
        axes.plot(*path[: moment + 1, :2].T, color=colour, linewidth=1.4)
        draw_robot(axes, path[moment], colour)
        axes.set(xticks=[], yticks=[], xlabel="", ylabel="", title=f"{moment} s")


def draw_against(
    axes: Axes, results: Results, key: str, metric: str, *, thesis: bool = False
) -> None:
    """A metric against what one key of the cases says, a line for each setting of the others, with 95 % intervals.

    Parameters
    ----------
    thesis : whether to mark the thesis's numbers too.
    """
    lines: dict[str, list[int]] = {}
    for place, case in enumerate(results.experiment.cases):
        others = {name: value for name, value in case.items() if name != key}
        said = (
            f"{value}" if isinstance(value, str) else f"{name} {value}"
            for name, value in others.items()
        )
        lines.setdefault(", ".join(said), []).append(place)
    numbers = results.experiment.thesis.get(metric, ())
    for (name, places), colour in zip(lines.items(), cycle(CYCLE)):
        x = [float(results.experiment.cases[place][key]) for place in places]
        summaries = [results.summary(metric, place) for place in places]
        mean = np.array([summary.mean for summary in summaries])
        reach = [
            mean - [summary.low for summary in summaries],
            [summary.high for summary in summaries] - mean,
        ]
        own = COLOURS.get(name, colour)
        axes.errorbar(
            x,
            mean,
            yerr=np.nan_to_num(reach),
            label=name,
            color=own,
            marker="o",
            markersize=4,
            capsize=2,
        )
        marked = [
            (here, numbers[place])
            for here, place in zip(x, places, strict=True)
            if thesis
        ]
    if thesis:
        axes.plot(
            *zip(*marked, strict=True),
            color=style.INK,
            marker="D",
            linestyle="none",
            label="thesis",
        )
    axes.set(xlabel=key)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2, fontsize=9)


def plot_demonstrations(results: Results) -> Figure:
    """Success against number of demonstrations, the thesis's beside ours (Table 3.2)."""
    figure, axes = plt.subplots(figsize=(6.5, 4))
    draw_against(axes, results, "demonstrations", "success", thesis=True)
    axes.set(ylabel=ARRIVE)
    return figure


def plot_iterations(results: Results) -> Figure:
    """Agreement with the demonstrations, and success, against iterations of training (Table 3.3)."""
    figure, (above, below) = plt.subplots(2, figsize=(6.5, 6), sharex=True)
    draw_against(above, results, "iterations", "success")
    above.set(ylabel=ARRIVE, xlabel="")
    above.get_legend().remove()
    draw_against(below, results, "iterations", "accuracy", thesis=True)
    below.set(ylabel="agreement (%)")
    return figure


def plot_planners(results: Results) -> Figure:
    """How much farther than the bird's way two planners go, and how many nodes they expand (Fig. 3.5)."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.4), sharey=True)
    cases = results.experiment.cases
    rows = np.arange(len(cases))
    straight = np.array(
        [np.hypot(80.0, float(case["target y"]) - 10) for case in cases]
    )
    for shift, name in ((-0.2, "modified"), (0.2, "grid")):
        colour = style.METHODS["A*" if name == "modified" else "grid A*"]
        length = [results.summary(name, row).mean for row in range(len(cases))]
        nodes = [
            results.summary(f"{name} expands", row).mean for row in range(len(cases))
        ]
        left.barh(
            rows + shift,
            np.array(length) - straight,
            height=0.38,
            color=colour,
            label=f"{name} A*",
        )
        right.barh(rows + shift, nodes, height=0.38, color=colour)
    labels = [
        f"target (90, {c['target y']}), {c['obstacles']} obstacles, cells {c['grid cell']} m"
        for c in cases
    ]
    left.set(
        yticks=rows, yticklabels=labels, xlabel="metres more than the straight line"
    )
    right.set(xlabel="nodes expanded")
    left.invert_yaxis()
    left.legend(fontsize=8)
    for axes in (left, right):
        axes.grid(axis="y", visible=False)
    return figure


def plot_cost(results: Results) -> Figure:
    """The cost in training: mean and, shaded, least to largest over runs (Fig. 3.7)."""
    figure, axes = plt.subplots(figsize=(6.5, 3.6))
    for case, (setting, colour) in enumerate(
        zip(results.experiment.cases, CYCLE, strict=False)
    ):
        runs = results.values("cost", case)
        label = f"expert: {setting['expert']}; inputs {setting['inputs']}"
        axes.plot(runs.mean(axis=0), color=colour, label=label)
        axes.fill_between(
            np.arange(runs.shape[1]),
            runs.min(axis=0),
            runs.max(axis=0),
            color=colour,
            alpha=0.2,
        )
    axes.axhline(
        0.91, color=style.INK, linewidth=1, linestyle="--", label="thesis, at 300: 0.91"
    )
    axes.set(xlabel="iteration", ylabel="cost $J$")
    axes.legend(fontsize=8)
    return figure


def plot_methods(results: Results) -> Figure:
    """Success of methods against the number of obstacles, with 95 % intervals over runs (Fig. 3.8)."""
    figure, axes = plt.subplots(figsize=(6.5, 4.6))
    draw_against(axes, results, "obstacles", "success")
    axes.set(
        ylabel=ARRIVE,
        xticks=sorted({int(case["obstacles"]) for case in results.experiment.cases}),
    )
    return figure


def plot_margins(results: Results) -> Figure:
    """Success against the margin that the expert keeps."""
    figure, axes = plt.subplots(figsize=(6.5, 4))
    draw_against(axes, results, "margin", "success")
    axes.set(xlabel="margin of the expert (m)", ylabel=ARRIVE)
    return figure


def draw_rounds(axes: Axes, results: Results) -> None:
    """Success after each of DAgger's rounds, a line a number of obstacles: mean, and least to largest over runs."""
    cases = [
        place
        for place, case in enumerate(results.experiment.cases)
        if case["method"] == "DAgger"
    ]
    for case, colour in zip(cases, CYCLE, strict=False):
        runs = results.values("success by round", case)
        rounds = np.arange(runs.shape[1])
        obstacles = results.experiment.cases[case]["obstacles"]
        axes.plot(
            rounds,
            runs.mean(axis=0),
            color=colour,
            marker="o",
            label=f"{obstacles} obstacles",
        )
        axes.fill_between(
            rounds,
            runs.min(axis=0),
            runs.max(axis=0),
            color=colour,
            alpha=0.15,
            linewidth=0,
        )
    axes.set(
        xlabel="round of DAgger (0: before the first)", ylabel=ARRIVE, xticks=rounds
    )
    axes.legend(fontsize=8)
