"""No process of the grader imports a module from a folder of submissions or from the current folder."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from robonav.grading import paths, sandbox, sandbox_check
from robonav.grading.classroom import GradingConfig, grade_class
from robonav.grading.course import Course

COURSE = Course.around(Path(__file__).parent)
ROBONAV = [sys.executable, "-c", "from robonav.cli import main; main()"]
# Modules that the processes of joblib and multiprocessing import when they start, and others that the grader imports.
NAMES = ("pickle", "numpy", "jinja2", "filelock", "json", "joblib", "typer", "tqdm")


@pytest.fixture
def trap(tmp_path):
    """A class of which every submission leaves a mark when it is imported, and the file with the marks."""
    marks, place = tmp_path / "marks", tmp_path / "class"
    place.mkdir()
    for name in NAMES:
        source = f"open({str(marks)!r}, 'a').write({name!r})\nimport os\nos._exit(3)\n"
        (place / f"{name}.py").write_text(source)
    (place / "anna").mkdir()
    (place / "anna/improve.py").write_text("raise ValueError")
    return place, marks


@pytest.mark.sandbox
@pytest.mark.parametrize("start", [".", "anna"])
def test_a_student_named_like_a_module_is_not_imported(trap, tmp_path, start):
    """With the current folder as the class, or as a student's folder, and joblib's processes."""
    if fault := sandbox_check.fault("official"):
        pytest.skip(fault)
    place, marks = trap
    code = (
        "import os, sys; sys.path[:] = [p for p in sys.path if p]\n"
        "from robonav.grading import classroom, sandbox_check\n"
        "from robonav.cli import main\n"
        "sys.path.insert(0, '')\n"  # as python -m has it
        "os.environ['PYTHONPATH'] += os.pathsep\n"  # for the processes started below
        "main()"
    )
    ran = subprocess.run(
        [sys.executable, "-c", code, "grade", str(place), "--exercise", "2.2"]
        + ["--jobs", "2", "--out", str(tmp_path / "out")],
        cwd=place / start,
        env={**os.environ, "PYTHONPATH": str(paths.PACKAGE)},
        capture_output=True,
        text=True,
    )
    assert not marks.exists(), marks.read_text()
    assert ran.returncode == 0, ran.stderr
    assert len(list((tmp_path / "out/students").iterdir())) == len(NAMES) + 1


def test_the_path_is_as_before_when_the_class_is_graded(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", f"{os.pathsep}{tmp_path}{os.pathsep}/elsewhere")
    monkeypatch.delenv("PYTHONSAFEPATH", raising=False)
    monkeypatch.syspath_prepend("")
    monkeypatch.syspath_prepend(str(tmp_path / "anna"))
    before = list(sys.path)
    with paths.without_submissions(tmp_path):
        assert os.environ["PYTHONSAFEPATH"] == "1"
        assert os.environ["PYTHONPATH"] == "/elsewhere"
        assert not {"", str(tmp_path / "anna")} & set(sys.path)
        code = "import sys; print(sys.path)"
        shown = subprocess.run(
            [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True
        )
        assert str(tmp_path) not in shown.stdout
        assert "''" not in shown.stdout
    assert sys.path == before
    assert "PYTHONSAFEPATH" not in os.environ


def test_a_dask_worker_that_could_import_a_submission_is_refused(tmp_path, monkeypatch):
    distributed = pytest.importorskip("distributed")
    (tmp_path / "class/anna").mkdir(parents=True)
    with distributed.LocalCluster(
        1, threads_per_worker=1, processes=False, dashboard_address=":0"
    ) as cluster:
        monkeypatch.setattr(paths, "unsafe_here", lambda folder: [folder])
        with pytest.raises(ValueError, match="PYTHONSAFEPATH=1, in another folder"):
            grade_class(
                GradingConfig(COURSE, "practice"),
                tmp_path / "class",
                tmp_path / "out",
                scheduler=cluster.scheduler_address,
            )


def test_a_worker_that_may_import_a_submission_says_so(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "path", [str(paths.PACKAGE), str(tmp_path / "anna")])
    assert paths.unsafe_here(str(tmp_path)) == [str(tmp_path / "anna")]
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [str(paths.PACKAGE), ""])
    assert paths.unsafe_here("/elsewhere") == [""]


def test_tests_among_the_submissions_are_not_run(tmp_path):
    """They run outside the sandbox, and a student may be called ``tests``."""
    (tmp_path / "tests/exercises").mkdir(parents=True)
    (tmp_path / "tests/exercises/manifest.toml").write_text("")
    config = GradingConfig(Course(tmp_path), "practice")
    with pytest.raises(ValueError, match="lie in the folder of submissions"):
        grade_class(config, tmp_path, tmp_path.parent / "out")


def test_bubblewrap_is_not_looked_for_in_the_current_folder(tmp_path, monkeypatch):
    program = tmp_path / "bwrap"
    program.write_text("")
    program.chmod(0o755)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", f".{os.pathsep}{os.pathsep}nothing")
    sandbox._bwrap.cache_clear()
    with pytest.raises(OSError, match="bubblewrap is not installed"):
        sandbox._bwrap()
    sandbox._bwrap.cache_clear()
