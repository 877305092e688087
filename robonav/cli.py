"""The command ``robonav``. What a command needs is imported when it runs, so that ``robonav --help`` is quick."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any

import typer

from robonav.errors import WorkerLost

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help=__doc__,
)
exercises = typer.Typer(
    no_args_is_help=True, help="Make what students get from solutions/."
)
app.add_typer(exercises, name="exercises")


def main() -> None:
    """Run the command; a wrong input is one line and exit code 2."""
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
            "--check", help="Write nothing; exit 1 if anything is out of date."
        ),
    ] = False,
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
def exercises_zip(
    path: Annotated[Path, typer.Argument(help="The zip to write.")],
) -> None:
    """A zip for students: stubs, notebooks and tests, without the solutions."""
    from robonav.grading.build import students_zip
    from robonav.grading.course import Course

    students_zip(Course.around(Path.cwd()), path)


@app.command()
def check(
    keys: Annotated[
        list[str] | None,
        typer.Argument(help="Exercises, such as 3.2; all if none is named."),
    ] = None,
    submission: Annotated[
        Path | None,
        typer.Option(help="Your folder, notebook or zip; exercises/ by default."),
    ] = None,
) -> None:
    """Check your answers to the exercises, as the grader would, on the public cases."""
    from robonav.grading.course import Course
    from robonav.grading.plugin import command, environment

    course = Course.around(Path.cwd())
    wanted = [
        argument
        for key in keys or []
        for argument in ("--exercise", course.named(key).id)
    ]
    with TemporaryDirectory() as folder:
        report = Path(folder, "grade.json")
        arguments = [
            str(course.tests),
            "--submission",
            str(submission or course.stubs),
            "--grade-json",
            str(report),
        ]
        run = command(course.tests, [*arguments, *wanted])
        done = subprocess.run(run, env=environment(), capture_output=True, text=True)
        if not report.is_file():
            raise ValueError(
                f"the check did not run: {(done.stderr or done.stdout).strip()}"
            )
        grade = json.loads(report.read_text())
    _tell(course, grade, everything=bool(keys))
    if any(entry["state"] != "correct" for entry in grade["exercises"]):
        raise typer.Exit(1)


@app.command()
def grade(
    folder: Annotated[
        Path,
        typer.Argument(
            help="A folder with one folder, zip or notebook for each student."
        ),
    ],
    out: Annotated[
        Path, typer.Option(help="Where grades, feedback and the overview go.")
    ],
    secret: Annotated[
        Path | None,
        typer.Option(
            help="Draw the cases from this file's content; or set ROBONAV_SECRET."
        ),
    ] = None,
    student: Annotated[
        list[str] | None, typer.Option(help="Grade this one again; may be repeated.")
    ] = None,
    exercise: Annotated[
        list[str] | None, typer.Option(help="Grade only this again; may be repeated.")
    ] = None,
    jobs: Annotated[
        int, typer.Option(help="How many at once; -1 for one a processor.")
    ] = -1,
    scheduler: Annotated[
        str | None,
        typer.Option(help="Address of a Dask scheduler to send the work to."),
    ] = None,
    practice: Annotated[
        bool,
        typer.Option(
            "--practice", help="Go on where there is no sandbox; gives no marks."
        ),
    ] = False,
) -> None:
    """Grade a class. Run it again after it was cut: what is graded stays."""
    from robonav import progress
    from robonav.grading import sandbox_check
    from robonav.grading.cases import secret_from
    from robonav.grading.classroom import GradingConfig, grade_class
    from robonav.grading.course import Course

    course = Course.around(Path(__file__).parent, Path.cwd())
    ids = [course.named(key).id for key in exercise or []]
    config = GradingConfig(course, sandbox_check.best(), secret_from(secret))
    if config.tier == "practice" and not practice:
        raise ValueError(
            f"there is no sandbox here, only --practice: {sandbox_check.fault('official')}"
        )
    with progress.bar("grading") as shown:
        grade_class(
            config,
            folder,
            out,
            again=student or [],
            ids=ids,
            jobs=jobs,
            scheduler=scheduler,
            progress=shown,
        )
    print(f"{out / 'index.html'}")


@app.command()
def reproduce(
    name: Annotated[
        str,
        typer.Argument(
            help="all, or a name such as table-3.2 or figure-4.6; see --list."
        ),
    ] = "",
    out: Annotated[Path, typer.Option(help="Folder for results and figures.")] = Path(
        "results"
    ),
    json_file: Annotated[
        Path | None,
        typer.Option("--json", help="Also write what each case came to here."),
    ] = None,
    scale: Annotated[
        str, typer.Option(help="quick, or thesis for the thesis's own number of runs.")
    ] = "quick",
    backend: Annotated[
        str, typer.Option(help="joblib for this machine, or dask.")
    ] = "joblib",
    scheduler: Annotated[
        str | None, typer.Option(help="Address of a Dask scheduler.")
    ] = None,
    jobs: Annotated[
        int, typer.Option(help="Processes on this machine; -1 for one a core.")
    ] = -1,
    show: Annotated[
        bool, typer.Option("--list", help="Only list what can be reproduced.")
    ] = False,
) -> None:
    """Run a table or figure of the thesis again; cut and started anew, it goes on where it was."""
    from robonav import experiments, progress
    from robonav.experiments.runner.report import as_json, as_text
    from robonav.plots.experiments import save_figure

    if show or not name:
        for known in experiments.names():
            print(f"{known:20} {experiments.experiment(known).title}")
        return
    _check_json(json_file)
    chosen = [
        experiments.experiment(one)
        for one in (experiments.names() if name == "all" else [name])
    ]
    done = []
    for experiment in chosen:
        with progress.bar(experiment.name) as shown:
            done.append(
                experiments.reproduce(
                    experiment,
                    out,
                    scale=scale,
                    backend=backend,
                    scheduler=scheduler,
                    jobs=jobs,
                    progress=shown,
                )
            )
        save_figure(done[-1], out)
        print(as_text(done[-1]))
    if json_file is not None:
        _write_json(json_file, as_json(done))


@app.command()
def navigate(
    method: Annotated[
        str,
        typer.Option(
            help="A method by name, or a file: .safetensors or .py; see --list."
        ),
    ] = "",
    obstacles: Annotated[int, typer.Option(help="Standing obstacles.")] = 10,
    moving: Annotated[int, typer.Option(help="Moving obstacles on top.")] = 0,
    speed: Annotated[float, typer.Option(help="Of the robot, in m/s.")] = 2.0,
    worlds: Annotated[int, typer.Option(help="How many new worlds.")] = 200,
    seed: Annotated[int, typer.Option(help="Of the worlds.")] = 0,
    json_file: Annotated[
        Path | None, typer.Option("--json", help="Also write the result here.")
    ] = None,
    show: Annotated[
        bool, typer.Option("--list", help="Only list the methods.")
    ] = False,
) -> None:
    """Drive a method through new worlds."""
    from robonav.benchmark import policies
    from robonav.validation import check_integer

    if show or not method:
        print("\n".join(policies.methods()))
        return
    check_integer("worlds", worlds, at_least=1)
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
    print(
        f"{method}: {100 * rate:.1f} % of {worlds} worlds arrive (95 % interval {100 * low:.1f} to {100 * high:.1f}), "
        f"{result['outcomes']['collided']} collide, {result['outcomes']['out of steps']} run out of steps"
    )
    if json_file is not None:
        _write_json(json_file, result)


@app.command()
def leaderboard(
    method: Annotated[
        list[str] | None,
        typer.Argument(help="Methods by name, or files; by default all."),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder for results.")] = Path("results"),
    json_file: Annotated[
        Path | None,
        typer.Option("--json", help="Also write what each case came to here."),
    ] = None,
    scale: Annotated[
        str, typer.Option(help="quick, or thesis for all of the board's worlds.")
    ] = "thesis",
) -> None:
    """Put methods, your own in a file among them, on the board of all chapters' methods."""
    from robonav import experiments, progress
    from robonav.benchmark import method as known
    from robonav.benchmark import methods
    from robonav.experiments.leaderboard import board
    from robonav.experiments.runner.report import as_json, as_table

    names = method or methods()
    for name in names:
        known(name)
    _check_json(json_file)
    with progress.bar("leaderboard") as shown:
        results = experiments.reproduce(board(names), out, scale=scale, progress=shown)
    print(as_table(results, "success", rows="method", columns="setting"))
    if json_file is not None:
        _write_json(json_file, as_json([results]))


def _check_json(path: Path | None) -> None:
    """Say now what could not be written later."""
    from robonav.experiments.runner.results import check_writable

    if path is not None:
        if path.is_dir():
            raise ValueError(f"json must be a file to write, got the folder {path}")
        check_writable("json", path.parent)


def _write_json(path: Path, content: Any) -> None:
    from robonav import atomic

    with atomic.atomic_write(path) as file:
        file.write((json.dumps(content, indent=2) + "\n").encode())


def _tell(course: Any, grade: dict[str, Any], *, everything: bool) -> None:
    """A grade for its student to read; exercises not yet begun in one line, unless asked for."""
    for entry in grade["exercises"]:
        exercise = course.exercises[entry["id"]]
        print(
            f"{entry['id']} {exercise.title}: {_points(entry)} of {entry['max_points']} points"
        )
        if entry["state"] == "missing":
            print(
                f"  Not begun yet: write {exercise.name} in exercises/{exercise.file} or the notebook."
            )
        elif entry["state"] != "correct" or everything:
            print("\n".join(f"  {line}" for line in entry["feedback"].splitlines()))
    print(
        f"\nTogether {grade['points']} of {grade['max_points']} points, on the public cases."
    )
    if all(entry["state"] == "correct" for entry in grade["exercises"]):
        print(
            "Well done: marks are given on other cases of the same kind, so this should hold there too."
        )


def _points(entry: dict[str, Any]) -> str:
    return "?" if entry["points"] is None else f"{entry['points']:g}"
