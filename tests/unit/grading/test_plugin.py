"""``pytest tests/exercises --submission ...`` as instructors and scripts run it."""

import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from robonav.grading import sandbox_check
from robonav.grading.build import code
from robonav.grading.classroom import GradingConfig, grade_submission
from robonav.grading.course import Course
from robonav.grading.reference import Recorder, solution
from robonav.grading.submission import read

pytestmark = pytest.mark.sandbox

COURSE = Course.around(Path(__file__).parent)
TESTS = str(COURSE.tests)
PASSES = (COURSE.solutions / "ch2/improve.py").read_text()


@pytest.fixture(scope="module", autouse=True)
def _official():
    if fault := sandbox_check.fault("official"):
        pytest.skip(fault)


def run(*arguments, folder, **environment):
    """The command's exit code, output, and the grade it wrote, if any."""
    grade = folder / "written.json"
    command = [
        sys.executable,
        "-m",
        "pytest",
        *map(str, arguments),
        "--grade-json",
        str(grade),
    ]
    done = subprocess.run(
        command,
        cwd=COURSE.root,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=120,
    )
    return (
        done.returncode,
        done.stdout + done.stderr,
        json.loads(grade.read_text()) if grade.is_file() else None,
    )


def submit(folder, **files):
    """A submission of these files of chapter 2."""
    for name, text in files.items():
        path = folder / "submission" / "ch2" / f"{name}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder / "submission"


def test_solutions_score_full_in_the_agreed_format(tmp_path):
    code, output, grade = run(TESTS, "--submission", COURSE.solutions, folder=tmp_path)
    assert code == 0
    assert list(grade) == [
        *("points", "max_points", "tier", "exercises"),
        *("files", "notes", "problems"),
    ]
    assert grade["tier"] == "official"
    assert (
        grade["points"]
        == grade["max_points"]
        == sum(e.points for e in COURSE.exercises.values())
    )
    assert [entry["id"] for entry in grade["exercises"]] == list(COURSE.exercises)
    assert all(
        list(entry) == ["id", "points", "max_points", "state", "feedback", "parts"]
        for entry in grade["exercises"]
    )
    assert {entry["state"] for entry in grade["exercises"]} == {"correct"}
    assert f"{grade['points']} of {grade['max_points']} points" in output


def test_stubs_score_nothing_and_are_named_missing(tmp_path):
    code, _, grade = run(TESTS, "--submission", COURSE.stubs, folder=tmp_path)
    assert code == 1
    assert grade["points"] == 0
    assert {entry["state"] for entry in grade["exercises"]} == {"missing"}
    assert len(grade["exercises"]) == len(COURSE.exercises)


@pytest.mark.parametrize(
    "choice",
    [
        ("-k", "improve"),
        ("-k", "2.2"),
        ("--exercise", "2.2"),
        ("--exercise", "improve"),
    ],
)
def test_one_exercise_alone(tmp_path, choice):
    code, _, grade = run(
        TESTS,
        "--submission",
        submit(tmp_path, improve=PASSES),
        *choice,
        folder=tmp_path,
    )
    assert code == 0
    assert [(entry["id"], entry["points"]) for entry in grade["exercises"]] == [
        ("2.2", 4)
    ]
    assert grade["max_points"] == 4


def test_some_parts_of_an_exercise_are_no_grade_of_it(tmp_path):
    _, _, grade = run(
        TESTS,
        "--submission",
        COURSE.solutions,
        "-k",
        "where_actions_tie and improve",
        folder=tmp_path,
    )
    (entry,) = grade["exercises"]
    assert (entry["points"], entry["state"]) == (None, "grader-fault")


def test_partial_credit_and_a_hint(tmp_path):
    greedy = PASSES.replace("> tolerance", "> 0")
    _, output, grade = run(
        TESTS,
        "--submission",
        submit(tmp_path, improve=greedy),
        "-k",
        "2.2",
        folder=tmp_path,
    )
    (entry,) = grade["exercises"]
    assert (entry["points"], entry["state"]) == (3, "partial")
    assert "Keep the current action where the gain is at most" in entry["feedback"]
    assert "Keep the current action where the gain is at most" in output


def test_the_class_runner_gives_the_same_grade(tmp_path):
    submission = submit(
        tmp_path,
        improve=PASSES.replace("> tolerance", "> 0"),
        bounds="import os\nos._exit(0)",
        track="",
    )
    _, _, grade = run(TESTS, "--submission", submission, folder=tmp_path)
    same = grade_submission(GradingConfig(COURSE, "official"), read(submission))
    del same["run"]  # what was run, for the log of a class
    assert grade == same


@pytest.mark.parametrize(
    "kind", ["zip", "zip in a folder", "notebook", "notebook beside stubs", "file"]
)
def test_every_kind_of_submission(tmp_path, kind):
    place = tmp_path / "handed in"
    place.mkdir()
    cells = [
        "%matplotlib inline\nimport seaborn",
        "1 / 0",
        code(PASSES),
        "improve(",
        "assert False",
        "!rm -rf /tmp/nothing",
    ]
    notebook = {
        "cells": [
            {"cell_type": "code", "source": cell.splitlines(True)} for cell in cells
        ]
    }
    match kind:
        case "zip" | "zip in a folder":
            with zipfile.ZipFile(place / "mine.zip", "w") as archive:
                archive.writestr("my work/exercises/ch2/improve.py", PASSES)
            submission = place / "mine.zip" if kind == "zip" else place
        case "notebook" | "notebook beside stubs":
            submission = place / "ch2.ipynb" if kind == "notebook" else place
            (place / "ch2.ipynb").write_text(json.dumps(notebook))
            if kind == "notebook beside stubs":
                shutil.copytree(COURSE.stubs / "ch2", place / "ch2")
        case "file":
            submission = place / "improve.py"
            submission.write_text(PASSES)
    _, output, grade = run(
        TESTS, "--submission", submission, "-k", "2.2", folder=tmp_path
    )
    assert grade["points"] == 4, output


def test_what_a_submission_brings_along_never_runs_here(tmp_path):
    """Configuration, plugins, packages and tests of the submission's own, tried from every side."""
    submission = submit(tmp_path, improve=PASSES)
    touch = f"open({str(tmp_path / 'ran')!r}, 'a').write(__file__ + '\\n')\n"
    for name in (
        "conftest.py",
        "sitecustomize.py",
        "usercustomize.py",
        "evil.py",
        "numpy/__init__.py",
        "pytest.py",
    ):
        (submission / name).parent.mkdir(exist_ok=True)
        (submission / name).write_text(touch)
    for name in (
        "robonav/__init__.py",
        "tests/exercises/test_ch2.py",
        "tests/exercises/conftest.py",
        "test_mine.py",
    ):
        (submission / name).parent.mkdir(parents=True, exist_ok=True)
        (submission / name).write_text(touch)
    shutil.copy(COURSE.tests / "manifest.toml", submission / "tests/exercises")
    (submission / "pytest.ini").write_text("[pytest]\npythonpath = .\naddopts = .\n")
    shutil.copy(submission / "pytest.ini", submission / "tests/exercises")
    # Not ("--submission", submission, TESTS): before any plugin is there to say that it is an option's value, pytest
    # takes the first path it sees for the tests and reads the pytest.ini there. The documentation puts the tests first.
    orders = [
        (TESTS, "--submission", submission),
        (f"--submission={submission}", TESTS),
    ]
    for order in orders:
        _, output, grade = run(
            *order, "-k", "2.2", folder=tmp_path, PYTEST_ADDOPTS="-q"
        )
        assert grade["points"] == 4, output
        assert not (tmp_path / "ran").exists(), (tmp_path / "ran").read_text()
    command = [
        str(Path(sys.executable).with_name("pytest")),
        TESTS,
        "--submission",
        ".",
        "-k",
        "2.2",
    ]
    done = subprocess.run(
        command, cwd=submission, capture_output=True, text=True, timeout=120
    )
    assert "4 of 4 points" in done.stdout, done.stdout + done.stderr
    assert not (tmp_path / "ran").exists(), (tmp_path / "ran").read_text()


def test_a_link_out_of_the_submission_is_not_followed(tmp_path):
    submission = submit(tmp_path, bounds="")
    (submission / "ch2/improve.py").symlink_to(COURSE.solutions / "ch2/improve.py")
    _, _, grade = run(TESTS, "--submission", submission, "-k", "2.2", folder=tmp_path)
    (entry,) = grade["exercises"]
    assert (entry["points"], entry["state"]) == (0, "missing")
    assert grade["problems"][0] == "ch2/improve.py is a link that leaves the submission"


@pytest.fixture(scope="module")
def crib():
    """A submission to 2.2 that knows all public cases by heart and leaks the others in every way it can think of."""
    recorder = Recorder(COURSE)
    known = {}

    def learn(*arguments):
        known[repr([getattr(a, "tolist", lambda a=a: a)() for a in arguments])] = (
            function(*arguments).tolist()
        )
        return function(*arguments)

    from robonav.grading.check import InProcessCalls, graded

    function = solution(COURSE, COURSE.named("2.2"))
    graded(COURSE, COURSE.named("2.2"), InProcessCalls(learn), recorder)
    return f"""
KNOWN = {known!r}
def improve(q, policy, tolerance):
    key = repr([q.tolist(), policy.tolist(), tolerance])
    if key in KNOWN:
        return KNOWN[key]
    if tolerance == 2:
        return {{key: 0}}
    if tolerance == 0:
        return [12345 + q[0][0]] * len(policy)
    kind = type(key, (ValueError,), {{}})
    exec(compile("def leak(kind, key): raise kind(key)", key, "exec"), globals())
    leak(kind, key)
"""


def test_answers_known_by_heart_fail_on_secret_cases_and_leak_none_of_them(
    tmp_path, crib
):
    secret = tmp_path / "secret"
    secret.write_text("not for students")
    submission = submit(tmp_path, improve=crib)
    _, _, public = run(TESTS, "--submission", submission, "-k", "2.2", folder=tmp_path)
    assert public["points"] == 4
    by_file = run(
        TESTS,
        "--submission",
        submission,
        "-k",
        "2.2",
        "--secret",
        secret,
        folder=tmp_path,
    )
    by_environment = run(
        TESTS,
        "--submission",
        submission,
        "-k",
        "2.2",
        folder=tmp_path,
        ROBONAV_SECRET="not for students",
    )
    other = run(
        TESTS,
        "--submission",
        submission,
        "-k",
        "2.2",
        folder=tmp_path,
        ROBONAV_SECRET="another",
    )
    assert by_file[2] == by_environment[2]
    for _, _, grade in (by_file, other):
        (entry,) = grade["exercises"]
        assert (entry["points"], entry["state"]) == (0, "error")
        under_secret = entry["feedback"].partition("On the public cases")[0]
        assert not [
            said for said in ("1234", "[", "expected", "line") if said in under_secret
        ]
        assert "all parts are right" in entry["feedback"]
        assert "not for students" not in entry["feedback"]


def test_honest_answers_score_full_on_secret_cases(tmp_path):
    _, _, grade = run(
        TESTS,
        "--submission",
        COURSE.solutions,
        folder=tmp_path,
        ROBONAV_SECRET="a word",
    )
    assert grade["points"] == grade["max_points"]


def test_no_marks_without_a_sandbox(tmp_path):
    code, output, grade = run(
        TESTS,
        "--submission",
        COURSE.solutions,
        "--tier",
        "practice",
        folder=tmp_path,
        ROBONAV_SECRET="a word",
    )
    assert code == pytest.ExitCode.USAGE_ERROR
    assert "no marks in the practice tier" in output
    assert grade is None


def test_practice_says_that_it_is_practice(tmp_path):
    _, output, grade = run(
        TESTS,
        "--submission",
        submit(tmp_path, improve=PASSES),
        "-k",
        "2.2",
        "--tier",
        "practice",
        folder=tmp_path,
    )
    assert (grade["tier"], grade["points"]) == ("practice", 4)
    assert "practice" in output


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (
            ("--submission", "/nowhere"),
            "must be a folder, a zip, a notebook or a Python file",
        ),
        (("--submission", ".", "--secret", "/nowhere"), "the secret cannot be read"),
        (("--submission", ".", "--exercise", "9.9"), "no exercise '9.9'"),
    ],
)
def test_a_wrong_argument_is_one_clear_line_and_leaves_no_old_grade(
    tmp_path, arguments, sentence
):
    (tmp_path / "written.json").write_text("{}")
    code, output, grade = run(TESTS, *arguments, folder=tmp_path)
    assert code == pytest.ExitCode.USAGE_ERROR
    assert sentence in output
    assert "Traceback" not in output
    assert grade is None


def test_a_fault_of_the_grader_is_no_zero(tmp_path):
    """A course whose solution to one exercise fails: its points are open, its neighbour's are not."""
    for folder in ("tests/exercises", "solutions"):
        shutil.copytree(COURSE.root / folder, tmp_path / "course" / folder)
    (tmp_path / "course/solutions/ch2/improve.py").write_text(
        "def improve(*a): raise RuntimeError('broken')"
    )
    tests = tmp_path / "course/tests/exercises"
    chosen = ("--exercise", "improve", "--exercise", "bounds")
    _, _, grade = run(tests, "--submission", COURSE.solutions, *chosen, folder=tmp_path)
    states = {
        entry["id"]: (entry["state"], entry["points"]) for entry in grade["exercises"]
    }
    assert states == {"2.2": ("grader-fault", None), "2.3": ("correct", 4)}
    assert grade["points"] == 4
