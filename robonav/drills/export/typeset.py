"""Markdown with formulas in lines of type."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

from ..markup import NOT_READ
from .boxes import BOLD, ITALIC, MONO, UPRIGHT, Box, beside, letters, width
from .formula import pieces
from .svg import MINUS

UNITS = {"m", "s", "m/s", "rad", "degrees"}
LEADING = 1.3  # the distance of two lines, in sizes of the letters


@dataclass(frozen=True)
class Word:
    """What stands together in a line.

    Attributes
    ----------
    space : float
        The space in front of it, unless it begins a line.
    box : Box
        What is set.
    """

    space: float
    box: Box


@cache
def _parser() -> Any:
    from markdown_it import MarkdownIt
    from mdit_py_plugins.dollarmath import dollarmath_plugin

    return MarkdownIt("commonmark").disable(NOT_READ).use(dollarmath_plugin)


def lines(
    text: str, measure: float, size: float = 11.0, font: str = UPRIGHT
) -> list[Box]:
    """Return Markdown as lines of type.

    Parameters
    ----------
    text : str
        Markdown with formulas between dollar signs.
    measure : float
        The width of a line in points.
    size : float, default 11.0
        The size of the letters in points.
    font : str, optional
        The font of what is not emphasised.

    Returns
    -------
    list of Box

    Examples
    --------
    >>> [round(line.width) <= 60 for line in lines("Two short lines of text.", 60)]
    [True, True]
    """
    made: list[Box] = []
    for token in _parser().parse(text):
        if token.type == "inline":
            words = list(_words(token.children, size, font))
            made += _broken(words, measure)
    return made


def height(set_: list[Box], size: float = 11.0) -> float:
    """Return the height of lines in points.

    Examples
    --------
    >>> round(height(lines("One line.", 100.0, 10.0), 10.0), 6)
    13.0
    """
    return sum(_advance(line, size) for line in set_)


def _advance(line: Box, size: float) -> float:
    """The distance to the next line: larger where a formula is high."""
    return max(LEADING * size, line.height + line.depth + 0.2 * size)


def base_lines(set_: list[Box], top: float, size: float = 11.0) -> list[float]:
    """Return the heights of the base lines of lines whose first begins at the top.

    Examples
    --------
    >>> first, second, *_ = base_lines(lines("One short line", 30.0), top=50.0)
    >>> 50.0 > first > second
    True
    """
    at, bases = top, []
    for line in set_:
        advance = _advance(line, size)
        bases.append(at - advance + max(line.depth, 0.28 * size))
        at -= advance
    return bases


def _words(tokens: list[Any], size: float, font: str) -> Iterator[Word]:
    """Words in order. What follows another without a space is part of the same word."""
    glued: list[Box] = []
    space, fonts = 0.0, [font]
    for token in tokens:
        for gap, box in _parts(token, size, fonts):
            if gap is None:
                glued.append(box)
                continue
            if glued:
                yield Word(space, beside(glued))
            glued, space = [box], gap
    if glued:
        yield Word(space, beside(glued))


def _parts(
    token: Any, size: float, fonts: list[str]
) -> Iterator[tuple[float | None, Box]]:
    """Boxes of a token, each with the space in front of it at which a line may break; None if it may not."""
    blank = width(" ", fonts[-1], size)
    if token.type == "em_open":
        fonts.append(ITALIC)
    elif token.type == "strong_open":
        fonts.append(BOLD)
    elif token.type in ("em_close", "strong_close"):
        fonts.pop()
    elif token.type in ("softbreak", "hardbreak"):
        yield blank, Box(0.0)
    elif token.type == "code_inline":
        yield None, letters(token.content, MONO, 0.85 * size)
    elif token.type.startswith("math"):
        for k, (gap, box, breaks) in enumerate(pieces(token.content.strip(), size)):
            if breaks:
                yield gap, box
            else:
                yield None, box.moved(gap) if k == 0 else beside([box], [gap])
    elif token.type == "text":
        first, *others = MINUS.sub("−", token.content).split(" ")
        yield None, letters(first, fonts[-1], size)
        for word in others:
            if first == "" and word.strip(".,;:?") in UNITS:  # stays with its number
                yield None, letters(f" {word}", fonts[-1], size)
            else:
                yield blank, letters(word, fonts[-1], size)
            first = word


def _broken(words: list[Word], measure: float) -> list[Box]:
    """Fill lines with words, as many in each as fit."""
    made: list[Box] = []
    line: list[Word] = []
    used = 0.0
    for word in words:
        space = word.space if line else 0.0
        if line and used + space + word.box.width > measure:
            made.append(_line(line))
            line, used, space = [], 0.0, 0.0
        line.append(word)
        used += space + word.box.width
    if line:
        made.append(_line(line))
    return made


def _line(words: list[Word]) -> Box:
    gaps = [0.0, *(word.space for word in words[1:])]
    return beside([word.box for word in words], gaps)
