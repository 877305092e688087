"""Answer a student who objects to a mark: what was handed in, what was run on it, and what came out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from . import compare
from .cases import PUBLIC
from .check import graded
from .classroom import students
from .course import Exercise
from .evidence import Evidence
from .grade import printable
from .gradebook import Account, Gradebook, plain, why_no_mark
from .reference import reference
from .session import Session
from .submission import Submission
from .variants import own_course

MOST_CASES = 3  # of each part are shown in full when a run is repeated


def explain(book: Gradebook, account: Account, exercise: Exercise) -> str:
    """Say how a mark came about.

    Parameters
    ----------
    book : Gradebook
        The marks.
    account : Account
        The student.
    exercise : Exercise
        The exercise.

    Returns
    -------
    str
        Lines for the instructor: the file and its hash, every run with its cases, seed, versions and sandbox, what
        failed and with which message, changes by hand, and what lateness costs.

    Raises
    ------
    ValueError
        If the student has no mark for the exercise.

    Examples
    --------
    >>> from robonav.grading.course import Course
    >>> from robonav.grading.gradebook import Mark
    >>> from robonav.grading.ledger import Log
    >>> from robonav.grading.roster import Student
    >>> course = Course.around(Path())
    >>> account = Account(Student("ada", "Ada"), "", {"2.1": Mark("2.1", 4, None, "missing")})
    >>> book = Gradebook(Path(), course, [account], [], Log([], [], [], ""), {})
    >>> print(explain(book, account, course.named("2.1")))
    Ada (ada), exercise 2.1 A backup with rewards on transitions
    Counts: – of 4 points
    No submission of this student is graded.
    """
    if exercise.id not in account.marks:
        raise ValueError(why_no_mark(book, account, exercise.id))
    return "\n".join(_lines(book, account, exercise))


def _lines(book: Gradebook, account: Account, exercise: Exercise) -> Iterator[str]:
    mark, student = account.marks[exercise.id], account.student
    group = f", group {student.group}" if student.group else ""
    yield f"{student.name} ({student.id}){group}, exercise {exercise.id} {exercise.title}"
    yield f"Counts: {plain(mark.points)} of {mark.most} points"
    yield from (f"To be settled: {problem}" for problem in account.problems)
    if mark.late.days:
        yield f"Lateness: {mark.late.said}; {plain(mark.before)} points before that"
    events = book.log.of_kind("mark")
    for event in events:
        if event["exercise"] == exercise.id and event["student"] in (student.id, account.submission):  # fmt: skip
            to = "taken back" if event["points"] is None else f"{plain(event['points'])} points"  # fmt: skip
            yield (
                f"By hand, {event['time']}: {to} instead of the grader's {plain(event['graded'])}, "
                f"by {event['by']}: {printable(event['reason'])}"
            )
    runs = _runs(book, account, exercise)
    if not account.submission or account.submission not in book.grades:
        yield "No submission of this student is graded."
    for number, run in enumerate(runs, start=1):
        yield f"Run {number} of {len(runs)}"
        yield from (f"  {line}" for line in _run(run, exercise))
    entry = _entry(book, account, exercise)
    if entry:
        yield "Feedback of the grade that counts"
        yield from (f"  {line}" for line in entry["feedback"].splitlines())


def _runs(
    book: Gradebook, account: Account, exercise: Exercise
) -> list[dict[str, Any]]:
    """Return the times that this exercise of this submission was graded."""
    return [
        event
        for event in book.log.of_kind("graded")
        if event["student"] == account.submission
        and any(entry["id"] == exercise.id for entry in event["exercises"])
    ]


def _entry(book: Gradebook, account: Account, exercise: Exercise) -> Any:
    grade = book.grades.get(account.submission, {"exercises": []})
    found = [entry for entry in grade["exercises"] if entry["id"] == exercise.id]
    return found[0] if found else None


def _run(run: Mapping[str, Any], exercise: Exercise) -> Iterator[str]:
    entry = next(one for one in run["exercises"] if one["id"] == exercise.id)
    where = run["where"].get(exercise.id)
    file = f"{where}, sha256 {run.get('files', {}).get(where)}" if where else "none"
    yield f"Began: {run.get('began', run['time'])}; written: {run['time']}"
    yield f"Submission: {run['student']}, hash {run['submission']}"
    yield f"File with the answer: {file}"
    yield f"Sandbox: {run['tier']}; tests, solutions and grader: hash {run['config']}"
    versions = run.get("versions", {})
    yield f"Versions: {', '.join(f'{name} {version}' for name, version in versions.items())}"
    yield f"Seed of the cases: {run.get('seed', 'unknown')}"
    yield f"Result: {plain(entry['points'])} of {exercise.points} points, {entry['state']}"
    calls = run.get("calls", {}).get(exercise.id, {})
    for part in entry["parts"] or []:
        made = calls.get(part["test"], 0)
        hint = f"; hint: {part['hint']}" if part["hint"] else ""
        earned = part["points"] if part["state"] == "correct" else 0
        yield (
            f"- {part['name']} {earned}/{part['points']} {part['state']}, "
            f"{made} call{'s' * (made != 1)} ({part['test']}){hint}"
        )


def repeat(book: Gradebook, account: Account, exercise: Exercise, folder: Path) -> str:
    """Run the exercise again on the cases of the grade that counts, and show those that failed in full.

    Parameters
    ----------
    book : Gradebook
        The marks.
    account : Account
        The student.
    exercise : Exercise
        The exercise.
    folder : Path
        The class: the submissions as they were graded.

    Returns
    -------
    str
        Lines with each part's calls that were answered wrongly: the call, the answer and the right answer.

    Raises
    ------
    ValueError
        If the submission is not there, or is not the one that was graded.

    Examples
    --------
    >>> from robonav.grading.course import Course
    >>> from robonav.grading.ledger import Log
    >>> from robonav.grading.roster import Student
    >>> course = Course.around(Path())
    >>> account = Account(Student("ada", "Ada"), "", {})
    >>> book = Gradebook(Path(), course, [account], [], Log([], [], [], ""), {})
    >>> repeat(book, account, course.named("2.1"), Path())
    Traceback (most recent call last):
    ValueError: no run of 2.1 for ada is in the log
    """
    runs = _runs(book, account, exercise)
    if not runs:
        raise ValueError(f"no run of {exercise.id} for {account.student.id} is in the log")  # fmt: skip
    run, found = runs[-1], students(folder)
    if account.submission not in found:
        raise ValueError(f"no submission of {account.submission} in {folder}")
    loaded = found[account.submission].load()
    if not isinstance(loaded, Submission) or loaded.digest != run["submission"]:
        raise ValueError(
            f"{account.submission} in {folder} is not what was graded: its hash differs"
        )
    course = own_course(book.course, book.folder, account.submission)
    known = reference(course)
    seed = PUBLIC if run["seed"] == "public" else bytes.fromhex(run["seed"])
    session, evidence = Session(loaded, run["tier"]), Evidence(known, course.parameters(exercise))  # fmt: skip
    try:
        entry = graded(course, exercise, session, known, seed=seed, evidence=evidence)
    finally:
        session.close()
    lines = [f"Run again: {plain(entry['points'])} of {entry['max_points']} points, {entry['state']}"]  # fmt: skip
    for part in entry["parts"]:
        lines.append(f"- {part['name']} {part['state']}")
        wrong = [
            one
            for one in evidence.observations
            if one.case.part == part["test"] and part["state"] != "correct"
        ]
        wrong = [one for one in wrong if one.verdict == "wrong"] or wrong[-1:]
        with np.printoptions(threshold=200, precision=6, suppress=True):
            for one in wrong[:MOST_CASES]:
                call = compare.call(exercise.name, one.case.arguments)
                lines.append(f"  call {one.case.number + 1}: {printable(call)}")
                lines.append(f"    expected {printable(str(one.expected))}")
                lines.append(f"    got      {printable(str(one.got))}")
    return "\n".join(lines)
