"""The cache of compiled kernels: a change in one file of the core is seen by the kernels of the others."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import robonav

COUNT = """
from robonav.robot import make_world, sense, Simulator
import numpy as np
from robonav.robot import _fast
simulator = Simulator(make_world())
simulator.sense()
simulator.step(np.array([0]))
print(sum(sum(kernel.stats.cache_misses.values()) for kernel in (_fast.sense, _fast.step)))
print(sense(make_world(circles=[(60, 50, 2)]), [(50, 50, 0)]).ranges[0, 0])
"""


@pytest.mark.slow
def test_changed_geometry_compiles_sensing_and_motion_anew(tmp_path):
    shutil.copytree(
        Path(robonav.__file__).parent,
        tmp_path / "robonav",
        ignore=shutil.ignore_patterns("__pycache__", "results", "weights"),
    )
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    environment.pop("NUMBA_CACHE_DIR", None)

    def run() -> list[str]:
        done = subprocess.run(
            [sys.executable, "-c", COUNT],
            env=environment,
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=True,
        )
        return done.stdout.split()

    assert run() == ["2", "8.0"]
    assert run() == ["0", "8.0"]
    geometry = tmp_path / "robonav" / "robot" / "_fast" / "geometry.py"
    text = geometry.read_text()
    assert "distance * 1e6" in text
    geometry.write_text(text.replace("distance * 1e6", "(distance + 1.0) * 1e6"))
    assert run() == ["2", "9.0"]
