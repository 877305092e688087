"""Explorables: small widgets for one idea each, with a question to answer before anything is moved."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import anywidget
import traitlets

from ..shared import HERE, front_end, style_sheet


@dataclass(frozen=True)
class Question:
    """What an explorable asks, and where its numbers and its JavaScript come from.

    Attributes
    ----------
    title : str
        The idea in a few words.
    question : str
        The question that the reader answers before moving a control.
    guesses : sequence of str
        Answers to choose from.
    right : str
        The guess that is right.
    because : str
        One sentence that says why.
    files : sequence of str
        JavaScript files of :mod:`robonav.widgets` that it uses besides its own.
    given : callable
        Computes what the page needs, with the package's functions.
    """

    title: str
    question: str
    guesses: Sequence[str]
    right: str
    because: str
    files: Sequence[str]
    given: Callable[..., dict[str, Any]]

    @property
    def name(self) -> str:
        """The name of the function that computes its numbers, and of its JavaScript file."""
        return self.given.__name__

    @property
    def front_end(self) -> Sequence[str]:
        """All its JavaScript files, in order."""
        return (*self.files, "explorables/explorable", f"explorables/{self.name}")


EXPLORABLES: dict[str, Question] = {}
"""All explorables by name."""


def asks(
    title: str,
    question: str,
    *,
    guesses: Sequence[str],
    right: str,
    because: str,
    files: Sequence[str] = (),
) -> Callable[[Callable[..., dict[str, Any]]], Callable[..., dict[str, Any]]]:
    """Register the function below as the numbers of an explorable; see :class:`Question`."""

    def register(given: Callable[..., dict[str, Any]]) -> Callable[..., dict[str, Any]]:
        """Keep the function and what is asked about its numbers."""
        asked = Question(title, question, guesses, right, because, files, given)
        EXPLORABLES[asked.name] = asked
        return given

    return register


class Explorable(anywidget.AnyWidget):
    """A question, a few controls, a picture and what it says in words."""

    data = traitlets.Dict().tag(sync=True)

    def __init__(self, asked: Question, given: dict[str, Any]) -> None:
        self._esm = front_end(*asked.front_end)
        styled = [name for name in asked.files if (HERE / f"{name}.css").is_file()]
        self._css = style_sheet(*styled, "explorables/explorable")
        super().__init__(
            data={
                "title": asked.title,
                "question": asked.question,
                "guesses": list(asked.guesses),
                "right": asked.right,
                "because": asked.because,
                "given": given,
            }
        )


def explorable(name: str, **settings: Any) -> Explorable:
    """Return the explorable of a name.

    Parameters
    ----------
    name : str
        A key of ``EXPLORABLES``.
    **settings
        Arguments of the function of that name, which change its numbers.

    Returns
    -------
    Explorable

    Raises
    ------
    ValueError
        If there is no such explorable.

    Examples
    --------
    >>> explorable("discounted_return", soon=4.0, late=10.0).data["title"]
    'How far ahead does a discount look?'
    """
    if name not in EXPLORABLES:
        raise ValueError(
            f"name must be one of {', '.join(sorted(EXPLORABLES))}, got {name!r}"
        )
    asked = EXPLORABLES[name]
    return Explorable(asked, asked.given(**settings))
