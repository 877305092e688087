"""Marks as learning platforms import them, and feedback as they hand it back."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from robonav.atomic import atomic_write

from .gradebook import Account, Gradebook, plain
from .report import csv_text, feedback
from .roster import of_canvas

FORMATS = ("moodle", "canvas", "gradescope")
WORKSHEET = (
    "Identifier",
    "Grade",
)  # columns that make a roster Moodle's grading worksheet
CANVAS = ("Student", "ID", "SIS User ID", "SIS Login ID", "Section")


def marks_for(book: Gradebook, platform: str, title: str) -> str:
    """Return the marks as CSV with the columns that a platform imports.

    Parameters
    ----------
    book : Gradebook
        The marks. Its roster should be the platform's own export, so that the platform knows the students again.
    platform : str
        ``moodle``, ``canvas`` or ``gradescope``.
    title : str
        The assignment, as the platform calls it. On Canvas it ends with the number that Canvas gives it, as in
        ``Exercises 2 (1234)``; without a number Canvas makes a new assignment.

    Returns
    -------
    str
        The file's text.

    Raises
    ------
    ValueError
        If there is no such platform, or a mark is not settled.

    Examples
    --------
    >>> from pathlib import Path
    >>> from robonav.grading.course import Course
    >>> from robonav.grading.gradebook import Mark
    >>> from robonav.grading.ledger import Log
    >>> from robonav.grading.roster import Student
    >>> ada = Student("ada", row={"Student": "ada", "ID": "17", "Section": "A"})
    >>> account = Account(ada, "ada", {"2.1": Mark("2.1", 4, 3, "partial")})
    >>> book = Gradebook(Path(), Course.around(Path()), [account], [], Log([], [], [], ""), {})
    >>> print(marks_for(book, "canvas", "Chapter 2 (5)").lstrip("\\ufeff").replace("\\r", ""))
    Student,ID,SIS User ID,SIS Login ID,Section,Chapter 2 (5)
        Points Possible,,,,,4
    ada,17,,,A,3
    <BLANKLINE>
    """
    if platform not in FORMATS:
        raise ValueError(f"format must be one of {', '.join(FORMATS)}, got {platform}")
    make = {"moodle": _moodle, "canvas": _canvas, "gradescope": _gradescope}[platform]
    return csv_text(make(book, title))


def unsettled(book: Gradebook) -> list[str]:
    """Return the students whose mark is not certain. An export leaves their cells empty.

    Examples
    --------
    >>> from pathlib import Path
    >>> from robonav.grading.course import Course
    >>> from robonav.grading.ledger import Log
    >>> unsettled(Gradebook(Path(), Course.around(Path()), [], [], Log([], [], [], ""), {}))
    []
    """
    return [a.student.id for a in book.accounts if _total(a) == "" and a.problems]


def not_all_taken(book: Gradebook) -> list[str]:
    """Return a sentence for each student who has a mark, though a part of the submission could not be taken.

    Examples
    --------
    >>> from pathlib import Path
    >>> from robonav.grading.course import Course
    >>> from robonav.grading.ledger import Log
    >>> from robonav.grading.roster import Student
    >>> ada = Account(Student("ada"), "ada", {}, ["Not taken, though exercises are missing: a link."])
    >>> not_all_taken(Gradebook(Path(), Course.around(Path()), [ada], [], Log([], [], [], ""), {}))
    ['ada: Not taken, though exercises are missing: a link.']
    """
    return [
        f"{account.student.id}: {problem}"
        for account in book.accounts
        for problem in account.problems
        if problem.startswith("Not taken") and _total(account)
    ]


def _total(account: Account) -> str:
    """Return the sum of a student's points, or an empty cell if there is none or it is not certain."""
    return "" if account.total is None else plain(account.total)


def _most(book: Gradebook) -> int:
    return max((account.most for account in book.accounts), default=0)


def _moodle(book: Gradebook, title: str) -> list[list[Any]]:
    """Moodle's grading worksheet with the grades filled in, or else columns for the import into the gradebook."""
    rows = [dict(account.student.row or {}) for account in book.accounts]
    if rows and all(heading in rows[0] for heading in WORKSHEET):
        for row, account in zip(rows, book.accounts, strict=True):
            row["Grade"] = _total(account)
        return [[*rows[0]], *([*row.values()] for row in rows)]
    headings = [
        heading
        for heading in ("Username", "ID number", "Email address")
        if any(_named(row, heading) for row in rows)
    ]
    lines: list[list[Any]] = [[*headings, "Full name", title]]
    for row, account in zip(rows, book.accounts, strict=True):
        known = [_named(row, heading) for heading in headings]
        lines.append([*known, account.student.name, _total(account)])
    return lines


def _canvas(book: Gradebook, title: str) -> list[list[Any]]:
    """Canvas's gradebook with one assignment, and the points possible in the second line."""
    lines: list[list[Any]] = [[*CANVAS, title]]
    lines.append(["    Points Possible", "", "", "", "", _most(book)])
    for account in book.accounts:
        row = account.student.row or {"Student": account.student.name}
        name = _named(row, "Student") or account.student.name
        _, number, login, section = (_named(row, heading) for heading in CANVAS[1:])
        number = number or account.student.number
        rest = [_canvas_id(account), number, login, section]
        lines.append([name, *rest, _total(account)])
    return lines


def _canvas_id(account: Account) -> str:
    """Return Canvas's own number of a student, which only Canvas's gradebook has."""
    row = account.student.row or {}
    return _named(row, "ID") if of_canvas(row) else ""


def without_canvas_id(book: Gradebook) -> str:
    """Return a sentence on how Canvas finds the students, or an empty text if it knows one of them by its own ID.

    Examples
    --------
    >>> from pathlib import Path
    >>> from robonav.grading.course import Course
    >>> from robonav.grading.ledger import Log
    >>> from robonav.grading.roster import Student
    >>> ada = Account(Student("ada", number="s1"), "ada", {})
    >>> without_canvas_id(Gradebook(Path(), Course.around(Path()), [ada], [], Log([], [], [], ""), {}))
    "The roster has no Canvas IDs, so Canvas finds the students by SIS User ID; ..."
    """
    if not book.accounts or any(map(_canvas_id, book.accounts)):
        return ""
    advice = "make Canvas's own gradebook the roster"
    if all(account.student.number for account in book.accounts):
        return (
            "The roster has no Canvas IDs, so Canvas finds the students by SIS User ID; "
            f"if it does not know these numbers, {advice}."
        )
    return (
        "The roster has no Canvas IDs, and no number of some students either, so that Canvas cannot find them; "
        f"{advice}."
    )


def other_maximum(book: Gradebook) -> str:
    """Return a sentence if Moodle's grading worksheet has another maximum than the exercises that count.

    Examples
    --------
    >>> from pathlib import Path
    >>> from robonav.grading.course import Course
    >>> from robonav.grading.ledger import Log
    >>> other_maximum(Gradebook(Path(), Course.around(Path()), [], [], Log([], [], [], ""), {}))
    ''
    """
    most = _most(book)
    for account in book.accounts:
        told = _named(account.student.row or {}, "Maximum grade")
        try:
            other = bool(told) and float(told.replace(",", ".")) != most
        except ValueError:  # a scale, which has no number
            other = True
        if other:
            return (
                f"The worksheet's maximum grade is {told}, but the exercises that count have {most} points: "
                "set the maximum grade of the assignment to this in Moodle before you upload the worksheet."
            )
    return ""


def _first_and_last(name: str) -> tuple[str, str]:
    """Divide a name written as "Ada Lovelace", or as "Lovelace, Ada", as Canvas writes it."""
    if "," in name:
        last, _, first = name.partition(",")
    else:
        first, _, last = name.rpartition(" ")
    return first.strip(), last.strip()


def _gradescope(book: Gradebook, title: str) -> list[list[Any]]:
    """The columns of Gradescope's own export of an assignment, with one for each exercise."""
    ids = list(dict.fromkeys(id for a in book.accounts for id in a.marks))
    exercises = book.course.exercises
    lines: list[list[Any]] = [
        ["First Name", "Last Name", "SID", "Email", "Total Score", "Max Points", "Status"]
        + [f"{id}: {exercises[id].title} ({exercises[id].points:.1f} pts)" for id in ids]
    ]  # fmt: skip
    for account in book.accounts:
        row = account.student.row or {}
        first, last = _named(row, "First Name"), _named(row, "Last Name")
        if not (first or last):
            first, last = _first_and_last(account.student.name)
        total = _total(account)
        lines.append(
            [
                first,
                last,
                _named(row, "SID") or account.student.id,
                _named(row, "Email") or _named(row, "Email address"),
                total,
                account.most,
                "Graded" if total else "Ungraded" if account.submission else "Missing",
                *(plain(account.marks[id].points) if total and id in account.marks else "" for id in ids),
            ]
        )  # fmt: skip
    return lines


def _named(row: Any, heading: str) -> str:
    for name, value in row.items():
        if name.strip().casefold() == heading.casefold():
            return value
    return ""


def write_feedback(book: Gradebook, folder: Path) -> list[Path]:
    """Write a zip file for each student: the feedback page with the marks that count, and a summary as CSV.

    Nothing in it depends on the secret cases but what the feedback page says.

    Parameters
    ----------
    book : Gradebook
        The marks.
    folder : Path
        Where the files go.

    Returns
    -------
    list of Path
        The files, one for each student who has a grade.

    Examples
    --------
    >>> from robonav.grading.course import Course
    >>> from robonav.grading.ledger import Log
    >>> write_feedback(Gradebook(Path(), Course.around(Path()), [], [], Log([], [], [], ""), {}), Path())
    []
    """
    written, names = list[Path](), set[str]()
    for account in book.accounts:
        if account.submission not in book.grades:
            continue
        record = book.grades[account.submission] | {"student": account.student.name}
        rows: list[Sequence[Any]] = [["exercise", "points", "max_points", "late"]]
        rows += [
            [id, None if account.open else mark.points, mark.most, mark.late.said]
            for id, mark in account.marks.items()
        ]
        content = io.BytesIO()
        with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, text in (
                ("feedback.html", feedback(record, book.course, account)),
                ("marks.csv", csv_text(rows)),
            ):
                # The same feedback gives the same bytes.
                entry = zipfile.ZipInfo(name, (2000, 1, 1, 0, 0, 0))
                entry.external_attr = 0o644 << 16
                archive.writestr(entry, text.encode(), zipfile.ZIP_DEFLATED)
        path = folder / f"{_file_name(account.student.id, names)}.zip"
        with atomic_write(path) as file:
            file.write(content.getvalue())
        written.append(path)
    return written


def _file_name(id: str, taken: set[str]) -> str:
    """Return a name for a student's file that every system can write, and that no other student has."""
    plain_name = re.sub(r"[^\w@+-]+", "_", id).strip("_")[:80] or "student"
    name, number = plain_name, 2
    while name.casefold() in taken:
        name, number = f"{plain_name}_{number}", number + 1
    taken.add(name.casefold())
    return name
