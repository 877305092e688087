"""The exercises on their pages: solutions in the instructors' build alone, and no answer anywhere else."""

import html
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from robonav.grading.course import Course

COURSE = Course.around(Path(__file__).parent)
CONFIGURATION = """
import sys
sys.path.insert(0, {folder!r})
extensions = ["myst_nb", "sphinx_exercise", "sphinx_design", "course_exercises"]
myst_enable_extensions = ["dollarmath"]
nb_execution_mode = "off"
suppress_warnings = ["myst.xref_missing"]
"""


def answer(exercise):
    """The lines of the solution that say something of their own."""
    source = (COURSE.solutions / exercise.file).read_text()
    body = source.partition("### BEGIN SOLUTION\n")[2].partition("### END SOLUTION")[0]
    return {line.strip() for line in body.splitlines() if len(line.strip()) > 30}


@pytest.mark.parametrize(
    "solutions",
    [
        pytest.param("", id="for students", marks=pytest.mark.slow),
        pytest.param("1", id="for instructors", marks=pytest.mark.slow),
    ],
)
def test_solutions_stand_in_the_instructors_build_alone(tmp_path, solutions):
    pytest.importorskip("sphinx_exercise")
    (tmp_path / "conf.py").write_text(
        CONFIGURATION.format(folder=str(COURSE.root / "book/_ext"))
    )
    (tmp_path / "index.md").write_text(
        (COURSE.root / "book/exercises-5.md").read_text()
    )
    (tmp_path / "nirl-in-practice.md").write_text(
        "---\norphan: true\n---\n# A page\n\n```{exercises}\n```\n"
    )
    subprocess.run(
        [
            sys.executable,
            "-m",
            "sphinx",
            "-q",
            "-b",
            "html",
            tmp_path,
            tmp_path / "built",
        ],
        env={**os.environ, "SOLUTIONS": solutions},
        check=True,
        capture_output=True,
    )
    page = html.unescape(
        re.sub("<[^>]+>", "", (tmp_path / "built/index.html").read_text())
    )
    exercises = [
        exercise for exercise in COURSE.exercises.values() if exercise.chapter == "ch5"
    ]
    for exercise in exercises:
        assert f"{exercise.id} {exercise.title}" in page
        assert bool([line for line in answer(exercise) if line in page]) == bool(
            solutions
        ), exercise.id
    listed = (tmp_path / "built/nirl-in-practice.html").read_text()
    assert 'href="index.html#exercise-5-6"' in listed
    assert "5.6 The accuracy trap" in listed
    assert "about 10 minutes" in listed
    assert "5.1" not in listed
    assert 'href="nirl-in-practice.html"' in (tmp_path / "built/index.html").read_text()
    assert page.count("Known mistakes") == (len(exercises) if solutions else 0)
    for path in (tmp_path / "built").rglob("*"):
        assert path.is_dir() or b"BEGIN SOLUTION" not in path.read_bytes()


def test_no_line_of_an_answer_stands_in_the_package_or_on_a_page():
    elsewhere = [
        *(COURSE.root / "robonav").rglob("*.py"),
        *(COURSE.root / "book").glob("*.md"),
    ]
    written = {
        line.strip() for path in elsewhere for line in path.read_text().splitlines()
    }
    found = {
        exercise.id: answer(exercise) & written
        for exercise in COURSE.exercises.values()
    }
    assert {id: lines for id, lines in found.items() if lines} == {}


def test_every_exercise_belongs_to_a_page_of_the_book():
    pages = {path.stem for path in (COURSE.root / "book").glob("*.md")}
    assert {exercise.page for exercise in COURSE.exercises.values()} <= pages
