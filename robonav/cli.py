"""The command ``robonav``. What a command needs is imported when it runs, so that ``robonav --help`` is quick."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any

import typer

app = typer.Typer(no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False, help=__doc__)
exercises = typer.Typer(no_args_is_help=True, help="Make what students get from solutions/.")
app.add_typer(exercises, name="exercises")


def main() -> None:
    """Run the command; a wrong input is one line and exit code 2."""
    try:
        app()
    except (ValueError, TypeError) as error:
        print(f"robonav: {error}", file=sys.stderr)
        sys.exit(2)


@exercises.command("build")
def exercises_build(
    check: Annotated[bool, typer.Option("--check", help="Write nothing; exit 1 if anything is out of date.")] = False,
) -> None:
    """Write exercises/ and nbgrader's notebooks from solutions/."""
    from robonav.grading import build
    from robonav.grading.course import Course

    course = Course.around(Path.cwd())
    changed = build.outdated(course) if check else build.build(course)
    for name in changed:
        print(f"{'out of date' if check else 'written'}: {name}")
    if check and changed:
        print("run: robonav exercises build")
        raise typer.Exit(1)


@exercises.command("zip")
def exercises_zip(path: Annotated[Path, typer.Argument(help="The zip to write.")]) -> None:
    """A zip for students: stubs, notebooks and tests, without the solutions."""
    from robonav.grading.build import students_zip
    from robonav.grading.course import Course

    students_zip(Course.around(Path.cwd()), path)


@app.command()
def check(
    keys: Annotated[list[str] | None, typer.Argument(help="Exercises, such as 3.2; all if none is named.")] = None,
    submission: Annotated[
        Path | None, typer.Option(help="Your folder, notebook or zip; exercises/ by default.")
    ] = None,
) -> None:
    """Check your answers to the exercises, as the grader would, on the public cases."""
    from robonav.grading.course import Course
    from robonav.grading.plugin import command, environment

    course = Course.around(Path.cwd())
    wanted = [argument for key in keys or [] for argument in ("--exercise", course.named(key).id)]
    with TemporaryDirectory() as folder:
        report = Path(folder, "grade.json")
        run = command(
            [str(course.tests), "--submission", str(submission or course.stubs), "--grade-json", str(report), *wanted]
        )
        done = subprocess.run(run, env=environment(), capture_output=True, text=True)
        if not report.is_file():
            raise ValueError(f"the check did not run: {(done.stderr or done.stdout).strip()}")
        grade = json.loads(report.read_text())
    _tell(course, grade, everything=bool(keys))
    if any(entry["state"] != "correct" for entry in grade["exercises"]):
        raise typer.Exit(1)


def _tell(course: Any, grade: dict[str, Any], *, everything: bool) -> None:
    """A grade for its student to read; exercises not yet begun in one line, unless asked for."""
    for entry in grade["exercises"]:
        exercise = course.exercises[entry["id"]]
        print(f"{entry['id']} {exercise.title}: {_points(entry)} of {entry['max_points']} points")
        if entry["state"] == "missing":
            print(f"  Not begun yet: write {exercise.name} in exercises/{exercise.file} or the notebook.")
        elif entry["state"] != "correct" or everything:
            print("\n".join(f"  {line}" for line in entry["feedback"].splitlines()))
    print(f"\nTogether {grade['points']} of {grade['max_points']} points, on the public cases.")
    if all(entry["state"] == "correct" for entry in grade["exercises"]):
        print("Well done: marks are given on other cases of the same kind, so this should hold there too.")


def _points(entry: dict[str, Any]) -> str:
    return "?" if entry["points"] is None else f"{entry['points']:g}"
