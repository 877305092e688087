"""The marks of a class: what the grader gave, what was changed by hand, what lateness costs, and what counts.

Each time everything is computed from the grades in ``students/``, the log, the roster and the rules. None of them is
changed here, so that grading again never overwrites a decision.
"""

from __future__ import annotations

import json
import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from robonav.atomic import write_text

from . import ledger
from .classroom import HANDED_IN
from .course import Course
from .ledger import Log
from .report import csv_text, page
from .roster import Matching, Student, fitting, forms, match, one, read_roster
from .rules import Late, Rules, read_rules

ROSTER = "roster.csv"


@dataclass(frozen=True, eq=False)
class Mark:
    """What a student gets for an exercise.

    Attributes
    ----------
    exercise : str
        The id of the exercise.
    most : int
        Its points.
    graded : float or None
        What the grader gave. None if there is no grade.
    state : str
        The state of the exercise in the grade.
    by_hand : dict or None
        The last change by hand, which counts instead.
    late : Late
        How late it was.
    """

    exercise: str
    most: int
    graded: float | None
    state: str
    by_hand: Mapping[str, Any] | None = None
    late: Late = field(default_factory=Late)

    @property
    def before(self) -> float | None:
        """The points before lateness is taken off."""
        return self.graded if self.by_hand is None else self.by_hand["points"]

    @property
    def points(self) -> float | None:
        """The points that count."""
        if self.before is None:
            return None
        return round(self.before * (1 - self.late.share), 2)

    @property
    def graded_since(self) -> bool:
        """Whether the grader has given other points since the change by hand."""
        return self.by_hand is not None and self.by_hand["graded"] != self.graded


@dataclass(frozen=True, eq=False)
class Account:
    """All marks of a student.

    Attributes
    ----------
    student : Student
        The student.
    submission : str
        The submission that counts, or an empty string.
    marks : dict of str to Mark
        The marks by exercise.
    problems : list of str
        What keeps the marks from being final.
    """

    student: Student
    submission: str
    marks: dict[str, Mark]
    problems: list[str] = field(default_factory=list)

    @property
    def points(self) -> float:
        """The sum of the points that count."""
        return round(math.fsum(mark.points or 0 for mark in self.marks.values()), 2)

    @property
    def most(self) -> int:
        """The sum of all points."""
        return sum(mark.most for mark in self.marks.values())

    @property
    def free_days(self) -> int:
        """How many free days the student used. Exercises that were due at the same time share them."""
        late = [mark.late for mark in self.marks.values()]
        return sum(free for _, free in {(one.due, one.free) for one in late})


@dataclass(frozen=True, eq=False)
class Gradebook:
    """The marks of a class.

    Attributes
    ----------
    folder : Path
        The folder of grades.
    course : Course
        The course.
    accounts : list of Account
        The marks by student, in the roster's order.
    problems : list of str
        What is not certain about the class as a whole.
    log : Log
        What was graded and changed.
    grades : dict of str to dict
        The grades by submission.
    """

    folder: Path
    course: Course
    accounts: list[Account]
    problems: list[str]
    log: Log
    grades: dict[str, dict[str, Any]]

    def account(self, word: str) -> Account:
        """Return the account of the student with this id, name, login or address."""
        student = one((account.student for account in self.accounts), word)
        return next(one for one in self.accounts if one.student is student)


def read_gradebook(folder: Path, course: Course) -> Gradebook:
    """Compute the marks of a class from its grades, log, roster and rules.

    Parameters
    ----------
    folder : Path
        The folder that ``robonav grade`` wrote. Without a roster each submission is a student.
    course : Course
        The course.

    Returns
    -------
    Gradebook
        The marks.

    Raises
    ------
    ValueError
        If the folder holds no grades, or the roster or the rules are not right.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> read_gradebook(folder, Course.around(folder))
    Traceback (most recent call last):
    ValueError: ... holds no grades; make them with robonav grade
    """
    rules, log = read_rules(folder, course), ledger.read(folder)
    handed_in = _handed_in(folder)
    grades = {
        name: grade for name in handed_in if (grade := _grade(folder, name)) is not None
    }
    same = {name: grade["submission"] for name, grade in grades.items()}
    people = {name: told["people"] for name, told in handed_in.items()}
    if (folder / ROSTER).exists():
        students = read_roster(folder / ROSTER, rules.teams)
        rules, unknown = with_ids(rules, students)
        students = _in_groups(students, rules)
        matching = match(students, people, rules.matches, same)
    else:
        students = [
            Student(name, name, names=frozenset(forms(name))) for name in handed_in
        ]
        rules, unknown = with_ids(rules, students)
        students = _in_groups(students, rules)
        matching = Matching({name: name for name in handed_in}, [], set())
        if rules.groups:
            decided = {**{s.id: s.id for s in students}, **rules.matches}
            matching = match(students, people, decided, same)
    problems = list(matching.problems)
    problems += [
        f"{name} is not graded yet: run robonav grade again"
        for name in handed_in
        if name not in grades
    ]
    problems += [
        f"Line {number} of {ledger.LOG} was changed by something else than robonav."
        for number in log.broken
    ]
    problems += unknown
    book = Gradebook(folder, course, [], problems, log, grades)
    earlier, changed = _earlier(folder, rules, course), _by_student(log)
    graded = {e["id"] for grade in grades.values() for e in grade["exercises"]}
    everything = graded or set(course.exercises)
    for student in students:
        used = sum(one.get(student.id, 0) for one in earlier)
        told = handed_in.get(matching.submissions.get(student.id, ""), {})
        free = rules.free_days - used
        book.accounts.append(
            _account(book, student, matching, told, rules, free, changed, everything)
        )
    return book


def change(
    book: Gradebook,
    account: Account,
    exercise: str,
    points: float | None,
    reason: str,
    by: str,
) -> dict[str, Any]:
    """Change a mark by hand, or take the change back. The log keeps all changes.

    Parameters
    ----------
    book : Gradebook
        The marks as they are.
    account : Account
        The student.
    exercise : str
        The id of the exercise.
    points : float or None
        The points that count, before lateness is taken off. None takes earlier changes back.
    reason : str
        Why.
    by : str
        Who decided.

    Returns
    -------
    dict
        What the log records.

    Raises
    ------
    ValueError
        If the points are not possible, or reason or name are missing.

    Examples
    --------
    >>> import tempfile
    >>> account = Account(Student("ada"), "", {"2.1": Mark("2.1", 4, 1, "partial")})
    >>> folder = Path(tempfile.mkdtemp())
    >>> book = Gradebook(folder, Course.around(folder), [account], [], ledger.read(folder), {})
    >>> change(book, account, "2.1", 3, "right idea", "Dr B.")["points"]
    3
    """
    mark = account.marks[exercise]
    if points is not None and not 0 <= points <= mark.most:
        raise ValueError(f"points of {exercise} must be from 0 to {mark.most}, got {points:g}")  # fmt: skip
    for name, value in (("a reason", reason), ("the name of who decides", by)):
        if not value.strip():
            raise ValueError(f"a mark that is changed by hand needs {name}")
    event = {
        "student": account.student.id,
        "exercise": exercise,
        "points": points,
        "graded": mark.graded,
        "reason": reason,
        "by": by,
    }
    return ledger.append(book.folder, "mark", event)


def write_gradebook(book: Gradebook) -> None:
    """Write ``marks.html`` and ``marks.csv``. Each file is whole or not there.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> write_gradebook(Gradebook(folder, Course.around(folder), [], [], ledger.read(folder), {}))
    >>> sorted(path.name for path in folder.iterdir())
    ['marks.csv', 'marks.html']
    """
    exercises = _exercises(book)
    rows: list[list[Any]] = [
        ["student", "name", "group", "submission", "points", "max_points", "changed_by_hand", "late", "problems"]
        + exercises
    ]  # fmt: skip
    for account in book.accounts:
        marks = account.marks
        rows.append(
            [
                account.student.id,
                account.student.name,
                account.student.group,
                account.submission,
                account.points,
                account.most,
                " ".join(id for id, mark in marks.items() if mark.by_hand),
                " ".join(id for id, mark in marks.items() if mark.late.days),
                "; ".join(account.problems),
                *(marks[id].points if id in marks else None for id in exercises),
            ]
        )
    write_text(book.folder / "marks.csv", csv_text(rows))
    write_text(
        book.folder / "marks.html",
        page("marks.html", book=book, exercises=exercises, plain=plain),
    )


def plain(points: float | None) -> str:
    """Return points as people write them.

    Examples
    --------
    >>> plain(3.0), plain(2.25), plain(None)
    ('3', '2.25', '–')
    """
    return "–" if points is None else f"{points:g}"


def _exercises(book: Gradebook) -> list[str]:
    return list(dict.fromkeys(id for account in book.accounts for id in account.marks))


def _handed_in(folder: Path) -> dict[str, dict[str, Any]]:
    try:
        return json.loads((folder / HANDED_IN).read_bytes())
    except (OSError, ValueError):
        raise ValueError(
            f"{folder} holds no grades; make them with robonav grade"
        ) from None


def _grade(folder: Path, name: str) -> dict[str, Any] | None:
    try:
        return json.loads((folder / "students" / name / "grade.json").read_bytes())
    except (OSError, ValueError):
        return None


def _in_groups(students: list[Student], rules: Rules) -> list[Student]:
    """Return the students with the groups of the rules, which count more than those of the roster."""
    of = {who: group for group, members in rules.groups.items() for who in members}
    return [replace(s, group=of.get(s.id, s.group)) for s in students]


def with_ids(rules: Rules, students: Sequence[Student]) -> tuple[Rules, list[str]]:
    """Return rules in which students have the ids of the roster, and a sentence for each word that is not one student.

    Parameters
    ----------
    rules : Rules
        The rules as the file has them, where students have ids, names, email addresses or accounts.
    students : sequence of Student
        The roster.

    Returns
    -------
    Rules
        The rules. A word that fits nobody, or several, stays as it is, and applies to nobody.
    list of str
        What is wrong with these words.

    Examples
    --------
    >>> ada, bo = (Student(f"s{k}", name, names=frozenset(forms(name))) for k, name in enumerate(("Ada L.", "Bo D.")))
    >>> rules, problems = with_ids(Rules(groups={"team": ["Ada L.", "Zoe"]}), [ada, bo])
    >>> rules.groups["team"], problems
    (['s0', 'Zoe'], ['The rules name Zoe, who is not in the roster.'])
    """
    problems = list[str]()

    def id_of(word: str, said: str = "The rules name") -> str:
        fits = fitting(students, word)
        if len(fits) == 1:
            return fits[0].id
        whom = " or ".join(student.id for student in fits)
        problems.append(
            f"{said} {word}, but several students are called so: write {whom} instead."
            if fits
            else f"{said} {word}, who is not in the roster."
        )
        return word

    teams = {*rules.groups, *(student.group for student in students), ""}
    extensions = [
        {**extension, "student": id_of(extension["student"])}
        for extension in rules.extensions
    ]
    groups = {
        name: [id_of(member) for member in members]
        for name, members in rules.groups.items()
    }
    matches = {
        submission: who
        if who in teams
        else id_of(who, f"The rules give {submission} to")
        for submission, who in rules.matches.items()
    }
    found = replace(rules, extensions=extensions, groups=groups, matches=matches)
    return found, list(dict.fromkeys(problems))


def _earlier(folder: Path, rules: Rules, course: Course) -> list[dict[str, int]]:
    """Return the free days that each student used in earlier folders of grades."""
    used = []
    for name in rules.earlier:
        place = folder / name
        if place.resolve() == folder.resolve():
            raise ValueError(f"earlier must name other folders of grades, got {name}")
        book = read_gradebook(place, course)
        used.append({one.student.id: one.free_days for one in book.accounts})
    return used


def _account(
    book: Gradebook,
    student: Student,
    matching: Matching,
    told: Mapping[str, Any],
    rules: Rules,
    free: int,
    changed: Mapping[str, Sequence[tuple[int, dict[str, Any]]]],
    everything: set[str],
) -> Account:
    submission, problems = matching.submissions.get(student.id, ""), list[str]()
    grade = book.grades.get(submission)
    entries = {e["id"]: e for e in grade["exercises"]} if grade else {}
    if student.id in matching.unsettled:
        problems.append("It is not certain which submission is this student's.")
    if grade and grade["tier"] == "practice":
        problems.append("Graded for practice, without a sandbox: these are no marks.")
    changes = _changes(changed, student.id, submission)
    late = dict[str, Late]()
    if submission and rules.deadlines:
        written = told.get("submitted") or student.submitted
        time = rules.submitted.get(submission) or rules.time(written)
        answered = [id for id, e in entries.items() if e["state"] != "missing"]
        if time is not None:
            late = rules.lateness(student.id, answered, time, max(free, 0))
        elif any(rules.due(student.id, id) for id in answered):
            how = f" from {written!r}" if written else ""
            said = ", and the platform calls it late" if told.get("late") else ""
            problems.append(f"It cannot be told{how} when it was handed in{said}.")
    assigned = set(entries) or everything
    marks = {}
    for id, exercise in book.course.exercises.items():
        entry = entries.get(id)
        if rules.exercises and id not in rules.exercises:
            continue
        if id not in assigned and id not in changes:
            continue
        marks[id] = Mark(
            id,
            entry["max_points"] if entry else exercise.points,
            entry["points"] if entry else None,
            entry["state"] if entry else "missing",
            changes.get(id),
            late.get(id, Late()),
        )
        if marks[id].state == "grader-fault" and id not in changes:
            problems.append(f"The grader failed in {id}: run robonav grade again.")
        if marks[id].graded_since:
            problems.append(
                f"{id} was graded again since its mark was changed by hand: look whether the change still holds."
            )
    return Account(student, submission, marks, problems)


def _by_student(log: Log) -> dict[str, list[tuple[int, dict[str, Any]]]]:
    """Return the changes by hand of each student, numbered in the log's order."""
    found = defaultdict[str, list[tuple[int, dict[str, Any]]]](list)
    for number, event in enumerate(log.of_kind("mark")):
        found[event["student"]].append((number, event))
    return found


def _changes(
    changed: Mapping[str, Sequence[tuple[int, dict[str, Any]]]],
    student: str,
    submission: str,
) -> dict[str, dict[str, Any]]:
    """Return the last change of each exercise by hand, unless it was taken back.

    A change that was made before there was a roster has the submission's name.
    """
    names = {student, submission}
    events = sorted((e for name in names for e in changed.get(name, ())), key=_number)
    found = {event["exercise"]: event for _, event in events}
    return {id: event for id, event in found.items() if event["points"] is not None}


def _number(event: tuple[int, dict[str, Any]]) -> int:
    return event[0]
