"""The right answer to a case, and the known mistake behind a wrong one.

The grader computes both from ``solutions/``: ``ch2/backup.py`` holds the solution, and ``wrong/ch2/backup.py`` one
function for each known mistake, whose docstring is the hint. Students have no ``solutions/``. Their copy of the tests
holds recorded answers to the public cases instead, so that the same checks run at home.
"""

from __future__ import annotations

import copy
import functools
import hashlib
import inspect
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, Protocol

import numpy as np

from robonav.atomic import atomic_write

from . import compare, frames
from .course import Course, Exercise, trusted


@dataclass(frozen=True, eq=False)
class Case:
    """The ``number``-th call in a part of an exercise, and its arguments."""

    exercise: Exercise
    part: str
    number: int
    arguments: tuple[Any, ...] = ()

    def key(self) -> bytes:
        """Hash of the exercise and the arguments."""
        return hashlib.sha256(
            self.exercise.id.encode() + frames.encode(self.arguments)
        ).digest()


class Mistake(NamedTuple):
    """A known mistake in one case."""

    name: str
    hint: str
    answer: Any  # or {"raised": kind} if the mistake ends in an exception


class Reference(Protocol):
    """Source of right answers, and of the wrong answers of known mistakes."""

    def expected(self, case: Case) -> Any:
        """Return the right answer to a case."""

    def mistakes(self, case: Case) -> Sequence[Mistake]:
        """Return the known mistakes whose answer to a case is wrong."""


class Solutions:
    """Answers that the solutions compute. They are cached, because a whole class gets the same cases.

    Parameters
    ----------
    course : Course
        The course, with its folder ``solutions/``.
    """

    def __init__(self, course: Course) -> None:
        self.course = course
        self._right: dict[bytes, Any] = {}
        self._wrong: dict[bytes, list[Mistake]] = {}

    def expected(self, case: Case) -> Any:
        """Return the solution's answer to a case."""
        key = case.key()
        if key not in self._right:
            self._right[key] = solution(self.course, case.exercise)(*case.arguments)
        return self._right[key]

    def mistakes(self, case: Case) -> Sequence[Mistake]:
        """Return the known mistakes whose answer to a case is wrong."""
        key = case.key()
        if key not in self._wrong:
            self._wrong[key] = list(self._mistakes(case))
        return self._wrong[key]

    def _mistakes(self, case: Case) -> Iterator[Mistake]:
        right = self.expected(case)
        for name, function in mistakes(self.course, case.exercise).items():
            try:
                with np.errstate(all="ignore"):
                    value = function(*copy.deepcopy(case.arguments))
            except Exception as error:  # some mistakes end in an exception
                value = {"raised": type(error).__name__}
            if compare.difference(value, right) is not None:
                hint = " ".join((inspect.getdoc(function) or "").split())
                yield Mistake(name, hint, value)


class Recorder:
    """Answers of the solutions, with a record of them that :class:`Recorded` reads.

    Parameters
    ----------
    course : Course
        The course, with its folder ``solutions/``.
    """

    def __init__(self, course: Course) -> None:
        self._solutions = Solutions(course)
        self._cases: dict[str, dict[str, list[Any]]] = {}

    def expected(self, case: Case) -> Any:
        """Return the solution's answer to a case, and record it with the answers of the known mistakes."""
        right = self._solutions.expected(case)
        mistakes = [list(mistake) for mistake in self._solutions.mistakes(case)]
        of_exercise = self._cases.setdefault(case.exercise.name, {})
        of_exercise.setdefault(case.part, []).append(
            [list(case.arguments), right, mistakes]
        )
        return right

    def mistakes(self, case: Case) -> Sequence[Mistake]:
        """Return the known mistakes whose answer to a case is wrong."""
        return self._solutions.mistakes(case)

    def write(self, folder: Path) -> None:
        """Write one file of frames per exercise."""
        for name, parts in self._cases.items():
            with atomic_write(folder / f"{name}.frame") as file:
                file.write(frames.encode(parts))


class Recorded:
    """Recorded answers to the public cases.

    Parameters
    ----------
    folder : Path
        The folder with the files that :meth:`Recorder.write` wrote.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._cases: dict[str, Any] = {}

    def expected(self, case: Case) -> Any:
        """Return the recorded answer to a case."""
        return self._entry(case)[1]

    def mistakes(self, case: Case) -> Sequence[Mistake]:
        """Return the known mistakes whose recorded answer to a case is wrong."""
        return [Mistake(*mistake) for mistake in self._entry(case)[2]]

    def _entry(self, case: Case) -> Any:
        """Return the arguments, the right answer and the mistakes that are recorded for a case.

        Raises
        ------
        RuntimeError
            If the record has other arguments.
        """
        name = case.exercise.name
        if name not in self._cases:
            self._cases[name] = frames.decode(
                (self._folder / f"{name}.frame").read_bytes()
            )
        try:
            entry = self._cases[name][case.part][case.number]
        except (KeyError, IndexError):
            entry = [None, None, []]
        if compare.difference(list(case.arguments), entry[0]) is not None:
            raise RuntimeError(
                "the recorded answers belong to other cases, because this version of numpy draws other random numbers: "
                "install numpy 2"
            )
        return entry


@functools.cache
def reference(course: Course) -> Reference:
    """Return answers from the solutions if they exist, and from the record otherwise."""
    return Solutions(course) if course.solutions.is_dir() else Recorded(course.recorded)


def solution(course: Course, exercise: Exercise) -> Callable[..., Any]:
    """Return the solution's function."""
    return getattr(trusted(course.solutions / exercise.file), exercise.name)


def mistakes(course: Course, exercise: Exercise) -> dict[str, Callable[..., Any]]:
    """Return the known wrong answers by name."""
    module = trusted(course.solutions / "wrong" / exercise.file)
    functions = inspect.getmembers(module, inspect.isfunction)
    return {name: function for name, function in functions if not name.startswith("_")}
