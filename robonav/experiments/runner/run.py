"""Run experiments on this machine's cores or on a cluster; an interrupted experiment resumes with the same numbers."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import BrokenExecutor
from pathlib import Path

from robonav.errors import WorkerLost
from robonav.processes import in_processes
from robonav.progress import Progress
from robonav.validation import check_one_of

from .dependencies import code_digest
from .experiment import SCALES, Experiment, Results, Row, rows_of
from .results import (
    check_writable,
    load_run,
    run_file,
    save_results,
    save_run,
    save_timing,
)

BACKENDS = ("joblib", "dask")
RETRIES = 3  # how often worker processes may die
ANSWER = 10  # seconds that a scheduler has to answer

Unit = tuple[int, int]  # case, seed
Done = tuple[Unit, list[Row], float]


def reproduce(
    experiment: Experiment,
    out: str | Path,
    *,
    scale: str = "quick",
    backend: str = "joblib",
    scheduler: str | None = None,
    jobs: int = -1,
    progress: Progress | None = None,
) -> Results:
    """Run an experiment, and write ``NAME.csv``, ``NAME.json`` and ``NAME.machine.json``.

    Finished runs are kept in ``out/.runs``, so an interrupted experiment resumes. The numbers depend neither on the
    backend, nor on the number of workers, nor on interruptions.

    Parameters
    ----------
    experiment : Experiment
        What to run.
    out : str or Path
        The folder for the results.
    scale : str
        "quick" or "thesis".
    backend : str
        "joblib" runs on this machine, "dask" on a cluster.
    scheduler : str or None
        The address of a Dask scheduler; only for the backend "dask".
    jobs : int
        The number of processes on this machine; -1 means one process a core.
    progress : callable or None
        A function that is called with the number of finished runs and the number of all runs.

    Returns
    -------
    Results
        All numbers.

    Raises
    ------
    ValueError
        If the scale or backend is unknown, ``jobs`` is 0, no scheduler answers, a scheduler is given without dask,
        a worker has other code than this process, or the folder is not writable.
    WorkerLost
        If worker processes die more than three times. Finished runs are kept.

    Examples
    --------
    >>> import tempfile
    >>> dice = Experiment("dice", "Dice", [{"sides": 6}], lambda case, seed, scale: {"throw": seed + 1},
    ...                   {"quick": 3, "thesis": 6})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     reproduce(dice, folder, jobs=1).values("throw", 0)
    array([1., 2., 3.])
    """
    _check_settings(scale, backend, scheduler, jobs)
    check_writable("out", out)
    folder, began = Path(out), time.perf_counter()
    units = _units(experiment, scale)
    finished = _finished(experiment, units, scale, folder)
    waiting = [unit for unit in units if unit not in finished]
    report = progress or (lambda done, total: None)
    report(len(finished), len(units))
    for unit, rows, seconds in (
        _on_cluster(experiment, waiting, scale, scheduler)
        if scheduler
        else _here(experiment, waiting, scale, jobs)
    ):
        save_run(run_file(folder, experiment, scale, *unit), rows, seconds)
        finished[unit] = rows, seconds
        report(len(finished), len(units))
    rows = [row for unit in units for row in finished[unit][0]]
    results = Results.from_rows(experiment, scale, rows)
    save_results(folder, results)
    times = {
        "runs": len(units),
        "processor seconds in all runs": sum(
            seconds for _, seconds in finished.values()
        ),
        "runs since the last start": len(waiting),
        "seconds since the last start": time.perf_counter() - began,
    }
    save_timing(folder, experiment, times)
    return results


def _check_settings(scale: str, backend: str, scheduler: str | None, jobs: int) -> None:
    """Check that the settings of :func:`reproduce` are known and fit each other."""
    check_one_of("scale", scale, SCALES)
    check_one_of("backend", backend, BACKENDS)
    if backend == "dask" and scheduler is None:
        raise ValueError(
            "scheduler must be the address of a Dask scheduler, such as tcp://host:8786, got none"
        )
    if backend != "dask" and scheduler is not None:
        raise ValueError(
            f"scheduler must come with backend dask, got {scheduler} with backend {backend}"
        )
    if jobs == 0:
        raise ValueError(
            "jobs must be a number of processes, or -1 for one process for each core, got 0"
        )


def _units(experiment: Experiment, scale: str) -> list[Unit]:
    """All runs of an experiment: every case with every seed."""
    seeds = range(experiment.seeds[scale])
    return [(case, seed) for case in range(len(experiment.cases)) for seed in seeds]


def _finished(
    experiment: Experiment, units: Sequence[Unit], scale: str, folder: Path
) -> dict[Unit, tuple[list[Row], float]]:
    """The rows and processor seconds of the runs that are already in the folder."""
    kept = {
        unit: load_run(run_file(folder, experiment, scale, *unit)) for unit in units
    }
    return {unit: run for unit, run in kept.items() if run is not None}


def run_unit(experiment: Experiment, unit: Unit, scale: str) -> Done:
    """Do one run and return its rows and processor seconds.

    The run has one thread, so that the order of additions does not depend on the number of cores.
    """
    from threadpoolctl import threadpool_limits

    case, seed = unit
    began = time.process_time()
    torch = sys.modules.get("torch")
    threads = torch.get_num_threads() if torch else 0
    with threadpool_limits(1):
        if torch:
            torch.set_num_threads(1)
        try:
            numbers = experiment.run(experiment.cases[case], seed, scale)
        finally:
            if torch:
                torch.set_num_threads(threads)
    return unit, rows_of(case, seed, numbers), time.process_time() - began


def _here(
    experiment: Experiment, units: Sequence[Unit], scale: str, jobs: int
) -> Iterator[Done]:
    """Do runs on this machine, and yield them in the order in which they finish.

    If a process dies, the unfinished runs start again.
    """
    waiting, deaths = dict.fromkeys(units), 0
    while waiting:
        calls = [(experiment, unit, scale) for unit in waiting]
        try:
            for done in in_processes(run_unit, calls, jobs):
                del waiting[done[0]]
                yield done
        except BrokenExecutor:
            deaths += 1
            if deaths > RETRIES:
                raise WorkerLost(
                    f"{experiment.name} lost {deaths} processes, perhaps because memory ran out: finished runs are "
                    "kept, start again with fewer jobs"
                ) from None


def _on_cluster(
    experiment: Experiment, units: Sequence[Unit], scale: str, scheduler: str | None
) -> Iterator[Done]:
    """Do runs on a Dask cluster, and yield them in the order in which they finish.

    If a worker dies, another worker does its run.
    """
    from dask.distributed import Client, KilledWorker, as_completed

    try:
        client = Client(scheduler, timeout=ANSWER)
    except (OSError, ValueError) as error:
        raise ValueError(
            f"scheduler must be the address of one that answers, got {scheduler}: {error}"
        ) from None
    with client:
        futures = [
            client.submit(
                _on_worker,
                experiment,
                unit,
                scale,
                code_digest(experiment.run),
                pure=False,
            )
            for unit in units
        ]
        try:
            for future in as_completed(futures):
                yield future.result()
        except KilledWorker:
            raise WorkerLost(
                f"a run of {experiment.name} killed every worker that did it, perhaps because memory ran out: finished "
                "runs are kept, start again with workers that have more memory"
            ) from None


def _on_worker(experiment: Experiment, unit: Unit, scale: str, wanted: str) -> Done:
    """Do one run on a worker. Raise a ValueError if the worker has another version of the package."""
    if code_digest(experiment.run) != wanted:
        raise ValueError(
            "workers must have the same robonav as the command, but one has another: install the same version there"
        )
    return run_unit(experiment, unit, scale)
