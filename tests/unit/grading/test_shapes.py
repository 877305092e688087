"""Whatever a person would recognise as an answer is graded, however it is packed, named and written.

Each shape makes one submission with the right answer to exercise 2.2 and says how. It must get all points.
"""

import io
import json
import os
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robonav.cli import app
from robonav.grading import answers, sandbox_check
from robonav.grading.check import InProcessCalls, graded
from robonav.grading.classroom import GradingConfig, grade_class
from robonav.grading.course import Course
from robonav.grading.layouts import handed_in, passed_over
from robonav.grading.reference import reference
from robonav.grading.submission import Refused, Submission, read

COURSE = Course.around(Path(__file__).parent)
EXERCISE = COURSE.named("improve")
RIGHT = (COURSE.solutions / EXERCISE.file).read_text("utf-8")
STUB = (COURSE.stubs / EXERCISE.file).read_text("utf-8")
LINE = 'raise NotImplementedError("improve is yours to write")'
FUNCTION = RIGHT[RIGHT.index("def improve") :]
HEAD = "from __future__ import annotations\n\nimport numpy as np\n\n\n"


def zipped(files):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo("name")
            entry.filename = name  # with its backslashes
            archive.writestr(entry, content)
    return file.getvalue()


def tarred(files, mode):
    file = io.BytesIO()
    with tarfile.open(fileobj=file, mode=mode) as archive:
        for name, content in files.items():
            entry = tarfile.TarInfo(name)
            entry.size = len(content)
            archive.addfile(entry, io.BytesIO(content.encode()))
    return file.getvalue()


def notebook(*cells, version=4):
    """A notebook with these cells of code."""
    key = "source" if version == 4 else "input"
    listed = [{"cell_type": "code", "metadata": {}, key: cell} for cell in cells]
    held = {"cells": listed} if version == 4 else {"worksheets": [{"cells": listed}]}
    return json.dumps(
        {"nbformat": version, "nbformat_minor": 0, "metadata": {}, **held}
    )


IMPROVE = {"ch2/improve.py": RIGHT}
PLOT = {"data": {"image/png": "A" * (9 << 20), "text/plain": ["<Figure>\n", "x"]}}
LARGE = json.loads(notebook(HEAD + FUNCTION))
LARGE["cells"][0]["outputs"] = [PLOT]
LOOP = FUNCTION.replace("tolerance", "TOL")

PACKED = {
    "a folder": IMPROVE,
    "no folders": {"improve.py": RIGHT},
    "other folders": {"My work/week 2/improve.py": RIGHT},
    "a zip": {"work.zip": zipped(IMPROVE)},
    "a zip in a zip": {"a.zip": zipped({"b.zip": zipped(IMPROVE)})},
    "a zip beside a readme": {"a.zip": zipped(IMPROVE), "readme.txt": "Hello"},
    "a zip beside a PDF": {"a.ZIP": zipped(IMPROVE), "report.pdf": b"%PDF"},
    "a zip beside a page": {"a.zip": zipped(IMPROVE), "onlinetext.html": "<p>Hi</p>"},
    "two zips": {"ch2.zip": zipped({"improve.py": RIGHT}), "ch3.zip": zipped({"a.py": ""})},
    "a zip beside files as handed out": {"a.zip": zipped(IMPROVE), "ch2/improve.py": STUB},
    "a zip of Windows PowerShell": {"a.zip": zipped({"exercises\\ch2\\improve.py": RIGHT})},
    "names with backslashes": {"exercises\\ch2\\improve.py": RIGHT},
    "a zip of macOS": {"a.zip": zipped({**IMPROVE, "__MACOSX/ch2/._improve.py": b"\0"})},
    "tar": {"a.tar": tarred(IMPROVE, "w")},
    "tar.gz": {"a.tar.gz": tarred(IMPROVE, "w:gz")},
    "tgz": {"a.TGZ": tarred(IMPROVE, "w:gz")},
    "tar.bz2": {"a.tar.bz2": tarred(IMPROVE, "w:bz2")},
    "tar.xz": {"a.tar.xz": tarred(IMPROVE, "w:xz")},
    "beside an archive that cannot be read": {**IMPROVE, "notes.rar": b"Rar!"},
    "beside a damaged zip": {**IMPROVE, "a.zip": b"PK"},
    "beside a virtual environment": {
        **IMPROVE, "env/pyvenv.cfg": "", **{f"env/lib/{n}.py": "" for n in range(300)}
    },
    "zipped with a virtual environment": {
        "a.zip": zipped({"w/env/pyvenv.cfg": "", **{f"w/env/lib/{n}.py": "" for n in range(300)},
                         "w/improve.py": RIGHT})
    },
    "beside node_modules": {**IMPROVE, **{f"node_modules/a/{n}.py": "" for n in range(300)}},
    "among more than 200 files": {**IMPROVE, **{f"tried/out/{n}.py": "x = 1" for n in range(300)}},
    "beside the whole package": {
        **IMPROVE, "robonav/__init__.py": "", "robonav/improve.py": "def improve(*a): return 0"
    },
    "in a folder called as the package": {"robonav/exercises/ch2/improve.py": RIGHT},
    "beside a broken notebook": {**IMPROVE, "ch2.ipynb": "{"},
}  # fmt: skip

NAMED = {
    "another case": {"Improve.py": RIGHT},
    ".PY": {"improve.PY": RIGHT},
    "improve (1).py": {"improve (1).py": RIGHT, "improve.py": STUB},
    "improve-2.py": {"improve-2.py": RIGHT},
    "a second try": {"improve-1.py": RIGHT.replace(">", "<"), "improve-2.py": RIGHT},
    "Copy of improve.py": {"Copy of improve.py": RIGHT},
    "improve.py.txt": {"improve.py.txt": RIGHT},
    "a colon": {"task 2: improve.py": RIGHT},
    "a no-break space": {"improve\N{NO-BREAK SPACE}final.py": RIGHT},
    "one file for a chapter": {"ch2.py": f"print('tried')\n{RIGHT}\nimprove(1, 2, 3)"},
    "main.py": {"main.py": RIGHT + "\nif __name__ == '__main__':\n    plot()"},
    "solutions.py beside stubs": {"solutions.py": RIGHT, "ch2/improve.py": STUB},
    "a notebook by any name": {"My Homework FINAL (2).ipynb": notebook(HEAD + FUNCTION)},
    ".IPYNB": {"ch2.IPYNB": notebook(HEAD + FUNCTION)},
    "a notebook of Safari": {"ch2.ipynb.json": notebook(HEAD + FUNCTION)},
}  # fmt: skip

WRITTEN = {
    "UTF-16": {"improve.py": RIGHT.encode("utf-16")},
    "UTF-8 with a mark": {"improve.py": RIGHT.encode("utf-8-sig")},
    "Latin-1": {"improve.py": f"# -*- coding: latin-1 -*-\n# é\n{RIGHT}".encode("latin-1")},
    "Windows' lines": {"improve.py": RIGHT.replace("\n", "\r\n").encode()},
    "a notebook in UTF-16": {"a.ipynb": notebook(HEAD + FUNCTION).encode("utf-16")},
    "a notebook with a mark": {"a.ipynb": notebook(HEAD + FUNCTION).encode("utf-8-sig")},
    "a notebook of format 3": {"a.ipynb": notebook(HEAD + FUNCTION, version=3)},
    "a notebook with large outputs": {"a.ipynb": json.dumps(LARGE)},
    "the line as handed out, below": {"improve.py": f"{RIGHT.rstrip()}\n    {LINE}\n"},
    "the line in a comment": {"improve.py": f"# {LINE}\n{RIGHT}"},
    "the line above": {"improve.py": STUB.replace(LINE, f"{LINE}\n    return right(q, policy, tolerance)")
                       + FUNCTION.replace("def improve", "def right")},
    "the function as handed out, below": {"improve.py": RIGHT + "\n\n" + STUB[STUB.index("def improve"):]},
    "a future import in a later cell": {"a.ipynb": notebook("import numpy as np", HEAD + FUNCTION)},
    "an if": {"a.ipynb": notebook("import numpy as np\nif True:\n    " + FUNCTION.replace("\n", "\n    "))},
    "a try": {"improve.py": "import numpy as np\ntry:\n    " + FUNCTION.replace("\n", "\n    ").rstrip()
              + "\nexcept ValueError:\n    pass"},
    "a file that a cell writes": {"a.ipynb": notebook(f"%%writefile improve.py\n{RIGHT}", "%run improve.py")},
    "a file that a cell writes over a stub": {
        "a.ipynb": notebook(f"%%writefile ch2/improve.py\n{RIGHT}"), "improve.py": STUB},
    "a helper that a cell writes": {
        "a.ipynb": notebook(f"%%file helper.py\n{RIGHT.replace('def improve', 'def right')}",
                            "from helper import right\ndef improve(*a): return right(*a)")},
    "magics, questions and shell lines": {
        "a.ipynb": notebook("%matplotlib inline\n!ls\nnp.where?",
                            f"%%time\nfiles = !ls\nt = %timeit -o 1\n{HEAD}{FUNCTION}improve?")},
    "constants that a cell computes": {
        "a.ipynb": notebook("import numpy as np\nZERO, ONE = 1 - 1, 10**-0\nBOUND = np.inf",
                            "HERE = np.array(ZERO) * ONE", FUNCTION.replace(
                                "def improve(q, policy", "def improve(q, policy", 1)
                            + "\nright = improve\ndef improve(q, p, t): return right(q, p, t + HERE * ONE)")},
    "a trial beside the answer": {"a.ipynb": notebook(HEAD + FUNCTION, "print(improve(1, 2, 3))", "1 / 0")},
    "an answer beside a broken cell": {"a.ipynb": notebook("def other(", HEAD + FUNCTION)},
    "as an exported notebook": {"ch2.py": f"get_ipython().run_line_magic('matplotlib', 'inline')\n# In[1]:\n{RIGHT}"},
}  # fmt: skip

SHAPES = PACKED | NAMED | WRITTEN


def handed_over(folder, files):
    """A folder with these files."""
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return folder


def points(loaded, folder, monkeypatch):
    """The points of a submission in exercise 2.2, found and loaded as the worker does it."""
    handed_over(folder, loaded.files)
    found = answers.find(folder, EXERCISE.chapter, EXERCISE.name)
    monkeypatch.setattr(sys, "path", [*sys.path])
    module = answers.load(folder, found.path, EXERCISE.name)
    for name in ("improve", "helper"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    calls = InProcessCalls(getattr(module, EXERCISE.name))
    return graded(COURSE, EXERCISE, calls, reference(COURSE))["points"]


@pytest.mark.parametrize("shape", SHAPES)
def test_an_answer_that_a_person_would_recognise_gets_its_points(
    tmp_path, monkeypatch, shape
):
    try:
        folder = handed_over(tmp_path / "in", SHAPES[shape])
    except OSError:
        pytest.skip("this system does not allow such a name")
    assert points(read(folder), tmp_path / "out", monkeypatch) == EXERCISE.points


@pytest.mark.parametrize("shape", ["a zip", "tar.gz", "improve-2.py", "a notebook of Safari"])  # fmt: skip
def test_a_file_alone_is_a_submission(tmp_path, monkeypatch, shape):
    folder = handed_over(tmp_path / "in", SHAPES[shape])
    (path,) = folder.iterdir()
    assert points(read(path), tmp_path / "out", monkeypatch) == EXERCISE.points


def test_a_link_that_stays_inside_is_followed(tmp_path, monkeypatch):
    folder = handed_over(tmp_path / "in", {"final/answer.txt": RIGHT})
    (folder / "improve.py").symlink_to("final/answer.txt")
    assert points(read(folder), tmp_path / "out", monkeypatch) == EXERCISE.points


@pytest.mark.parametrize("kind", ["zip", "tar.gz"])
def test_a_link_inside_an_archive_is_followed(tmp_path, monkeypatch, kind):
    if kind == "zip":
        with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
            entry = zipfile.ZipInfo("x/improve.py")
            entry.external_attr = 0o120777 << 16
            archive.writestr(entry, "../final/answer.txt")
            archive.writestr("final/answer.txt", RIGHT)
    else:
        with tarfile.open(tmp_path / "a.tar.gz", "w:gz") as archive:
            entry = tarfile.TarInfo("x/improve.py")
            entry.type, entry.linkname = tarfile.SYMTYPE, "../final/answer.txt"
            archive.addfile(entry)
            content = tarfile.TarInfo("final/answer.txt")
            content.size = len(RIGHT.encode())
            archive.addfile(content, io.BytesIO(RIGHT.encode()))
    loaded = read(tmp_path / f"a.{kind}")
    assert points(loaded, tmp_path / "out", monkeypatch) == EXERCISE.points


NOTED = {
    "a zip in a zip": "a/b.zip was unpacked",
    "beside node_modules": "the folder node_modules was passed over",
    "beside a virtual environment": "the folder env was passed over",
    "zipped with a virtual environment": "the folder env was passed over",
    "UTF-16": "improve.py was taken from UTF-16",
    ".PY": "improve.PY was taken as improve.py",
    "improve.py.txt": "improve.py.txt was taken as improve.py",
    "a colon": "task 2: improve.py was taken as task 2_ improve.py",
}


@pytest.mark.parametrize("shape", NOTED)
def test_what_was_unusual_is_noted(tmp_path, shape):
    assert NOTED[shape] in read(handed_over(tmp_path, SHAPES[shape])).notes


NOT_TAKEN = {
    "rar": ({"a.rar": b"Rar!"}, "a.rar was not taken: the grader cannot read this kind"),
    "7z": ({"a.7z": b"7z"}, "a.7z was not taken: the grader cannot read this kind"),
    "a damaged zip": ({"a.zip": b"PK"}, "a.zip cannot be read: File is not a zip file"),
    "a damaged tar": ({"a.tar.gz": b"\x1f\x8bx"}, "a.tar.gz cannot be read"),
    "a PDF": ({"report.pdf": b""}, "no Python file or notebook is in it, only report.pdf"),
    "a page": ({"onlinetext.html": b""}, "only onlinetext.html"),
    "an absolute name": ({"a.zip": zipped({"/etc/a.py": ""})}, "leaves the submission"),
    "zips without end": (
        {"a.zip": zipped({"b.zip": zipped({"c.zip": zipped({"d.zip": zipped({"e.py": ""})})})})},
        "it lies in too many archives",
    ),
}  # fmt: skip


@pytest.mark.parametrize("shape", NOT_TAKEN)
def test_what_cannot_be_taken_is_refused_with_the_reason(tmp_path, shape):
    files, reason = NOT_TAKEN[shape]
    with pytest.raises(Refused, match=reason):
        read(handed_over(tmp_path, files))


@pytest.mark.parametrize("shape", ["rar", "a damaged zip", "zips without end"])
def test_what_can_be_taken_beside_it_is(tmp_path, shape):
    files, reason = NOT_TAKEN[shape]
    loaded = read(handed_over(tmp_path, {**files, **IMPROVE}))
    assert list(loaded.files) == ["ch2/improve.py"]
    assert reason in loaded.problems[0]


LAYOUTS = {
    "Canvas": (
        {
            "lovelaceada_123_456_improve.py": RIGHT,
            "lovelaceada_123_457_notes.pdf": "",
            "hopper_LATE_124_458_improve-2.py": RIGHT,
        },
        {"lovelaceada": 2, "hopper": 1},
    ),
    "Canvas, two of a name": (
        {"lee_1_10_improve.py": RIGHT, "lee_2_11_improve.py": RIGHT},
        {"lee (1)": 1, "lee (2)": 1},
    ),
    "Moodle": (
        {
            "Ada Lovelace_123_assignsubmission_file_/improve.py": RIGHT,
            "Ada Lovelace_123_assignsubmission_onlinetext_/onlinetext.html": "",
            "Grace O'Hopper_124_assignsubmission_file/work.zip": zipped(IMPROVE),
        },
        {"Ada Lovelace": 2, "Grace O'Hopper": 1},
    ),
    "Moodle without folders": (
        {"Ada Lovelace_123_assignsubmission_file_improve.py": RIGHT},
        {"Ada Lovelace": 1},
    ),
    "Blackboard": (
        {
            "Exercises 2_ada_attempt_2024-05-01-10-30-00.txt": "Name: Ada",
            "Exercises 2_ada_attempt_2024-05-01-10-30-00_improve.py": "x",
            "Exercises 2_ada_attempt_2024-05-02-09-00-00.txt": "Name: Ada",
            "Exercises 2_ada_attempt_2024-05-02-09-00-00_improve.py": RIGHT,
        },
        {"ada": 2},
    ),
    "Gradescope": (
        {
            "submission_11/improve.py": RIGHT,
            "submission_12/ch2/improve.py": RIGHT,
            "submission_13/improve.py": RIGHT,
            "submission_metadata.yml": (
                "submission_11:\n  :submitters:\n  - :name: Ada Lovelace\n    :sid: '1'\n  :score: 3\n"
                "submission_12:\n  :submitters:\n  - :name: Grace\n  - :name: Mary\n"
            ),
        },
        {"Ada Lovelace": 1, "Grace and Mary": 1, "submission_13": 1},
    ),
    "GitHub Classroom": (
        {
            "week2-ada/.git/config": "",
            "week2-ada/.github/workflows/check.yml": "",
            "week2-ada/exercises/ch2/improve.py": RIGHT,
            "week2-ada/tests/exercises/test_ch2.py": "def test_improve(): pass",
        },
        {"week2-ada": 1},
    ),
    "folders and archives": (
        {
            "ada/improve.py": RIGHT,
            "bo.zip": zipped(IMPROVE),
            "chen.tar.gz": tarred(IMPROVE, "w:gz"),
            "dora.ipynb": notebook(HEAD + FUNCTION),
            "emil.PY": RIGHT,
        },
        {"ada": 1, "bo": 1, "chen": 1, "dora": 1, "emil": 1},
    ),
    "a folder and a zip of one name": (
        {"ada/notes.txt": "", "ada.zip": zipped(IMPROVE)},
        {"ada": 2},
    ),
}  # fmt: skip


@pytest.mark.parametrize("layout", LAYOUTS)
def test_each_student_gets_what_is_theirs(tmp_path, monkeypatch, layout):
    files, expected = LAYOUTS[layout]
    found = handed_in(handed_over(tmp_path / "class", files))
    assert {name: len(handin.parts) for name, handin in found.items()} == expected
    assert passed_over(tmp_path / "class") == []
    for name, handin in found.items():
        loaded = handin.load()
        assert points(loaded, tmp_path / name, monkeypatch) == EXERCISE.points


def test_the_last_attempt_counts_and_this_is_noted(tmp_path):
    folder = handed_over(tmp_path, LAYOUTS["Blackboard"][0])
    assert (
        "the attempt of 2024-05-02-09-00-00 counts, the last of 2"
        in handed_in(folder)["ada"].load().notes
    )


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
def test_whatever_one_student_hands_in_the_others_are_read(tmp_path):
    folder = handed_over(tmp_path / "class", {"ada/improve.py": RIGHT})
    deep = folder / "deep"
    deep.mkdir()
    for _ in range(300):
        deep = deep / "d"
        deep.mkdir()
    os.mkfifo(folder / "pipe.zip")
    (folder / "link.zip").symlink_to("/etc/passwd")
    (folder / "odd").mkdir()
    (folder / "odd/\udcff\n.py").symlink_to("/etc/passwd")
    (folder / "\udcffnobody.py").write_text("x" * (9 << 20))
    loaded = {name: handin.load() for name, handin in handed_in(folder).items()}
    assert set(loaded) == {"ada", "deep", "pipe", "link", "odd", "_nobody"}
    assert isinstance(loaded.pop("ada"), Submission)
    reasons = {name: str(refused) for name, refused in loaded.items()}
    assert "folders more than 40 deep were not read" in reasons["deep"]
    assert "not a regular file" in reasons["pipe"]
    assert reasons["odd"] == "__.py is a link that leaves the submission"
    assert reasons["link"] == "link.zip is a link"
    assert "more than 8 MB" in reasons["_nobody"]


@pytest.mark.sandbox
def test_a_class_of_all_kinds_is_graded_and_what_was_not_taken_is_red(tmp_path):
    if fault := sandbox_check.fault("official"):
        pytest.skip(fault)
    config = GradingConfig(COURSE, "official", b"")
    folder = handed_over(
        tmp_path / "class",
        {
            "Ada_1_assignsubmission_file_/a.zip": zipped({"b.zip": zipped(IMPROVE)}),
            "bo/ch2.ipynb": SHAPES["magics, questions and shell lines"]["a.ipynb"],
            "chen/a.ipynb": SHAPES["a helper that a cell writes"]["a.ipynb"],
            "dora.rar": b"Rar!",
            "emil/other.py": "x = 1",
            "fay/ch2/improve.py": STUB,
        },
    )
    grade_class(config, folder, tmp_path / "out", jobs=1)
    records = {
        path.parent.name: json.loads(path.read_text())
        for path in (tmp_path / "out").glob("students/*/grade.json")
    }
    assert {name: record["points"] for name, record in records.items()} == {
        "Ada": 4, "bo": 4, "chen": 4, "dora": 0, "emil": 0, "fay": 0,
    }  # fmt: skip
    assert records["chen"]["files"] == {"2.2": "a.ipynb"}
    page = (tmp_path / "out/index.html").read_text()
    red = page[page.index('<ul class="bad">') : page.index("</ul>")]
    assert "the grader cannot read this kind of archive; hand in a zip" in red
    assert "no function of an exercise was found in other.py" in red
    assert "fay" not in red
    assert "b.zip was unpacked" in page
    feedback = (tmp_path / "out/students/bo/feedback.html").read_text()
    assert "4 of 4 points, correct, from ch2.ipynb" in feedback


@pytest.mark.sandbox
def test_a_student_sees_at_home_what_will_be_found(tmp_path, monkeypatch):
    files = {
        "work/answers.py": RIGHT,
        "work/ch2/bounds.py": "def bounds(:",
        "a.7z": b"",
    }
    (tmp_path / "work.zip").write_bytes(zipped(files))
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, ["check", "work.zip", "2.1", "2.2", "2.3"])
    assert done.exit_code == 1
    lines = done.output.splitlines()
    assert lines[0].startswith("Not taken: a.7z was not taken: the grader cannot read")
    assert "2.1 A backup with rewards on transitions: 0 of 4 points" in done.output
    assert any(
        line.startswith("2.2 ")
        and line.endswith("4 of 4 points (from work/answers.py)")
        for line in lines
    )
    assert "SyntaxError" in done.output


@pytest.mark.sandbox
def test_a_submission_without_an_answer_says_so_at_home(tmp_path):
    (tmp_path / "report.pdf").write_text("")
    done = CliRunner().invoke(app, ["check", str(tmp_path), "2.2"])
    assert "Not taken: no Python file or notebook is in it, only report.pdf." in (
        done.output
    )
    assert "The submission was refused" in done.output
