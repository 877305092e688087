"""Calls in several processes: all results, and no process that outlives the one that began it."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

from robonav.processes import in_processes

WORK = """
import os, time
from pathlib import Path
def work(folder, name):
    Path(folder, f"{name}-{os.getpid()}").touch()
    time.sleep(300)
"""


@pytest.mark.parametrize("jobs", [1, 2])
def test_every_result_comes_once(jobs: int) -> None:
    assert sorted(in_processes(pow, [(k, 2) for k in range(9)], jobs)) == [
        k * k for k in range(9)
    ]


def alive(pid: int) -> bool:
    with suppress(OSError):
        return (
            Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
        )
    return False


@pytest.mark.slow
def test_processes_end_when_their_parent_is_killed(tmp_path: Path) -> None:
    (tmp_path / "work.py").write_text(WORK)
    begun = tmp_path / "begun"
    begun.mkdir()
    code = (
        "from robonav.processes import in_processes; from work import work; "
        f"list(in_processes(work, [({str(begun)!r}, k) for k in range(2)], jobs=2))"
    )
    path = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    parent = subprocess.Popen(
        [sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": path}
    )
    while len(started := list(begun.iterdir())) < 2:
        assert parent.poll() is None
        time.sleep(0.05)
    parent.kill()
    parent.wait()
    pids = [int(file.name.partition("-")[2]) for file in started]
    assert len({*pids, parent.pid}) == 3
    until = time.monotonic() + 60
    while any(map(alive, pids)) and time.monotonic() < until:
        time.sleep(0.1)
    assert not any(map(alive, pids))
