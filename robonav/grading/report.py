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
from .grade import STATES

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
    out: Path, names: Sequence[str], passed_over: Sequence[str], course: Course
) -> list[str]:
    """Write the gradebook and the overview of these students, with the names of the files that are not submissions.

    Returns
    -------
    list of str
        The students who must be graded again.
    """
    rows, counts, earned, totals, unfinished = (
        [],
        {id: Counter[str]() for id in course.exercises},
        Counter[str](),
        [],
        [],
    )
    notes: dict[str, list[str]] = {}
    problems: dict[str, list[str]] = {}
    for name in names:
        record = json.loads((out / "students" / name / "grade.json").read_bytes())
        entries = {entry["id"]: entry for entry in record["exercises"]}
        again = [id for id, entry in entries.items() if entry["points"] is None]
        unfinished += [name] if again else []
        notes[name] = record.get("notes", [])
        problems[name] = record.get("problems", [])
        points = [
            entries[id]["points"] if id in entries else None for id in course.exercises
        ]
        rows.append(
            [
                name,
                record["points"],
                record["max_points"],
                record["tier"],
                " ".join(again),
                "; ".join(problems[name]),
                *points,
            ]
        )
        totals.append(record["points"])
        for id, entry in entries.items():
            counts[id][entry["state"]] += 1
            earned[id] += entry["points"] or 0
    write_text(out / "gradebook.csv", gradebook(rows, course))
    shares = {
        id: earned[id] / (course.exercises[id].points * max(len(rows), 1))
        for id in course.exercises
    }
    overview = page(
        "overview.html", rows=rows, counts=counts, shares=shares, totals=totals, course=course, colours=COLOURS,
        passed_over=[name.encode("utf-8", "replace").decode() for name in passed_over],
        folders=[f"students/{name}/feedback.html" for name in names], notes=notes, problems=problems,
    )  # fmt: skip
    write_text(out / "index.html", overview)
    return unfinished


def feedback(record: dict[str, Any], course: Course, account: Any = None) -> str:
    """Return the feedback page of a student, with the marks that count where there is an account of them."""
    return page("feedback.html", record=record, course=course, account=account)


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
