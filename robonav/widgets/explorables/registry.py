"""Explorables: small widgets for one idea each, with a question to answer before anything is moved."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ..kernel_training import KernelTraining, Report
from ..shared import HERE, front_end, style_sheet
from .training import TRAININGS, KernelPart

KERNEL_FILES = (
    "learning/worker",
    "learning/training_panel",
    "learning/kernel_panel",
    "explorables/kernel_part",
)
"""What an explorable needs besides its own files if Python trains something for it."""


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


class Explorable(KernelTraining):
    """A question, a few controls, a picture and what it says in words. Some can train in the kernel."""

    def __init__(
        self, asked: Question, given: dict[str, Any], part: KernelPart | None
    ) -> None:
        files, styles = list(asked.front_end), [*asked.files, "explorables/explorable"]
        if part is not None:
            files += KERNEL_FILES
            styles.append("learning/training_panel")
        self._esm = front_end(*dict.fromkeys(files))
        self._css = style_sheet(
            *(name for name in styles if (HERE / f"{name}.css").is_file())
        )
        self._part = part
        super().__init__(
            {
                "title": asked.title,
                "question": asked.question,
                "guesses": list(asked.guesses),
                "right": asked.right,
                "because": asked.because,
                "given": given,
                "kernel": None if part is None else part.for_page(),
            }
        )

    def uses_kernel(self) -> bool:
        """Whether Python trains anything for it."""
        return self._part is not None

    def train(self, request: dict[str, Any], report: Report) -> dict[str, Any]:
        """Train as the page asked, and return the numbers that it then shows."""
        assert self._part is not None
        trained = self._part.compute(self._part.checked(request["settings"]), report)
        self.trainings = list(trained.results)
        return {"sentence": trained.sentence, "given": trained.given}


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
    return Explorable(asked, asked.given(**settings), TRAININGS.get(name))
