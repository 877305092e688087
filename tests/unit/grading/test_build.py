"""One source: what students and nbgrader get, and the commands that make it and check by it."""

import ast
import json
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import course_exercises
import pytest

from robonav.grading import build
from robonav.grading.course import Course
from robonav.grading.notebook import is_unwritten, parsed, sources
from robonav.grading.sandbox import Limits

COURSE = Course.around(Path(__file__).parent)
ROBONAV = str(Path(sys.executable).with_name("robonav"))
TRY = "return q.argmax(axis=1)"
SOURCE = '''"""Add one."""


def add(x: int) -> int:
    """The next number."""
    ### BEGIN SOLUTION
    return x + 1
    ### END SOLUTION
'''


def test_a_stub_has_everything_but_the_solution():
    stub = build.stub(SOURCE, "add")
    assert "x + 1" not in stub
    assert stub.startswith(SOURCE.partition("    ### BEGIN")[0])
    with pytest.raises(NotImplementedError, match="add is yours to write"):
        exec(stub + "add(1)", {})


@pytest.mark.parametrize(
    "source",
    [
        "def add(x): pass",
        SOURCE.replace("    ### END SOLUTION\n", ""),
        SOURCE + "### END SOLUTION\n",
    ],
)
def test_a_source_without_marks_is_named(source):
    with pytest.raises(ValueError, match="add must have its solution between"):
        build.stub(source, "add")


def test_what_is_in_the_repository_is_up_to_date():
    assert build.outdated(COURSE) == []


@pytest.mark.parametrize(
    "exercise", COURSE.exercises.values(), ids=lambda exercise: exercise.name
)
def test_every_stub_has_a_signature_with_types_and_says_its_shapes(exercise):
    text = (COURSE.stubs / exercise.file).read_text()
    (function,) = [
        node for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)
    ]
    assert function.name == exercise.name
    assert function.returns is not None
    assert all(argument.annotation for argument in function.args.args)
    said = ast.get_docstring(function)
    assert "Parameters" in said
    assert "Returns" in said
    assert all(f"{argument.arg}" in said for argument in function.args.args)
    assert len(ast.get_docstring(ast.parse(text))) > 150
    assert "SOLUTION" not in text
    too_wide = [line for line in text.splitlines() if len(line) > 88]
    assert [line for line in too_wide if not line.startswith("$$")] == []


def test_the_manifest_has_six_exercises_a_chapter_of_every_kind():
    for chapter, exercises in COURSE.chapters():
        assert len(exercises) >= 6, chapter
        assert {exercise.difficulty for exercise in exercises} >= {
            "warm-up",
            "exercise",
            "project",
        }


@pytest.mark.slow
def test_open_tasks_tell_how_often_right_answers_pass():
    """The manifest has what the benchmark measured, and stubs and notebooks say it."""
    import nbformat  # takes seconds, so other tests do without

    path = COURSE.root / "benchmarks/open_tasks.json"
    measured = json.loads(path.read_text("utf-8"))
    tasks = {e.id for e in COURSE.exercises.values() if e.difficulty == "open task"}
    assert set(measured) == tasks
    table = course_exercises.open_tasks(COURSE)
    for exercise in COURSE.exercises.values():
        if exercise.id not in tasks:
            assert (exercise.draws, exercise.passed, exercise.seconds) == (0, (), ())
            continue
        found = measured[exercise.id]
        passed = [
            found[where]["all parts"] for where in ("solutions", "solutions/otherwise")
        ]
        assert (exercise.draws, list(exercise.passed)) == (found["draws"], passed)
        assert list(exercise.seconds) == found["seconds"]
        assert exercise.draws >= 30
        assert min(passed) >= 0.95 * exercise.draws
        call, everything = exercise.seconds
        assert call < Limits().call_seconds / 2
        assert everything < Limits().exercise_seconds / 2
        each = ", ".join(f"{one} of {exercise.draws}" for one in passed)
        (row,) = (line for line in table.splitlines() if exercise.title in line)
        assert each in row
        said = build.how_fair(exercise)
        assert exercise.fairness in said
        stub = (COURSE.stubs / exercise.file).read_text("utf-8")
        assert said in " ".join(stub.replace("\n# ", " ").split())
        notebook = nbformat.read(
            COURSE.stubs / f"{exercise.chapter}.ipynb", as_version=4
        )
        assert any(said in cell.source for cell in notebook.cells)


@pytest.mark.parametrize("chapter", [chapter for chapter, _ in COURSE.chapters()])
@pytest.mark.slow
def test_notebooks_are_valid_and_carry_what_nbgrader_reads(chapter):
    import nbformat

    handed_out = nbformat.read(COURSE.stubs / f"{chapter}.ipynb", as_version=4)
    source = nbformat.read(
        COURSE.solutions / f"nbgrader/source/{chapter}/{chapter}.ipynb", as_version=4
    )
    for notebook in (handed_out, source):
        nbformat.validate(notebook)
        graded = [
            cell.metadata.nbgrader
            for cell in notebook.cells
            if cell.cell_type == "code"
        ]
        assert len({meta.grade_id for meta in graded}) == len(graded)
        points = sum(meta.points for meta in graded if meta.grade)
        assert points == sum(
            e.points for e in COURSE.exercises.values() if e.chapter == chapter
        )
        assert all(
            meta.solution != meta.grade and meta.schema_version == 3 for meta in graded
        )
    assert "BEGIN SOLUTION" not in json.dumps(handed_out)
    assert json.dumps(source).count("BEGIN SOLUTION") == len(source.cells) // 3
    cells = sources((COURSE.stubs / f"{chapter}.ipynb").read_bytes())
    statements = [node for cell in cells for node in parsed(cell)]
    for e in COURSE.exercises.values():
        unwritten = sum(is_unwritten(node, e.name) for node in statements)
        assert unwritten == (e.chapter == chapter)


@pytest.mark.slow
def test_building_writes_what_differs_and_removes_what_has_no_source(tmp_path):
    for folder in ("solutions", "tests/exercises", "exercises"):
        subprocess.run(
            ["cp", "-r", "--parents", folder, tmp_path], cwd=COURSE.root, check=True
        )
    (tmp_path / "exercises/ch2/improve.py").write_text("spoiled")
    (tmp_path / "exercises/ch2/old.py").write_text("")
    (tmp_path / "exercises/ch2.ipynb").unlink()
    stale = ["exercises/ch2.ipynb", "exercises/ch2/improve.py", "exercises/ch2/old.py"]
    check = subprocess.run(
        [ROBONAV, "exercises", "build", "--check"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert check.returncode == 1
    assert [line for line in check.stdout.splitlines() if "out of date" in line] == [
        f"out of date: {name}" for name in stale
    ]
    assert build.build(Course(tmp_path)) == stale
    assert build.outdated(Course(tmp_path)) == []
    assert not (tmp_path / "exercises/ch2/old.py").exists()


@pytest.mark.slow
def test_a_zip_of_a_week_holds_its_exercises_alone(tmp_path):
    def robonav(*arguments, cwd):
        return subprocess.run(
            [ROBONAV, *arguments], cwd=cwd, capture_output=True, text=True, timeout=120
        )

    path, home = tmp_path / "week3.zip", tmp_path / "week3"
    only = ("exercises", "zip", path, "--only")
    refused = robonav(*only, "2.2", "--only", "9.9", cwd=COURSE.root)
    assert refused.returncode != 0
    assert "no exercise '9.9'" in " ".join(refused.stderr.split())
    assert not path.exists()
    made = robonav(*only, "2.2", "--only", "6.3", cwd=COURSE.root)
    assert made.returncode == 0, made.stderr
    with zipfile.ZipFile(path) as archive:
        archive.extractall(tmp_path)
    found = {p.relative_to(home).as_posix() for p in home.rglob("*") if p.is_file()}
    assert found == {
        "exercises/README.md",
        *("exercises/ch2.ipynb", "exercises/ch2/improve.py"),
        *("exercises/ch6.ipynb", "exercises/ch6/leave.py"),
        *("tests/exercises/manifest.toml", "tests/exercises/pytest.ini"),
        *("tests/exercises/test_ch2.py", "tests/exercises/test_ch6.py"),
        "tests/exercises/recorded/improve.frame",
        "tests/exercises/recorded/leave.frame",
    }
    for name in ("ch2/improve.py", "ch6/leave.py"):
        stub = (home / "exercises" / name).read_text("utf-8")
        assert stub == (COURSE.stubs / name).read_text("utf-8")
        answer = (COURSE.solutions / name).read_text("utf-8")
        (home / "exercises" / name).write_text(answer, "utf-8")
    checked = robonav("check", cwd=home)
    assert checked.returncode == 0, checked.stdout + checked.stderr
    assert "Total: 8 of 8 points" in checked.stdout


@pytest.mark.slow
def test_a_student_with_the_zip_alone_checks_an_answer(tmp_path):
    build.students_zip(COURSE, tmp_path / "students.zip")
    again = tmp_path / "again"
    again.mkdir()
    build.students_zip(COURSE, again / "students.zip")
    written = (tmp_path / "students.zip", again / "students.zip")
    assert written[0].read_bytes() == written[1].read_bytes()
    with zipfile.ZipFile(tmp_path / "students.zip") as archive:
        assert not [name for name in archive.namelist() if "solution" in name]
        assert not [
            name for name in archive.namelist() if b"### BEGIN" in archive.read(name)
        ]
        archive.extractall(tmp_path)
    home = tmp_path / "students"

    def check(*arguments):
        done = subprocess.run(
            [ROBONAV, "check", *arguments],
            cwd=home,
            capture_output=True,
            text=True,
            timeout=120,
        )
        return done.returncode, done.stdout + done.stderr

    code, said = check("2.2")
    assert (
        code,
        "Not begun: write improve in exercises/ch2/improve.py" in said,
    ) == (1, True)
    stub = (home / "exercises/ch2/improve.py").read_text()
    (home / "exercises/ch2/improve.py").write_text(
        stub.replace('raise NotImplementedError("improve is yours to write")', TRY)
    )
    code, said = check("2.2")
    documented = (
        (COURSE.root / "book/students.md")
        .read_text()
        .split("```text\n")[1]
        .partition("```")[0]
    )
    assert [
        line
        for line in documented.splitlines()
        if "…" not in line and line not in said.splitlines()
    ] == []
    assert len(documented.splitlines()) == len(said.splitlines())
    answer = (COURSE.solutions / "ch2/improve.py").read_text()
    (home / "exercises/ch2/improve.py").write_text(answer.replace("> tolerance", "> 0"))
    code, said = check("2.2")
    assert code == 1
    assert "3 of 4 points" in said
    assert "Keep the current action where the gain is at most the tolerance" in said
    (home / "exercises/ch2/improve.py").write_text(answer)
    code, said = check("improve")
    assert code == 0, said
    assert "4 of 4 points" in said
    assert "Well done" in said


@pytest.mark.slow
def test_an_assignment_of_nbgrader_has_the_tests_that_its_cells_call(tmp_path):
    """As nbgrader grades it: a copy of the assignment's folder below the course's root, and nothing of this book."""
    written = build.nbgrader_course(COURSE, tmp_path)
    assert [folder.name for folder in written] == ["ch2", "ch3", "ch4", "ch5", "ch6"]
    graded = tmp_path / "autograded/anna/ch2"
    shutil.copytree(tmp_path / "source/ch2", graded)
    cells = json.loads((graded / "ch2.ipynb").read_text("utf-8"))["cells"]
    keep = [
        "".join(cell["source"])
        for cell in cells
        if cell["id"] in ("answer-2-2", "check-2-2")
    ]
    code = "\n".join(
        [
            *keep,
            "from pathlib import Path",
            "from robonav.grading.course import Course",
            "assert Course.around(Path.cwd()).root == Path.cwd().resolve()",
        ]
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=graded, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("✓") == 3


def test_a_cell_of_the_notebook_checks_an_answer(capsys):
    from robonav.grading.check import check
    from robonav.grading.reference import solution

    assert check("2.2", solution(COURSE, COURSE.named("2.2"))) == 4
    assert check("improve", lambda q, policy, tolerance: q.argmax(axis=1)) == 1
    said = capsys.readouterr().out
    assert "✓ 1/1 Takes the best action where it is clearly better." in said
    assert "Hint: This always takes a best action." in said


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["check", "9.9"], "no exercise '9.9'"),
        (
            ["grade", "/nowhere", "--out", "/tmp/never", "--practice"],
            "must be a folder of submissions",
        ),
        (
            ["grade", ".", "--out", "/tmp/never", "--secret", "/nowhere"],
            "the secret cannot be read",
        ),
        (["check", "--submission", "/nowhere"], "must be a folder, a zip"),
        (["check", "nowhere.zip"], "must be a folder, a zip"),
        (
            ["check", "exercises", "2.1", "tests"],
            "one folder, notebook or zip file at a time",
        ),
    ],
)
def test_a_wrong_input_is_one_line_and_code_2(arguments, sentence):
    done = subprocess.run(
        [ROBONAV, *arguments], capture_output=True, text=True, cwd=COURSE.root
    )
    assert done.returncode == 2
    assert sentence in done.stderr
    assert "Traceback" not in done.stderr
    assert done.stderr.strip().splitlines()[-1].startswith("robonav: ")
