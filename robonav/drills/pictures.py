"""Small pictures of drills as SVG text, which a page, a learning platform and a printed paper show in the same way.

Lines and letters have the colour of the text around them. A place that a reader may click on is a group with the class
"place" and its name in ``data-place``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape

CELL = 64  # width and height of a grid's cell
SHIFTS = {"↑": (0, -1), "→": (1, 0), "↓": (0, 1), "←": (-1, 0)}


def picture(width: float, height: float, *parts: str, title: str) -> str:
    """Return an SVG picture.

    Parameters
    ----------
    width, height : float
        In pixels of a desktop; a phone shows it smaller.
    *parts : str
        What is drawn.
    title : str
        What can be seen, in words.

    Returns
    -------
    str

    Examples
    --------
    >>> picture(10, 10, label(5, 5, "A"), title="the letter A")[:13]
    '<svg viewBox='
    """
    return (
        f'<svg viewBox="0 0 {width:g} {height:g}" width="{width:g}" role="img" '
        f'aria-label="{escape(title)}" fill="none" stroke="currentColor">{"".join(parts)}</svg>'
    )


def label(
    x: float, y: float, text: str, *, size: float = 15, anchor: str = "middle"
) -> str:
    """Return a text whose middle is at a point.

    Examples
    --------
    >>> "<text" in label(0, 0, "V")
    True
    """
    return (
        f'<text x="{x:g}" y="{y:g}" dy="0.35em" font-size="{size:g}" text-anchor="{anchor}" '
        f'fill="currentColor" stroke="none">{escape(text)}</text>'
    )


def box(x: float, y: float, width: float, height: float, *, fill: str = "none") -> str:
    """Return a rectangle.

    Examples
    --------
    >>> box(0, 0, 8, 8).startswith("<rect")
    True
    """
    return f'<rect x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" fill="{fill}"/>'


def arrow(x: float, y: float, direction: str, *, length: float = 20) -> str:
    """Return an arrow up, right, down or left that ends ``length`` from a point.

    Examples
    --------
    >>> "<path" in arrow(0, 0, "→")
    True
    """
    dx, dy = SHIFTS[direction]
    a, b = x + length * dx, y + length * dy
    head = (
        f"M{a - 6 * dx - 4 * dy:g} {b - 6 * dy - 4 * dx:g}L{a:g} {b:g}"
        f"L{a - 6 * dx + 4 * dy:g} {b - 6 * dy + 4 * dx:g}"
    )
    return f'<path d="M{x:g} {y:g}L{a:g} {b:g}{head}" stroke-width="1.5"/>'


def place(name: str, *parts: str) -> str:
    """Return a part of a picture that a reader may click on.

    Examples
    --------
    >>> place("A", box(0, 0, 8, 8)).startswith('<g class="place" data-place="A">')
    True
    """
    return f'<g class="place" data-place="{escape(name)}">{"".join(parts)}</g>'


def grid_picture(
    rows: Sequence[Sequence[str | None]],
    *,
    names: Mapping[tuple[int, int], str] | None = None,
    title: str,
) -> str:
    """Return a grid of cells with a text or an arrow in each.

    Parameters
    ----------
    rows : sequence of sequence of str or None
        What each cell shows; an arrow such as "→" is drawn, and None is a wall.
    names : mapping of (int, int) to str, optional
        Names of cells, by row and column. A cell with a name can be clicked on, and shows its name in its corner.
    title : str
        What can be seen, in words.

    Returns
    -------
    str

    Examples
    --------
    >>> grid_picture([["0.5", None, "→"]], title="three cells").count("<rect")
    3
    """
    named = names or {}
    parts = []
    for i, row in enumerate(rows):
        for j, text in enumerate(row):
            x, y = 1 + CELL * j, 1 + CELL * i
            cell = box(x, y, CELL, CELL, fill="#888" if text is None else "transparent")
            if text in SHIFTS:
                cell += arrow(x + CELL / 2, y + CELL / 2, text)
            elif text:
                cell += label(x + CELL / 2, y + CELL / 2, text)
            name = named.get((i, j))
            if name:
                cell += label(x + 5, y + 10, name, size=11, anchor="start")
                cell = place(name, cell)
            parts.append(cell)
    width, height = CELL * len(rows[0]) + 2, CELL * len(rows) + 2
    return picture(width, height, *parts, title=title)
