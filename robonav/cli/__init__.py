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

from .drill_commands import drills
from .exercise_commands import check, exercises

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
app.add_typer(exercises, name="exercises", rich_help_panel=TEACHING)
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


app.command(rich_help_panel=PRACTICE)(check)
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
    reflex: Annotated[
        str,
        typer.Option(
            help="What the robot's reflex knows of the direction of the target: its sector, or exact as in all tables."
        ),
    ] = "sector",
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
        reflex=reflex,
    )
    rate, (low, high) = result["success"], result["interval"]
    _print_beside(
        json_file,
        f"{method}: {100 * rate:.1f} % arrive in {counted(worlds, 'world')} (95 % interval {100 * low:.1f} to "
        f"{100 * high:.1f}), {result['outcomes']['collided']} collide, "
        f"{result['outcomes']['out of steps']} run out of steps; reflex: {reflex}",
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


app.registered_commands.sort(key=lambda command: PARTS.index(command.rich_help_panel))
