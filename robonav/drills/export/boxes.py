"""What is set in type: boxes of letters and lines, and the fonts whose letters have widths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

UPRIGHT = "STIXGeneral"
ITALIC = "STIXGeneralItalic"
BOLD = "STIXGeneralBol"
MONO = "DejaVuSansMono"


@dataclass(frozen=True)
class Run:
    """Letters of one font and size, at a place in a box.

    Attributes
    ----------
    x, y : float
        Where they begin, in points from the box's left end and up from its base line.
    text : str
        The letters.
    font : str
        The font's name.
    size : float
        The font's size in points.
    """

    x: float
    y: float
    text: str
    font: str
    size: float


@dataclass(frozen=True)
class Rule:
    """A filled rectangle at a place in a box.

    Attributes
    ----------
    x, y : float
        Its lower left corner, as in a :class:`Run`.
    width, height : float
        In points.
    """

    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True)
class Box:
    """Letters and lines that stay together.

    Attributes
    ----------
    width : float
        In points.
    runs : tuple of Run
        Letters.
    rules : tuple of Rule
        Lines of fractions, roots and bars.
    height, depth : float
        How far it reaches above and below the base line.
    """

    width: float
    runs: tuple[Run, ...] = ()
    rules: tuple[Rule, ...] = ()
    height: float = 0.0
    depth: float = 0.0

    def moved(self, x: float, y: float = 0.0) -> Box:
        """Return the box shifted right and up, its width as before.

        Examples
        --------
        >>> Box(3.0, height=7.0).moved(1.0, 2.0).height
        9.0
        """
        return Box(
            self.width,
            tuple(Run(r.x + x, r.y + y, r.text, r.font, r.size) for r in self.runs),
            tuple(Rule(r.x + x, r.y + y, r.width, r.height) for r in self.rules),
            self.height + y,
            self.depth - y,
        )


@cache
def registered(font: str) -> str:
    """Make a font that comes with Matplotlib known to ReportLab, and return its name.

    Examples
    --------
    >>> registered(UPRIGHT)
    'STIXGeneral'
    """
    from matplotlib import get_data_path
    from reportlab.pdfbase import pdfmetrics
    from reportlab.pdfbase.ttfonts import TTFont

    path = Path(get_data_path()) / "fonts" / "ttf" / f"{font}.ttf"
    pdfmetrics.registerFont(TTFont(font, str(path)))
    return font


@cache
def width(text: str, font: str, size: float) -> float:
    """Return the width of letters in points.

    Examples
    --------
    >>> width("mm", UPRIGHT, 11.0) == 2 * width("m", UPRIGHT, 11.0)
    True
    """
    from reportlab.pdfbase import pdfmetrics

    return float(pdfmetrics.stringWidth(text, registered(font), size))


def letters(text: str, font: str, size: float) -> Box:
    """Return letters as a box.

    Examples
    --------
    >>> letters("Q", ITALIC, 10.0).runs[0].text
    'Q'
    """
    run = Run(0.0, 0.0, text, font, size)
    return Box(width(text, font, size), (run,), (), 0.7 * size, 0.22 * size)


def beside(boxes: Sequence[Box], gaps: Sequence[float] = ()) -> Box:
    """Return boxes side by side as one, each with a gap in front of it.

    Examples
    --------
    >>> beside([Box(3.0), Box(4.0)], [0.0, 1.0]).width
    8.0
    """
    x = 0.0
    runs: list[Run] = []
    rules: list[Rule] = []
    for k, box in enumerate(boxes):
        x += gaps[k] if gaps else 0.0
        moved = box.moved(x)
        runs += moved.runs
        rules += moved.rules
        x += box.width
    return Box(
        x,
        tuple(runs),
        tuple(rules),
        max((box.height for box in boxes), default=0.0),
        max((box.depth for box in boxes), default=0.0),
    )
