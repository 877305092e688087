"""Backup diagrams: what an update of a value looks at, drawn from the root down."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc

from robonav import style
from robonav.validation import check_one_of

STATE, ACTION, END = "s", "a", "T"


@dataclass(frozen=True)
class Backup:
    """The tree of an update: its levels from the root down, and the branches below a node of each level but the last.

    ``levels`` holds ``s`` for a state, ``a`` for an action and ``T`` for a terminal state. ``labels`` are the names of
    the levels. An arc joins the branches below level ``maximum``, of which the update takes the largest.
    """

    levels: str
    branches: tuple[int, ...]
    labels: tuple[str, ...]
    maximum: int | None = None


BACKUPS: dict[str, Backup] = {
    "V": Backup("sas", (3, 2), ("$s$", "$a$", "$s'$")),
    "Q": Backup("asa", (2, 3), ("$s, a$", "$s'$", "$a'$")),
    "V*": Backup("sas", (3, 2), ("$s$", "$a$", "$s'$"), maximum=0),
    "Q*": Backup("asa", (2, 3), ("$s, a$", "$s'$", "$b$"), maximum=1),
    "Monte Carlo": Backup("sasaT", (1, 1, 1, 1), ("$s$", "$a$", "$s'$", "$a'$", "end")),
    "TD(0)": Backup("sas", (1, 1), ("$s$", "$a$", "$s'$")),
    "SARSA": Backup("asa", (1, 1), ("$s, a$", "$s'$", "$a'$")),
    "expected SARSA": Backup("asa", (1, 3), ("$s, a$", "$s'$", "$a'$")),
    "Q-learning": Backup("asa", (1, 3), ("$s, a$", "$s'$", "$b$"), maximum=1),
}

TITLES = {
    "V": r"$V^\pi(s)$",
    "Q": r"$Q^\pi(s, a)$",
    "V*": "$V^*(s)$",
    "Q*": "$Q^*(s, a)$",
}

Place = tuple[float, float]


def draw_backup(axes: Axes, name: str) -> None:
    """Draw the backup diagram of an update: open circles are states, dots actions, a square is a terminal state.

    The value of the node at the top is computed from the nodes at the bottom. An arc stands for the maximum over its
    branches. Branches without an arc are averaged. A single branch is a sample.

    Parameters
    ----------
    axes : Axes
        The axes to draw on. Their frame and ticks are removed.
    name : {"V", "Q", "V*", "Q*", "Monte Carlo", "TD(0)", "SARSA", "expected SARSA", "Q-learning"}
        The update.

    Raises
    ------
    ValueError
        If there is no such update.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_backup(axes, "SARSA")  # three nodes, and two branches between them
    >>> len(axes.lines)
    5
    """
    backup = BACKUPS[check_one_of("name", name, BACKUPS)]
    levels = _places(backup)
    for level, count in enumerate(backup.branches):
        for number, top in enumerate(levels[level]):
            below = levels[level + 1][number * count : (number + 1) * count]
            for bottom in below:
                axes.plot(*zip(top, bottom, strict=True), color=style.INK, zorder=1)
            if backup.maximum == level:
                _draw_arc(axes, top, below)
    for kind, places, label in zip(backup.levels, levels, backup.labels, strict=True):
        for place in places:
            _draw_node(axes, kind, place)
        axes.text(places[-1][0] + 0.3, places[-1][1], label, va="center")
    width = len(levels[-1]) / 2
    axes.set(
        title=TITLES.get(name, name),
        anchor="N",
        xlim=(-max(width, 1.0) - 0.2, max(width, 1.0) + 0.6),
        ylim=(-len(levels) + 0.6, 0.4),
        aspect="equal",
    )
    axes.axis("off")


def _places(backup: Backup) -> list[list[Place]]:
    """Return the places of the nodes, level by level; a node stands above the middle of its branches."""
    leaves = 1
    for count in backup.branches:
        leaves *= count
    across = [[leaf - (leaves - 1) / 2 for leaf in range(leaves)]]
    for count in reversed(backup.branches):
        below = across[0]
        groups = [below[i : i + count] for i in range(0, len(below), count)]
        across.insert(0, [sum(group) / count for group in groups])
    return [[(0.7 * x, -float(y)) for x in row] for y, row in enumerate(across)]


def _draw_node(axes: Axes, kind: str, place: Place) -> None:
    marker, size = {STATE: ("o", 11), ACTION: ("o", 6), END: ("s", 10)}[kind]
    axes.plot(
        *place,
        marker=marker,
        markersize=size,
        markerfacecolor=style.INK if kind != STATE else "white",
        markeredgecolor=style.INK,
        zorder=2,
    )


def _draw_arc(axes: Axes, top: Place, below: list[Place]) -> None:
    """Draw an arc through the branches below a node."""
    angles = [np.degrees(np.arctan2(y - top[1], x - top[0])) for x, y in below]
    axes.add_patch(
        Arc(top, 1.0, 1.0, theta1=min(angles), theta2=max(angles), color=style.INK)
    )
