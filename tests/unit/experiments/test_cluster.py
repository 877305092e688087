"""A Dask cluster of two workers: the same bytes as without one, also when a worker dies."""

import dataclasses
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from robonav.experiments import experiment, read_results, reproduce

pytestmark = [pytest.mark.slow, pytest.mark.long]

REAL = ("table-3.3", "figure-4.4", "figure-5.8")
"""One of each chapter: a network fitted by L-BFGS, networks trained step by step, and a reward learned."""

KILLED = """
    import os, signal, sys, time
    import dask, numpy as np
    from dask.distributed import LocalCluster
    from robonav.errors import WorkerLost
    from robonav.experiments import Experiment, reproduce

    def slow(case, seed, scale):
        time.sleep(0.2)
        return {"value": np.random.default_rng([seed, case["n"]]).random(4)}

    def deadly(case, seed, scale):
        os.kill(os.getpid(), signal.SIGKILL)

    cases, seeds = [{"n": 1}, {"n": 2}], {"quick": 10, "thesis": 10}

    if __name__ == "__main__":
        folder = sys.argv[1]
        experiment = Experiment("slow", "Slow", cases, slow, seeds)
        reproduce(experiment, f"{folder}/here", jobs=1)
        # A busy machine may not start a third and a fourth worker within the time that Dask allows.
        dask.config.set({"distributed.scheduler.allowed-failures": 1})
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster:
            victim = next(iter(cluster.workers.values())).pid
            killed = []

            def progress(done, total):
                if done == 5 and not killed:
                    killed.append(os.kill(victim, signal.SIGKILL))

            there = {"backend": "dask", "scheduler": cluster.scheduler_address}
            reproduce(experiment, f"{folder}/there", progress=progress, **there)
            assert killed, "no worker was killed"
            try:
                reproduce(Experiment("deadly", "Deadly", cases[:1], deadly, {"quick": 1, "thesis": 1}), folder, **there)
            except WorkerLost as error:
                print(error)
"""

REPRODUCED = """
    import dataclasses, sys
    from dask.distributed import LocalCluster
    from robonav.experiments import experiment, reproduce

    if __name__ == "__main__":
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster:
            for name in sys.argv[2:]:
                known = experiment(name)
                once = {**known.seeds, "quick": 1}
                short = dataclasses.replace(known, cases=known.cases[:2], seeds=once, thesis={})
                reproduce(short, sys.argv[1], backend="dask", scheduler=cluster.scheduler_address)
"""


def short(name):
    """An experiment with its first two cases, which two workers share, and its first seed."""
    known = experiment(name)
    once = {**known.seeds, "quick": 1}
    return dataclasses.replace(known, cases=known.cases[:2], seeds=once, thesis={})


def results(folder):
    return {
        p.name: p.read_bytes()
        for p in Path(folder).iterdir()
        if p.is_file() and ".machine." not in p.name
    }


def run(script, *arguments, folder):
    path = folder / "on_a_cluster.py"
    path.write_text(textwrap.dedent(script))
    done = subprocess.run(
        [sys.executable, path, folder / "there", *arguments],
        capture_output=True,
        text=True,
        timeout=400,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    return done.stdout


def test_a_cluster_with_a_dying_worker_gives_the_same_bytes(tmp_path):
    said = run(KILLED, folder=tmp_path)
    here, there = (
        results(tmp_path / "there" / "here"),
        results(tmp_path / "there" / "there"),
    )
    assert set(here) == {"slow.csv", "slow.json"}
    assert here == there
    assert (
        "a run of deadly killed every worker that did it, perhaps because memory ran out"
        in said
    )


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    folder = tmp_path_factory.mktemp("alone")
    for name in REAL:
        reproduce(short(name), folder, jobs=1)
    return folder


def test_two_workers_give_the_same_bytes(tmp_path, alone):
    for name in REAL:
        reproduce(short(name), tmp_path, jobs=2)
    assert results(tmp_path) == results(alone)


def test_a_cluster_gives_the_same_bytes(tmp_path, alone):
    run(REPRODUCED, *REAL, folder=tmp_path)
    assert results(tmp_path / "there") == results(alone)


@pytest.mark.parametrize("name", REAL[1:])
def test_the_first_seeds_are_those_of_the_committed_results(name, alone):
    """What does not depend on the number of episodes is the same on this machine, except for the last digits."""
    known = experiment(name)
    quick, committed = read_results(known, alone), read_results(known)
    for case in range(len(known.cases)):
        for metric in quick.metrics(case):
            again = quick.values(metric, case)
            assert committed.values(metric, case)[: len(again)] == pytest.approx(
                again, rel=1e-3
            ), metric
