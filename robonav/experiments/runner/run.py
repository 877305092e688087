"""Running experiments: on this machine's cores or a cluster, cut and resumed, always with the same numbers."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import BrokenExecutor
from pathlib import Path

from robonav.errors import WorkerLost
from robonav.progress import Progress
from robonav.validation import check_one_of

from .experiment import SCALES, Experiment, Results, Row, rows_of
from .results import (
    check_writable,
    code,
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
    """Run what is not yet run, and write ``NAME.csv``, ``NAME.json`` and ``NAME.machine.json``.

    Finished runs stay in ``out/.runs``: an experiment that was cut goes on where it was. The numbers depend on neither
    backend nor number of workers nor interruptions.

    Parameters
    ----------
    out : folder for the results.
    scale : "quick" or "thesis".
    backend, scheduler : "joblib" for this machine, or "dask" with the address of a Dask scheduler.
    jobs : processes of joblib; -1 for one a core.
    progress : called with runs done and runs in all.

    Raises
    ------
    ValueError : for an unknown scale or backend, no processes, dask without a scheduler that answers or a scheduler
        without dask, workers with other code than this process, or a folder that cannot be written in.
    WorkerLost : if processes that work die again and again; what is finished stays.
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
    results = Results(
        experiment, scale, tuple(row for unit in units for row in finished[unit][0])
    )
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
    """One run, on one thread: sums come out the same however many cores there are. With it, its processor seconds."""
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
    """Runs on this machine, as they finish; after a process died, what is not finished is begun again."""
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
    """Runs on a Dask cluster, as they finish; a worker that dies has its run done again by another."""
    from dask.distributed import Client, KilledWorker, as_completed

    try:
        client = Client(scheduler, timeout=ANSWER)
    except (OSError, ValueError) as error:
        raise ValueError(
            f"scheduler must be the address of one that answers, got {scheduler}: {error}"
        ) from None
    with client:
        futures = [
            client.submit(_on_worker, experiment, unit, scale, code(), pure=False)
            for unit in units
        ]
        try:
            for future in as_completed(futures):
                yield future.result()
        except KilledWorker:
            raise WorkerLost(f"a run of {experiment.name} killed every worker that did it, perhaps for want of memory: "
                             "what is finished stays, go on with workers that have more") from None  # fmt: skip


def _on_worker(experiment: Experiment, unit: Unit, scale: str, wanted: str) -> Done:
    """A run on a machine that may have another version of the package."""
    if code() != wanted:
        raise ValueError(
            "workers must have the same robonav as the command, but one has another: install it anew there"
        )
    return run_unit(experiment, unit, scale)
