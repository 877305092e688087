"""Check answers at home: a function inside a notebook without a sandbox, or a submission as the grader does."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

from . import frames
from .cases import PUBLIC, generator, outcome, parts_of
from .course import Course, Exercise
from .evidence import Evidence, Observation
from .grade import Unaccepted, exercise_grade, grade
from .reference import Reference, reference
from .session import Answer, Calls, Session
from .submission import Refused, Submission, load_submission


def check(key: str, function: Callable[..., Any]) -> float:
    """Check ``function`` as the answer to the exercise with this id or name, and print how each part went.

    Parameters
    ----------
    key : str
        The exercise's id or name, such as "2.2".
    function : callable
        The answer.

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


@dataclass(frozen=True, eq=False)
class FailedCall:
    """A call that the student's function answered wrongly.

    Attributes
    ----------
    observation : Observation
        The call and the answers.
    names : sequence of str
        The names of the arguments.
    """

    observation: Observation
    names: Sequence[str]


def check_submission(
    course: Course, exercises: Sequence[Exercise], path: Path
) -> tuple[dict[str, Any], FailedCall | None]:
    """Grade exercises of a submission on the public cases. What the student's code prints is part of the feedback.

    Parameters
    ----------
    course : Course
        The course.
    exercises : sequence of Exercise
        The exercises to check.
    path : Path
        A folder, notebook or zip file.

    Returns
    -------
    dict
        The grade.
    FailedCall or None
        The first call that was answered wrongly. There is none where only open tasks failed, which measure what all
        calls together achieve.
    """
    loaded, known = load_submission(path), reference(course)
    session = Session(loaded, "official", show=True, instead=["practice"])
    entries, failed = [], list[FailedCall]()
    try:
        for exercise in exercises:
            evidence = Evidence(known, course.parameters(exercise))
            entries.append(graded(course, exercise, session, known, evidence=evidence))
            if (failure := evidence.first_failure()) is not None:
                failed.append(FailedCall(failure, evidence.names))
    finally:
        session.close()
    result = grade(entries, session.tier) | remarks(loaded, session)
    return result, failed[0] if failed else None


def remarks(loaded: Submission | Refused, session: Session) -> dict[str, Any]:
    """Return how a submission was taken.

    Returns
    -------
    dict
        ``files`` has the file with the answer by exercise, ``notes`` what was taken in an unusual form, and
        ``problems`` what was not taken and why.
    """
    if isinstance(loaded, Refused):
        return {"files": {}, "notes": [], "problems": [str(loaded)]}
    problems = [
        *loaded.problems,
        *(f"{name} is not a complete notebook" for name in sorted(session.damaged)),
    ]
    whole = {n: file for n, file in loaded.files.items() if n not in session.damaged}
    empty = [name for name, file in sorted(whole.items()) if _is_empty(name, file)]
    problems += [f"{name} is empty" for name in empty]
    others = sorted(set(whole) - set(empty))
    if others and not session.found and not session.unwritten:
        names = ", ".join(others[:5])
        problems.append(f"no function of an exercise was found in {names}")
    files = dict(sorted(session.found.items()))
    return {"files": files, "notes": list(loaded.notes), "problems": problems}


def _is_empty(name: str, content: bytes) -> bool:
    """Whether a file has no text. An empty ``__init__.py`` is usual, and no answer."""
    return not content.strip() and PurePosixPath(name).name != "__init__.py"


def graded(
    course: Course,
    exercise: Exercise,
    calls: Calls,
    known: Reference,
    *,
    seed: bytes = PUBLIC,
    evidence: Evidence | None = None,
) -> dict[str, Any]:
    """Return the exercise's entry in a grade, on the cases of this seed. ``evidence`` gets all calls.

    On other cases than the public ones, the feedback says only which parts failed, and how.
    """
    secret = seed != PUBLIC
    parts, evidence = [], evidence or Evidence(known, course.parameters(exercise))
    for test, points in parts_of(course, exercise):
        name, error = test.__name__, None
        try:
            test(Answer(calls, evidence, exercise, name), generator(seed, name))
        except Exception as raised:
            error = raised
        parts.append(outcome(test, points, error, secret=secret))
    return exercise_grade(exercise, parts if secret else evidence.explained(parts))


def with_public_feedback(
    course: Course,
    entries: Sequence[dict[str, Any]],
    loaded: Submission | Refused,
    tier: str,
) -> list[dict[str, Any]]:
    """Return a grade's entries with feedback from the public cases for exercises that failed on secret ones.

    The student's code runs again for it, in a new sandbox that never had a secret case. Whatever the feedback repeats
    of its answers and messages, it can tell none.
    """
    known, session = reference(course), Session(loaded, tier)
    try:
        return [
            entry
            if entry["state"] in ("correct", "missing", "timeout", "grader-fault")
            else _publicly_explained(course, entry, session, known)
            for entry in entries
        ]
    finally:
        session.close()


def _publicly_explained(
    course: Course, entry: dict[str, Any], session: Session, known: Reference
) -> dict[str, Any]:
    public = graded(course, course.exercises[entry["id"]], session, known)
    if public["feedback"] == entry["feedback"]:  # the submission was refused
        return entry
    said = f"On the public cases, as with robonav check:\n{public['feedback']}"
    if public["state"] == "correct":
        said = "On the public cases, all parts are right."
    hints = {part["test"]: part["hint"] for part in public["parts"]}
    parts = [{**part, "hint": hints.get(part["test"], "")} for part in entry["parts"]]
    return {**entry, "feedback": f"{entry['feedback']}\n{said}", "parts": parts}


class InProcessCalls:
    """Calls without a sandbox: the function runs in this process, on copies of the arguments."""

    printed = ""  # the notebook itself shows what the function prints

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function
        self.changed: list[int] = []

    def call(self, exercise: Exercise, arguments: Sequence[Any]) -> Any:
        """Call the function, as :meth:`Session.call` does."""
        sent = [frames.encode(argument) for argument in arguments]
        came = [frames.decode(argument) for argument in sent]
        try:
            answer = frames.decode(frames.encode(self._function(*came)))
            self.changed = frames.differing(came, sent)
            return answer
        except NotImplementedError:
            raise Unaccepted("missing", "Not attempted.") from None
        except frames.FrameError as error:
            raise Unaccepted(
                "error",
                f"The answer must be numbers, strings, lists, dicts or arrays, not {error}.",
            ) from None
        except Exception as error:
            kind = type(error).__name__
            raise Unaccepted("error", f"{kind}: {error}.", raised=kind) from error
