"""Lines of a run of an algorithm, which a reader puts in the order in which they happen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .question import Order


@dataclass(frozen=True)
class Line:
    """What a run does or prints at one moment.

    Attributes
    ----------
    text : str
        The line, in Markdown.
    why : str
        Why it does not come before any of the lines above it, in a sentence.
    """

    text: str
    why: str


def some_in_order(rng: np.random.Generator, lines: Sequence[Line], count: int) -> Order:
    """Return some lines of a run, to be put in order.

    Parameters
    ----------
    rng : Generator
        Draws which.
    lines : sequence of Line
        All lines, in order.
    count : int
        How many are asked for.

    Returns
    -------
    Order
        An answer that puts a line in front of the one that comes before it gets the line's reason as a hint.

    Examples
    --------
    >>> lines = [Line("Sense.", ""), Line("Act.", "The robot acts by what it senses.")]
    >>> some_in_order(np.random.default_rng(0), lines, 2).judge([1, 0]).hint
    'The robot acts by what it senses.'
    """
    drawn = [lines[k] for k in sorted(rng.choice(len(lines), count, replace=False))]
    before = {(k, k + 1): line.why for k, line in enumerate(drawn[1:])}
    return Order([line.text for line in drawn], before=before)


def as_list(order: Order) -> str:
    """Return the steps in the right order as a sentence of a solution.

    Examples
    --------
    >>> as_list(Order(["Sense.", "Act."]))
    '(1) Sense. (2) Act.'
    """
    return " ".join(f"({k}) {step}" for k, step in enumerate(order.steps, start=1))
