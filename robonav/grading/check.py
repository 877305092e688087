"""Check a function inside a notebook, with the grader's tests and feedback but without a sandbox."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from . import frames
from .cases import PUBLIC, generator, outcome, parts_of
from .course import Course, Exercise
from .grade import Unaccepted, exercise_grade
from .reference import Reference, reference
from .session import Answer, Calls


def check(key: str, function: Callable[..., Any]) -> float:
    """Check ``function`` as the answer to the exercise with this id or name, and print how each part went.

    Returns
    -------
    float
        The points earned. nbgrader takes them as the score of a cell that ends with this call.
    """
    course = Course.around(Path.cwd())
    result = graded(
        course, course.named(key), InProcessCalls(function), reference(course)
    )
    print(result["feedback"])
    return float(result["points"] or 0)


def graded(
    course: Course,
    exercise: Exercise,
    calls: Calls,
    known: Reference,
    *,
    seed: bytes = PUBLIC,
) -> dict[str, Any]:
    """Return the exercise's entry in a grade, on the cases of this seed."""
    parts = []
    for test, points in parts_of(course, exercise):
        name, error = test.__name__, None
        try:
            test(Answer(calls, known, exercise, name), generator(seed, name))
        except Exception as raised:
            error = raised
        parts.append(outcome(test, points, error))
    return exercise_grade(exercise, parts)


class InProcessCalls:
    """Calls without a sandbox: the function runs in this process, on copies of the arguments."""

    secret = False

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function

    def call(self, exercise: Exercise, arguments: Sequence[Any]) -> Any:
        """Call the function, as :meth:`Session.call` does."""
        arguments = frames.decode(frames.encode(list(arguments)))
        try:
            return frames.decode(frames.encode(self._function(*arguments)))
        except NotImplementedError:
            raise Unaccepted("missing", "Not attempted.") from None
        except frames.FrameError as error:
            raise Unaccepted(
                "error",
                f"The answer must be numbers, strings, lists, dicts or arrays, not {error}.",
            ) from None
        except Exception as error:
            raise Unaccepted("error", f"{type(error).__name__}: {error}.") from error
