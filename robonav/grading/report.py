"""Write grades for students, instructors and learning platforms."""

from __future__ import annotations

import csv
import io
import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from robonav.atomic import write_text
from robonav.style import BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, YELLOW

from .course import Course
from .grade import STATES, not_taken

COLOURS = dict(
    zip(
        STATES, (GREEN, SKY, ORANGE, VERMILION, PURPLE, YELLOW, GREY, BLUE), strict=True
    )
)


def write_student(folder: Path, record: dict[str, Any], course: Course) -> None:
    """Write all files of one student. The last one is grade.json, so where it exists all others are complete."""
    write_text(folder / "feedback.html", feedback(record, course))
    write_text(folder / "results.json", _json(gradescope(record, course)))
    write_text(folder / "junit.xml", junit(record, course))
    write_text(folder / "grade.json", _json(record))


def write_class(
    out: Path,
    names: Sequence[str],
    passed_over: Sequence[str],
    course: Course,
    times: Sequence[str] = (),
) -> list[str]:
    """Write the gradebook and the overview of a class.

    Parameters
    ----------
    out : Path
        The folder of grades.
    names : sequence of str
        The students.
    passed_over : sequence of str
        The names of the files that are nobody's submission.
    course : Course
        The course.
    times : sequence of str
        What is assumed about when they handed in.

    Returns
    -------
    list of str
        The students who must be graded again.
    """
    records = {
        name: json.loads((out / "students" / name / "grade.json").read_bytes())
        for name in names
    }
    rows = [_row(name, record, course) for name, record in records.items()]
    write_text(out / "gradebook.csv", gradebook(rows, course))
    overview = page(
        "overview.html",
        records=records,
        course=course,
        colours=COLOURS,
        again={name: _again(record) for name, record in records.items()},
        passed_over=[name.encode("utf-8", "replace").decode() for name in passed_over],
        times=times,
        **_in_all(records, course),
    )
    write_text(out / "index.html", overview)
    return [name for name, record in records.items() if _again(record)]


def _row(name: str, record: dict[str, Any], course: Course) -> list[Any]:
    """Return a student's line of the gradebook. Where nothing was taken, there are no points, rather than 0."""
    entries = {entry["id"]: entry for entry in record["exercises"]}
    empty = bool(not_taken(record))
    points = [
        None if empty or id not in entries else entries[id]["points"]
        for id in course.exercises
    ]
    return [
        name,
        None if empty else record["points"],
        record["max_points"],
        record["tier"],
        " ".join(_again(record)),
        "; ".join(record.get("problems", ())),
        *points,
    ]


def _again(record: dict[str, Any]) -> list[str]:
    """Return the exercises that must be graded again."""
    return [entry["id"] for entry in record["exercises"] if entry["points"] is None]


def _in_all(records: dict[str, dict[str, Any]], course: Course) -> dict[str, Any]:
    """Return how the submissions of which something was taken did in each exercise, and in all that anyone answered."""
    taken = {name: one for name, one in records.items() if not not_taken(one)}
    counts = {id: Counter[str]() for id in course.exercises}
    earned = Counter[str]()
    for record in taken.values():
        for entry in record["exercises"]:
            counts[entry["id"]][entry["state"]] += 1
            earned[entry["id"]] += entry["points"] or 0
    answered = [
        id for id, states in counts.items() if states.total() > states["missing"]
    ] or [*counts]
    number = max(len(taken), 1)
    return {
        "taken": taken,
        "counts": counts,
        "shares": {
            id: earned[id] / (course.exercises[id].points * number) for id in counts
        },
        "answered": answered,
        "most": sum(course.exercises[id].points for id in answered),
        "average": earned.total() / number,
    }


def feedback(record: dict[str, Any], course: Course, account: Any = None) -> str:
    """Return the feedback page of a student, with the marks that count where there is an account of them."""
    return page(
        "feedback.html",
        record=record,
        course=course,
        account=account,
        not_taken=not_taken(record),
    )


def gradescope(record: dict[str, Any], course: Course) -> dict[str, Any]:
    """Return ``results.json`` in Gradescope's format. It names the exercises that must be graded again."""
    tests = [
        {
            "number": entry["id"],
            "name": course.exercises[entry["id"]].title,
            "score": entry["points"] or 0,
            "max_score": entry["max_points"],
            "status": "passed" if entry["state"] == "correct" else "failed",
            "output": entry["feedback"],
            "visibility": "visible",
        }
        for entry in record["exercises"]
    ]
    again = [entry["id"] for entry in record["exercises"] if entry["points"] is None]
    output = [
        *(f"Not taken: {problem}." for problem in record.get("problems", [])),
        *(f"Note: {note}." for note in record.get("notes", [])),
    ]
    if again:
        output.append(
            f"To be graded again, because the grader failed: {', '.join(again)}."
        )
    return {
        "score": record["points"],
        "output": "\n".join(output),
        "stdout_visibility": "hidden",
        "tests": tests,
    }


def junit(record: dict[str, Any], course: Course) -> str:
    """Return JUnit XML with one case per exercise: a failure for lost points, an error for a fault of the grader."""
    cases = record["exercises"]
    suite = ElementTree.Element(
        "testsuite",
        name=str(record["student"]),
        tests=str(len(cases)),
        failures=str(
            sum(entry["state"] not in ("correct", "grader-fault") for entry in cases)
        ),
        errors=str(sum(entry["state"] == "grader-fault" for entry in cases)),
    )
    for entry in cases:
        exercise = course.exercises[entry["id"]]
        case = ElementTree.SubElement(
            suite,
            "testcase",
            classname=exercise.chapter,
            name=f"{exercise.id} {exercise.title}",
        )
        if entry["state"] != "correct":
            kind = "error" if entry["state"] == "grader-fault" else "failure"
            found = ElementTree.SubElement(
                case, kind, message=entry["state"], type=entry["state"]
            )
            found.text = entry["feedback"]
    return ElementTree.tostring(suite, encoding="unicode", xml_declaration=True)


def gradebook(rows: Sequence[Sequence[Any]], course: Course) -> str:
    """Return the gradebook as CSV, one line per student. Spreadsheets read no cell as a formula."""
    headings = ["student", "points", "max_points", "tier", "grade_again", "not_taken"]
    return csv_text([headings + [*course.exercises], *rows])


def csv_text(rows: Sequence[Sequence[Any]]) -> str:
    """Return rows as CSV. Spreadsheets read no cell as a formula, and the text as UTF-8.

    Examples
    --------
    >>> csv_text([["=1+1", 2]])
    "\\ufeff'=1+1,2\\r\\n"
    """
    text = io.StringIO()
    csv.writer(text).writerows([[_cell(value) for value in row] for row in rows])
    # Spreadsheets take a file for UTF-8 only if it begins with this mark.
    return "\N{BYTE ORDER MARK}" + text.getvalue()


def _cell(value: Any) -> Any:
    """Prefix text that begins like a formula with an apostrophe, which spreadsheets read as text.

    A dash alone is none: Moodle writes it for an empty cell.
    """
    return (
        f"'{value}"
        if isinstance(value, str)
        and value != "-"
        and value.startswith(("=", "+", "-", "@", "\t", "\r"))
        else value
    )


def page(name: str, **content: Any) -> str:
    """Return a page made from the template with this name. Whatever it shows is escaped."""
    import jinja2

    folder = Path(__file__).with_name("templates")
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(folder),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
    )
    return environment.get_template(name).render(**content)


def _json(value: Any) -> str:
    return json.dumps(value, indent=1, ensure_ascii=False) + "\n"
