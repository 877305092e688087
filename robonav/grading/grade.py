"""Combine the parts of an exercise, and the exercises of a submission, into points, states and feedback."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

from .course import Exercise

State = Literal[
    "correct",
    "partial",
    "wrong",
    "error",
    "timeout",
    "memory",
    "missing",
    "grader-fault",
]
STATES: tuple[State, ...] = (
    "correct",
    "partial",
    "wrong",
    "error",
    "timeout",
    "memory",
    "missing",
    "grader-fault",
)
FAULT = "The grader failed here, which is not your fault: this exercise will be graded again."
MOST_FEEDBACK = 4_000  # characters of what a part says
MOST_FOR_HINT = 1_000  # for its name and its hint, which come besides


class Unaccepted(Exception):
    """Raised when an answer earns no points for a part.

    Attributes
    ----------
    state : str
        The state of the part.
    feedback : str
        What the student reads.
    raised : str or None
        The name of the exception that the student's function raised when it was called.
    refused : bool
        Whether the whole submission was refused, before any of its code ran.
    """

    def __init__(
        self,
        state: State,
        feedback: str,
        raised: str | None = None,
        *,
        refused: bool = False,
    ) -> None:
        super().__init__(feedback)
        self.state: State = state
        self.feedback = feedback
        self.raised = raised
        self.refused = refused


@dataclass(frozen=True)
class Part:
    """The result of one part of an exercise. Its points count if the state is correct."""

    name: str
    points: int
    state: State
    feedback: str
    test: str = ""  # name of the part's test function
    hint: str = ""  # for the mistake that the answers show


def exercise_grade(exercise: Exercise, parts: Sequence[Part]) -> dict[str, Any]:
    """Return an exercise's entry in a grade. Its points are None if the grader failed in any part."""
    missing = exercise.points - sum(part.points for part in parts)
    if missing > 0:
        parts = [
            *parts,
            Part("parts that were not run", missing, "grader-fault", FAULT),
        ]
    return {
        "id": exercise.id,
        "points": None
        if _any(parts, "grader-fault")
        else sum(part.points for part in parts if part.state == "correct"),
        "max_points": exercise.points,
        "state": _state(parts),
        "feedback": "Not attempted."
        if _state(parts) == "missing"
        else "\n".join(
            printable(_line(part), MOST_FEEDBACK + MOST_FOR_HINT)
            for part in _once(parts)
        ),
        "parts": [
            {
                "test": part.test,
                "name": part.name,
                "points": part.points,
                "state": part.state,
                "hint": part.hint,
            }
            for part in parts
        ],
    }


def grade(exercises: Sequence[Mapping[str, Any]], tier: str) -> dict[str, Any]:
    """Return the grade of a submission. Exercises that must be graded again count as 0 until then."""
    return {
        "points": sum(entry["points"] or 0 for entry in exercises),
        "max_points": sum(entry["max_points"] for entry in exercises),
        "tier": tier,
        "exercises": list(exercises),
    }


def fault_grade(exercises: Iterable[Exercise], tier: str) -> dict[str, Any]:
    """Return the grade of a submission for which the grader itself failed."""
    return grade([exercise_grade(exercise, []) for exercise in exercises], tier)


def not_taken(record: Mapping[str, Any]) -> str:
    """Return why nothing of a submission could be taken, or an empty string if something was, or nothing was there.

    Such a submission has no points rather than 0 points.

    Examples
    --------
    >>> not_taken({"exercises": [], "files": {}, "problems": ["work.rar was not taken"]})
    'work.rar was not taken'
    """
    failed = any(entry["points"] is None for entry in record["exercises"])
    if record.get("files") or failed:
        return ""
    return "; ".join(record.get("problems", ()))


def printable(text: str, most: int = MOST_FEEDBACK) -> str:
    """Replace characters that files and terminals cannot show, because a student's error message may contain any."""
    kept = "".join(
        c if c == "\n" or c.isprintable() else "\N{REPLACEMENT CHARACTER}"
        for c in text[:most]
    )
    return kept.encode("utf-8", "replace").decode()


def _any(parts: Sequence[Part], state: State) -> bool:
    return any(part.state == state for part in parts)


def _state(parts: Sequence[Part]) -> State:
    """Return the state of an exercise: a fault of the grader, else correct or partial, else that of the first part."""
    if _any(parts, "grader-fault"):
        return "grader-fault"
    if all(part.state == "correct" for part in parts):
        return "correct"
    return "partial" if _any(parts, "correct") else parts[0].state


def _once(parts: Sequence[Part]) -> Iterator[Part]:
    """Yield the parts. An error that several parts end in is described once."""
    seen: set[str] = set()
    for part in parts:
        error = part.feedback.partition("\n")[0]
        again = part.state in ("error", "timeout", "memory") and error in seen
        seen.add(error)
        yield replace(part, feedback="The same error as above.") if again else part


def _line(part: Part) -> str:
    """Format a part's points and name, with what went wrong below."""
    earned = part.points if part.state == "correct" else 0
    mark = "✓" if earned else "✗"
    details = (
        ""
        if part.state == "correct"
        else "".join(f"\n    {line}" for line in part.feedback.splitlines())
    )
    return f"{mark} {earned}/{part.points} {part.name}{details}"
