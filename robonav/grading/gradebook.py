"""The marks of a class: what the grader gave, what was changed by hand, what lateness costs, and what counts.

Each time everything is computed from the grades in ``students/``, the log, the roster and the rules. None of them is
changed here, so that grading again never overwrites a decision.
"""

from __future__ import annotations

import json
import math
from collections import defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from robonav.atomic import write_text

from . import arrival, ledger
from .arrival import Arrival
from .classroom import HANDED_IN
from .course import Course
from .grade import not_taken
from .ledger import Log
from .report import csv_text, page
from .roster import Matching, Student, fitting, forms, match, one, read_roster
from .rules import RULES, Late, Rules, read_rules

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
    submission : str
        The submission that was graded, or an empty string.
    """

    exercise: str
    most: int
    graded: float | None
    state: str
    by_hand: Mapping[str, Any] | None = None
    late: Late = field(default_factory=Late)
    submission: str = ""

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
        """Whether the grader has given the submission other points since the change by hand."""
        if self.by_hand is None or self.other_submission:
            return False
        return self.by_hand["graded"] != self.graded

    @property
    def other_submission(self) -> bool:
        """Whether another submission counted when the mark was changed by hand, or none."""
        if self.by_hand is None:
            return False
        if "submission" not in self.by_hand:  # of an older log
            return self.by_hand["graded"] is None and self.graded is not None
        return self.by_hand["submission"] != self.submission


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
    handed_in : str
        When the submission came, as far as it can be told.
    open : bool
        Whether the marks cannot be told before a problem is settled.
    """

    student: Student
    submission: str
    marks: dict[str, Mark]
    problems: list[str] = field(default_factory=list)
    handed_in: str = ""
    open: bool = False

    @property
    def status(self) -> str:
        """Whether there is a mark: "graded", "open" if it cannot be told yet, or "nothing handed in"."""
        decided = any(mark.by_hand for mark in self.marks.values())
        if not (self.submission or self.open or decided):
            return "nothing handed in"
        failed = any(
            mark.points is None and mark.state == "grader-fault"
            for mark in self.marks.values()
        )
        return "open" if self.open or failed else "graded"

    @property
    def total(self) -> float | None:
        """The sum of the points that count, or None if there is no mark: nothing handed in is not 0 points."""
        return self.points if self.status == "graded" else None

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
    rules : Rules
        The rules.
    notes : list of str
        What is assumed about the class.
    """

    folder: Path
    course: Course
    accounts: list[Account]
    problems: list[str]
    log: Log
    grades: dict[str, dict[str, Any]]
    rules: Rules = field(default_factory=Rules)
    notes: list[str] = field(default_factory=list)

    def account(self, word: str) -> Account:
        """Return the account of the student with this id, or else the one student whom the word may mean.

        It may be a name, login or address, or the name of the submission that counts.

        Raises
        ------
        ValueError
            If no student is meant, or several are.
        """
        students = [account.student for account in self.accounts]
        fits = fitting(students, word)
        if word and word not in [student.id for student in fits]:
            fits = [
                account.student
                for account in self.accounts
                if account.student in fits or account.submission == word
            ]
        student = one(fits, students, word)
        return next(account for account in self.accounts if account.student is student)


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
    students, rules, matching, unknown = _matched(folder, rules, handed_in, grades)
    book = Gradebook(folder, course, [], [], log, grades, rules)
    earlier, changed = _earlier(folder, rules, course), _by_student(log)
    for student in students:
        used = sum(one.get(student.id, 0) for one in earlier)
        told = handed_in.get(matching.submissions.get(student.id, ""), {})
        free = max(rules.free_days - used, 0)
        changes = _changes(
            changed, student.id, matching.submissions.get(student.id, "")
        )
        book.accounts.append(_account(book, student, matching, told, free, changes))
    book.problems.extend(
        [
            *matching.problems,
            *(
                f"{name} is not graded yet: run robonav grade again"
                for name in handed_in
                if name not in grades
            ),
            *(
                f"Line {number} of {ledger.LOG} was changed by something else than robonav."
                for number in log.broken
            ),
            *unknown,
            *_that_count_no_more(book, changed),
            *arrival.advice(book.rules, _arrivals(book, arrival.UNTOLD)),
        ]
    )
    book.notes.extend(arrival.assumptions(_arrivals(book, arrival.ASSUMED)))
    return book


def _matched(
    folder: Path,
    rules: Rules,
    handed_in: Mapping[str, Mapping[str, Any]],
    grades: Mapping[str, Mapping[str, Any]],
) -> tuple[list[Student], Rules, Matching, list[str]]:
    """Return the students, the rules with their ids, whose each submission is, and what the rules name wrongly."""
    same = {name: grade["submission"] for name, grade in grades.items()}
    people = {name: told["people"] for name, told in handed_in.items()}
    roster = (folder / ROSTER).exists()
    students = (
        read_roster(folder / ROSTER, rules.teams)
        if roster
        else [Student(name, name, names=frozenset(forms(name))) for name in handed_in]
    )
    rules, unknown = with_ids(rules, students)
    students = _in_groups(students, rules)
    unknown += [
        f"The rules name the submission {name} in [{table}], but there is none of this name."
        for table, named in (("matches", rules.matches), ("submitted", rules.submitted))
        for name in named
        if name not in handed_in
    ]
    if roster:
        matching = match(students, people, rules.matches, same)
    elif rules.groups:
        decided = {**{s.id: s.id for s in students}, **rules.matches}
        matching = match(students, people, decided, same)
    else:
        matching = Matching({name: name for name in handed_in}, [], set())
    return students, rules, matching, unknown


def _arrivals(book: Gradebook, kinds: Collection[str]) -> dict[str, str]:
    """Return what is told of the submissions that came like this."""
    return {
        account.submission: account.handed_in
        for account in book.accounts
        if account.handed_in in kinds
    }


def _that_count_no_more(
    book: Gradebook, changed: Mapping[str, Sequence[tuple[int, dict[str, Any]]]]
) -> list[str]:
    """Return a sentence for each change by hand of an exercise that does not count."""
    found = []
    for account in book.accounts:
        changes = _changes(changed, account.student.id, account.submission)
        found += [
            f"{account.student.name}: the mark for {id} that was changed by hand does not count. "
            + why_no_mark(book, account, id)
            for id in changes
            if id not in account.marks
        ]
    return found


def why_no_mark(book: Gradebook, account: Account, exercise: str) -> str:
    """Say why a student has no mark for an exercise.

    Examples
    --------
    >>> book = Gradebook(Path(), Course.around(Path()), [], [], Log([], [], [], ""), {}, Rules(exercises={"2.1"}))
    >>> why_no_mark(book, Account(Student("ada"), "", {}), "3.1")
    '3.1 does not count, because exercises in rules.toml does not name it: add it there first.'
    """
    if exercise not in book.course.exercises:
        return f"{exercise} is no exercise of this course."
    if book.rules.exercises and exercise not in book.rules.exercises:
        return f"{exercise} does not count, because exercises in {RULES} does not name it: add it there first."
    who = account.student.id
    return f"{exercise} was not graded for {who}: grade it first, with robonav grade ... --exercise {exercise}."


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
    if exercise not in account.marks:
        raise ValueError(why_no_mark(book, account, exercise))
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
        "submission": mark.submission,
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
        ["student", "name", "group", "submission", "handed_in", "status", "points", "max_points", "changed_by_hand"]
        + ["late", "problems", *exercises]
    ]  # fmt: skip
    for account in book.accounts:
        marks = account.marks
        rows.append(
            [
                account.student.id,
                account.student.name,
                account.student.group,
                account.submission,
                account.handed_in,
                account.status,
                account.total,
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
    free: int,
    changes: Mapping[str, Mapping[str, Any]],
) -> Account:
    """Return the marks of a student, who has so many free days left."""
    submission, problems = matching.submissions.get(student.id, ""), list[str]()
    grade = book.grades.get(submission)
    entries = {e["id"]: e for e in grade["exercises"]} if grade else {}
    refused = not_taken(grade) if grade else ""
    if student.id in matching.unsettled:
        problems.append("It is not certain which submission is this student's.")
    if grade and grade["tier"] == "practice":
        problems.append("Graded for practice, without a sandbox: these are no marks.")
    answered = [] if refused else [id for id, e in entries.items() if e["state"] != "missing"]  # fmt: skip
    arrived = (
        arrival.of(student, submission, told, answered, book.rules, free)
        if submission
        else Arrival()
    )
    problems += [arrived.problem] if arrived.problem else []
    marks = {
        id: _mark(book, id, None if refused else entries.get(id), changes.get(id), arrived, submission)
        for id in _assigned(book, entries, changes)
    }  # fmt: skip
    problems += _remaining(grade, refused, marks)
    problems += [said for mark in marks.values() for said in _look_at(mark)]
    decided = any(mark.by_hand for mark in marks.values())
    open = student.id in matching.unsettled or bool(refused)
    return Account(
        student,
        submission,
        marks,
        problems,
        arrived.said,
        bool(arrived.problem) or (open and not decided),
    )


def _assigned(
    book: Gradebook, entries: Collection[str], changes: Collection[str]
) -> list[str]:
    """Return the exercises for which a student has a mark."""
    graded = {e["id"] for grade in book.grades.values() for e in grade["exercises"]}
    assigned = set(entries) or graded or set(book.course.exercises)
    counted = book.rules.exercises or set(book.course.exercises)
    return [
        id
        for id in book.course.exercises
        if id in counted and (id in assigned or id in changes)
    ]


def _mark(
    book: Gradebook,
    id: str,
    entry: Mapping[str, Any] | None,
    change: Mapping[str, Any] | None,
    arrived: Arrival,
    submission: str,
) -> Mark:
    return Mark(
        id,
        entry["max_points"] if entry else book.course.exercises[id].points,
        entry["points"] if entry else None,
        entry["state"] if entry else "missing",
        change,
        arrived.late.get(id, Late()),
        submission,
    )


def _remaining(
    grade: Mapping[str, Any] | None, refused: str, marks: Mapping[str, Mark]
) -> list[str]:
    """Say what was not taken of a submission, if an answer that counts may be in it."""
    if refused:
        return [
            f"Nothing of the submission could be taken: {refused}. There is no mark, rather than 0; hand in for the "
            "student what can be read, and grade again, or change the marks by hand."
        ]
    if grade is None or all(mark.state != "missing" for mark in marks.values()):
        return []
    return [
        f"Not taken, though exercises are missing: {problem}."
        for problem in grade.get("problems", ())
    ]


def _look_at(mark: Mark) -> list[str]:
    """Say what has to be looked at in a mark."""
    if mark.state == "grader-fault" and not mark.by_hand:
        return [f"The grader failed in {mark.exercise}: run robonav grade again."]
    if mark.other_submission:
        return [
            f"Another submission counts for {mark.exercise} than when its mark was changed by hand: look whether the "
            "change still holds."
        ]
    if mark.graded_since:
        return [
            f"{mark.exercise} was graded again since its mark was changed by hand: look whether the change still holds."
        ]
    return []


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
