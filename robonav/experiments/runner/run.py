"""Run experiments on this machine's cores or on a cluster; an interrupted experiment resumes with the same numbers."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import BrokenExecutor
from pathlib import Path

from robonav.errors import WorkerLost
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
RETRIES = 3
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
        "joblib" for this machine, "dask" for a cluster.
    scheduler : str or None
        The address of a Dask scheduler, with backend "dask" alone.
    jobs : int
        The number of processes on this machine; -1 for one a core.
    progress : callable or None
        Called with the number of finished runs and of all runs.

    Returns
    -------
    Results
        All numbers.

    Raises
    ------
    ValueError
        For an unknown scale or backend, zero processes, dask without a scheduler that answers, a scheduler without
        dask, workers with other code than this process, or a folder that cannot be written in.
    WorkerLost
        If worker processes die again and again. Finished runs are kept.

    Examples
    --------
    >>> import tempfile
    >>> dice = Experiment("dice", "Dice", [{"sides": 6}], lambda case, seed, scale: {"throw": seed + 1},
    ...                   {"quick": 3, "thesis": 6})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     reproduce(dice, folder, jobs=1).values("throw", 0)
    array([1., 2., 3.])
    """
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
            "jobs must be a number of processes, or -1 for one a core, got 0"
        )
    check_writable("out", out)
    folder = Path(out)
    units = [
        (case, seed)
        for case in range(len(experiment.cases))
        for seed in range(experiment.seeds[scale])
    ]
    kept = {
        unit: load_run(run_file(folder, experiment, scale, *unit)) for unit in units
    }
    finished = {unit: run for unit, run in kept.items() if run is not None}
    waiting = [unit for unit in units if unit not in finished]
    began = time.perf_counter()
    if progress is not None:
        progress(len(finished), len(units))
    done = (
        _on_cluster(experiment, waiting, scale, scheduler)
        if scheduler
        else _here(experiment, waiting, scale, jobs)
    )
    for unit, rows, seconds in done:
        save_run(run_file(folder, experiment, scale, *unit), rows, seconds)
        finished[unit] = rows, seconds
        if progress is not None:
            progress(len(finished), len(units))
    rows = [row for unit in units for row in finished[unit][0]]
    results = Results.from_rows(experiment, scale, rows)
    save_results(folder, results)
    spent = {
        "runs": len(units),
        "processor seconds in all runs": sum(
            seconds for _, seconds in finished.values()
        ),
    }
    clock = {
        "runs since the last start": len(waiting),
        "seconds since the last start": time.perf_counter() - began,
    }
    save_timing(folder, experiment, spent | clock)
    return results


def run_unit(experiment: Experiment, unit: Unit, scale: str) -> Done:
    """The rows of one run, and its processor seconds. It has one thread, so that sums do not depend on the cores."""
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
    """Runs on this machine, in the order in which they finish. If a process dies, its run starts again."""
    from joblib import Parallel, delayed

    waiting, deaths = dict.fromkeys(units), 0
    while waiting:
        work = [delayed(run_unit)(experiment, unit, scale) for unit in waiting]
        try:
            for done in Parallel(n_jobs=jobs, return_as="generator_unordered")(work):
                del waiting[done[0]]
                yield done
        except BrokenExecutor:
            deaths += 1
            if deaths > RETRIES:
                raise WorkerLost(f"{experiment.name} lost {deaths} processes, perhaps for want of memory: "
                                 "what is finished stays, go on with fewer jobs") from None  # fmt: skip


def _on_cluster(
    experiment: Experiment, units: Sequence[Unit], scale: str, scheduler: str | None
) -> Iterator[Done]:
    """Runs on a Dask cluster, in the order in which they finish. If a worker dies, another one does its run."""
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
            raise WorkerLost(f"a run of {experiment.name} killed every worker that did it, perhaps for want of memory: "
                             "what is finished stays, go on with workers that have more") from None  # fmt: skip


def _on_worker(experiment: Experiment, unit: Unit, scale: str, wanted: str) -> Done:
    """One run on a worker; ValueError if the worker has another version of the package."""
    if code_digest(experiment.run) != wanted:
        raise ValueError(
            "workers must have the same robonav as the command, but one has another: install it anew there"
        )
    return run_unit(experiment, unit, scale)
