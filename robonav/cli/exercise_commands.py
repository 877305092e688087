"""The commands ``robonav exercises``, which makes the exercises, and ``robonav check``, which checks answers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from robonav.grading.check import FailedCall

exercises = typer.Typer(
    no_args_is_help=True, help="Make the students' exercises from the solutions."
)


@exercises.command("build")
def exercises_build(
    check: Annotated[
        bool,
        typer.Option(
            "--check", help="Write nothing. Exit with 1 if a file is out of date."
        ),
    ] = False,
    variant: Annotated[
        str | None,
        typer.Option(
            help="Any text. It chooses other details of each exercise, for a term or a student: the exercises go "
            "into OUT, with their solutions, tests, notebooks, and a zip file for students."
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(help="The folder for the variant. Only with --variant."),
    ] = None,
    student: Annotated[
        list[str] | None,
        typer.Option(
            help="Write a variant of this student's own into OUT/STUDENT, chosen by the text and the name. May be "
            "repeated. The name is that of the submission."
        ),
    ] = None,
) -> None:
    """Write exercises/ and the nbgrader notebooks from solutions/, or a variant of all exercises into a folder."""
    from robonav.grading import build
    from robonav.grading.course import Course

    course = Course.around(Path.cwd())
    if variant is not None or out is not None or student:
        _build_variant(course, variant, out, student or [], check)
        return
    changed = build.outdated(course) if check else build.build(course)
    for name in changed:
        print(f"{'out of date' if check else 'written'}: {name}")
    if check and changed:
        print("run: robonav exercises build")
        raise typer.Exit(1)


def _build_variant(
    course: Any,
    variant: str | None,
    out: Path | None,
    students: list[str],
    check: bool,
) -> None:
    """Write a variant of the exercises, or one for each student, and say which exercises have none."""
    from robonav.grading import build, variants

    if variant is None or out is None or check:
        raise ValueError("a variant needs both --variant and --out, and no --check")
    if students and (out / variants.MARK).is_file():
        raise ValueError(
            f"{out} holds one variant for all students; choose another folder, or remove it first"
        )
    variants.check_replaces_nothing(course, variant, out)
    each = variants.EachStudent(course, variant, out)
    for name in students:
        variants.check_replaces_nothing(course, each.secret_of(name), out / name)
    made = [each.of(name) for name in students] or [
        variants.write(course, variant, out)
    ]
    for one in made:
        path = one.root / "robonav-exercises.zip"
        build.students_zip(one, path)
        print(f"for students: {path}")
    if left_out := variants.without_variants(course):
        names = ", ".join(exercise.id for exercise in left_out)
        print(f"left out, because they have no variants yet: {names}")


@exercises.command("zip")
def exercises_zip(
    path: Annotated[Path, typer.Argument(help="The zip file to write.")],
    only: Annotated[
        list[str] | None,
        typer.Option(
            help="An exercise such as 3.2, or a chapter such as 3, to put into the file. May be repeated. The default "
            "is all of them."
        ),
    ] = None,
) -> None:
    """Write a zip file for students: stubs, notebooks and tests, without the solutions."""
    from tempfile import TemporaryDirectory

    from robonav.grading.build import students_zip
    from robonav.grading.course import Course
    from robonav.grading.variants import write_some

    course = Course.around(Path.cwd())
    if not only:
        students_zip(course, path)
        return
    wanted = [exercise for key in only for exercise in course.selected(key)]
    with TemporaryDirectory() as folder:
        students_zip(write_some(course, wanted, Path(folder)), path)


@exercises.command("nbgrader")
def exercises_nbgrader(
    folder: Annotated[Path, typer.Argument(help="The root of an nbgrader course.")],
) -> None:
    """Write the assignments of an nbgrader course, each with the tests that its cells call."""
    from robonav.grading.build import nbgrader_course
    from robonav.grading.course import Course

    for assignment in nbgrader_course(Course.around(Path.cwd()), folder):
        print(assignment)


def check(
    keys: Annotated[
        list[str] | None,
        typer.Argument(
            help="Exercises such as 3.2, or chapters such as 3; the default is all of them. You may also name your "
            "folder, notebook or zip file, if it is not exercises/."
        ),
    ] = None,
    submission: Annotated[
        Path | None,
        typer.Option(
            help="Your folder, notebook or zip file. The default is exercises/."
        ),
    ] = None,
    case: Annotated[
        Path | None,
        typer.Option(
            help="Write the arguments of the first call that fails to this .npz file. An open task has none, since it "
            "counts what many calls achieve."
        ),
    ] = None,
) -> None:
    """Check your answers to the exercises as the grader does, on the public cases."""
    from robonav.grading.check import check_submission
    from robonav.grading.course import Course

    course = Course.around(Path.cwd())
    paths = [Path(key) for key in keys or [] if _is_path(course, key)]
    names = [key for key in keys or [] if not _is_path(course, key)]
    if len(paths) + (submission is not None) > 1:
        raise ValueError("check takes one folder, notebook or zip file at a time")
    submission = submission or (paths[0] if paths else course.stubs)
    wanted = [exercise for key in names for exercise in course.selected(key)]
    chosen = list(dict.fromkeys(wanted)) or list(course.exercises.values())
    if case is not None and (case.is_dir() or not case.parent.is_dir()):
        raise ValueError(
            f"case must be a file to write in a folder that exists, got {case}"
        )
    grade, failed = check_submission(course, chosen, submission)
    _tell(course, grade, everything=len(chosen) == len(names))
    if case is not None:
        _write_case(course, grade, failed, case)
    elif failed is not None:
        print("To get the first call that failed as a file, add: --case case.npz")
    if any(entry["state"] != "correct" for entry in grade["exercises"]):
        raise typer.Exit(1)


def _is_path(course: Any, key: str) -> bool:
    """Whether an argument of ``check`` is a file or folder, and no exercise."""
    from robonav.grading.submission import is_handed_in

    known = {
        *course.exercises,
        *(exercise.name for exercise in course.exercises.values()),
        *(name for chapter, _ in course.chapters() for name in (chapter, chapter[2:])),
    }
    named = is_handed_in(key) or "/" in key
    return key not in known and (named or Path(key).exists())


def _tell(course: Any, grade: dict[str, Any], *, everything: bool) -> None:
    """Print a grade for its student. An exercise that was not begun takes one line unless ``everything`` is set."""
    for problem in grade["problems"]:
        print(f"Not taken: {problem}.")
    for note in grade["notes"]:
        print(f"Note: {note}.")
    for entry in grade["exercises"]:
        exercise = course.exercises[entry["id"]]
        file = grade["files"].get(entry["id"], exercise.file)
        print(
            f"{entry['id']} {exercise.title}: {_points(entry)} of {entry['max_points']} points"
            + ("" if file == exercise.file else f" (from {file})")
        )
        if entry["state"] == "missing":
            print(
                f"  Not begun: write {exercise.name} in exercises/{exercise.file} or the notebook."
            )
        elif entry["state"] != "correct" or everything:
            print("\n".join(f"  {line}" for line in entry["feedback"].splitlines()))
    print(
        f"\nTotal: {grade['points']} of {grade['max_points']} points on the public cases."
    )
    if all(entry["state"] == "correct" for entry in grade["exercises"]):
        print(
            "Well done. Marks are given on other cases of the same kind, so your answers should pass there too."
        )


def _write_case(
    course: Any, grade: dict[str, Any], failed: FailedCall | None, path: Path
) -> None:
    """Write the call that failed to a file and say how to repeat it, or say why there is none."""
    from robonav.grading.case_file import write_case

    if failed is None:
        print(f"{path} was not written: {_why_no_case(course, grade)}")
        return
    call = write_case(path, failed.observation, failed.names)
    print(
        f"\nThe first call that failed is in {path}. Repeat it with\n\n"
        f"    import numpy as np\n"
        f"    case = np.load({str(path)!r})\n"
        f"    {call}\n"
    )
    if failed.observation.expected is not None:
        print('and compare with case["expected"].')


def _why_no_case(course: Any, grade: dict[str, Any]) -> str:
    """Say why no single call failed."""
    states = {entry["id"]: entry["state"] for entry in grade["exercises"]}
    wrong = [id for id, state in states.items() if state not in ("correct", "missing")]
    if not wrong:
        begun = any(state == "correct" for state in states.values())
        return "no call failed." if begun else "nothing was begun."
    if tasks := [id for id in wrong if course.exercises[id].draws]:
        return (
            f"{' and '.join(tasks)} {'are open tasks' if len(tasks) > 1 else 'is an open task'}, which counts what "
            "your function achieves in many calls together, so that no single call is wrong. Print what you want to "
            "see from your function, or drive it in a notebook."
        )
    return "your function was not called, for the reason above."


def _points(entry: dict[str, Any]) -> str:
    return "?" if entry["points"] is None else f"{entry['points']:g}"
