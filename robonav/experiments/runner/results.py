"""Runs and results in files: a run that is finished stays, whatever happens to the next.

A run is a small JSON file with a checksum of its numbers; one that does not fit its checksum is as good as none.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
import platform
import re
import sys
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import astuple
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

from robonav import atomic
from robonav._version import __version__

from .experiment import Experiment, Results, Row

RESULTS = Path(__file__).parents[1] / "results"
"""What the experiments gave at the thesis's scale: the pages show it."""

FORMAT = "robonav results 1"
COMPUTING = ("mdp", "robot", "lfd", "nnql", "nirl", "experiments")
COLUMNS = ("seed", "metric", "step", "value")


def check_writable(name: str, folder: str | Path) -> None:
    """Make the folder, if need be; ValueError, naming the argument, where nothing can be written in it."""
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise ValueError(
            f"{name} must be in a folder to write in, got {folder}: {error.strerror}"
        ) from None


def run_file(
    folder: Path, experiment: Experiment, scale: str, case: int, seed: int
) -> Path:
    """Where one run is kept while its experiment is unfinished, and after."""
    return (
        folder
        / ".runs"
        / experiment.name
        / f"{scale}-{_identity(experiment)}"
        / f"{case}-{seed}.json"
    )


def save_run(path: Path, rows: Iterable[Row], seconds: float) -> None:
    """Keep the rows of a finished run."""
    numbers = [astuple(row) for row in rows]
    content = {"sha256": _digest(numbers), "rows": numbers, "seconds": seconds}
    with atomic.atomic_write(path) as file:
        file.write(json.dumps(content).encode())


def load_run(path: Path) -> tuple[list[Row], float] | None:
    """The rows of a finished run and its seconds; None if there is none, or its file is damaged."""
    try:
        content = json.loads(path.read_text())
        if content["sha256"] != _digest(content["rows"]):
            return None
        return [Row(*numbers) for numbers in content["rows"]], float(content["seconds"])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def save_results(folder: Path, results: Results) -> None:
    """Write ``NAME.csv``, one number a line, and ``NAME.json``, which says what made it."""
    experiment = results.experiment
    keys = list(experiment.cases[0])
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*keys, *COLUMNS])
    for row in results.rows:
        case = experiment.cases[row.case]
        writer.writerow(
            [
                *(case[key] for key in keys),
                row.seed,
                row.metric,
                row.step,
                repr(row.value),
            ]
        )
    content = text.getvalue().encode()
    about = {
        "format": FORMAT,
        "name": experiment.name,
        "title": experiment.title,
        "scale": results.scale,
        "seeds": experiment.seeds[results.scale],
        "settings": dict(experiment.settings),
        "version": __version__,
        "sha256": hashlib.sha256(content).hexdigest(),
    }
    with atomic.atomic_write(folder / f"{experiment.name}.csv") as file:
        file.write(content)
    with atomic.atomic_write(folder / f"{experiment.name}.json") as file:
        file.write((json.dumps(about, indent=2, sort_keys=True) + "\n").encode())


def load_results(folder: Path, experiment: Experiment) -> Results:
    """Read what :func:`save_results` wrote.

    Raises
    ------
    FileNotFoundError : if there is nothing.
    ValueError : if a file is damaged, or they do not belong together or to the experiment.
    """
    path = folder / f"{experiment.name}.csv"
    content = path.read_bytes()
    try:
        about: Mapping[str, Any] = json.loads(
            (folder / f"{experiment.name}.json").read_text()
        )
        fits = (
            about["format"] == FORMAT
            and about["sha256"] == hashlib.sha256(content).hexdigest()
        )
        if not fits:
            raise ValueError
        places = {
            tuple(str(v) for v in case.values()): place
            for place, case in enumerate(experiment.cases)
        }
        lines = list(csv.reader(io.StringIO(content.decode())))[1:]
        rows = tuple(
            Row(
                places[tuple(line[:-4])],
                int(line[-4]),
                line[-3],
                int(line[-2]),
                float(line[-1]),
            )
            for line in lines
        )
        return Results(experiment, about["scale"], rows)
    except (ValueError, KeyError, TypeError):
        raise ValueError(
            f"{path.name} must hold results of {experiment.name}, but is damaged or of another"
        ) from None


def save_timing(
    folder: Path, experiment: Experiment, spent: Mapping[str, float]
) -> None:
    """Write ``NAME.machine.json``: what no other machine will repeat."""
    with atomic.atomic_write(folder / f"{experiment.name}.machine.json") as file:
        file.write(
            (
                json.dumps(machine() | dict(spent), indent=2, sort_keys=True) + "\n"
            ).encode()
        )


def machine() -> dict[str, Any]:
    """What this process runs on: processor, cores it may use, system, and the libraries that compute."""
    told = Path("/proc/cpuinfo").read_text() if sys.platform == "linux" else ""
    named = re.search(r"model name\s*: (.+)", told)
    return {
        "machine": platform.machine(),
        "processor": named[1] if named else platform.processor(),
        "cores": len(os.sched_getaffinity(0))
        if hasattr(os, "sched_getaffinity")
        else os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
        "libraries": {
            name: metadata.version(name)
            for name in ("numpy", "scipy", "numba", "torch")
        },
    }


@cache
def code() -> str:
    """SHA-256 of the package's code that computes."""
    root = Path(__file__).parents[2]
    digest = hashlib.sha256()
    for path in sorted(
        path for part in COMPUTING for path in (root / part).rglob("*.py")
    ):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def _digest(numbers: object) -> str:
    return hashlib.sha256(json.dumps(numbers).encode()).hexdigest()


def _identity(experiment: Experiment) -> str:
    """What a kept run hangs on besides its case and seed: with other code or other settings it is another run."""
    cases = [dict(case) for case in experiment.cases]
    return _digest([code(), cases, dict(experiment.settings)])[:12]
