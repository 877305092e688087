"""Decision processes: grids with values and arrows, Figs. 2.1, 2.2 and 2.4, and plots of planning."""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb, to_rgba
from matplotlib.patches import Circle, FancyArrowPatch, FancyBboxPatch, Rectangle
from numpy.typing import ArrayLike, NDArray

from robonav import style
from robonav.mdp import GPIHistory, GridWorld
from robonav.mdp.gridworld import STEPS

# Cells are pale and their contents dark, in the light and in the dark theme, as in `grid_lab.js`.
ZERO, DARK, STRENGTH = "#F3F4F5", "#1F2328", 0.6
PLANNERS: dict[str, str] = {
    "value iteration": style.BLUE,
    "policy iteration": style.VERMILION,
    "modified policy iteration": style.GREEN,
    "in place": style.ORANGE,
    "prioritised": style.PURPLE,
}


def draw_grid(
    axes: Axes,
    grid: GridWorld,
    values: ArrayLike | None = None,
    *,
    policy: ArrayLike | None = None,
    digits: int = 2,
    scale: float | None = None,
) -> None:
    """Draw a gridworld: dark walls, framed terminal cells, values as colours and numbers, a policy as arrows.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    grid : GridWorld
        The gridworld.
    values : (S,) array, optional
        The values of the states; by default they are not drawn.
    policy : (S,) or (S, A) array, optional
        Actions, or probabilities, which give likelier actions longer arrows.
    digits : int
        The number of digits after the point; no numbers are drawn if it is negative.
    scale : float, optional
        The value with the strongest colour; by default the largest absolute value.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.mdp import GridWorld
    >>> axes = Figure().add_subplot()
    >>> draw_grid(axes, GridWorld("S # G"), [0.9, 0.0])
    >>> [text.get_text() for text in axes.texts]
    ['S', '0.90', '+1']
    """
    for row, column in np.argwhere(grid.numbers < 0):
        axes.add_patch(Rectangle((column, row), 1, 1, color=style.OBSTACLE))
    drawn = None if values is None else np.asarray(values, dtype=float)
    ink = style.INK if drawn is None else DARK
    strongest = scale or (1.0 if drawn is None else float(abs(drawn).max()) or 1.0)
    for state, (row, column) in enumerate(grid.cells):
        face = "none" if drawn is None else colour_of_value(drawn[state] / strongest)
        axes.add_patch(
            Rectangle(
                (column, row), 1, 1, facecolor=face, edgecolor=style.INK, linewidth=0.6
            )
        )
        _draw_meaning(axes, grid, state, ink)
        if drawn is not None and digits >= 0 and not grid.terminal[state]:
            lower = 0.5 if policy is None else 0.78
            axes.text(
                column + 0.5,
                row + lower,
                f"{drawn[state]:.{digits}f}",
                fontsize=9,
                color=ink,
                ha="center",
                va="center",
            )
    if policy is not None:
        _draw_arrows(
            axes,
            grid,
            np.asarray(policy),
            up=0.5 if drawn is None or digits < 0 else 0.38,
            ink=ink,
        )
    rows, columns = grid.shape
    axes.set(
        xlim=(-0.02, columns + 0.02),
        ylim=(rows + 0.02, -0.02),
        aspect="equal",
        xticks=[],
        yticks=[],
    )
    axes.grid(False)
    axes.spines[:].set_visible(False)


def colour_of_value(share: float) -> tuple[float, float, float]:
    """Return the colour of a value in [-1, 1], relative to the strongest colour: blue above 0, red below 0.

    Parameters
    ----------
    share : float
        The value, as a share of the strongest one.

    Returns
    -------
    tuple of float
        Red, green and blue, each in [0, 1].

    Examples
    --------
    >>> red, green, blue = colour_of_value(1.0)
    >>> red < blue
    True
    """
    pale, full = (
        np.array(to_rgb(ZERO)),
        np.array(to_rgb(style.BLUE if share > 0 else style.VERMILION)),
    )
    red, green, blue = pale + STRENGTH * min(abs(share), 1.0) * (full - pale)
    return float(red), float(green), float(blue)


def _draw_meaning(axes: Axes, grid: GridWorld, state: int, ink: str) -> None:
    """Draw a frame and the reward on a terminal cell, or the symbol of another special cell."""
    row, column = grid.cells[state]
    symbol = grid.rows[row][column]
    if grid.terminal[state]:
        reward = grid.cell_rewards[state] - grid.step_reward
        axes.add_patch(
            Rectangle(
                (column + 0.08, row + 0.08),
                0.84,
                0.84,
                facecolor="none",
                edgecolor=ink,
                linewidth=1.5,
            )
        )
        axes.text(
            column + 0.5,
            row + 0.5,
            f"{reward:+g}",
            color=ink,
            fontsize=11,
            ha="center",
            va="center",
        )
    elif symbol != ".":
        axes.text(
            column + 0.13,
            row + 0.18,
            symbol,
            fontsize=9,
            color=ink,
            ha="center",
            va="center",
        )


def _draw_arrows(
    axes: Axes, grid: GridWorld, policy: NDArray, *, up: float, ink: str
) -> None:
    """Draw an arrow for each action that the policy takes, starting ``up`` from the upper edge of its cell."""
    probabilities = policy if policy.ndim == 2 else np.eye(len(STEPS))[policy]
    for state in np.flatnonzero(~grid.terminal):
        row, column = grid.cells[state]
        sure = probabilities[state].max() > 0.99
        for (down, right), probability in zip(STEPS, probabilities[state], strict=True):
            if probability < 0.01:
                continue
            reach = 0.24 if sure else 0.08 + 0.2 * probability
            tail = 0.24 if sure else 0.0
            axes.add_patch(
                FancyArrowPatch(
                    (column + 0.5 - tail * right, row + up - tail * down),
                    (column + 0.5 + reach * right, row + up + reach * down),
                    arrowstyle="-|>",
                    mutation_scale=9 if sure else 5,
                    color=ink,
                    linewidth=1.6 if sure else 1.0,
                    shrinkA=0,
                    shrinkB=0,
                )
            )


def _box(
    axes: Axes,
    middle: tuple[float, float],
    text: str,
    *,
    width: float = 1.9,
    height: float = 0.7,
) -> None:
    corner = (middle[0] - width / 2, middle[1] - height / 2)
    shape = FancyBboxPatch(
        corner,
        width,
        height,
        boxstyle="round,pad=0,rounding_size=0.12",
        facecolor=to_rgba(style.SKY, 0.25),
        ec=style.INK,
    )
    axes.add_patch(shape)
    axes.text(*middle, text, ha="center", va="center")


def _arrow(
    axes: Axes,
    start: tuple[float, float],
    end: tuple[float, float],
    *,
    bend: float = 0.0,
) -> None:
    axes.add_patch(
        FancyArrowPatch(
            start,
            end,
            arrowstyle="-|>",
            mutation_scale=14,
            color=style.INK,
            connectionstyle=f"arc3,rad={bend}",
        )
    )


def _bare(axes: Axes, width: tuple[float, float], height: tuple[float, float]) -> None:
    axes.set(xlim=width, ylim=height, aspect="equal")
    axes.axis("off")


def draw_interaction(axes: Axes) -> None:
    """Draw the agent and its environment, which exchange actions, states and rewards (Fig. 2.1).

    Parameters
    ----------
    axes : Axes
        The axes to draw on. Their frame and ticks are removed.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_interaction(axes)
    >>> axes.texts[0].get_text()
    'agent'
    """
    _box(axes, (0, 1.6), "agent")
    _box(axes, (0, 0), "environment")
    for out, word, side in (
        (2.0, "action $A_t$", 1),
        (-2.0, "state $S_{t+1}$\nreward $R_{t+1}$", -1),
    ):
        axes.plot(
            [side * 0.95, out, out, side * 0.95],
            [1.6, 1.6, 0, 0],
            color=style.INK,
            linewidth=1.2,
        )
        axes.text(
            out + side * 0.15,
            0.8,
            word,
            ha="left" if side > 0 else "right",
            va="center",
        )
    _arrow(axes, (1.4, 0), (0.95, 0))
    _arrow(axes, (-1.4, 1.6), (-0.95, 1.6))
    _bare(axes, (-3.9, 3.9), (-0.5, 2.1))


def draw_decision_network(axes: Axes, *, steps: int = 3) -> None:
    """Draw the states, actions and rewards of some steps, with their dependences (Fig. 2.2).

    Parameters
    ----------
    axes : Axes
        The axes to draw on. Their frame and ticks are removed.
    steps : int
        How many steps.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_decision_network(axes, steps=2)
    >>> axes.texts[0].get_text()
    '$S_0$'
    """
    for t in range(steps + 1):
        _node(axes, (2.0 * t, 0), f"$S_{t}$", style.SKY)
        if t == steps:
            break
        _node(axes, (2.0 * t + 0.9, 1.1), f"$A_{t}$", style.ORANGE)
        _node(axes, (2.0 * t + 1.1, -1.1), f"$R_{t + 1}$", style.GREEN)
        _arrow(axes, (2.0 * t + 0.22, 0.26), (2.0 * t + 0.68, 0.84))
        _arrow(axes, (2.0 * t + 0.34, 0), (2.0 * t + 1.66, 0))
        _arrow(axes, (2.0 * t + 1.12, 0.84), (2.0 * t + 1.78, 0.27))
        _arrow(axes, (2.0 * t + 0.22, -0.26), (2.0 * t + 0.86, -0.87))
        _arrow(axes, (2.0 * t + 0.92, 0.76), (2.0 * t + 1.07, -0.76))
    axes.text(2.0 * steps + 0.6, 0, "…", va="center")
    _bare(axes, (-0.5, 2.0 * steps + 0.9), (-1.6, 1.6))


def _node(axes: Axes, middle: tuple[float, float], text: str, colour: str) -> None:
    axes.add_patch(
        Circle(middle, 0.34, facecolor=to_rgba(colour, 0.3), edgecolor=style.INK)
    )
    axes.text(*middle, text, ha="center", va="center")


def draw_evaluation_and_improvement(axes: Axes) -> None:
    """Draw the two processes of generalized policy iteration and what each passes to the other (Fig. 2.4(a)).

    Parameters
    ----------
    axes : Axes
        The axes to draw on. Their frame and ticks are removed.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_evaluation_and_improvement(axes)
    >>> axes.texts[1].get_text()
    'values $V$'
    """
    _box(axes, (0, 0), r"policy $\pi$", width=1.3)
    _box(axes, (4, 0), "values $V$", width=1.3)
    _arrow(axes, (0.2, 0.38), (3.8, 0.38), bend=-0.35)
    _arrow(axes, (3.8, -0.38), (0.2, -0.38), bend=-0.35)
    axes.text(2, 1.32, r"evaluation: $V \to V^\pi$", ha="center", va="center")
    axes.text(
        2, -1.32, r"improvement: $\pi \to \mathrm{greedy}(V)$", ha="center", va="center"
    )
    _bare(axes, (-1, 5), (-1.7, 1.7))


def draw_two_lines(axes: Axes) -> None:
    """Draw two lines that meet at the optimal values and policy, and the iteration between them (Fig. 2.4(b)).

    Parameters
    ----------
    axes : Axes
        The axes to draw on. Their frame and ticks are removed.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_two_lines(axes)
    >>> len(axes.lines)  # the two lines, and the point where they meet
    3
    """
    axes.plot([0, 6], [2.2, 0], color=style.BLUE)
    axes.plot([0, 6], [-2.2, 0], color=style.VERMILION)
    way = [(0.0, -0.6)]
    for step in range(7):  # straight to one line, then to the other
        side = 1 if step % 2 == 0 else -1
        x = way[-1][0]
        x = x + 0.55 + 0.25 * (6 - x) * 0.12
        way.append((x, side * 2.2 * (1 - x / 6)))
    for start, end in itertools.pairwise(way):
        _arrow(axes, start, end)
    axes.plot(6, 0, "o", color=style.INK, markersize=7)
    axes.text(6.15, 0, r"$V^*, \pi^*$", va="center")
    axes.text(2.6, 1.75, r"$V = V^\pi$", color=style.BLUE)
    axes.text(2.6, -1.95, r"$\pi = \mathrm{greedy}(V)$", color=style.VERMILION)
    axes.text(-0.1, -0.6, r"$V, \pi$", ha="right", va="center")
    _bare(axes, (-0.8, 7.1), (-2.5, 2.5))


def plot_trace(axes: Axes, trace: GPIHistory, *, least: float = 1e-8) -> None:
    """Plot how far generalized policy iteration is from both lines of Fig. 2.4(b) after each half step.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    trace : GPIHistory
        The half steps.
    least : float
        Smaller gaps are drawn at this height, because a logarithmic axis has no 0.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.mdp import four_by_three, generalized_policy_iteration
    >>> axes = Figure().add_subplot()
    >>> plot_trace(axes, generalized_policy_iteration(four_by_three().mdp(discount=0.9)))
    >>> axes.get_yscale()
    'log'
    """
    steps = np.arange(len(trace.values))
    gaps = {
        "from $V = V^\\pi$": trace.evaluation_gap,
        r"from $\pi = \mathrm{greedy}(V)$": trace.greedy_gap,
    }
    for (name, gap), colour, marker in zip(
        gaps.items(), (style.BLUE, style.VERMILION), "os", strict=True
    ):
        axes.plot(
            steps,
            np.maximum(gap, least),
            marker=marker,
            markersize=3.5,
            linewidth=1,
            color=colour,
            label=name,
        )
    axes.set(yscale="log", xlabel="half step", ylabel="distance")
    axes.legend()


def draw_value_plane(
    axes: Axes,
    cloud: ArrayLike,
    paths: Mapping[str, ArrayLike],
    *,
    corners: ArrayLike,
    best: ArrayLike,
) -> None:
    """Draw the values of two states as points in a plane: all policies as a cloud, and planners as paths.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    cloud : (N, 2) array
        The values of many stochastic policies.
    paths : mapping of str to (n, 2) array
        The values in each iteration of a planner, by name.
    corners : (K, 2) array
        The values of the deterministic policies.
    best : (2,) array
        The optimal values.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_value_plane(
    ...     axes, [[0.5, 0.5]], {"value iteration": [[0, 0], [1, 1]]}, corners=[[0, 0], [1, 1]], best=[1, 1])
    >>> len(axes.lines) >= 3
    True
    """
    points = np.asarray(cloud)
    axes.plot(
        points[:, 0],
        points[:, 1],
        ".",
        color=style.SKY,
        markersize=2,
        alpha=0.35,
        zorder=0,
    )
    axes.plot(
        *np.asarray(corners).T,
        "s",
        color=style.INK,
        markersize=6,
        label="deterministic policies",
    )
    for name, path in paths.items():
        axes.plot(
            *np.asarray(path).T,
            "o-",
            color=PLANNERS[name],
            markersize=3.5,
            linewidth=1.2,
            label=name,
        )
    axes.plot(
        *np.asarray(best),
        "*",
        color=style.ORANGE,
        markersize=15,
        label="the best",
        zorder=5,
    )
    axes.set(xlabel="value of state 0", ylabel="value of state 1")
    # the values may fill every corner
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=2)
