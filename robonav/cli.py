"""The command ``robonav``.

Each command imports what it needs when it runs, so that ``robonav --help`` is quick.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from robonav._version import __version__
from robonav.counting import counted
from robonav.errors import WorkerLost
from robonav.grading.commands import grade, gradebook, similarity

if TYPE_CHECKING:
    from robonav.experiments.runner.experiment import Experiment, Results

STANDARD_OUTPUT = Path("-")
# The parts of robonav --help, in order
PARTS = ROBOTS, PRACTICE, TEACHING = "Robots and results", "Exercises", "Teaching"

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Robot learning for autonomous navigation: imitation learning, reinforcement learning, and inverse "
    "reinforcement learning. The commands drive robots, reproduce the thesis's results, and check and grade exercises.",
)
exercises = typer.Typer(
    no_args_is_help=True, help="Make the students' exercises from the solutions."
)
app.add_typer(exercises, name="exercises", rich_help_panel=TEACHING)
drills = typer.Typer(
    no_args_is_help=True,
    help="Make question banks and exams of drills, which draw new numbers for each question.",
)
app.add_typer(drills, name="drills", rich_help_panel=TEACHING)
app.add_typer(gradebook, name="gradebook", rich_help_panel=TEACHING)


def _version(wanted: bool) -> None:
    """Print name and version, and exit, if wanted."""
    if wanted:
        print(f"robonav {__version__}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool,
        typer.Option(
            "--version",
            callback=_version,
            is_eager=True,
            help="Print name and version, and exit.",
        ),
    ] = False,
) -> None:
    """Options of the command itself."""


def main() -> None:
    """Run the command. A wrong input gives one line on stderr and exit code 2."""
    try:
        app()
    except (ValueError, TypeError, WorkerLost) as error:
        print(f"robonav: {error}", file=sys.stderr)
        sys.exit(2)


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
) -> None:
    """Write a zip file for students: stubs, notebooks and tests, without the solutions."""
    from robonav.grading.build import students_zip
    from robonav.grading.course import Course

    students_zip(Course.around(Path.cwd()), path)


@exercises.command("nbgrader")
def exercises_nbgrader(
    folder: Annotated[Path, typer.Argument(help="The root of an nbgrader course.")],
) -> None:
    """Write the assignments of an nbgrader course, each with the tests that its cells call."""
    from robonav.grading.build import nbgrader_course
    from robonav.grading.course import Course

    for assignment in nbgrader_course(Course.around(Path.cwd()), folder):
        print(assignment)


Chapters = Annotated[
    list[int] | None,
    typer.Option("--chapter", help="Only drills of this chapter. May be repeated."),
]
Pages = Annotated[
    list[str] | None,
    typer.Option(
        "--page",
        help="Only drills of this page, such as dynamic-programming. May be repeated.",
    ),
]


@drills.command("list")
def drills_list(chapter: Chapters = None, page: Pages = None) -> None:
    """List the drills: name, page, and learning goal."""
    from robonav.drills.export import selected

    for one in selected(chapter or (), page or ()):
        print(f"{one.name:26} {one.page:22} {one.goal}")


@drills.command("export")
def drills_export(
    file: Annotated[Path, typer.Argument(help="The file to write.")],
    format: Annotated[
        str,
        typer.Option(
            help="moodle (.xml, Moodle's question bank), qti (.zip, for Canvas and Blackboard), or pdf (an exam to "
            "print, and a second file with its solutions). By default the extension of the file tells."
        ),
    ] = "",
    chapter: Chapters = None,
    page: Pages = None,
    drill: Annotated[
        list[str] | None,
        typer.Option(help="This drill. May be repeated. See: robonav drills list"),
    ] = None,
    at_most: Annotated[
        int,
        typer.Option(
            help="At most this many drills, spread evenly over those chosen. 0 is 10 for an exam, and all for a bank."
        ),
    ] = 0,
    each: Annotated[int, typer.Option(help="Questions of each drill.")] = 1,
    seed: Annotated[
        int,
        typer.Option(
            help="Seed of the questions: the same seed gives the same questions. It is the number of the first paper."
        ),
    ] = 1,
    papers: Annotated[
        int,
        typer.Option(help="For pdf: how many different papers, in one file."),
    ] = 1,
    paper: Annotated[str, typer.Option(help="For pdf: a4 or letter.")] = "a4",
    platform: Annotated[
        str,
        typer.Option(
            help="For qti: canvas (QTI 1.2), or blackboard (QTI 2.1), which other platforms read as well."
        ),
    ] = "canvas",
    title: Annotated[
        str, typer.Option(help="The title of the question bank or exam.")
    ] = "Robot learning",
    force: Annotated[
        bool, typer.Option("--force", help="Write over files that exist.")
    ] = False,
) -> None:
    """Write questions of drills as a question bank or an exam. All drills take part unless you choose."""
    from robonav.drills import export

    request = export.Request(
        format=format,
        chapters=chapter or (),
        pages=page or (),
        drills=drill or (),
        at_most=at_most,
        each=each,
        seed=seed,
        papers=papers,
        paper=paper,
        platform=platform,
        title=title,
    )
    made = export.export(file, request, force=force)
    many = f"{made.papers} papers of " if made.papers > 1 else ""
    for path in made.paths:
        print(f"{path}: {many}{made.questions} questions")
    if made.left_out:
        print(
            f"Left out, because they have too few different questions: {', '.join(made.left_out)}",
            file=sys.stderr,
        )
    if made.fewer:
        print(
            f"These have fewer than {each} different questions and gave all: {', '.join(made.fewer)}",
            file=sys.stderr,
        )


@app.command(rich_help_panel=PRACTICE)
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
            help="Write the arguments of the first call that fails to this .npz file."
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
    grade, call = check_submission(course, chosen, submission, case)
    _tell(course, grade, everything=len(chosen) == len(names))
    if call:
        _tell_case(case, call)
    elif any(
        entry["state"] in ("partial", "wrong", "error") for entry in grade["exercises"]
    ):
        print("To get the first call that failed as a file, add: --case case.npz")
    if any(entry["state"] != "correct" for entry in grade["exercises"]):
        raise typer.Exit(1)


app.command(rich_help_panel=TEACHING)(grade)
app.command(rich_help_panel=TEACHING)(similarity)


@app.command(rich_help_panel=ROBOTS)
def reproduce(
    name: Annotated[
        str,
        typer.Argument(
            help="A table or figure such as table-3.2 or figure-4.6, or all. See --list."
        ),
    ] = "",
    out: Annotated[
        Path, typer.Option(help="The folder for results and figures.")
    ] = Path("results"),
    json_file: Annotated[
        Path | None,
        typer.Option(
            "--json", help="Also write the results to this file; - is standard output."
        ),
    ] = None,
    scale: Annotated[
        str, typer.Option(help="quick, or thesis for as many runs as the thesis made.")
    ] = "quick",
    backend: Annotated[
        str, typer.Option(help="joblib to run on this machine, or dask.")
    ] = "joblib",
    scheduler: Annotated[
        str | None, typer.Option(help="The address of a Dask scheduler.")
    ] = None,
    jobs: Annotated[
        int, typer.Option(help="Processes on this machine; -1 for one per core.")
    ] = -1,
    show: Annotated[
        bool, typer.Option("--list", help="List the tables and figures, and exit.")
    ] = False,
) -> None:
    """Reproduce a table or figure of the thesis. An interrupted run resumes when it is started again."""
    from robonav import experiments
    from robonav.experiments.runner.report import as_json, as_text

    if show or not name:
        for known in experiments.names():
            print(f"{known:20} {experiments.experiment(known).title}")
        return
    _check_json(json_file)
    chosen = [
        experiments.experiment(one)
        for one in (experiments.names() if name == "all" else [name])
    ]
    how = {"scale": scale, "backend": backend, "scheduler": scheduler, "jobs": jobs}
    done = []
    for experiment in chosen:
        results = _reproduced(experiment, out, **how)
        _print_beside(json_file, as_text(results))
        done.append(results)
    if json_file is not None:
        _write_json(json_file, as_json(done))


def _reproduced(experiment: Experiment, out: Path, **how: Any) -> Results:
    """Run one experiment with a progress bar, and keep its figure."""
    from robonav import experiments, progress
    from robonav.plots.experiments import save_figure

    with progress.bar(experiment.name) as report:
        results = experiments.reproduce(experiment, out, progress=report, **how)
    save_figure(results, out)
    return results


@app.command(rich_help_panel=ROBOTS)
def navigate(
    method: Annotated[
        str,
        typer.Option(
            help="A method by name, or a .safetensors or .py file. See --list."
        ),
    ] = "",
    obstacles: Annotated[
        int, typer.Option(help="Number of obstacles that stand still.")
    ] = 10,
    moving: Annotated[
        int, typer.Option(help="Number of moving obstacles, in addition.")
    ] = 0,
    speed: Annotated[float, typer.Option(help="Speed of the robot in m/s.")] = 2.0,
    worlds: Annotated[int, typer.Option(help="Number of random worlds.")] = 200,
    seed: Annotated[int, typer.Option(help="Seed of the random worlds.")] = 0,
    json_file: Annotated[
        Path | None,
        typer.Option(
            "--json", help="Also write the result to this file; - is standard output."
        ),
    ] = None,
    show: Annotated[
        bool, typer.Option("--list", help="List the methods, and exit.")
    ] = False,
) -> None:
    """Drive a robot with one method through random worlds, and report how often it arrives."""
    from robonav.benchmark import policies
    from robonav.validation import check_integer

    check_integer("worlds", worlds, at_least=1)
    if show or not method:
        print("\n".join(policies.methods()))
        return
    _check_json(json_file)
    result = policies.evaluate(
        method,
        obstacles=obstacles,
        moving=moving,
        speed=speed,
        worlds=worlds,
        seed=seed,
    )
    rate, (low, high) = result["success"], result["interval"]
    _print_beside(
        json_file,
        f"{method}: {100 * rate:.1f} % arrive in {counted(worlds, 'world')} (95 % interval {100 * low:.1f} to "
        f"{100 * high:.1f}), {result['outcomes']['collided']} collide, "
        f"{result['outcomes']['out of steps']} run out of steps",
    )
    if json_file is not None:
        _write_json(json_file, result)


@app.command(rich_help_panel=ROBOTS)
def leaderboard(
    method: Annotated[
        list[str] | None,
        typer.Argument(help="Methods by name, or files. The default is all methods."),
    ] = None,
    out: Annotated[Path, typer.Option(help="The folder for results.")] = Path(
        "results"
    ),
    json_file: Annotated[
        Path | None,
        typer.Option(
            "--json", help="Also write the results to this file; - is standard output."
        ),
    ] = None,
    scale: Annotated[
        str, typer.Option(help="quick, or thesis for all worlds of the leaderboard.")
    ] = "thesis",
) -> None:
    """Compare methods on the frozen worlds of the leaderboard. Give your own method as a file."""
    from robonav import experiments, progress
    from robonav.benchmark import method as known
    from robonav.benchmark import methods
    from robonav.experiments.leaderboard import board
    from robonav.experiments.runner.report import as_json, as_table

    names = method or methods()
    for name in names:
        known(name)
    _check_json(json_file)
    with progress.bar("leaderboard") as report:
        results = experiments.reproduce(board(names), out, scale=scale, progress=report)
    table = as_table(results, "success", rows="method", columns="setting")
    _print_beside(json_file, table)
    if json_file is not None:
        _write_json(json_file, as_json([results]))


def _check_json(path: Path | None) -> None:
    """Fail before the work starts if the file cannot be written after it."""
    from robonav.experiments.runner.results import check_writable

    if path is not None and path != STANDARD_OUTPUT:
        if path.is_dir():
            raise ValueError(f"json must be a file to write, got the folder {path}")
        check_writable("json", path.parent)


def _write_json(path: Path, content: Any) -> None:
    from robonav import atomic

    text = json.dumps(content, indent=2) + "\n"
    if path == STANDARD_OUTPUT:
        sys.stdout.write(text)
        return
    atomic.write_text(path, text)


def _print_beside(json_file: Path | None, text: str) -> None:
    """Print results for people: to standard output, or to standard error if that takes the JSON."""
    print(text, file=sys.stderr if json_file == STANDARD_OUTPUT else sys.stdout)


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


def _tell_case(path: Path | None, call: str) -> None:
    """Say how to repeat the call that was written to a file."""
    print(
        f"\nThe first call that failed is in {path}. Repeat it with\n\n"
        f"    import numpy as np\n"
        f"    case = np.load({str(path)!r})\n"
        f"    {call}\n\n"
        'and compare with case["expected"].'
    )


def _points(entry: dict[str, Any]) -> str:
    return "?" if entry["points"] is None else f"{entry['points']:g}"


app.registered_commands.sort(key=lambda command: PARTS.index(command.rich_help_panel))
