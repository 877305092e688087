"""Which exercises, parts and mistakes a class had trouble with."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field
from typing import Any

from robonav.atomic import write_text

from .grade import not_taken
from .gradebook import Gradebook
from .report import csv_text, page


@dataclass(frozen=True, eq=False)
class PartCount:
    """How the class did in one part of an exercise.

    Attributes
    ----------
    name : str
        What the part asks for.
    states : Counter of str
        Number of submissions in each state.
    """

    name: str
    states: Counter[str] = field(default_factory=Counter)


@dataclass(frozen=True, eq=False)
class ExerciseCount:
    """How the class did in one exercise.

    Attributes
    ----------
    parts : dict of str to PartCount
        The parts, by the name of their test.
    hints : dict of str to set of str
        The submissions that met a hint, by hint.
    attempted : int
        Number of submissions with an answer.
    points : float
        Points that the grader gave in all.
    """

    parts: dict[str, PartCount]
    hints: dict[str, set[str]]
    attempted: int
    points: float


def counts(book: Gradebook) -> dict[str, ExerciseCount]:
    """Count states and hints over the submissions of a class.

    A group's submission counts once. One of which nothing could be taken does not count.

    Examples
    --------
    >>> from pathlib import Path
    >>> from robonav.grading.course import Course
    >>> from robonav.grading.ledger import Log
    >>> part = {"test": "t", "name": "Right.", "points": 2, "state": "wrong", "hint": "A sign."}
    >>> entry = {"id": "2.1", "points": 0, "state": "wrong", "parts": [part]}
    >>> course = Course.around(Path())
    >>> book = Gradebook(Path(), course, [], [], Log([], [], [], ""), {"ada": {"exercises": [entry]}})
    >>> counts(book)["2.1"].hints
    {'A sign.': {'ada'}}
    """
    found, taken = {}, _taken(book)
    for id in book.course.exercises:
        parts, hints = dict[str, PartCount](), defaultdict[str, set[str]](set)
        attempted, points = 0, 0.0
        for name, grade in taken.items():
            for entry in grade["exercises"]:
                if entry["id"] != id:
                    continue
                attempted += entry["state"] != "missing"
                points += entry["points"] or 0
                for part in entry.get("parts", []):
                    count = parts.setdefault(part["test"], PartCount(part["name"]))
                    count.states[part["state"]] += 1
                    if part["hint"]:
                        hints[part["hint"]].add(name)
        by_number = sorted(hints.items(), key=lambda hint: (-len(hint[1]), hint[0]))
        found[id] = ExerciseCount(parts, dict(by_number), attempted, points)
    return found


def _taken(book: Gradebook) -> dict[str, dict[str, Any]]:
    return {name: one for name, one in book.grades.items() if not not_taken(one)}


def write_statistics(book: Gradebook) -> None:
    """Write ``statistics.html`` and ``statistics.csv``.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from robonav.grading.course import Course
    >>> from robonav.grading.ledger import Log
    >>> folder = Path(tempfile.mkdtemp())
    >>> write_statistics(Gradebook(folder, Course.around(folder), [], [], Log([], [], [], ""), {}))
    >>> sorted(path.name for path in folder.iterdir())
    ['statistics.csv', 'statistics.html']
    """
    found, total = counts(book), len(_taken(book))
    rows: list[list[object]] = [["exercise", "what", "text", "submissions", "of"]]
    for id, count in found.items():
        title = book.course.exercises[id].title
        rows.append([id, "attempted", title, count.attempted, total])
        for part in count.parts.values():
            rows += [
                [id, f"part {state}", part.name, number, total]
                for state, number in sorted(part.states.items())
            ]
        rows += [
            [id, "hint", hint, len(names), total] for hint, names in count.hints.items()
        ]
    write_text(book.folder / "statistics.csv", csv_text(rows))
    text = page(
        "statistics.html",
        found=found,
        total=total,
        refused=len(book.grades) - total,
        course=book.course,
    )
    write_text(book.folder / "statistics.html", text)
