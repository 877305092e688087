"""Learning from episodes: returns during training, paths on a grid, estimates and true values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle
from numpy.typing import ArrayLike

from robonav import style
from robonav.mdp import Tiles

COLOURS: dict[str, str] = {
    "Q-learning": style.VERMILION,
    "SARSA": style.BLUE,
    "expected SARSA": style.GREEN,
    "Monte Carlo": style.ORANGE,
    "TD(0)": style.PURPLE,
    "planned": style.GREY,
}


def colour_of(name: str, place: int) -> str:
    """Return the colour of a method, or for another name the palette's colour of this place.

    Parameters
    ----------
    name : str
        A method's name, or another.
    place : int
        The place in the palette.

    Returns
    -------
    str

    Examples
    --------
    >>> colour_of("", 0) == colour_of("", 1)
    False
    """
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
    """Plot the mean over seeds of a number for each episode, with a band of the middle ``band`` per cent of seeds.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    curves : mapping of str to (seeds, T) array
        The numbers, by name.
    x : (T,) array, optional
        The horizontal positions; by default 1, 2, ...
    window : int
        The number of neighbours along T to average over.
    band : float
        The percentage of seeds in the band.

    Examples
    --------
    >>> import numpy as np
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> plot_runs(axes, {"SARSA": np.arange(12.0).reshape(3, 4)})  # three seeds, four episodes
    >>> axes.lines[0].get_ydata()
    array([4., 5., 6., 7.])
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


def draw_trajectories(
    axes: Axes,
    shape: tuple[int, int],
    trajectories: Mapping[str, ArrayLike],
    *,
    forbidden: Sequence[int] = (),
    start: int | None = None,
    goal: int | None = None,
) -> None:
    """Draw paths over a grid of cells. Cells are numbered row by row from the top.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    shape : (int, int)
        The numbers of rows and columns.
    trajectories : mapping of str to array of int
        The numbers of the cells on each path, by name.
    forbidden : sequence of int
        Cells to mark, such as those of the cliff.
    start, goal : int, optional
        Cells to name.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_trajectories(axes, (2, 3), {"SARSA": [3, 0, 1, 2, 5]}, forbidden=[4], start=3, goal=5)
    >>> [text.get_text() for text in axes.texts]
    ['S', 'G']
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
    for place, (name, cells) in enumerate(trajectories.items()):
        down, across = np.divmod(np.asarray(cells), columns)
        # trajectories that share cells lie side by side
        aside = 0.5 + 0.1 * (place - (len(trajectories) - 1) / 2)
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
    if trajectories:
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=3)


def plot_estimates(
    axes: Axes,
    names: Sequence[str],
    truth: ArrayLike,
    estimates: Mapping[str, ArrayLike],
) -> None:
    """Plot the estimated values of some states with the true values.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    names : sequence of str
        The names of the S states.
    truth : (S,) array
        The true values.
    estimates : mapping of str to (S,) array
        The estimates, by name.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> plot_estimates(axes, ["a", "b"], [0.5, 1.0], {"TD(0)": [0.4, 0.9]})
    >>> len(axes.lines)
    2
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


def draw_tiles(axes: Axes, tiles: Tiles, states: ArrayLike) -> None:
    """Draw the tilings of a plane in different colours, some states, and the tiles that hold the first of them.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    tiles : Tiles
        Tilings of a state of two coordinates.
    states : (N, 2) array
        The states to mark.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.mdp import Tiles
    >>> tiles = Tiles(low=[0.0, 0.0], high=[1.0, 1.0], tiles=[2, 2], tilings=2, n_actions=1)
    >>> axes = Figure().add_subplot()
    >>> draw_tiles(axes, tiles, [[0.3, 0.6]])
    >>> axes.get_xlim() != (0.0, 1.0)
    True
    """
    points = np.asarray(states, dtype=float)
    low, high = np.asarray(tiles.low), np.asarray(tiles.high)
    side = (high - low) / tiles.tiles
    active = np.unravel_index(tiles.active(points[0]), tiles.shape)
    for tiling, shift in enumerate(tiles.shifts):
        colour = colour_of("", tiling)
        corner = low - shift * side
        for column in range(tiles.tiles[0] + 1):
            for row in range(tiles.tiles[1] + 1):
                on = (column, row) == (active[1][tiling], active[2][tiling])
                axes.add_patch(
                    Rectangle(
                        tuple(corner + side * (column, row)),
                        *side,
                        facecolor=colour if on else "none",
                        alpha=0.3 if on else 0.6,
                        edgecolor=colour,
                        linewidth=1.2,
                    )
                )
    axes.plot(*points.T, "o", color=style.INK, markersize=5)
    for number, (x, y) in enumerate(points):
        axes.annotate(
            "ABCDEFGH"[number], (x, y), xytext=(4, 4), textcoords="offset points"
        )
    edge = 0.02 * (high - low)
    axes.set(
        xlim=(low[0] - edge[0], high[0] + edge[0]),
        ylim=(low[1] - edge[1], high[1] + edge[1]),
    )
    axes.grid(False)
