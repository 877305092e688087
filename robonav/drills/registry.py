"""All drills, by name: a drill draws as many questions of one kind as a reader wants."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .question import Question

ATTEMPTS = 1000  # a drill whose numbers are so rarely clear is wrong


@dataclass(frozen=True)
class Drill:
    """A kind of question.

    Attributes
    ----------
    name : str
        Its name, such as "bellman-backup".
    page : str
        The page of the book that it belongs to.
    title : str
        What it practises, in a few words.
    draw : callable
        ``draw(rng)`` returns a :class:`Question` with new numbers.
    """

    name: str
    page: str
    title: str
    draw: Callable[[np.random.Generator], Question]

    @property
    def goal(self) -> str:
        """What the reader can do afterwards, the first line of the function's docstring."""
        return (inspect.getdoc(self.draw) or "").partition("\n")[0]

    def question(self, seed: int) -> Question:
        """Draw a question, again and again until its usual wrong answers can be told from the right one.

        Parameters
        ----------
        seed : int
            Makes the numbers.

        Returns
        -------
        Question
            The same for the same seed.

        Raises
        ------
        RuntimeError
            If the drill hardly ever draws a question that is clear.

        Examples
        --------
        >>> from robonav.drills import DRILLS
        >>> DRILLS["discounted-return"].question(seed=0).asked.unit
        ''
        """
        rng = np.random.default_rng(seed)
        for _ in range(ATTEMPTS):
            question = self.draw(rng)
            if question.clear:
                return question
        raise RuntimeError(f"the drill {self.name} draws no question that is clear")


DRILLS: dict[str, Drill] = {}
"""All drills by name, chapter by chapter."""


def drill(
    page: str, title: str
) -> Callable[
    [Callable[[np.random.Generator], Question]],
    Callable[[np.random.Generator], Question],
]:
    """Register the function below as a drill of a page.

    Parameters
    ----------
    page : str
        The page of the book.
    title : str
        What it practises, in a few words.

    Returns
    -------
    callable
        A decorator that keeps the function as it is. The drill's name is the function's, with hyphens.
    """

    def register(
        draw: Callable[[np.random.Generator], Question],
    ) -> Callable[[np.random.Generator], Question]:
        """Keep the function."""
        name = draw.__name__.replace("_", "-")
        DRILLS[name] = Drill(name, page, title, draw)
        return draw

    return register


def of_page(page: str) -> list[Drill]:
    """Return the drills of a page.

    Parameters
    ----------
    page : str
        The page's name, such as "dynamic-programming".

    Returns
    -------
    list of Drill
        Empty if the page has none.

    Examples
    --------
    >>> [drill.page for drill in of_page("dynamic-programming")][:1]
    ['dynamic-programming']
    """
    return [drill for drill in DRILLS.values() if drill.page == page]
