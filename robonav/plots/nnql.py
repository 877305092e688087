"""Rewards, exploration and learning curves of chapter 4 (Fig. 4.2 to 4.7)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from numpy.typing import ArrayLike

from robonav import style
from robonav.benchmark import display_name
from robonav.experiments import Results
from robonav.nnql import softmax_policy
from robonav.nnql.reward import COZY_DISTANCE, REWARDS, reward_row
from robonav.robot import SENSOR_RANGE, Action, Sensing, Worlds
from robonav.robot._fast import RUNNING

from .robot import draw_paths

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.figure import Figure

ACTIONS = [Action(a).name for a in range(5)]
GOOD_AND_BAD = LinearSegmentedColormap.from_list(
    "good and bad", [style.VERMILION, "#9A9A9A40", style.BLUE]
)
ACTION_COLOURS = (style.BLUE, style.GREEN, style.SKY, style.ORANGE, style.VERMILION)


def draw_rewards(axes: Axes) -> None:
    """Draw the reward of a step that does not end the episode, over the least range before and after (Table 4.1).

    Parameters
    ----------
    axes : Axes
        The axes to draw on.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_rewards(axes)
    >>> len(axes.images)
    1
    """
    distance = (np.arange(400) + 0.5) / 400 * (SENSOR_RANGE + 1)
    before, after = np.meshgrid(distance, distance)
    row = reward_row(
        _seen(before), _seen(after), np.full(before.size, RUNNING, np.int8)
    )
    extent = (0, SENSOR_RANGE + 1, 0, SENSOR_RANGE + 1)
    image = axes.imshow(
        REWARDS[row].reshape(before.shape),
        extent=extent,
        origin="lower",
        cmap=GOOD_AND_BAD,
        vmin=-1,
        vmax=1,
    )
    for border in (COZY_DISTANCE, SENSOR_RANGE):
        axes.axvline(border, color=style.INK, linewidth=0.6)
        axes.axhline(border, color=style.INK, linewidth=0.6)
    for place, name in ((2.5, "dangerous"), (7.5, "cozy"), (10.5, "safe")):
        axes.annotate(name, (place, 11.1), ha="center", annotation_clip=False)
        axes.annotate(
            name,
            (11.1, place),
            va="center",
            rotation=-90,
            annotation_clip=False,
        )
    axes.set(xlabel="least range before the step (m)", ylabel="after it (m)")
    axes.grid(False)
    axes.figure.colorbar(image, ax=axes, label="reward", pad=0.12)


def _seen(nearest: ArrayLike) -> Sensing:
    """Return the sensing of robots with given least ranges. Beyond the sensors' range they sense nothing."""
    ranges = np.minimum(np.ravel(nearest), SENSOR_RANGE)[:, None] + np.zeros(9)
    n = len(ranges)
    return Sensing(ranges, np.zeros((n, 9), bool), np.ones(n, int), np.zeros(n, bool))


def draw_softmax_policy(
    axes: Axes, q: ArrayLike, *, coldest: float = 0.01, hottest: float = 10.0
) -> None:
    """Draw the probability of each action from low to high temperatures.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    q : (5,) array
        Q-values of the five actions.
    coldest, hottest : float
        The lowest and the highest temperature.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_softmax_policy(axes, [0.9, 0.8, 0.5, 0.3, 0.1])
    >>> len(axes.lines)
    5
    """
    temperatures = np.geomspace(coldest, hottest, 200)
    shares = softmax_policy(np.tile(np.asarray(q, dtype=float), (200, 1)), temperatures)
    for name, value, share, colour in zip(
        ACTIONS, np.asarray(q), shares.T, ACTION_COLOURS, strict=True
    ):
        axes.plot(temperatures, share, color=colour, label=f"{name}, Q = {value:g}")
    axes.set(xscale="log", xlabel="temperature $T$", ylabel="probability", ylim=(0, 1))
    axes.legend()


def animate_softmax_policy(
    q: ArrayLike, temperatures: Sequence[float]
) -> FuncAnimation:
    """Animate bars of the actions' probabilities while the temperature falls.

    Parameters
    ----------
    q : (5,) array
        Q-values of the five actions.
    temperatures : sequence of float
        One for each frame.

    Returns
    -------
    FuncAnimation

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> from robonav.plots.player import player
    >>> animation = animate_softmax_policy([0.9, 0.8, 0.5, 0.3, 0.1], [1.0, 0.1])
    >>> "It cools" in player(animation, description="It cools").data
    True
    >>> plt.close()
    """
    from matplotlib.animation import FuncAnimation

    figure, axes = plt.subplots(figsize=(5, 2.6))

    def draw(frame: int) -> list:
        axes.clear()
        axes.bar(ACTIONS, softmax_policy(q, temperatures[frame]), color=ACTION_COLOURS)
        axes.set(
            ylim=(0, 1), ylabel="probability", title=f"$T$ = {temperatures[frame]:.2g}"
        )
        return []

    return FuncAnimation(figure, draw, frames=len(temperatures), interval=200)


def draw_learning(
    axes: Axes, counts: Mapping[str, ArrayLike], *, size: int = 30
) -> None:
    """Draw the successful episodes in every ``size``: mean and standard deviation over seeds (Figs. 4.4 and 4.6).

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    counts : mapping of str to (S, blocks) array
        Counts by method.
    size : int
        Episodes in a block.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_learning(axes, {"nnql": [[10, 20], [20, 30]]})  # two seeds
    >>> axes.lines[0].get_ydata()
    array([15., 25.])
    """
    for name, given in counts.items():
        runs = np.atleast_2d(np.asarray(given, dtype=float))
        ends = size * np.arange(1, runs.shape[1] + 1)
        mean, spread = runs.mean(axis=0), runs.std(axis=0)
        colour = style.METHOD_COLOURS.get(name, style.BLUE)
        axes.fill_between(
            ends, mean - spread, mean + spread, color=colour, alpha=0.18, linewidth=0
        )
        axes.plot(ends, mean, color=colour, marker=".", label=display_name(name))
    axes.set(
        xlabel="episode", ylabel=f"successes in {size} episodes", ylim=(0, size + 1)
    )
    axes.legend()


def draw_weight_changes(
    axes: Axes, changes: Mapping[str, ArrayLike], *, colour: str = style.BLUE
) -> None:
    """Draw how much the weights of one layer changed in each episode, for one or more kinds of sum (Fig. 4.3).

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    changes : mapping of str to (E,) or (S, E) array
        Sums of one seed, or of several seeds, by kind of sum. Of several seeds the function draws the mean and a
        standard deviation.
    colour : str
        The colour of the lines.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_weight_changes(axes, {"signed": [1.0, -2.0], "absolute": [1.0, 2.0]})
    >>> axes.lines[0].get_ydata()
    array([ 1., -2.])
    """
    for (name, values), shade in zip(changes.items(), (1.0, 0.45), strict=False):
        runs = np.atleast_2d(np.asarray(values, dtype=float))
        episodes, mean, spread = (
            np.arange(1, runs.shape[1] + 1),
            runs.mean(axis=0),
            runs.std(axis=0),
        )
        axes.fill_between(
            episodes,
            mean - spread,
            mean + spread,
            color=colour,
            alpha=0.2 * shade,
            linewidth=0,
        )
        axes.plot(episodes, mean, color=colour, alpha=shade, linewidth=1, label=name)
    axes.axhline(0, color=style.INK, linewidth=0.6)
    axes.set(xlabel="episode")
    axes.legend()


def animate_learning(
    world: Worlds,
    paths: Sequence[ArrayLike],
    titles: Sequence[str],
    *,
    colour: str = style.ROBOT,
) -> FuncAnimation:
    """Animate several episodes in one world: each frame shows a path (steps + 1, 3) and a title.

    Parameters
    ----------
    world : Worlds
        The map.
    paths : sequence of (steps + 1, 3) arrays
        One for each frame.
    titles : sequence of str
        One for each frame.
    colour : str
        The colour of the paths.

    Returns
    -------
    FuncAnimation

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> from robonav.plots.player import player
    >>> from robonav.robot import make_world
    >>> animation = animate_learning(make_world(), [np.zeros((2, 3))], ["episode 1"])
    >>> "It learns" in player(animation, description="It learns").data
    True
    >>> plt.close()
    """
    from matplotlib.animation import FuncAnimation

    figure, axes = plt.subplots(figsize=(4.4, 4.6))

    def draw(frame: int) -> list:
        axes.clear()
        draw_paths(axes, world, [paths[frame]], colour=colour)
        axes.set(title=titles[frame], xlabel="", ylabel="")
        return []

    return FuncAnimation(figure, draw, frames=len(paths), interval=500)


def draw_rates(
    axes: Axes,
    rates: Mapping[str, ArrayLike],
    *,
    thesis: Mapping[str, float] | None = None,
) -> None:
    """Draw the success of every seed as a dot, their mean as a line, and the thesis's mean as a diamond, in per cent.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    rates : mapping of str to (S,) array
        Success rates by name, such as that of a method.
    thesis : mapping of str to float, optional
        The thesis's means by the same names, where it has them.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_rates(axes, {"nnql": [90, 100]}, thesis={"nnql": 98})
    >>> len(axes.lines)  # the dots, their mean, and the thesis's
    3
    """
    for row, (name, values) in enumerate(rates.items()):
        dots = np.sort(np.asarray(values, dtype=float))
        colour = style.METHOD_COLOURS.get(name, style.BLUE)
        # a fixed spread, so that dots do not overlap
        height = row + 0.22 * np.sin(2.4 * np.arange(len(dots)))
        axes.plot(dots, height, ".", color=colour, alpha=0.6, markersize=5)
        axes.plot(
            [dots.mean()] * 2, [row - 0.35, row + 0.35], color=colour, linewidth=2.5
        )
        if thesis and name in thesis:
            axes.plot(
                thesis[name], row, "D", color=style.INK, markersize=6, fillstyle="none"
            )
    axes.set(
        yticks=range(len(rates)),
        yticklabels=list(map(display_name, rates)),
        xlabel="episodes that arrive (%)",
    )
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)


def draw_trials(axes: Axes, means: Mapping[str, ArrayLike]) -> None:
    """Draw the mean success of every trial by method, sorted; a cross marks the thesis's settings.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    means : mapping of str to (trials,) array
        Success in per cent by method; the first trial has the thesis's settings.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_trials(axes, {"nnql": [50.0, 90.0, 20.0]})
    >>> axes.lines[0].get_ydata()
    array([20., 50., 90.])
    """
    for place, (name, values) in enumerate(means.items()):
        rates = np.asarray(values, dtype=float)
        order = np.argsort(rates)
        across = place + 0.7 * (np.arange(len(rates)) / max(len(rates) - 1, 1) - 0.5)
        colour = style.METHOD_COLOURS.get(name, style.BLUE)
        axes.plot(across, rates[order], ".", color=colour, markersize=8)
        first = int(np.flatnonzero(order == 0)[0])
        axes.plot(across[first], rates[0], "x", color=style.INK, markersize=9)
    axes.set(
        xticks=range(len(means)),
        xticklabels=list(map(display_name, means)),
        ylabel="success (%)",
        ylim=(0, 102),
    )
    axes.grid(axis="x", visible=False)


def draw_endings(axes: Axes, endings: Mapping[str, tuple[float, float, float]]) -> None:
    """Draw how episodes end in per cent, with one bar for each label: arrived, out of steps and collided.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    endings : mapping of str to tuple of float
        Per cent of the episodes that arrived, were out of steps and collided, by label.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_endings(axes, {"a": (90.0, 7.0, 3.0)})
    >>> axes.texts[0].get_text()
    '90.0 %'
    """
    left = np.zeros(len(endings))
    rates = np.array(list(endings.values())).reshape(-1, 3)
    kinds = (
        ("arrived", style.GREEN),
        ("out of steps", style.ORANGE),
        ("collided", style.VERMILION),
    )
    for (label, colour), width in zip(kinds, rates.T, strict=True):
        axes.barh(
            range(len(endings)),
            width,
            left=left,
            color=colour,
            label=label,
            height=0.65,
        )
        left += width
    for row, rate in enumerate(rates[:, 0]):
        axes.annotate(f"{rate:.1f} %", (101, row), va="center", annotation_clip=False)
    axes.set(
        yticks=range(len(endings)),
        yticklabels=list(endings),
        xlim=(0, 100),
        xlabel="episodes (%)",
    )
    axes.legend(
        loc="lower right", bbox_to_anchor=(1.18, 1.0), ncols=3, columnspacing=1.0
    )
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)


def plot_learning(results: Results) -> Figure:
    """Plot Fig. 4.4 or 4.6 from its results."""
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, 3.4))
    cases = results.experiment.cases
    draw_learning(
        axes,
        {
            str(case["method"]): results.values("successes", k)
            for k, case in enumerate(cases)
        },
    )
    return figure


def plot_weight_changes(results: Results) -> Figure:
    """Plot Fig. 4.3 from its results, one panel a layer."""
    figure, panels = plt.subplots(2, figsize=(style.FIGURE_WIDTH, 4.6), sharex=True)
    for panel, layer in zip(panels, ("first layer", "second layer"), strict=True):
        ways = {
            str(case["sum"]): results.values(layer, k)
            for k, case in enumerate(results.experiment.cases)
        }
        draw_weight_changes(panel, ways, colour=style.METHOD_COLOURS["nnql"])
        panel.set(title=layer)
    return figure


def plot_rates(results: Results) -> Figure:
    """Plot Table 4.3 from its results."""
    cases = results.experiment.cases
    rates = {
        str(case["method"]): results.values("success", k)
        for k, case in enumerate(cases)
    }
    thesis = dict(zip(rates, results.experiment.thesis["success"], strict=True))
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, 3.4))
    draw_rates(
        axes,
        rates,
        thesis={name: mean for name, mean in thesis.items() if mean is not None},
    )
    return figure


def plot_speeds(results: Results) -> Figure:
    """Plot Table 4.2 from its results: the mean over seeds, and a band from the worst to the best."""
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, 3.8))
    cases = results.experiment.cases
    for name in dict.fromkeys(str(case["method"]) for case in cases):
        own = [k for k, case in enumerate(cases) if case["method"] == name]
        speeds = [float(cases[k]["speed"]) for k in own]
        runs = np.array([results.values("success", k) for k in own])
        colour = style.METHOD_COLOURS.get(name, style.BLUE)
        axes.fill_between(
            speeds,
            runs.min(axis=1),
            runs.max(axis=1),
            color=colour,
            alpha=0.15,
            linewidth=0,
        )
        axes.plot(
            speeds,
            runs.mean(axis=1),
            color=colour,
            marker=".",
            label=display_name(name),
        )
    axes.set(xlabel="speed (m/s)", ylabel="episodes that arrive (%)", ylim=(0, 102))
    axes.legend()
    return figure


def plot_trials(results: Results) -> Figure:
    """Plot the trials of all methods from their results."""
    means: dict[str, list[float]] = {}
    for k, case in enumerate(results.experiment.cases):
        means.setdefault(str(case["method"]), []).append(
            results.summary("success", k).mean
        )
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, 3))
    draw_trials(axes, means)
    return figure


def plot_endings(results: Results, factor: str) -> Figure:
    """Plot how episodes end for all levels of one factor, from the results of ``nnql-circles``."""
    ends = {}
    for k, case in enumerate(results.experiment.cases):
        if case["factor"] == factor:
            arrived, cut, collided = (
                results.summary(how, k).mean
                for how in ("success", "out of steps", "collision")
            )
            ends[str(case["level"])] = (arrived, cut, collided)
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, 0.42 * len(ends) + 1.3))
    draw_endings(axes, ends)
    return figure


def plot_variations(results: Results) -> Figure:
    """Plot the mean success of every case of ``nnql-circles``, with its interval."""
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, 7))
    cases = results.experiment.cases
    for k in range(len(cases)):
        summary = results.summary("success", k)
        axes.plot([summary.low, summary.high], [k, k], color=style.INK, linewidth=2)
        axes.plot(summary.mean, k, "o", color=style.METHOD_COLOURS["nnql"])
    labels = [f"{case['factor']}: {case['level']}" for case in cases]
    axes.set(
        yticks=range(len(cases)),
        yticklabels=labels,
        xlabel="episodes that arrive (%)",
        xlim=(0, 102),
    )
    axes.invert_yaxis()
    return figure
