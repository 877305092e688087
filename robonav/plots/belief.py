"""Beliefs about the cells of a corridor and about poses on a map, and the values of beliefs (Fig. 2.3)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, to_rgba
from matplotlib.patches import FancyArrowPatch, Rectangle
from numpy.typing import ArrayLike

from robonav import style
from robonav.mdp import AlphaVectors, PoseGrid

SURE = LinearSegmentedColormap.from_list(
    "sure", [to_rgba(style.SKY, 0), to_rgba(style.SKY, 1), to_rgba(style.BLUE, 1)]
)

PLAN_COLOURS = (style.BLUE, style.GREEN, style.ORANGE, style.PURPLE, style.SKY)
"""The colours of a plan's first action, as in the explorable of the tiger."""

Plan = tuple[str, Mapping[str, "Plan"]]
"""An action, and the plan that follows each observation."""


def draw_belief(
    axes: Axes, belief: ArrayLike, cells: str, *, state: int | None = None
) -> None:
    """Draw a belief about the cells of a corridor as bars, with the corridor below them.

    The corridor has its doors filled. A triangle marks the true cell of the robot.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    belief : (S,) array
        The probability of each cell.
    cells : str
        One letter for each cell; ``D`` is a door.
    state : int, optional
        The true cell of the robot; by default it is not drawn.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_belief(axes, [0.1, 0.2, 0.7], "  D", state=2)
    >>> len(axes.patches) >= 3
    True
    """
    b = np.asarray(belief, dtype=float)
    axes.bar(np.arange(len(b)), b, width=0.9, color=style.BLUE)
    for place, letter in enumerate(cells):
        axes.add_patch(
            Rectangle(
                (place - 0.45, -0.13),
                0.9,
                0.1,
                facecolor=style.ORANGE if letter == "D" else "none",
                edgecolor=style.INK,
                linewidth=0.6,
            )
        )
    if state is not None:
        axes.plot(state, -0.08, marker="^", color=style.VERMILION, markersize=7)
    axes.set(
        ylim=(-0.16, 1.0),
        xlim=(-0.6, len(b) - 0.4),
        xticks=np.arange(len(b)),
        yticks=[0, 0.5, 1],
    )
    axes.grid(axis="x", visible=False)


def draw_values_of_beliefs(
    axes: Axes, values: AlphaVectors, names: Sequence[str]
) -> None:
    """Draw the value of a belief about two states: the maximum of straight lines, one for each vector.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    values : AlphaVectors
        Vectors (K, 2). The horizontal axis is the belief in the first state.
    names : sequence of str
        The names of the actions.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.mdp import qmdp, tiger
    >>> axes = Figure().add_subplot()
    >>> draw_values_of_beliefs(axes, qmdp(tiger()), ["listen", "left", "right"])
    >>> len(axes.lines) > 2  # a line for each vector, and their maximum
    True
    """
    belief = np.linspace(0, 1, 501)
    both = np.stack([belief, 1 - belief], axis=1)
    lines = both @ values.vectors.T
    edge = lines.max(axis=1)
    named = set()
    for k, action in enumerate(values.actions.tolist()):
        label = names[action] if action not in named else None
        named.add(action)
        axes.plot(
            belief, lines[:, k], color=PLAN_COLOURS[action], linewidth=0.8, alpha=0.7
        )
        best = np.where(lines[:, k] >= edge - 1e-9, edge, np.nan)
        axes.plot(belief, best, color=PLAN_COLOURS[action], linewidth=3.5, label=label)
    margin = 0.1 * np.ptp(edge)
    axes.set(ylim=(edge.min() - 3 * margin, edge.max() + margin), xlim=(0, 1))
    axes.legend()


def draw_plan(axes: Axes, plan: Plan, *, colour: str = style.INK) -> None:
    """Draw a plan as a tree: actions in boxes, and observations on the lines between them.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    plan : tuple of str and mapping
        The action, and a plan for each observation; no observations at the end.
    colour : str
        The colour of the boxes and lines.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_plan(axes, ("listen", {"left": ("open", {}), "right": ("listen", {})}))
    >>> [text.get_text() for text in axes.texts]
    ['open', 'left', 'listen', 'right', 'listen']
    """
    _draw_node(axes, plan, 0.0, 0, colour)
    axes.axis("off")
    axes.set(xlim=(0, _leaves(plan)), ylim=(-_depth(plan) - 0.25, 0.25))


def _draw_node(
    axes: Axes, plan: Plan, left: float, depth: int, colour: str
) -> tuple[float, float]:
    """Draw a plan whose leaves begin at ``left``; return where its action stands."""
    action, further = plan
    here = (left + _leaves(plan) / 2, -float(depth))
    for observation, after in further.items():
        there = _draw_node(axes, after, left, depth + 1, colour)
        axes.plot(*zip(here, there, strict=True), color=colour, linewidth=1, zorder=0)
        x, y = np.add(here, there) / 2
        axes.text(x, y, observation, ha="center", va="center", backgroundcolor="white")
        left += _leaves(after)
    box = {"boxstyle": "round", "facecolor": "white", "edgecolor": colour}
    axes.text(*here, action, ha="center", va="center", bbox=box)
    return here


def _leaves(plan: Plan) -> int:
    return sum(map(_leaves, plan[1].values())) or 1


def _depth(plan: Plan) -> int:
    return max((1 + _depth(after) for after in plan[1].values()), default=0)


def draw_pose_belief(
    axes: Axes,
    grid: PoseGrid,
    belief: ArrayLike,
    *,
    pose: ArrayLike | None = None,
    arrows: int = 12,
) -> None:
    """Draw a belief about the pose: dark cells are likely, and arrows show the likeliest poses.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    grid : PoseGrid
        The grid of poses. Cells that are not free are drawn as walls.
    belief : (S,) array
        The probability of each pose.
    pose : (3,) array, optional
        The true x, y and heading; by default they are not drawn.
    arrows : int
        The number of poses with an arrow.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.mdp import PoseGrid
    >>> grid = PoseGrid([[True, True]], headings=4)
    >>> axes = Figure().add_subplot()
    >>> draw_pose_belief(axes, grid, grid.uniform(), pose=[0.5, 0.5, 0.0])
    >>> len(axes.images) + len(axes.collections) > 0
    True
    """
    b = np.asarray(belief, dtype=float)
    rows, columns = grid.free.shape
    extent = (0, columns * grid.cell, 0, rows * grid.cell)
    share = b.reshape(rows, columns, -1).sum(axis=2)
    axes.imshow(
        np.sqrt(share / share.max()),
        cmap=SURE,
        extent=extent,
        origin="lower",
        interpolation="nearest",
    )
    walls = np.where(
        grid.free[..., None], to_rgba(style.OBSTACLE, 0), to_rgba(style.OBSTACLE, 0.9)
    )
    axes.imshow(walls, extent=extent, origin="lower", interpolation="nearest")
    axes.add_patch(
        Rectangle(
            (0, 0),
            extent[1],
            extent[3],
            clip_on=False,
            facecolor="none",
            edgecolor=style.OBSTACLE,
            linewidth=1.5,
        )
    )
    likely = np.argsort(b)[::-1][:arrows]
    for x, y, heading in grid.poses[likely[b[likely] > 0.02 * b.max()]]:
        ahead = 2.5 * grid.cell * np.array([np.cos(heading), np.sin(heading)])
        axes.add_patch(
            FancyArrowPatch(
                (x, y),
                (x + ahead[0], y + ahead[1]),
                arrowstyle="->",
                mutation_scale=8,
                color=style.ORANGE,
            )
        )
    if pose is not None:
        draw_robot(axes, pose, size=1.3 * grid.cell)
    axes.set(xlim=extent[:2], ylim=extent[2:], aspect="equal", xticks=[], yticks=[])
    axes.grid(False)
    axes.spines[:].set_visible(False)


def draw_robot(axes: Axes, pose: ArrayLike, *, size: float = 1.5) -> None:
    """Draw the robot at its pose as a triangle that points ahead.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    pose : (3,) array
        x, y and heading.
    size : float
        The length of the triangle, in the axes' units.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_robot(axes, [2.0, 3.0, 0.0])
    >>> len(axes.patches)
    1
    """
    x, y, heading = np.asarray(pose, dtype=float)
    corners = heading + np.array([0, 2.4, -2.4])
    axes.fill(
        x + size * np.cos(corners),
        y + size * np.sin(corners),
        color=style.VERMILION,
        zorder=5,
    )


def plot_uncertainty(axes: Axes, entropies: Mapping[str, ArrayLike]) -> None:
    """Plot the entropy of a belief in bits after each step, with one line for each name.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    entropies : mapping of str to (T,) array
        The entropy after each of T steps, by the name of the line.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> plot_uncertainty(axes, {"with sensing": [3.0, 1.0, 0.2], "without": [3.0, 3.1, 3.2]})
    >>> len(axes.lines)
    2
    """
    for colour, (name, bits) in zip(
        (style.BLUE, style.ORANGE, style.GREEN, style.GREY),
        entropies.items(),
        strict=False,
    ):
        axes.plot(
            np.arange(len(np.asarray(bits))),
            np.asarray(bits),
            "o-",
            color=colour,
            markersize=3,
            label=name,
        )
    axes.set(xlabel="step", ylabel="uncertainty in bits", ylim=(0, None))
    axes.legend()


# Rows of Fig. 2.3 from top to bottom: height, letter and colour.
POMDP_ROWS = {
    "action": (3.0, "A", style.ORANGE),
    "belief": (2.0, "b", style.BLUE),
    "observation": (1.0, "O", style.GREEN),
    "state": (0.0, "S", style.GREY),
    "reward": (-1.0, "R", style.VERMILION),
}
WITHIN_A_STEP = (
    ("state", "observation"),
    ("observation", "belief"),
    ("belief", "action"),
    ("state", "reward"),
    ("action", "reward"),
)
TO_THE_NEXT_STEP = (
    ("state", "state"),
    ("belief", "belief"),
    ("action", "state"),
    ("action", "observation"),
    ("action", "belief"),
)


def draw_pomdp(axes: Axes) -> None:
    """Draw the states, observations, beliefs, actions and rewards of some steps, with their dependences (Fig. 2.3).

    Parameters
    ----------
    axes : Axes
        The axes to draw on. Their frame and ticks are removed.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_pomdp(axes)
    >>> len(axes.patches) > 10
    True
    """
    for time in range(3):
        for start, end in WITHIN_A_STEP:
            _draw_dependence(axes, (start, time), (end, time))
        for start, end in TO_THE_NEXT_STEP if time < 2 else ():
            _draw_dependence(axes, (start, time), (end, time + 1))
    times = ("t-1", "t", "t+1", "t+2")
    for kind, (_, letter, colour) in POMDP_ROWS.items():
        for time in range(3):
            x, y = _place(kind, time)
            axes.plot(
                x, y, "o", markersize=26, markerfacecolor=to_rgba(colour, 0.15),
                markeredgecolor=colour, markeredgewidth=1.5, linestyle="none",
            )  # fmt: skip
            # the reward of a step comes with the next state
            index = times[time + 1] if kind == "reward" else times[time]
            axes.annotate(f"${letter}_{{{index}}}$", (x, y), ha="center", va="center")
        x, y = _place(kind, 0)
        name = "hidden" if kind == "state" else kind
        axes.annotate(name, (x - 1.15, y), ha="center", va="center", style="italic")
    axes.set(xlim=(-1.9, 6.6), ylim=(-1.5, 3.5), aspect="equal")
    axes.axis("off")


def _place(kind: str, time: int) -> tuple[float, float]:
    """Return where the circle of a kind and time stands: actions and rewards lie between two steps."""
    between = 0.9 if kind in ("action", "reward") else 0.0
    return 2.6 * time + between, POMDP_ROWS[kind][0]


def _draw_dependence(axes: Axes, start: tuple[str, int], end: tuple[str, int]) -> None:
    """Draw an arrow between two circles; that from an action to its reward bends around the circles between them."""
    bend = -0.22 if (start[0], end[0]) == ("action", "reward") else 0.0
    axes.add_patch(
        FancyArrowPatch(
            _place(*start), _place(*end), arrowstyle="-|>", mutation_scale=10,
            color=style.INK, linewidth=0.9, shrinkA=14, shrinkB=14,
            connectionstyle=f"arc3,rad={bend}",
        )
    )  # fmt: skip
