"""Figures of chapter 3: planned paths, demonstrations and episodes on their maps, and the experiments' results."""

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

from .experiments import setting_label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = style.METHOD_COLOURS | {
    "dagger": style.GREEN,
    "1-neighbour": style.YELLOW,
    "5-neighbours": style.ORANGE,
    "15-neighbours": style.VERMILION,
}
CYCLE = (
    style.BLUE,
    style.GREEN,
    style.ORANGE,
    style.VERMILION,
    style.PURPLE,
    style.SKY,
)
SUCCESS = "episodes that arrive (%)"
LONG_NAME = 20  # characters; longer names of lines stand one below the other
VISITED = LinearSegmentedColormap.from_list(
    "visited", [to_rgba(style.SKY, 0.75), to_rgba(style.PURPLE, 0.75)]
)


def draw_search(
    axes: Axes,
    world: Worlds,
    made: Plan | GridPlan,
    *,
    colour: str = style.METHOD_COLOURS["A*"],
) -> None:
    """Draw a planned path as stars, and the nodes expanded as dots from light (early) to dark (late) (Fig. 3.4).

    Parameters
    ----------
    axes : Axes
        Where to draw.
    world : Worlds
        Batch of one: the map.
    made : Plan or GridPlan
        What the search found in this map. Without recorded nodes, only the path is drawn.
    colour : str
        Of the path.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.lfd import plan
    >>> from robonav.robot import make_world
    >>> world = make_world(circles=[(50, 50, 5)])
    >>> axes = Figure().add_subplot()
    >>> draw_search(axes, world, plan(world))
    >>> len(axes.lines[-1].get_xdata()) > 30  # the points of the path
    True
    """
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


def draw_named_paths(
    axes: Axes,
    world: Worlds,
    paths: Mapping[str, ArrayLike],
    *,
    colours: Mapping[str, str] = style.METHOD_COLOURS,
) -> None:
    """Draw several paths on one map, each with its name in the legend (Fig. 3.5, 3.9).

    Parameters
    ----------
    axes : Axes
        Where to draw.
    world : Worlds
        Batch of one: the map.
    paths : mapping of str to (steps + 1, 2 or 3) array
        x, y (and heading) along each path, by name.
    colours : mapping of str to str
        Colours by name, by default those of the methods.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.robot import make_world
    >>> axes = Figure().add_subplot()
    >>> draw_named_paths(axes, make_world(), {"A*": [(10, 10), (90, 90)]})
    >>> axes.lines[-1].get_label()
    'A*'
    """
    draw_world(axes, world)
    for name, path in paths.items():
        x, y = np.asarray(path)[:, :2].T
        axes.plot(x, y, color=colours.get(name, style.BLUE), linewidth=1.6, label=name)


def draw_demonstrations(
    figure: Figure,
    demonstrations: Demonstrations,
    trajectories: Sequence[int],
    *,
    columns: int = 4,
) -> None:
    """Draw some demonstrations on their maps, with dots where the effective pairs are (Fig. 3.6).

    Parameters
    ----------
    figure : Figure
        Gets a panel for each trajectory.
    demonstrations : Demonstrations
        By any expert.
    trajectories : sequence of int
        Which of them to draw.
    columns : int
        Panels a row.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.lfd import demonstrate
    >>> from robonav.robot import random_worlds
    >>> figure = Figure()
    >>> draw_demonstrations(figure, demonstrate(random_worlds(2, obstacles=5, seed=1)), [0, 1])
    >>> len(figure.axes)
    2
    """
    rows = -(-len(trajectories) // columns)
    for place, number in enumerate(trajectories, start=1):
        axes = figure.add_subplot(rows, columns, place)
        draw_world(axes, demonstrations.worlds[number])
        one = demonstrations.select_trajectories([number])
        axes.plot(*one.poses[:, :2].T, color=style.GREY, linewidth=1)
        axes.plot(
            *one.effective.poses[:, :2].T,
            color=style.METHOD_COLOURS["A*"],
            linestyle="none",
            marker=".",
            markersize=4,
        )
        axes.set(
            xticks=[],
            yticks=[],
            xlabel="",
            ylabel="",
            title=str(demonstrations.outcome[number]),
        )


def draw_moments(
    figure: Figure,
    world: Worlds,
    path: NDArray[np.float64],
    moments: Sequence[int],
    *,
    columns: int = 4,
    colour: str = style.ROBOT,
) -> None:
    """Draw some moments of an episode among moving obstacles (Fig. 3.10).

    Each panel shows the robot, its path so far, and the obstacles where they are at that moment.

    Parameters
    ----------
    figure : Figure
        Gets a panel for each moment.
    world : Worlds
        Batch of one.
    path : (steps + 1, 3) array
        The robot's poses in the episode.
    moments : sequence of int
        Seconds after the start.
    columns : int
        Panels in a row.
    colour : str
        Of the robot and its path.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.robot import navigate, random_worlds, straight
    >>> world = random_worlds(1, obstacles=0, moving=3, seed=1)
    >>> path = navigate(straight, world, record_paths=True).paths[0]
    >>> figure = Figure()
    >>> draw_moments(figure, world, path, [0, 5])
    >>> [axes.get_title() for axes in figure.axes]
    ['0 s', '5 s']
    """
    rows = -(-len(moments) // columns)
    tracks = obstacle_tracks(world, len(path) - 1)[0]
    for place, moment in enumerate(moments, start=1):
        axes = figure.add_subplot(rows, min(columns, len(moments)), place)
        draw_world(axes, world, tracks[moment])
        axes.plot(*path[: moment + 1, :2].T, color=colour, linewidth=1.4)
        draw_robot(axes, path[moment], colour)
        axes.set(xticks=[], yticks=[], xlabel="", ylabel="", title=f"{moment} s")


def draw_against(
    axes: Axes, results: Results, key: str, metric: str, *, thesis: bool = False
) -> None:
    """Draw a metric against one setting of the cases, with one line for each combination of the other settings.

    Bars show 95 % intervals over runs.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    results : Results
        Of one experiment.
    key : str
        The setting on the horizontal axis.
    metric : str
        The metric on the vertical axis.
    thesis : bool
        Whether to mark the thesis's numbers too.
    """
    lines: dict[tuple[tuple[str, str | float], ...], list[int]] = {}
    for place, case in enumerate(results.experiment.cases):
        others = {name: value for name, value in case.items() if name != key}
        lines.setdefault(tuple(others.items()), []).append(place)
    numbers = results.experiment.thesis.get(metric, ())
    labels = [
        ", ".join(setting_label(*setting) for setting in settings) for settings in lines
    ]
    for (settings, places), label, colour in zip(lines.items(), labels, cycle(CYCLE)):
        x = [float(results.experiment.cases[place][key]) for place in places]
        summaries = [results.summary(metric, place) for place in places]
        mean = np.array([summary.mean for summary in summaries])
        reach = [
            mean - [summary.low for summary in summaries],
            [summary.high for summary in summaries] - mean,
        ]
        own = COLOURS.get(str(dict(settings).get("method")), colour)
        axes.errorbar(
            x,
            mean,
            yerr=np.nan_to_num(reach),
            label=label,
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
    columns = 1 if max(map(len, labels)) > LONG_NAME else 2
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=columns)


def plot_demonstrations(results: Results) -> Figure:
    """Plot success against the number of demonstrations, with the thesis's numbers (Table 3.2)."""
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, 4))
    draw_against(axes, results, "demonstrations", "success", thesis=True)
    numbers = {case["demonstrations"] for case in results.experiment.cases}
    axes.set(ylabel=SUCCESS, xticks=sorted(numbers))
    return figure


def plot_iterations(results: Results) -> Figure:
    """Plot accuracy on the demonstrations, and success, against training iterations (Table 3.3)."""
    figure, (above, below) = plt.subplots(
        2, figsize=(style.FIGURE_WIDTH, 6), sharex=True
    )
    draw_against(above, results, "iterations", "success")
    above.set(ylabel=SUCCESS, xlabel="")
    above.get_legend().remove()
    draw_against(below, results, "iterations", "accuracy", thesis=True)
    below.set(ylabel="accuracy (%)")
    return figure


def plot_planners(results: Results) -> Figure:
    """Plot by how much two planners' paths exceed the straight line, and how many nodes they expand (Fig. 3.5)."""
    figure, (above, below) = plt.subplots(2, figsize=(style.FIGURE_WIDTH, 6.4))
    cases = results.experiment.cases
    rows = np.arange(len(cases))
    straight = np.array(
        [np.hypot(80.0, float(case["target y"]) - 10) for case in cases]
    )
    for shift, name, colour in (
        (-0.2, "modified A*", style.METHOD_COLOURS["A*"]),
        (0.2, "grid A*", style.METHOD_COLOURS["grid A*"]),
    ):
        length, nodes = (
            [
                results.summary(f"{metric}, {name}", row).mean
                for row in range(len(cases))
            ]
            for metric in ("length", "expanded")
        )
        above.barh(
            rows + shift,
            np.array(length) - straight,
            height=0.38,
            color=colour,
            label=name,
        )
        below.barh(rows + shift, nodes, height=0.38, color=colour)
    labels = [
        f"(90, {c['target y']}), {c['obstacles']} obstacles, {c['grid cell']} m"
        for c in cases
    ]
    above.set(xlabel="metres more than the straight line")
    below.set(xlabel="nodes expanded")
    above.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2)
    for axes in (above, below):
        axes.set(yticks=rows, yticklabels=labels)
        axes.invert_yaxis()
        axes.grid(axis="y", visible=False)
    return figure


def plot_cost(results: Results) -> Figure:
    """Plot the cost during training: the mean over runs, shaded from the least to the largest (Fig. 3.7)."""
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, 3.6))
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
    axes.legend()
    return figure


def plot_methods(results: Results) -> Figure:
    """Plot the success of methods against the number of obstacles, with 95 % intervals over runs (Fig. 3.8)."""
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, 4.6))
    draw_against(axes, results, "obstacles", "success")
    axes.set(
        ylabel=SUCCESS,
        xticks=sorted({int(case["obstacles"]) for case in results.experiment.cases}),
    )
    return figure


def plot_margins(results: Results) -> Figure:
    """Plot success against the margin that the expert keeps, with 95 % intervals over runs."""
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, 4))
    draw_against(axes, results, "margin", "success")
    margins = {case["margin"] for case in results.experiment.cases}
    axes.set(xlabel="margin of the expert (m)", ylabel=SUCCESS, xticks=sorted(margins))
    return figure


def draw_rounds(axes: Axes, results: Results) -> None:
    """Draw the success after each round of DAgger, with one line for each number of obstacles.

    A line is the mean over runs; the shade extends from the least to the largest.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    results : Results
        Of an experiment with cases of the method "dagger".
    """
    cases = [
        place
        for place, case in enumerate(results.experiment.cases)
        if case["method"] == "dagger"
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
        xlabel="round of DAgger (0: behaviour cloning)", ylabel=SUCCESS, xticks=rounds
    )
    axes.legend()
