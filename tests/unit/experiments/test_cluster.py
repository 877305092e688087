"""A Dask cluster of two workers, one of them killed in the middle: the same bytes as without a cluster."""

import subprocess
import sys
import textwrap
from pathlib import Path

SCRIPT = """
    import os, signal, sys, time
    import numpy as np
    from dask.distributed import LocalCluster
    from robonav.experiments import Experiment, reproduce

    def slow(case, seed, scale):
        time.sleep(0.2)
        return {"value": np.random.default_rng([seed, case["n"]]).random(4)}

    experiment = Experiment("slow", "Slow", [{"n": 1}, {"n": 2}], slow, {"quick": 10, "thesis": 10})

    if __name__ == "__main__":
        folder = sys.argv[1]
        reproduce(experiment, f"{folder}/here", jobs=1)
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster:
            victim = next(iter(cluster.workers.values())).pid
            killed = []

            def progress(done, total):
                if done == 5 and not killed:
                    killed.append(os.kill(victim, signal.SIGKILL))

            address = cluster.scheduler_address
            reproduce(experiment, f"{folder}/there", backend="dask", scheduler=address, progress=progress)
            assert killed, "no worker was killed"
"""


def results(folder):
    return {p.name: p.read_bytes() for p in Path(folder).iterdir() if p.is_file() and ".machine." not in p.name}


def test_a_cluster_with_a_dying_worker_gives_the_same_bytes(tmp_path):
    script = tmp_path / "on_a_cluster.py"
    script.write_text(textwrap.dedent(SCRIPT))
    done = subprocess.run([sys.executable, script, tmp_path], capture_output=True, text=True, timeout=180, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    here, there = results(tmp_path / "here"), results(tmp_path / "there")
    assert set(here) == {"slow.csv", "slow.json"}
    assert here == there
