"""All drills, by name: a drill draws as many questions of one kind as a reader wants."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from .question import Choice, Question

Draw = Callable[[np.random.Generator], Question | None]
"""Draws a question, or None if the numbers that it drew leave more than one answer, or none that a reader can tell."""

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
        ``draw(rng)`` returns a :class:`Question` with new numbers, or None if these numbers make no good question.

    Examples
    --------
    >>> from robonav.drills import DRILLS
    >>> DRILLS["td-error"].page
    'prediction'
    """

    name: str
    page: str
    title: str
    draw: Draw

    @property
    def goal(self) -> str:
        """What the reader can do afterwards, the first line of the function's docstring."""
        return (inspect.getdoc(self.draw) or "").partition("\n")[0]

    def question(self, seed: int) -> Question:
        """Draw a question, again and again until its usual wrong answers can be told from the right one.

        Options that have no order of their own are shuffled, so that their places tell nothing.

        Parameters
        ----------
        seed : int
            Seed of the questions.

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
            if question is not None and question.clear:
                return _shuffled(question, rng)
        raise RuntimeError(f"the drill {self.name} draws no question that is clear")


def _shuffled(question: Question, rng: np.random.Generator) -> Question:
    """The question with its options in a random order, unless they have an order of their own."""
    asked = question.asked
    if not isinstance(asked, Choice) or asked.order:
        return question
    order = [asked.options[k] for k in rng.permutation(len(asked.options))]
    return replace(question, asked=replace(asked, order=order))


DRILLS: dict[str, Drill] = {}
"""All drills by name, chapter by chapter."""


def drill(page: str, title: str) -> Callable[[Draw], Draw]:
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

    Examples
    --------
    >>> from robonav.drills import DRILLS, Number, Question, drill
    >>> @drill("decision-processes", "A sum of two rewards")
    ... def sum_of_rewards(rng):
    ...     '''Add two rewards.'''
    ...     first, second = rng.integers(1, 10, size=2)
    ...     return Question(f"{first} + {second}", Number(first + second), "Add them.")
    >>> DRILLS.pop("sum-of-rewards").title
    'A sum of two rewards'
    """

    def register(draw: Draw) -> Draw:
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
