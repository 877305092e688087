"""Learning from episodes: returns over training, walks on a grid, estimates beside the truth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle
from numpy.typing import ArrayLike

from robonav import style

COLOURS: dict[str, str] = {
    "Q-learning": style.VERMILION,
    "SARSA": style.BLUE,
    "expected SARSA": style.GREEN,
    "Monte Carlo": style.ORANGE,
    "TD(0)": style.PURPLE,
    "planned": style.GREY,
}


def colour_of(name: str, place: int) -> str:
    """A method's own colour; for any other name one of the palette, by its place."""
    others = (
        style.BLUE,
        style.VERMILION,
        style.GREEN,
        style.ORANGE,
        style.PURPLE,
        style.SKY,
    )
    return COLOURS.get(name, others[place % len(others)])


def plot_runs(
    axes: Axes,
    curves: Mapping[str, ArrayLike],
    *,
    x: ArrayLike | None = None,
    window: int = 1,
    band: float = 80.0,
) -> None:
    """The mean over seeds of some numbers a training, and the band that holds the middle ``band`` per cent of them.

    Parameters
    ----------
    curves : (seeds, T) by name.
    x : (T,) where they stand; 1, 2, ... if left out.
    window : neighbours to average over, along T.
    """
    for place, (name, given) in enumerate(curves.items()):
        runs = np.atleast_2d(np.asarray(given, dtype=float))
        smooth = np.stack(
            [np.convolve(run, np.ones(window) / window, "valid") for run in runs]
        )
        at = (np.arange(1, runs.shape[1] + 1) if x is None else np.asarray(x))[
            window - 1 :
        ]
        low, high = np.percentile(smooth, [50 - band / 2, 50 + band / 2], axis=0)
        colour = colour_of(name, place)
        axes.fill_between(at, low, high, color=colour, alpha=0.2, linewidth=0)
        axes.plot(at, smooth.mean(axis=0), color=colour, label=name)
    axes.legend()


def draw_walks(
    axes: Axes,
    shape: tuple[int, int],
    walks: Mapping[str, ArrayLike],
    *,
    forbidden: Sequence[int] = (),
    start: int | None = None,
    goal: int | None = None,
) -> None:
    """Walks over a grid of cells, each a line through the cells' numbers, row by row from the top.

    Parameters
    ----------
    shape : rows and columns.
    walks : numbers of the cells passed, by name.
    forbidden : cells to mark, as the cliff.
    """
    rows, columns = shape
    for cell in range(rows * columns):
        row, column = divmod(cell, columns)
        dark = cell in forbidden
        axes.add_patch(
            Rectangle(
                (column, row),
                1,
                1,
                facecolor=style.OBSTACLE if dark else "none",
                edgecolor=style.INK,
                linewidth=0.5,
            )
        )
    for place, (name, cells) in enumerate(walks.items()):
        down, across = np.divmod(np.asarray(cells), columns)
        aside = 0.5 + 0.1 * (
            place - (len(walks) - 1) / 2
        )  # walks that share cells lie side by side
        axes.plot(
            across + aside,
            down + aside,
            color=colour_of(name, place),
            linewidth=2.5,
            label=name,
        )
    for marked, letter in ((start, "S"), (goal, "G")):
        if marked is not None:
            row, column = divmod(marked, columns)
            axes.annotate(
                letter,
                (column + 0.18, row + 0.3),
                ha="center",
                va="center",
                weight="bold",
            )
    axes.set(
        xlim=(-0.05, columns + 0.05),
        ylim=(rows + 0.05, -0.05),
        aspect="equal",
        xticks=[],
        yticks=[],
    )
    axes.grid(False)
    axes.spines[:].set_visible(False)
    if walks:
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=3)


def plot_estimates(
    axes: Axes,
    names: Sequence[str],
    truth: ArrayLike,
    estimates: Mapping[str, ArrayLike],
) -> None:
    """Estimated values of some states beside the true ones.

    Parameters
    ----------
    names : of the states, (S,).
    truth : (S,).
    estimates : (S,) by name.
    """
    places = np.arange(len(names))
    axes.plot(
        places,
        np.asarray(truth),
        color=style.INK,
        linewidth=1,
        linestyle="--",
        label="true",
    )
    for place, (name, values) in enumerate(estimates.items()):
        axes.plot(
            places,
            np.asarray(values),
            "o-",
            color=colour_of(name, place),
            markersize=4,
            label=name,
        )
    axes.set_xticks(places, names)
    axes.legend()
