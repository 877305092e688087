"""Files of runs and results. Each run is saved when it is finished.

A run is a small JSON file with a checksum of its numbers. A file with a wrong checksum is not used.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
import re
import sys
import tempfile
from collections.abc import Iterable, Mapping
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robonav import atomic
from robonav._version import __version__

from .dependencies import code_digest
from .experiment import Experiment, Results, Row

if TYPE_CHECKING:
    import pandas as pd

RESULTS = Path(__file__).parents[1] / "results"
"""The committed results of all experiments at the thesis's scale. The pages show them."""

FORMAT = "robonav results 1"


def check_writable(name: str, folder: str | Path) -> None:
    """Make the folder if it does not exist. Raise a ValueError with the name of the argument if it is not writable."""
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
    """Return the file of one run. Its name contains the :func:`cache_key`, which depends on code and settings."""
    runs = folder / ".runs" / experiment.name / f"{scale}-{cache_key(experiment)}"
    return runs / f"{case}-{seed}.json"


def save_run(path: Path, rows: Iterable[Row], seconds: float) -> None:
    """Write the rows of a finished run."""
    numbers = [tuple(row) for row in rows]
    content = {"sha256": _digest(numbers), "rows": numbers, "seconds": seconds}
    atomic.write_text(path, json.dumps(content))


def load_run(path: Path) -> tuple[list[Row], float] | None:
    """Return the rows of a finished run and its seconds, or None if there is no file or it is damaged."""
    try:
        content = json.loads(path.read_text("utf-8"))
        if content["sha256"] != _digest(content["rows"]):
            return None
        rows = [
            (case, seed, metric, step, value)
            for case, seed, metric, step, value in content["rows"]
        ]
        return rows, float(content["seconds"])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def save_results(folder: str | Path, results: Results) -> None:
    """Write ``NAME.csv``, with one number in each line, and ``NAME.json``, which describes how it was made.

    Parameters
    ----------
    folder : str or Path
        The folder to write in. It must exist.
    results : Results
        The numbers.

    Examples
    --------
    >>> import tempfile
    >>> baselines = read_results("baselines")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_results(folder, baselines)
    ...     load_results("baselines", folder).equals(load_results("baselines"))
    True
    """
    experiment, folder = results.experiment, Path(folder)
    content = _tidy(results).to_csv(index=False, lineterminator="\n").encode()
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
    text = json.dumps(about, indent=2, sort_keys=True) + "\n"
    atomic.write_text(folder / f"{experiment.name}.json", text)


def load_results(name: str, folder: str | Path = RESULTS) -> pd.DataFrame:
    """Read all numbers of an experiment as a tidy table.

    Parameters
    ----------
    name : str
        The name of an experiment, such as ``table-4.3``.
    folder : str or Path
        The folder to which :func:`reproduce` wrote; by default that of the committed results at the thesis's scale.

    Returns
    -------
    pandas.DataFrame
        One number in each line. The first columns are the settings that the experiment varies (``method``,
        ``obstacles``, ...). The last four are ``seed`` (the run), ``metric`` (such as ``success``, in per cent),
        ``step`` (the position in a curve, 0 for a single number) and ``value``.

    Raises
    ------
    FileNotFoundError
        If the folder has no results of this name.
    ValueError
        If a file is damaged, or the two files do not belong together.

    Examples
    --------
    >>> table = load_results("baselines")
    >>> list(table.columns)
    ['method', 'obstacles', 'moving', 'speed', 'seed', 'metric', 'step', 'value']
    >>> success = table[(table.metric == "success") & (table.speed == 2.0) & (table.moving == 0)]
    >>> print(success.pivot_table(index="method", columns="obstacles", values="value").round().to_markdown())
    | method     |   10 |   20 |   30 |
    |:-----------|-----:|-----:|-----:|
    | freer-side |   99 |   90 |   71 |
    | straight   |   36 |   13 |    5 |
    """
    import pandas as pd

    path = Path(folder) / f"{name}.csv"
    try:
        content = path.read_bytes()
        description = path.with_suffix(".json").read_text("utf-8")
    except FileNotFoundError as error:
        raise FileNotFoundError(
            f"results of {name} must be in {path.parent}, but {Path(error.filename).name} is missing there: run "
            f"robonav reproduce {name}"
        ) from None
    try:
        about: Mapping[str, Any] = json.loads(description)
        whole = hashlib.sha256(content).hexdigest()
        if (about["format"], about["sha256"]) != (FORMAT, whole):
            raise ValueError
        return pd.read_csv(path, converters={"value": float}, keep_default_na=False)
    except (ValueError, KeyError, TypeError):
        raise ValueError(
            f"{path.name} must hold results of {name}, but is damaged or belongs to another experiment"
        ) from None


def read_results(experiment: Experiment | str, folder: str | Path = RESULTS) -> Results:
    """Read results together with their experiment, for plots and reports.

    Parameters
    ----------
    experiment : Experiment or str
        The experiment, or its name.
    folder : str or Path
        The folder of the results, as in :func:`load_results`.

    Returns
    -------
    Results
        The numbers of every case.

    Raises
    ------
    FileNotFoundError
        If the folder has no results of the experiment.
    ValueError
        If a file is damaged, or belongs to another experiment or to other cases.

    Examples
    --------
    >>> results = read_results("table-4.3")
    >>> results.experiment.cases[0], results.values("success", 0).shape
    ({'method': 'nnql'}, (50,))
    """
    if isinstance(experiment, str):
        from ..registry import experiment as registered

        experiment = registered(experiment)
    path = Path(folder) / f"{experiment.name}.json"
    table = load_results(experiment.name, folder)
    keys = list(experiment.cases[0])
    places = {
        tuple(str(value) for value in case.values()): place
        for place, case in enumerate(experiment.cases)
    }
    try:
        cases = [places[case] for case in zip(*(table[key].astype(str) for key in keys), strict=True)]  # fmt: skip
        frame = table.drop(columns=keys)
        frame.insert(0, "case", cases)
        return Results(experiment, json.loads(path.read_text("utf-8"))["scale"], frame)
    except KeyError:
        raise ValueError(
            f"{path.stem}.csv must hold results of {experiment.name}, but is damaged or belongs to another experiment"
        ) from None


def _tidy(results: Results) -> pd.DataFrame:
    """Return the table that is written, where each case's settings replace its number."""
    import pandas as pd

    frame, cases = results.frame, results.experiment.cases
    varied = {key: [cases[place][key] for place in frame["case"]] for key in cases[0]}
    return pd.concat(
        [pd.DataFrame(varied, dtype=object), frame.drop(columns="case").reset_index(drop=True)],
        axis=1,
    )  # fmt: skip


def save_timing(
    folder: Path, experiment: Experiment, spent: Mapping[str, float]
) -> None:
    """Write ``NAME.machine.json``: the times and the machine, which differ from run to run."""
    content = json.dumps(machine() | dict(spent), indent=2, sort_keys=True)
    atomic.write_text(folder / f"{experiment.name}.machine.json", content + "\n")


def machine() -> dict[str, Any]:
    """Return a description of the machine: processor, available cores, system, and versions of libraries."""
    told = Path("/proc/cpuinfo").read_text("utf-8") if sys.platform == "linux" else ""
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


def cache_key(experiment: Experiment) -> str:
    """Return the key of an experiment's kept runs: a digest of the code of its runs, its cases and its settings."""
    cases = [dict(case) for case in experiment.cases]
    return _digest(
        [code_digest(experiment.run), cases, dict(experiment.settings)],
    )[:12]


def _digest(numbers: object) -> str:
    return hashlib.sha256(json.dumps(numbers).encode()).hexdigest()
