"""Build the files for students and instructors from the source of each exercise, ``solutions/chN/name.py``.

Students get the file without its solution, a notebook per chapter, and a zip file with the tests. nbgrader gets a
notebook that still contains the solutions. These files are generated and never edited; ``outdated`` lists those that
differ from their source.
"""

from __future__ import annotations

import ast
import json
import re
import textwrap
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from robonav.atomic import atomic_write, write_text

from .check import InProcessCalls, graded
from .course import Course, Exercise
from .notebook import STUB
from .reference import Recorder, solution
from .sandbox import Limits

SOLUTION = re.compile(
    r"^( *)### BEGIN SOLUTION\n.*?^ *### END SOLUTION\n", re.MULTILINE | re.DOTALL
)
# the date of every file in a zip, so that the same content makes the same zip
LONG_AGO = (
    2015,
    1,
    1,
    0,
    0,
    0,
)


def stub(source: str, name: str) -> str:
    """Return the source without its solution.

    Raises
    ------
    ValueError
        If the source of ``name`` has no solution between ``### BEGIN SOLUTION`` and ``### END SOLUTION``.
    """
    cut, found = SOLUTION.subn(rf"\1{STUB.format(name=name)}\n", source)
    if not found or "### " in cut:
        raise ValueError(
            f"{name} must have its solution between ### BEGIN SOLUTION and ### END SOLUTION"
        )
    return cut


def question(source: str) -> str:
    """Return the docstring of the source, which is the question in MyST Markdown."""
    return ast.get_docstring(ast.parse(source)) or ""


def code(source: str) -> str:
    """Return the source without its docstring."""
    first = ast.parse(source).body[0]
    return "".join(source.splitlines(keepends=True)[first.end_lineno :]).strip() + "\n"


def built(course: Course) -> dict[str, str]:
    """Return the text of every generated file by its path from the course's root."""
    files = {"exercises/README.md": _readme(course)}
    for chapter, exercises in course.chapters():
        sources = {
            exercise: (course.solutions / exercise.file).read_text("utf-8")
            for exercise in exercises
        }
        stubs = {
            exercise: stub(source, exercise.name)
            for exercise, source in sources.items()
        }
        for exercise, text in stubs.items():
            files[f"exercises/{exercise.file}"] = f"{_heading(exercise)}\n{text}"
        files[f"exercises/{chapter}.ipynb"] = _notebook(chapter, stubs)
        files[f"solutions/nbgrader/source/{chapter}/{chapter}.ipynb"] = _notebook(
            chapter, sources
        )
    return files


def outdated(course: Course) -> list[str]:
    """Return the generated files that are missing, out of date, or without a source."""
    files = built(course)
    present = {path.relative_to(course.root).as_posix() for path in _generated(course)}
    differ = [
        name
        for name in files
        if name in present and (course.root / name).read_text("utf-8") != files[name]
    ]
    return sorted({*differ, *(set(files) ^ present)})


def build(course: Course) -> list[str]:
    """Write the files that are out of date, remove those without a source, and return the names of both."""
    files = built(course)
    changed = outdated(course)
    for name in changed:
        if name in files:
            write_text(course.root / name, files[name])
        else:
            (course.root / name).unlink()
    return changed


def students_zip(course: Course, path: Path) -> None:
    """Write a zip file for students.

    It contains stubs, notebooks, and the tests with the answers to the public cases only. They lie in a folder with the
    name of the file, so that the zip of one week does not overwrite the answers to those of another.
    """
    content = {
        name: text.encode()
        for name, text in built(course).items()
        if name.startswith("exercises/")
    }
    content |= _tests(course)
    with (
        atomic_write(path) as file,
        zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive,
    ):
        for name, text in content.items():
            archive.writestr(zipfile.ZipInfo(f"{path.stem}/{name}", LONG_AGO), text)


def nbgrader_course(course: Course, folder: Path) -> list[Path]:
    """Write the assignments into the root of an nbgrader course, and return their folders.

    Each assignment contains the tests that its cells call. nbgrader gives them to the students with the notebook, and
    puts them back before it grades.
    """
    tests, assignments = _tests(course), []
    for chapter, exercises in course.chapters():
        assignment = folder / "source" / chapter
        names = [
            *("manifest.toml", "pytest.ini", f"test_{chapter}.py"),
            *(f"recorded/{exercise.name}.frame" for exercise in exercises),
        ]
        files = [f"tests/exercises/{name}" for name in names]
        content = {name: tests[name] for name in files if name in tests}
        notebook = f"solutions/nbgrader/source/{chapter}/{chapter}.ipynb"
        content[f"{chapter}.ipynb"] = built(course)[notebook].encode()
        for name, text in content.items():
            with atomic_write(assignment / name) as file:
                file.write(text)
        assignments.append(assignment)
    return assignments


def _tests(course: Course) -> dict[str, bytes]:
    """Return the tests and the recorded answers to the public cases, by their path from the course's root."""
    recorder = Recorder(course)
    for exercise in course.exercises.values():
        calls = InProcessCalls(solution(course, exercise))
        result = graded(course, exercise, calls, recorder)
        if result["state"] != "correct":
            raise ValueError(
                f"the solution of {exercise.id} does not pass: {result['feedback']}"
            )
    files = [course.tests / name for name in ("manifest.toml", "pytest.ini")]
    files += sorted(course.tests.glob("test_*.py"))
    content = {
        path.relative_to(course.root).as_posix(): path.read_bytes() for path in files
    }
    with TemporaryDirectory() as folder:
        recorder.write(Path(folder))
        for path in sorted(Path(folder).iterdir()):
            content[f"tests/exercises/recorded/{path.name}"] = path.read_bytes()
    return content


def _generated(course: Course) -> Iterator[Path]:
    for folder, kinds in (
        (course.stubs, (".py", ".ipynb", ".md")),
        (course.solutions / "nbgrader", (".ipynb",)),
    ):
        for path in folder.rglob("*"):
            if path.suffix in kinds and not any(
                part.startswith((".", "__")) for part in path.parts[-2:]
            ):
                yield path


def _heading(exercise: Exercise) -> str:
    lines = [
        f"# Exercise {exercise.id}: {exercise.title}.",
        f"# {exercise.points} points, {exercise.difficulty}, about {exercise.minutes} minutes.",
        *(f"# {line}" for line in textwrap.wrap(how_fair(exercise), 86)),
        f"# Check it with: robonav check {exercise.id}",
    ]
    return "\n".join(lines)


def how_fair(exercise: Exercise) -> str:
    """Return what students should know about the checks of an open task, or an empty string.

    Examples
    --------
    >>> how_fair(Exercise("2.2", "improve", "Ties", 4, "warm-up", 10, "dynamic-programming"))
    ''
    """
    if not exercise.draws:
        return ""
    limits = Limits()
    call, everything = (max(0.1, seconds) for seconds in exercise.seconds)
    return (
        "Your marks come from new random cases, which are drawn again whenever your submission changes. "
        f"{exercise.fairness} A call may take {limits.call_seconds:g} s and all calls "
        f"{limits.exercise_seconds:g} s; theirs took at most {call:.1f} s and {everything:.1f} s."
    )


def _readme(course: Course) -> str:
    rows = [
        f"| {e.id} | `{e.file}` | {e.title} | {e.difficulty} | {e.minutes} min | {e.points} |"
        for e in course.exercises.values()
    ]
    head = [
        "| exercise | file | title | kind | time | points |",
        "|---|---|---|---|---|---|",
    ]
    return "\n".join(
        [
            "# Exercises",
            "",
            "Each file asks for one function; its docstring says what goes in and what comes out. Write it there, or",
            "in the chapter's notebook, with Python's standard library and numpy, and check it one folder up:",
            "",
            "```bash",
            "robonav check 2.1        # one exercise",
            "robonav check 2          # all of chapter 2",
            "robonav check            # all of them",
            "robonav check work.zip   # what you are about to hand in",
            "robonav check 2.1 --case case.npz    # the first call that fails, as a file for numpy.load",
            "```",
            "",
            *head,
            *rows,
            "",
            "These files are generated from the solutions; do not edit them in the book's own repository.",
            "",
        ]
    )


def _notebook(chapter: str, sources: Mapping[Exercise, str]) -> str:
    """Return a chapter's exercises as one notebook, with the cell metadata that nbgrader reads."""
    number = chapter.removeprefix("ch")
    cells = [
        _markdown(
            "title",
            f"# Exercises of chapter {number}\n\nRun a cell with `check` to see how you are doing.",
        )
    ]
    for exercise, source in sources.items():
        key = exercise.id.replace(".", "-")
        about = f"{exercise.points} points, {exercise.difficulty}, about {exercise.minutes} minutes"
        fair = f"\n\n{how_fair(exercise)}" if exercise.draws else ""
        text = f"## Exercise {exercise.id}: {exercise.title}\n\n*{about}*\n\n{question(source)}{fair}"
        check = f'from robonav.grading.check import check\n\ncheck("{exercise.id}", {exercise.name})'
        cells += [
            _markdown(f"question-{key}", text),
            _code(
                f"answer-{key}",
                code(source).rstrip(),
                solution=True,
                locked=False,
                grade=False,
            ),
            _code(
                f"check-{key}",
                check,
                solution=False,
                locked=True,
                grade=True,
                points=exercise.points,
            ),
        ]
    kernel = {
        "kernelspec": {
            "display_name": "Python 3",
            "language": "python",
            "name": "python3",
        }
    }
    notebook = {"cells": cells, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(notebook, indent=1, ensure_ascii=False) + "\n"


def _markdown(key: str, text: str) -> dict[str, Any]:
    return {"cell_type": "markdown", "id": key, "metadata": {}, "source": _lines(text)}


def _code(key: str, text: str, **grading: Any) -> dict[str, Any]:
    metadata = {
        "nbgrader": {
            "grade_id": key,
            "schema_version": 3,
            "task": False,
            "cell_type": "code",
            **grading,
        }
    }
    head = {"cell_type": "code", "execution_count": None, "id": key}
    return {**head, "metadata": metadata, "outputs": [], "source": _lines(text)}


def _lines(text: str) -> Sequence[str]:
    return text.splitlines(keepends=True)
