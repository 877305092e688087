"""A class: what is graded stays, what is written can be read, and a cut run loses nothing."""

import csv
import errno
import json
import multiprocessing
import os
import random
import shutil
import subprocess
import sys
import time
import zipfile
from contextlib import suppress
from pathlib import Path
from xml.etree import ElementTree

import pytest
from typer.testing import CliRunner

from robonav.cli import app
from robonav.grading import (
    class_statistics,
    classroom,
    commands,
    exports,
    gradebook,
    layouts,
    sandbox_check,
    session,
)
from robonav.grading.classroom import (
    GradingConfig,
    grade_class,
    grade_submission,
    students,
)
from robonav.grading.course import Course
from robonav.grading.sandbox import Limits
from robonav.grading.submission import Submission

COURSE = Course.around(Path(__file__).parent)
OFFICIAL = GradingConfig(COURSE, "official")
HERE = GradingConfig(COURSE, "practice")
PASSES = (COURSE.solutions / "ch2/improve.py").read_text()
NAMES = ["anna", "=1+1", "<b>bo</b>", "carl", "döra", "eve"]


@pytest.fixture
def folder(tmp_path):
    """Six students: full points in 2.2, a name that is a formula, one that is markup, an attack, a zip, nothing."""
    place = tmp_path / "class"
    place.mkdir()
    for name, text in {
        "anna": PASSES,
        "=1+1": PASSES.replace(">", "<"),
        "carl": "import os\nos._exit(0)",
    }.items():
        (place / name / "ch2").mkdir(parents=True)
        (place / name / "ch2/improve.py").write_text(text)
    (place / "<b>bo<").mkdir()
    (place / "<b>bo<" / "b>").mkdir()
    (place / "eve").mkdir()
    with zipfile.ZipFile(place / "döra.zip", "w") as archive:
        archive.writestr("ch2/improve.py", PASSES)
    (place / "<b>bo<" / "improve.py").write_text(
        "def improve(*a): raise ValueError('<script>alert(1)</script>')"
    )
    (place / ".DS_Store").write_text("")
    (place / "readme.txt").write_text("")
    (place / "<fay>.doc").write_text("")
    return place


@pytest.fixture
def course(tmp_path):
    """A course of the first three exercises."""
    place = tmp_path / "course"
    for part in ("tests/exercises", "solutions/ch2", "solutions/wrong/ch2"):
        shutil.copytree(COURSE.root / part, place / part)
    manifest = place / "tests/exercises/manifest.toml"
    manifest.write_text(
        "[[exercise]]".join(manifest.read_text().split("[[exercise]]")[:4])
    )
    return Course(place)


@pytest.fixture
def quick(monkeypatch):
    """Grading without a sandbox: one point for each file, and a log of who was marked."""
    marked = []

    def count(config, loaded, ids=()):
        marked.append((len(loaded.files), tuple(ids)))
        exercises = [
            exercise
            for exercise in COURSE.exercises.values()
            if not ids or exercise.id in ids
        ]
        entries = [
            {
                "id": e.id,
                "points": len(loaded.files),
                "max_points": e.points,
                "state": "partial",
                "feedback": str(len(marked)),
            }
            for e in exercises
        ]
        return {
            "points": 0,
            "max_points": 44,
            "tier": config.tier,
            "exercises": entries,
        }

    monkeypatch.setattr(classroom, "grade_submission", count)
    return marked


def records(out):
    return {
        path.parent.name: json.loads(path.read_text())
        for path in out.glob("students/*/grade.json")
    }


@pytest.mark.sandbox
def test_a_class_is_graded_and_written_down_for_everyone(folder, course, tmp_path):
    if fault := sandbox_check.fault("official"):
        pytest.skip(fault)
    out, seen = tmp_path / "out", []
    grade_class(
        GradingConfig(course, "official"),
        folder,
        out,
        jobs=2,
        progress=lambda done, total: seen.append((done, total)),
    )
    assert seen == [(n, 6) for n in range(1, 7)]
    graded = records(out)
    assert {name: record["points"] for name, record in graded.items()} == {
        "anna": 4, "=1+1": 0, "<b>bo<": 0, "carl": 0, "döra": 4, "eve": 0,
    }  # fmt: skip
    states = {name: record["exercises"][1]["state"] for name, record in graded.items()}
    assert (states["carl"], states["<b>bo<"], states["eve"]) == (
        "error",
        "error",
        "missing",
    )

    with (out / "gradebook.csv").open(newline="", encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    assert [row["student"] for row in rows] == [
        "<b>bo<",
        "'=1+1",
        "anna",
        "carl",
        "döra",
        "eve",
    ]
    assert [row["points"] for row in rows] == ["0", "0", "4", "0", "4", "0"]
    assert rows[2]["2.2"] == "4"

    overview = (out / "index.html").read_text()
    assert "<b>bo" not in overview
    assert "&lt;b&gt;bo" in overview
    assert "students/anna/feedback.html" in overview
    assert (
        "no folder, archive, notebook or Python file: &lt;fay&gt;.doc, readme.txt."
        in overview
    )
    assert "students/%3D1%2B1/feedback.html" in overview
    feedback = (out / "students" / "<b>bo<" / "feedback.html").read_text()
    assert "<script>" not in feedback
    assert "&lt;script&gt;" in feedback

    results = json.loads((out / "students/anna/results.json").read_text())
    assert results["score"] == 4
    assert sum(test["score"] for test in results["tests"]) == 4
    assert (
        sum(test["max_score"] for test in results["tests"])
        == graded["anna"]["max_points"]
    )
    suite = ElementTree.parse(out / "students/anna/junit.xml").getroot()
    assert suite.get("failures") == "2"
    assert len(suite.findall("testcase/failure")) == 2


@pytest.mark.slow
def test_what_cannot_be_taken_has_no_mark_rather_than_zero(course, tmp_path):
    """Archives and notebooks that cannot be read, empty files and code of something else; the others are graded."""
    folder, out = tmp_path / "class", tmp_path / "out"
    (folder / "anna").mkdir(parents=True)
    (folder / "anna/improve.py").write_text(PASSES)
    (folder / "eve").mkdir()
    for name in ("carl.rar", "dora.7z", "emil.zip"):
        (folder / name).write_bytes(b"PK\3\4 not an archive")
    notebook = json.dumps(
        {"cells": [{"cell_type": "code", "source": [PASSES]}], "nbformat": 4}
    )
    contents = {
        "hugo/improve.py": PASSES,
        "ida/improve.py": "",
        "kim/work.ipynb": notebook[: len(notebook) * 2 // 3],
        "lea/improve.py": PASSES,
        "lea/half.ipynb": "{",
        "lea/backup.py": "# to do",
        "max/improve.py": PASSES,
        "max/arrays.py": "\n",
    }
    for name in (
        "finn/report.pdf",
        "gwen/other.py",
        "hugo/improve.py",
        "hugo/more.rar",
        "ida/improve.py",
        "jane/improve.py",
        "kim/work.ipynb",
        "lea/improve.py",
        "lea/half.ipynb",
        "lea/backup.py",
        "max/improve.py",
        "max/arrays.py",
    ):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(contents.get(name, "x = 1"))
    grade_class(GradingConfig(course, "practice"), folder, out, jobs=1)
    refused = ["carl", "dora", "emil", "finn", "gwen", "ida", "jane", "kim"]
    with (out / "gradebook.csv").open(newline="", encoding="utf-8-sig") as file:
        points = {row["student"]: row for row in csv.DictReader(file)}
    book = gradebook.read_gradebook(out, course)
    gradebook.write_gradebook(book)
    with (out / "marks.csv").open(newline="", encoding="utf-8-sig") as file:
        marks = {row["student"]: row for row in csv.DictReader(file)}
    for name in refused:
        assert (points[name]["points"], points[name]["2.2"]) == ("", "")
        assert points[name]["not_taken"]
        assert (marks[name]["points"], marks[name]["2.2"]) == ("", "")
        assert "Nothing of the submission could be taken: " in marks[name]["problems"]
    assert "hand in a zip" in marks["carl"]["problems"]
    assert {name: points[name]["not_taken"] for name in ("ida", "jane", "kim", "lea", "max")} == {
        "ida": "improve.py is empty",
        "jane": "no function of an exercise was found in improve.py",
        "kim": "work.ipynb is not a complete notebook",
        "lea": "half.ipynb is not a complete notebook",
        "max": "arrays.py is empty",
    }  # fmt: skip
    assert marks["lea"]["points"] == marks["max"]["points"] == "4.0"
    assert "exercises are missing: arrays.py is empty." in marks["max"]["problems"]
    assert (marks["eve"]["points"], points["eve"]["points"]) == ("0.0", "0")
    # Of hugo a part was taken, which counts, and what was not is said.
    assert marks["hugo"]["points"] == "4.0"
    assert "Not taken, though exercises are missing: more.rar" in marks["hugo"]["problems"]  # fmt: skip
    overview = (out / "index.html").read_text()
    red = overview[overview.index('<ul class="bad">') : overview.index("</ul>")]
    assert all(f">{name}</a>: " in red for name in [*refused, "hugo", "lea", "max"])
    assert "13 students; of 8 nothing could be taken" in overview
    for platform in exports.FORMATS:
        text = exports.marks_for(book, platform, "Work").splitlines()
        for name in refused:
            line = next(one for one in text if name in one)
            assert line.endswith(",") or ",,12,Ungraded," in line
    assert exports.unsettled(book) == refused
    partly = [said[:15] for said in exports.not_all_taken(book)]
    assert partly == ["hugo: Not taken", "lea: Not taken,", "max: Not taken,"]
    tried = class_statistics.counts(book)
    assert {id: tried[id].attempted for id in ("2.1", "2.2")} == {"2.1": 0, "2.2": 4}
    class_statistics.write_statistics(book)
    assert "8 of which nothing could be taken do not count" in (
        (out / "statistics.html").read_text()
    )
    feedback = (out / "students/carl/feedback.html").read_text()
    assert "carl: no mark yet" in feedback
    # A mark by hand counts.
    gradebook.change(book, book.account("carl"), "2.2", 3, "read it on paper", "Dr B.")
    assert gradebook.read_gradebook(out, course).account("carl").total == 3


def test_what_is_graded_stays_and_what_changed_is_graded_again(folder, tmp_path, quick):
    out = tmp_path / "out"
    grade_class(HERE, folder, out, jobs=1)
    assert len(quick) == 6
    grade_class(HERE, folder, out, jobs=1)
    assert len(quick) == 6
    (folder / "eve/improve.py").write_text("")
    (out / "students/anna/grade.json").write_text("{")
    shutil.rmtree(out / "students/carl")
    grade_class(HERE, folder, out, jobs=1)
    assert len(quick) == 9


def test_a_class_remembers_whether_it_was_graded_with_a_secret(folder, tmp_path, quick):
    out, secret = tmp_path / "out", GradingConfig(COURSE, "practice", b"a secret")
    grade_class(HERE, folder, out, jobs=1)
    with pytest.raises(ValueError, match="was graded without a secret; give that one"):
        grade_class(secret, folder, out, jobs=1)
    assert len(quick) == 6
    grade_class(secret, folder, out, jobs=1, new_secret=True)
    assert len(quick) == 12
    grade_class(secret, folder, out, jobs=1, again=["anna"])
    assert len(quick) == 13
    other = GradingConfig(COURSE, "practice", b"another")
    for forgotten in (HERE, other):
        with pytest.raises(ValueError, match="was graded with another secret"):
            grade_class(forgotten, folder, out, jobs=1, again=["anna"])
    assert len(quick) == 13
    assert b"a secret" not in (out / "class.json").read_bytes()


def test_reports_in_the_class_folder_would_be_a_student(folder, quick):
    for out in (folder, folder / "graded", folder / "anna/graded"):
        with pytest.raises(ValueError, match="must not lie in the class folder"):
            grade_class(HERE, folder, out, jobs=1)
    assert "graded" not in os.listdir(folder)


def test_a_folder_that_cannot_be_written_to_is_one_sentence(
    folder, tmp_path, quick, monkeypatch
):
    (tmp_path / "file").write_text("mine")
    for out in (tmp_path / "file", tmp_path / "file/graded"):
        with pytest.raises(ValueError, match=r"cannot write to .*file"):
            grade_class(HERE, folder, out, jobs=1)
    assert (tmp_path / "file").read_text() == "mine"
    out, written = tmp_path / "out", classroom.report.write_student

    def full(path, record, course):
        if len(quick) == 3:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        written(path, record, course)

    monkeypatch.setattr(classroom.report, "write_student", full)
    with pytest.raises(ValueError, match="No space left on device"):
        grade_class(HERE, folder, out, jobs=1)
    assert len(records(out)) == 2
    monkeypatch.setattr(classroom.report, "write_student", written)
    grade_class(HERE, folder, out, jobs=1)
    assert len(records(out)) == 6
    assert len(quick) == 3 + 4


def test_a_fault_of_the_grader_is_graded_again(folder, tmp_path, quick, monkeypatch):
    out, honest = tmp_path / "out", classroom.grade_submission

    def fails_for_anna(config, loaded, ids=()):
        grade = honest(config, loaded, ids)
        if PASSES.encode() in loaded.files.values():
            grade["exercises"][0] |= {"points": None, "state": "grader-fault"}
        return grade

    monkeypatch.setattr(classroom, "grade_submission", fails_for_anna)
    grade_class(HERE, folder, out, jobs=1)
    assert "2.1" in (out / "gradebook.csv").read_text("utf-8-sig").splitlines()[3]
    assert "To be graded again" in (out / "students/anna/feedback.html").read_text()
    assert (
        "2.1" in json.loads((out / "students/anna/results.json").read_text())["output"]
    )
    assert (
        ElementTree.parse(out / "students/anna/junit.xml").getroot().get("errors")
        == "1"
    )
    monkeypatch.setattr(classroom, "grade_submission", honest)
    grade_class(HERE, folder, out, jobs=1)
    assert len(quick) == 6 + 2


@pytest.mark.slow
def test_one_student_or_one_exercise_again(folder, tmp_path, quick):
    out = tmp_path / "out"
    grade_class(HERE, folder, out, jobs=1)
    before = records(out)
    grade_class(HERE, folder, out, jobs=1, again=["carl"])
    assert len(quick) == 7
    grade_class(HERE, folder, out, jobs=1, ids=["2.3"])
    assert len(quick) == 13
    assert {ids for _, ids in quick[7:]} == {("2.3",)}
    after = records(out)
    for name, record in after.items():
        changed = [
            new["id"]
            for new, old in zip(
                record["exercises"], before[name]["exercises"], strict=True
            )
            if new != old
        ]
        assert changed == (list(COURSE.exercises) if name == "carl" else ["2.3"])
    grade_class(HERE, folder, out, jobs=1, again=["anna"], ids=["2.1"])
    assert quick[13:] == [(1, ("2.1",))]


def test_a_scheduler_gets_a_few_submissions_at_once(tmp_path, quick, monkeypatch):
    distributed = pytest.importorskip("distributed")
    place, out, held = tmp_path / "class", tmp_path / "out", []
    for number in range(20):
        (place / f"student{number:02}").mkdir(parents=True)
    with distributed.LocalCluster(
        1, threads_per_worker=1, processes=False, dashboard_address=":0"
    ) as cluster:
        load = layouts.Handin.load
        monkeypatch.setattr(
            layouts.Handin, "load", lambda handin: held.append(handin) or load(handin)
        )
        seen = []
        grade_class(
            HERE,
            place,
            out,
            scheduler=cluster.scheduler_address,
            progress=lambda done, total: seen.append((done, len(held) - 20)),
        )
    assert [done for done, _ in seen] == list(range(1, 21))
    assert all(in_hand <= done + 8 for done, in_hand in seen)
    assert len(records(out)) == len(quick) == 20


def test_a_class_must_be_one(tmp_path):
    with pytest.raises(ValueError, match="must be a folder"):
        students(tmp_path / "nowhere")
    with pytest.raises(ValueError, match="no folder, zip or notebook"):
        students(tmp_path)
    (tmp_path / "all.zip").write_text("")
    with pytest.raises(ValueError, match="unpack it first"):
        students(tmp_path / "all.zip")


@pytest.mark.parametrize("name", ["an\na.py", "an\x07a.ZIP", "an\udcffa.py"])
def test_a_name_that_no_report_can_hold_is_written_in_other_characters(tmp_path, name):
    try:
        (tmp_path / name).write_text("")
    except OSError:
        pytest.skip("no such names here")
    assert list(students(tmp_path)) == ["an_a"]


def test_an_unknown_student_is_named(folder, tmp_path):
    with pytest.raises(ValueError, match="no submission of zoe"):
        grade_class(HERE, folder, tmp_path / "out", again=["zoe"])


def test_two_runs_do_not_meet(folder, tmp_path):
    with (
        classroom._locked(tmp_path / "out"),
        pytest.raises(ValueError, match="another run"),
    ):
        grade_class(HERE, folder, tmp_path / "out")


def test_an_exception_in_the_grader_is_a_fault_not_a_crash(monkeypatch):
    def broken(*args, **options):
        raise OSError("no space left")

    monkeypatch.setattr(classroom, "graded", broken)
    grade = grade_submission(HERE, Submission({}))
    assert {entry["state"] for entry in grade["exercises"]} == {"grader-fault"}
    assert {entry["points"] for entry in grade["exercises"]} == {None}


def documented():
    """The points that the instructors' page gives for the example class."""
    page = (COURSE.root / "book/instructors.md").read_text()
    rows = [
        [cell.strip() for cell in line.split("|")[1:-1]]
        for line in page.splitlines()
        if line.startswith("| ")
    ]
    return {
        row[0]: ["" if points == "–" else points for points in row[1:5]]
        for row in rows
        if len(row) == 6 and (row[1].isdigit() or row[1] == "–")
    }


@pytest.mark.sandbox
def test_the_example_class_gets_the_documented_results(tmp_path, monkeypatch):
    """With a shorter deadline than it has, of which Eve uses up each second."""
    if fault := sandbox_check.fault("official"):
        pytest.skip(fault)
    monkeypatch.setattr(session, "Limits", lambda: Limits(call_seconds=1.5))
    grade_class(OFFICIAL, COURSE.solutions / "example-class", tmp_path, jobs=1)
    with (tmp_path / "gradebook.csv").open(newline="", encoding="utf-8-sig") as file:
        found = {
            row["student"]: [row[key] for key in ("2.1", "2.2", "2.3", "points")]
            for row in csv.DictReader(file)
        }
    assert len(found) == 7
    assert found == documented()


@pytest.mark.sandbox
def test_what_gradescope_runs_writes_what_gradescope_reads(tmp_path):
    if fault := sandbox_check.fault("official"):
        pytest.skip(fault)
    (tmp_path / "venv").symlink_to(Path(sys.executable).parents[1])
    (tmp_path / "source").mkdir()
    (tmp_path / "source/secret").write_text("a word")
    shutil.copytree(COURSE.solutions / "example-class/ada", tmp_path / "submission")
    subprocess.run(
        [COURSE.solutions / "gradescope/run_autograder"],
        env={**os.environ, "AUTOGRADER_ROOT": str(tmp_path)},
        check=True,
        capture_output=True,
        timeout=120,
    )
    results = json.loads((tmp_path / "results/results.json").read_text())
    assert results["score"] == 12
    assert [test["number"] for test in results["tests"]] == list(COURSE.exercises)


@pytest.mark.parametrize("code", [1, 2])
def test_gradescope_sees_a_failure_where_the_grader_fails(tmp_path, code):
    (tmp_path / "submission").mkdir()
    (tmp_path / "venv/bin").mkdir(parents=True)
    robonav = tmp_path / "venv/bin/robonav"
    robonav.write_text(
        "#!/bin/sh\n"
        'mkdir -p "$4/students/submission"\n'
        'echo {} >"$4/students/submission/results.json"\n'
        f"exit {code}\n"
    )
    robonav.chmod(0o755)
    done = subprocess.run(
        [COURSE.solutions / "gradescope/run_autograder"],
        env={**os.environ, "AUTOGRADER_ROOT": str(tmp_path)},
        capture_output=True,
    )
    assert done.returncode != 0
    assert not (tmp_path / "results/results.json").exists()


def test_the_command_fails_where_the_grader_failed(tmp_path, monkeypatch):
    monkeypatch.setattr(classroom, "grade_class", lambda *args, **options: ["anna"])
    monkeypatch.setattr(commands, "write_all", lambda out: None)
    done = CliRunner().invoke(app, ["grade", str(tmp_path), "--out", "x", "--practice"])
    assert done.exit_code == 1
    assert "The grader failed for anna. Run the command again" in done.output


def written(out):
    return {
        str(path.relative_to(out)): path.read_bytes()
        for path in out.rglob("*")
        if path.is_file() and path.name != "log.jsonl"  # which holds times
    }


def run(course, seconds, *arguments, jobs):
    """What ``robonav grade`` ends with if it is killed after so many seconds.

    With two jobs it is the command; with one, which is quicker, a process forked from one that has imported all.
    """
    code = f"""
import os
from pathlib import Path
from robonav import cli
from robonav.grading.course import Course
for stream in (1, 2):
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
Course.around = lambda *starts: Course(Path({str(course.root)!r}))
cli.app({["grade", *map(str, arguments), "--jobs", str(jobs)]!r})
"""
    if jobs == 2:
        command = subprocess.Popen([sys.executable, "-c", code])
        with suppress(subprocess.TimeoutExpired):
            command.wait(seconds)
        command.kill()
        return command.wait()
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(
        ["robonav.cli", "robonav.grading.classroom", "joblib", "jinja2", "tqdm"]
    )
    process = context.Process(target=exec, args=(code, {}))
    process.start()
    process.join(seconds)
    process.kill()
    process.join()
    return process.exitcode


@pytest.mark.sandbox
@pytest.mark.long
def test_a_run_killed_twenty_times_ends_as_one_that_was_not(folder, course, tmp_path):
    """SIGKILL at random moments; no grade changes once it is there, and the end is byte for byte the same."""
    if fault := sandbox_check.fault("official"):
        pytest.skip(fault)
    whole, cut, moments = tmp_path / "whole", tmp_path / "cut", random.Random(1)
    usual, seen, finished = {}, {}, 0
    for jobs in (1, 2):
        begin = time.monotonic()
        assert run(course, 120, folder, "--out", whole / str(jobs), jobs=jobs) == 0
        usual[jobs] = time.monotonic() - begin
    assert written(whole / "1") == written(whole / "2")
    for kill in range(20):
        jobs = 1 if kill % 4 else 2
        ended = (
            run(
                course,
                moments.uniform(0.2, 0.9) * usual[jobs],
                folder,
                "--out",
                cut,
                jobs=jobs,
            )
            == 0
        )
        graded = {
            path: path.stat().st_mtime_ns for path in cut.glob("students/*/grade.json")
        }
        assert all(graded.get(path) == time_ns for path, time_ns in seen.items()), (
            f"graded again after kill {kill}"
        )
        seen = graded
        if (
            ended and (finished := finished + 1) < 4
        ):  # start over while there are kills left
            shutil.rmtree(cut)
            seen = {}
    assert run(course, 120, folder, "--out", cut, jobs=2) == 0
    assert written(cut) == written(whole / "1")
    assert not [name for name in os.listdir(cut / "students") if name.startswith(".")]
