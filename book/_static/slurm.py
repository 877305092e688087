"""Run the experiments on a SLURM cluster. Start this on its login node.

It needs "robonav[cluster]" and dask-jobqueue.

python slurm.py all
"""

import subprocess
import sys

from dask_jobqueue import SLURMCluster

cluster = SLURMCluster(
    cores=16,  # of one job
    processes=16,  # runs at once in a job, each on one core
    memory="32GB",
    walltime="02:00:00",
    queue="short",  # the name of your partition
    job_script_prologue=["source robonav/.venv/bin/activate"],  # where you installed it
)
cluster.scale(jobs=8)
command = [
    "robonav",
    "reproduce",
    *sys.argv[1:],
    "--scale",
    "thesis",
    "--backend",
    "dask",
]
subprocess.run([*command, "--scheduler", cluster.scheduler_address], check=True)
