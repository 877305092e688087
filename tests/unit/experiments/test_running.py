"""Same numbers whatever the backend, the workers and the interruptions."""

import importlib
import json
import os
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from robonav.errors import WorkerLost
from robonav.experiments import (
    Experiment,
    Plot,
    experiment,
    load_results,
    names,
    read_results,
    reproduce,
)
from robonav.experiments.runner.dependencies import (
    PACKAGE,
    _file_of,
    code_digest,
    dependencies,
)
from robonav.experiments.runner.results import load_run, run_file
from robonav.experiments.runner.run import _on_worker


def roll(case, seed, scale):
    rng = np.random.default_rng([seed, case["sides"]])
    return {
        "throws": rng.integers(1, case["sides"] + 1, 5).astype(float),
        "mean": rng.random() / 3,
    }


def toy(run=roll, **changes):
    settings = {
        "name": "toy",
        "title": "Dice",
        "cases": [
            {"sides": 6, "kind": "plain"},
            {"sides": 20, "kind": "odd, and quoted"},
        ],
        "run": run,
        "seeds": {"quick": 4, "thesis": 40},
    }
    return Experiment(**settings | changes)


def content(folder):
    return {
        p.name: p.read_bytes()
        for p in Path(folder).iterdir()
        if p.is_file() and ".machine." not in p.name
    }


def test_results_read_back(tmp_path):
    results = reproduce(toy(), tmp_path, jobs=1)
    assert set(content(tmp_path)) == {"toy.csv", "toy.json"}
    back = read_results(toy(), tmp_path)
    pd.testing.assert_frame_equal(back.frame, results.frame)
    assert list(load_results("toy", tmp_path).columns) == [
        "sides",
        "kind",
        "seed",
        "metric",
        "step",
        "value",
    ]
    assert results.values("throws", 1).shape == (4, 5)
    assert results.values("mean", 0).shape == (4,)
    np.testing.assert_array_equal(
        results.values("throws", 1)[2], roll({"sides": 20}, 2, "quick")["throws"]
    )


@pytest.mark.slow
def test_workers_do_not_change_a_byte(tmp_path):
    for jobs in (1, 2):
        reproduce(toy(), tmp_path / str(jobs), jobs=jobs)
    assert content(tmp_path / "1") == content(tmp_path / "2")


def test_progress_counts_every_run(tmp_path):
    seen = []
    reproduce(
        toy(), tmp_path, jobs=1, progress=lambda done, total: seen.append((done, total))
    )
    assert seen == [(done, 8) for done in range(9)]


def test_finished_runs_are_not_run_again(tmp_path):
    reproduce(toy(), tmp_path, jobs=1)
    before = content(tmp_path)

    def never(case, seed, scale):
        raise AssertionError("run again")

    reproduce(toy(never), tmp_path, jobs=1)
    assert content(tmp_path) == before


@pytest.mark.parametrize(
    "damage",
    [b"", b"{", b'{"rows": [], "sha256": "0", "seconds": 1}', "truncate", "digit"],
)
def test_a_damaged_run_is_noticed_and_run_again(tmp_path, damage):
    reproduce(toy(), tmp_path, jobs=1)
    before = content(tmp_path)
    path = run_file(tmp_path, toy(), "quick", 1, 2)
    whole = path.read_bytes()
    at = whole.index(b"0.")
    broken = {
        "truncate": whole[: len(whole) // 2],
        "digit": whole[: at + 3] + b"7" + whole[at + 4 :],
    }
    path.write_bytes(broken.get(damage, damage) if isinstance(damage, str) else damage)
    assert load_run(path) is None
    reproduce(toy(), tmp_path, jobs=1)
    assert content(tmp_path) == before


def test_other_settings_are_other_runs(tmp_path):
    reproduce(toy(), tmp_path, jobs=1)
    calls = []

    def counted(case, seed, scale):
        calls.append(seed)
        return roll(case, seed, scale)

    reproduce(toy(counted, settings={"worlds": 7}), tmp_path, jobs=1)
    assert len(calls) == 8


def test_damaged_results_are_refused_with_a_sentence(tmp_path):
    reproduce(toy(), tmp_path, jobs=1)
    path = tmp_path / "toy.csv"
    path.write_bytes(path.read_bytes().replace(b"mean", b"mode"))
    with pytest.raises(ValueError, match="must hold results of toy, but is damaged"):
        read_results(toy(), tmp_path)


@pytest.mark.parametrize("ending", ["csv", "json"])
def test_missing_results_are_one_sentence(tmp_path, ending):
    reproduce(toy(), tmp_path, jobs=1)
    (tmp_path / f"toy.{ending}").unlink()
    with pytest.raises(
        FileNotFoundError, match=f"but toy.{ending} is missing there: run robonav"
    ):
        load_results("toy", tmp_path)


@pytest.mark.slow
def test_a_killed_experiment_goes_on_where_it_was(tmp_path):
    """SIGKILL at several moments, then to the end: the same files as without."""
    script = tmp_path / "slow.py"
    script.write_text(
        textwrap.dedent("""
            import sys, time
            import numpy as np
            from robonav.experiments import Experiment, reproduce
            def slow(case, seed, scale):
                time.sleep(0.15)
                return {"value": np.random.default_rng([seed, case["n"]]).random(3)}
            slowly = Experiment("slow", "Slow", [{"n": 1}, {"n": 2}], slow, {"quick": 6, "thesis": 6})
            reproduce(slowly, sys.argv[1], jobs=1)
        """)
    )
    reference = subprocess.run(
        [sys.executable, script, tmp_path / "whole"], capture_output=True, text=True
    )
    assert reference.returncode == 0, reference.stderr
    cut = tmp_path / "cut"
    for number in range(3):
        started = subprocess.Popen([sys.executable, script, cut])
        deadline = time.monotonic() + 60
        while (
            len(list(cut.rglob("*-*.json"))) <= 2 * number
            and time.monotonic() < deadline
        ):
            time.sleep(0.02)
        os.kill(started.pid, signal.SIGKILL)
        started.wait()
        assert not (cut / "slow.csv").exists()
    kept = len(list(cut.rglob("*-*.json")))
    assert 3 <= kept < 12
    assert subprocess.run([sys.executable, script, cut]).returncode == 0
    assert content(cut) == content(tmp_path / "whole")


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"scale": "huge"}, "scale must be one of quick, thesis"),
        ({"backend": "ray"}, "backend must be one of joblib, dask"),
        ({"backend": "dask"}, "scheduler must be the address"),
        (
            {"scheduler": "tcp://127.0.0.1:8786"},
            "scheduler must come with backend dask",
        ),
        ({"jobs": 0}, "jobs must be a number of processes"),
    ],
)
def test_bad_settings_are_refused(tmp_path, settings, message):
    with pytest.raises(ValueError, match=message):
        reproduce(toy(), tmp_path, **settings)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_written_in_is_refused_before_any_run(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(ValueError, match="out must be in a folder to write in"):
        reproduce(toy(), tmp_path / "file" / "results", jobs=1)


@pytest.mark.slow
def test_a_process_that_dies_costs_its_run(tmp_path):
    """The first run kills its process once, as the system does when memory runs out."""

    def fragile(case, seed, scale):
        sign = tmp_path / "died"
        if (case["sides"], seed) == (6, 0) and not sign.exists():
            sign.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return roll(case, seed, scale)

    reproduce(toy(), tmp_path / "whole", jobs=1)
    reproduce(toy(fragile), tmp_path / "cut", jobs=2)
    assert (tmp_path / "died").exists()
    assert content(tmp_path / "cut") == content(tmp_path / "whole")


@pytest.mark.slow
def test_a_run_that_always_kills_its_process_is_one_sentence(tmp_path):
    def deadly(case, seed, scale):
        os.kill(os.getpid(), signal.SIGKILL)

    with pytest.raises(
        WorkerLost, match="toy lost 4 processes, perhaps because memory ran out"
    ):
        reproduce(toy(deadly), tmp_path, jobs=2)


def test_a_worker_with_other_code_is_refused():
    assert _on_worker(toy(), (0, 1), "quick", code_digest(roll))[0] == (0, 1)
    with pytest.raises(ValueError, match="workers must have the same robonav"):
        _on_worker(toy(), (0, 1), "quick", "another")


def test_a_run_kept_from_other_code_is_run_again(tmp_path, monkeypatch):
    before = run_file(tmp_path, toy(), "quick", 0, 0)
    monkeypatch.setattr(
        "robonav.experiments.runner.results.code_digest", lambda run: "another"
    )
    assert run_file(tmp_path, toy(), "quick", 0, 0) != before


def test_the_machine_is_told(tmp_path):
    reproduce(toy(), tmp_path, jobs=1)
    (run_file(tmp_path, toy(), "quick", 0, 0)).unlink()
    reproduce(toy(), tmp_path, jobs=1)
    told = json.loads((tmp_path / "toy.machine.json").read_text())
    assert told["cores"] >= 1
    assert told["processor"]
    assert set(told["libraries"]) == {"numpy", "scipy", "numba", "torch"}
    assert (told["runs"], told["runs since the last start"]) == (8, 1)
    assert told["seconds since the last start"] > 0


def test_a_scheduler_that_does_not_answer_is_one_sentence(tmp_path, monkeypatch):
    monkeypatch.setattr("robonav.experiments.runner.run.ANSWER", 0.5)
    with pytest.raises(
        ValueError, match="scheduler must be the address of one that answers, got tcp"
    ):
        reproduce(toy(), tmp_path, backend="dask", scheduler="tcp://127.0.0.1:1")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"cases": []}, "cases of toy must be at least one"),
        ({"cases": [{"a": 1}, {"b": 1}]}, "all with the same keys"),
        ({"cases": [{"step": 1}]}, "cases of toy must not have the keys case, seed"),
        ({"seeds": {"quick": 1}}, "seeds of toy must be given"),
        ({"thesis": {"mean": [1.0]}}, "thesis of toy must have one number a case"),
    ],
)
def test_experiments_that_make_no_sense_are_refused(changes, message):
    with pytest.raises(ValueError, match=message):
        toy(**changes)


def test_a_run_that_gives_no_number_is_refused(tmp_path):
    with pytest.raises(ValueError, match="mean must hold finite numbers"):
        reproduce(
            toy(lambda case, seed, scale: {"mean": float("nan")}), tmp_path, jobs=1
        )


def test_the_catalogue(tmp_path):
    assert "baselines" in names()
    with pytest.raises(ValueError, match="name must be all or one of"):
        experiment("table-9.9")
    for name in names():
        found = experiment(name)
        json.dumps([dict(case) for case in found.cases])
        json.dumps(dict(found.settings))


def test_a_run_depends_on_the_code_that_it_imports():
    known = {
        name: {path.relative_to(PACKAGE).as_posix() for path in files}
        for name, files in (
            (name, dependencies(_file_of(experiment(name).run.__module__)))
            for name in ("figure-3.8", "table-4.3")
        )
    }
    assert {"lfd/astar.py", "robot/_fast/geometry.py"} <= known["figure-3.8"]
    assert "experiments/chapter3/settings.toml" in known["figure-3.8"]
    assert not any(path.startswith("nirl/") for path in known["table-4.3"])
    assert "nnql/nnql.py" in known["table-4.3"]
    assert code_digest(experiment("figure-3.8").run) != code_digest(
        experiment("table-4.3").run
    )


@pytest.mark.parametrize("name", names())
def test_every_experiment_has_a_figure_or_a_reason(name):
    plot = experiment(name).plot
    if isinstance(plot, Plot):
        module, function = plot.function.split(".")
        assert callable(
            getattr(importlib.import_module(f"robonav.plots.{module}"), function)
        )
    else:
        assert len(plot.split()) > 3
