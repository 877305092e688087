"""The three ways to learn a policy as boxes and arrows (Figures 2 to 4 of the summary of the thesis)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robonav import style
from robonav.validation import check_one_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Box:
    """A box of a scheme: its text in each language, its centre on a grid, and its colour."""

    texts: dict[str, str]
    column: float
    row: float
    colour: str


@dataclass(frozen=True)
class Arrow:
    """An arrow between two boxes. ``bend`` moves it along their sides, ``shift`` moves its text from its middle."""

    start: str
    end: str
    texts: dict[str, str]
    bend: float = 0.0
    shift: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class Scheme:
    """A scheme: boxes by name, and the arrows between them."""

    boxes: dict[str, Box]
    arrows: tuple[Arrow, ...]


SIZE = (4.8, 3.1)
WIDTH, HEIGHT = 0.58, 0.54  # of a box, in cells of the grid

SCHEMES: dict[str, Scheme] = {
    "demonstration": Scheme(
        {
            "expert": Box({"en": "expert", "fr": "expert"}, 0, 0, style.ORANGE),
            "data": Box(
                {"en": "effective\nexamples", "fr": "exemples\nutiles"},
                1,
                0,
                style.ORANGE,
            ),
            "network": Box(
                {"en": "neural\nnetwork", "fr": "réseau de\nneurones"}, 2, 0, style.BLUE
            ),
            "world": Box(
                {"en": "unknown\nmap", "fr": "carte\ninconnue"}, 1, 1, style.GREY
            ),
            "policy": Box({"en": "policy", "fr": "politique"}, 2, 1, style.BLUE),
        },
        (
            Arrow("expert", "data", {"en": "drives", "fr": "conduit"}),
            Arrow("data", "network", {"en": "train", "fr": "forment"}),
            Arrow(
                "network", "policy", {"en": "becomes", "fr": "devient"}, shift=(0.24, 0)
            ),
            Arrow(
                "world",
                "policy",
                {"en": "senses", "fr": "perçoit"},
                bend=-0.25,
                shift=(0, 0.21),
            ),
            Arrow(
                "policy",
                "world",
                {"en": "moves", "fr": "agit"},
                bend=-0.25,
                shift=(0, -0.21),
            ),
        ),
    ),
    "reinforcement": Scheme(
        {
            "world": Box(
                {
                    "en": "map, new\neach\nepisode",
                    "fr": "carte,\nnouvelle à\nchaque fois",
                },
                0,
                0.5,
                style.GREY,
            ),
            "policy": Box(
                {"en": "stochastic\npolicy", "fr": "politique\nstochastique"},
                1,
                0,
                style.GREEN,
            ),
            "update": Box(
                {"en": "Q-value\nupdate", "fr": "mise à jour\nde Q"}, 1, 1, style.GREEN
            ),
            "network": Box(
                {"en": "neural\nnetwork", "fr": "réseau de\nneurones"},
                2,
                0,
                style.GREEN,
            ),
            "memory": Box(
                {"en": "pairs\nof the\nepisode", "fr": "paires de\nl'épisode"},
                2,
                1,
                style.ORANGE,
            ),
        },
        (
            Arrow(
                "policy", "world", {"en": "action", "fr": "action"}, shift=(-0.16, 0.10)
            ),
            Arrow(
                "world",
                "update",
                {"en": "state, reward", "fr": "état,\nrécompense"},
                shift=(-0.22, -0.16),
            ),
            Arrow("update", "memory", {"en": "adds", "fr": "ajoute"}),
            Arrow(
                "memory", "network", {"en": "train", "fr": "entraîne"}, shift=(0.22, 0)
            ),
            Arrow("network", "policy", {"en": "values", "fr": "valeurs"}),
        ),
    ),
    "inverse": Scheme(
        {
            "expert": Box({"en": "expert", "fr": "expert"}, 0, 0, style.ORANGE),
            "refined": Box(
                {"en": "refined\nexamples", "fr": "exemples\nraffinés"},
                1,
                0,
                style.ORANGE,
            ),
            "reward": Box(
                {"en": "reward\nfunction", "fr": "fonction de\nrécompense"},
                2,
                0,
                style.VERMILION,
            ),
            "world": Box({"en": "map", "fr": "carte"}, 0, 1, style.GREY),
            "policy": Box(
                {"en": "neural\npolicy", "fr": "politique\nneuronale"},
                1,
                1,
                style.VERMILION,
            ),
            "update": Box(
                {"en": "SARSA\nupdate", "fr": "mise à jour\nSARSA"},
                2,
                1,
                style.VERMILION,
            ),
        },
        (
            Arrow("expert", "refined", {"en": "drives", "fr": "conduit"}),
            Arrow("refined", "reward", {"en": "margin", "fr": "marge"}),
            Arrow("reward", "update", {"en": "scores", "fr": "note"}, shift=(0.20, 0)),
            Arrow("update", "policy", {"en": "trains", "fr": "entraîne"}),
            Arrow(
                "policy",
                "reward",
                {"en": "compared", "fr": "comparée"},
                shift=(-0.20, 0.04),
            ),
            Arrow(
                "policy",
                "world",
                {"en": "moves", "fr": "agit"},
                bend=-0.25,
                shift=(0, -0.21),
            ),
            Arrow(
                "world",
                "policy",
                {"en": "senses", "fr": "perçoit"},
                bend=-0.25,
                shift=(0, 0.21),
            ),
        ),
    ),
}


def draw_scheme(axes: Axes, name: str, *, language: str = "en") -> None:
    """Draw one of the schemes. ``SIZE`` is a suitable size of its figure, in inches.

    Parameters
    ----------
    axes : Axes
        The axes to draw on. Their frame and ticks are removed.
    name : {"demonstration", "reinforcement", "inverse"}
        The scheme.
    language : {"en", "fr"}
        The language of the text.

    Raises
    ------
    ValueError
        If there is no such scheme or language.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_scheme(axes, sorted(SCHEMES)[0])
    >>> len(axes.texts) > 0
    True
    """
    drawn = SCHEMES[check_one_of("name", name, SCHEMES)]
    check_one_of("language", language, ("en", "fr"))
    for box in drawn.boxes.values():
        _draw_box(axes, box, language)
    for arrow in drawn.arrows:
        _draw_arrow(axes, drawn, arrow, language)
    axes.set(xlim=(-0.5, 2.5), ylim=(1.42, -0.42))
    axes.axis("off")


def _draw_box(axes: Axes, box: Box, language: str) -> None:
    from matplotlib.patches import FancyBboxPatch

    corner = (box.column - WIDTH / 2 + 0.06, box.row - HEIGHT / 2 + 0.06)
    outline = FancyBboxPatch(
        corner,
        WIDTH - 0.12,
        HEIGHT - 0.12,
        boxstyle="round,pad=0.06",
        edgecolor=box.colour,
        facecolor="none",
        linewidth=2,
    )
    axes.add_patch(outline)
    axes.text(
        box.column,
        box.row,
        box.texts[language],
        ha="center",
        va="center",
        fontsize=9.5,
    )


def _draw_arrow(axes: Axes, drawn: Scheme, arrow: Arrow, language: str) -> None:
    start, end = drawn.boxes[arrow.start], drawn.boxes[arrow.end]
    (tail, head) = _edge(start, end, arrow.bend), _edge(end, start, -arrow.bend)
    axes.annotate(
        "",
        head,
        tail,
        arrowprops={
            "arrowstyle": "-|>",
            "color": style.INK,
            "linewidth": 1.5,
            "shrinkA": 2,
            "shrinkB": 2,
        },
    )
    middle = (
        (tail[0] + head[0]) / 2 + arrow.shift[0],
        (tail[1] + head[1]) / 2 - arrow.shift[1] - _lift(tail, head, arrow),
    )
    axes.text(
        *middle,
        arrow.texts[language],
        ha="center",
        va="center",
        fontsize=9.5,
        style="italic",
    )


def _edge(box: Box, other: Box, bend: float) -> tuple[float, float]:
    """Return the point where an arrow between two boxes meets the first box; ``bend`` moves it along that side."""
    across, down = other.column - box.column, other.row - box.row
    if abs(across) * HEIGHT >= abs(down) * WIDTH:
        side = 1 if across > 0 else -1
        return (
            box.column + side * WIDTH / 2,
            box.row + down * HEIGHT / 4 + side * bend * HEIGHT,
        )
    side = 1 if down > 0 else -1
    return box.column + across * WIDTH / 4, box.row + side * HEIGHT / 2


def _lift(tail: tuple[float, float], head: tuple[float, float], arrow: Arrow) -> float:
    """Return how far the text of an arrow is lifted: above a horizontal arrow whose text has no shift of its own."""
    level = abs(tail[1] - head[1]) < 0.1
    return 0.12 if level and arrow.shift == (0.0, 0.0) else 0.0
