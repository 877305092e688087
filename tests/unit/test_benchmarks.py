"""The benchmarks can be started, and the page of them runs each."""

from __future__ import annotations

import ast
import importlib
import json
import runpy
import subprocess
import sys
from pathlib import Path

import gymnasium
import pytest

FOLDER = Path(__file__).parents[2] / "benchmarks"
SCRIPTS = sorted(path for path in FOLDER.glob("*.py"))
ELSEWHERE = {"quantecon"}
"""Of an extra that the tests do not need."""


def imports(script: Path) -> list[tuple[str, str]]:
    """The modules that a script imports anywhere, and the names out of them."""
    tree = ast.parse(script.read_text("utf-8"))
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            found += [(node.module, alias.name) for alias in node.names]
        elif isinstance(node, ast.Import):
            found += [(alias.name, "") for alias in node.names]
    return found


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_what_a_benchmark_imports_is_there(script):
    for module, name in imports(script):
        if module.split(".")[0] in ELSEWHERE or (FOLDER / f"{module}.py").is_file():
            continue
        there = importlib.import_module(module)
        if name and not hasattr(there, name):
            importlib.import_module(f"{module}.{name}")


def page() -> dict[str, object]:
    return runpy.run_path(str(FOLDER / "page.py"))


def test_the_page_runs_every_benchmark():
    names = {script for script, *_ in page()["SCRIPTS"].values()}
    others = {
        "growth.py",  # the page draws its numbers
        "open_tasks.py",  # its numbers stand beside the exercises
        "page.py",
        "peer_process.py",  # others run their peers with it
        "question_banks.py",  # it needs two programs of others
        "timing.py",  # others time with it
        "similarity.py",  # its numbers stand on the page for instructors
        "variants.py",  # likewise
    }
    assert names | others == {path.name for path in SCRIPTS}


@pytest.mark.parametrize(
    ("code", "text"),
    [("print('3 s')", "3 s"), ("print('9 s'); raise SystemExit(1)", "9 s")],
)
def test_a_benchmark_over_its_limit_is_on_the_page_too(tmp_path, code, text):
    (tmp_path / "some.py").write_text(code, "utf-8")
    assert page()["printed"](str(tmp_path / "some.py"), ()) == text


@pytest.mark.parametrize("code", ["import nowhere", "print(1); 1 / 0", "pass"])
def test_a_benchmark_that_fails_says_which(tmp_path, code):
    (tmp_path / "some.py").write_text(code, "utf-8")
    with pytest.raises(SystemExit, match=r"some\.py failed"):
        page()["printed"](str(tmp_path / "some.py"), ())


@pytest.mark.slow
def test_help_is_given_without_a_benchmark():
    asked = subprocess.run(
        [sys.executable, FOLDER / "page.py", "--help"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert "--peers" in asked.stdout


def test_the_page_has_the_committed_scores_of_gail():
    """The control lasts longest, and the ranges of the seeds of both programs overlap."""
    found = json.loads((FOLDER / "gail.json").read_text("utf-8"))
    text = (FOLDER.parent / "book/benchmarks.md").read_text("utf-8")
    *_, about = page()["SCRIPTS"]["Generative adversarial imitation learning"]
    assert f"\n{about} `benchmarks/gail.py`:" in text
    for name in ("ours", "ours, control", "imitation"):
        scores = found[name]["scores"]
        each = ", ".join(f"{score:.0f}" for score in scores)
        shown = f"{name:22} {sum(scores) / len(scores):5.0f} (seeds: {each})"
        assert shown in text
    ours, control, theirs = (
        found[name]["scores"] for name in ("ours", "ours, control", "imitation")
    )
    assert min(control) > max(ours)
    assert sum(control) > sum(theirs)
    assert min(theirs) < max(ours)


def test_the_expert_of_gail_keeps_the_pole_up(monkeypatch):
    monkeypatch.syspath_prepend(FOLDER)
    gail = runpy.run_path(str(FOLDER / "gail.py"))
    env = gymnasium.make(gail["TASK"])
    assert len(gail["episode"](env, gail["expert"], 0)) == 500


def test_the_instructors_page_says_how_long_a_variant_takes():
    result = json.loads((FOLDER / "variants.json").read_text("utf-8"))
    text = (FOLDER.parent / "book/instructors.md").read_text("utf-8")
    assert (
        f"takes {result['processor seconds']} seconds of processor time for each student "
        f"and all {result['exercises']} exercises (`benchmarks/variants.py`, "
        f"the median of {result['students']} students"
    ) in text
    manifest = (FOLDER.parent / "tests/exercises/manifest.toml").read_text("utf-8")
    assert result["exercises"] == manifest.count("[[exercise]]")
