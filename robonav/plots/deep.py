"""PPO: its clipped objective, and how many episodes arrive as a training goes on."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import torch
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from robonav import style
from robonav.deep import clipped_surrogate
from robonav.experiments import Results, bootstrap_interval

COLOURS = (style.BLUE, style.VERMILION, style.GREEN, style.PURPLE, style.ORANGE)


def draw_clipped_surrogate(axes: Axes, advantage: float, clip: float) -> None:
    """Draw the clipped surrogate of one step over the ratio of probabilities, beside the one that is not clipped.

    Parameters
    ----------
    axes : Axes
        To draw on.
    advantage : float
        The advantage of the action.
    clip : float
        epsilon.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_clipped_surrogate(axes, 1.0, clip=0.2)
    >>> print(axes.lines[-1].get_ydata()[-1])
    1.2
    """
    ratio = np.linspace(0, 2, 201)
    rho = torch.as_tensor(ratio)
    gain = clipped_surrogate(rho, torch.full_like(rho, advantage), clip)
    for end in (1 - clip, 1 + clip):
        axes.axvline(end, color=style.ORANGE, linestyle="--", linewidth=1)
    axes.plot(
        ratio, ratio * advantage, color=style.GREY, linestyle="--", label="not clipped"
    )
    axes.plot(ratio, gain.numpy(), color=style.BLUE, linewidth=2.5, label="clipped")
    axes.set(xlabel=r"ratio $\rho$", title=f"advantage {advantage:+g}".replace("-", "−"))  # fmt: skip


def draw_arrivals(axes: Axes, shares: Mapping[str, ArrayLike], *, steps: int) -> None:
    """Draw which share of the episodes arrives as a training goes on: mean and 95 % interval of the mean over seeds.

    Parameters
    ----------
    axes : Axes
        To draw on.
    shares : mapping of str to (S, U) array
        Per cent of the episodes that ended in each update and arrived, by name.
    steps : int
        Steps of the actors of one seed in an update.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_arrivals(axes, {"PPO": [[10, 20], [20, 30]]}, steps=2048)  # two seeds
    >>> axes.lines[0].get_ydata()
    array([15., 25.])
    """
    for colour, (name, given) in zip(COLOURS, shares.items(), strict=False):
        runs = np.asarray(given, dtype=float)
        thousands = steps * np.arange(1, runs.shape[1] + 1) / 1000
        low, high = np.transpose([bootstrap_interval(column) for column in runs.T])
        axes.fill_between(thousands, low, high, color=colour, alpha=0.2, linewidth=0)
        axes.plot(thousands, runs.mean(axis=0), color=colour, marker=".", label=name)
    axes.set(
        xlabel="thousand steps of the actors",
        ylabel="arrivals (%)",
        ylim=(0, 101),
    )
    if len(shares) > 1:
        axes.figure.legend(loc="outside upper left", ncols=2)


def draw_failures(axes: Axes, results: Results, *, steps: str, lines: str) -> None:
    """Draw which share of the episodes fails, on a logarithmic scale, with the 95 % interval of the mean over seeds.

    Parameters
    ----------
    axes : Axes
        To draw on.
    results : Results
        With the metric "success".
    steps, lines : str
        The key of the cases that goes along the axis, and the one that has a line for each value.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.experiments import read_results
    >>> axes = Figure().add_subplot()
    >>> draw_failures(axes, read_results("ppo-curriculum"), steps="stage", lines="setting")
    >>> len(axes.containers)
    3
    """
    cases = results.experiment.cases
    names = list(dict.fromkeys(str(case[steps]) for case in cases))
    for colour, line in zip(COLOURS, dict.fromkeys(c[lines] for c in cases), strict=False):  # fmt: skip
        found = [
            results.summary("success", place)
            for place, case in enumerate(cases)
            if case[lines] == line
        ]
        failed = 100 - np.array([one.mean for one in found])
        ends = [[one.high - one.mean, one.mean - one.low] for one in found]
        axes.errorbar(
            range(len(names)), failed, np.transpose(ends),
            color=colour, marker="o", capsize=3, label=str(line),
        )  # fmt: skip
    axes.set(yscale="log", ylabel="episodes that fail (%)", xticks=range(len(names)), xticklabels=names)  # fmt: skip
    axes.yaxis.set_major_formatter("{x:g}")
    axes.legend()
