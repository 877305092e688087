"""The commands ``robonav drills list`` and ``robonav drills export``: files, refusals, and what they say."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from typer.testing import CliRunner

from robonav.cli import app
from robonav.drills import DRILLS, Drill, Number, Question
from robonav.drills.export import drawn, files, seen, selected, varied


def run(*arguments: object) -> str:
    done = CliRunner().invoke(
        app, ["drills", *map(str, arguments)], catch_exceptions=True
    )
    if done.exception:
        return str(done.exception)
    return done.output


def test_list_has_every_drill() -> None:
    lines = run("list").splitlines()
    assert [line.split()[0] for line in lines] == list(DRILLS)
    some = run("list", "--page", "dynamic-programming").splitlines()
    assert 0 < len(some) < len(lines)


def test_bank_for_moodle(tmp_path: Path) -> None:
    path = tmp_path / "bank.xml"
    said = run(
        "export", path, "--page", "dynamic-programming", "--at-most", 3, "--each", 2
    )
    assert said.startswith(f"{path}: ")
    kinds = [node.get("type") for node in ElementTree.parse(path).getroot()]
    assert 3 < len(kinds) <= 7
    assert list(tmp_path.iterdir()) == [path]


def test_banks_for_canvas_and_blackboard(tmp_path: Path) -> None:
    run("export", tmp_path / "c.zip", "--drill", "td-error")
    run("export", tmp_path / "b.zip", "--drill", "td-error", "--platform", "blackboard")
    names = [set(zipfile.ZipFile(tmp_path / f"{one}.zip").namelist()) for one in "cb"]
    assert names == [
        {"imsmanifest.xml", "questions/assessment.xml"},
        {"imsmanifest.xml", "questions/test.xml", "questions/td-error-1.xml"},
    ]


def test_exam_and_solutions(tmp_path: Path) -> None:
    pytest.importorskip("reportlab")
    path = tmp_path / "exam.pdf"
    said = run(
        "export", path, "--chapter", 2, "--at-most", 2, "--papers", 3, "--seed", 7
    )
    assert said.count("3 papers of 2 questions") == 2
    names = sorted(one.name for one in tmp_path.iterdir())
    assert names == ["exam-solutions.pdf", "exam.pdf"]


def test_a_file_is_not_written_over_without_force(tmp_path: Path) -> None:
    path = tmp_path / "bank.xml"
    path.write_text("mine")
    assert "add --force" in run("export", path, "--drill", "td-error")
    assert path.read_text() == "mine"
    run("export", path, "--drill", "td-error", "--force")
    assert path.read_text() != "mine"


def test_neither_file_of_an_exam_is_written_over(tmp_path: Path) -> None:
    pytest.importorskip("reportlab")
    (tmp_path / "exam-solutions.pdf").write_text("mine")
    assert "add --force" in run("export", tmp_path / "exam.pdf", "--drill", "td-error")
    assert [one.name for one in tmp_path.iterdir()] == ["exam-solutions.pdf"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["exam.doc"], "end the file's name in one of .xml, .zip, .pdf"),
        (["bank.xml", "--format", "word"], "format must be one of moodle, qti, pdf"),
        (["bank.xml", "--drill", "none"], "there is no drill none"),
        (["bank.xml", "--page", "none"], "there is no page none"),
        (["bank.xml", "--chapter", "9"], "there is no chapter 9"),
        (["bank.xml", "--each", "0"], "each must be"),
        (["bank.xml", "--seed", "-1"], "seed must be"),
        (["bank.xml", "--papers", "2"], "only an exam"),
        (["bank.zip", "--platform", "sakai"], "platform must be one of"),
    ],
)
def test_wrong_input_is_said_in_a_sentence(
    arguments: list[str], said: str, tmp_path: Path, monkeypatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert said in run("export", *arguments)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "notes").write_text("mine")
    path = tmp_path / "notes" / "bank.xml"
    said = run("export", path, "--drill", "td-error")
    assert re.fullmatch(rf"{re.escape(str(path))} cannot be written: [\w ]+", said)


@pytest.fixture
def constant(monkeypatch) -> str:
    """A drill of chapter 2 that has one question only."""

    def draw(rng: np.random.Generator) -> Question:
        return Question("What is $1 + 1$?", Number(2), "Two.")

    draw.__module__ = DRILLS["td-error"].draw.__module__
    monkeypatch.setitem(DRILLS, "constant", Drill("constant", "sums", "A sum", draw))
    return "constant"


def test_drills_with_few_questions_are_named(tmp_path: Path, constant: str) -> None:
    chosen = ["--drill", "td-error", "--drill", constant]
    said = run("export", tmp_path / "bank.xml", *chosen, "--each", 2)
    assert "3 questions" in said
    assert said.strip().endswith(f"gave all: {constant}")


def test_an_exam_of_many_papers_leaves_out_drills_that_ask_everybody_the_same(
    tmp_path: Path, constant: str
) -> None:
    pytest.importorskip("reportlab")
    said = run("export", tmp_path / "exam.pdf", "--page", "sums", "--papers", 3)
    assert "too few different questions for 3 papers: constant" in said
    both = ["--page", "sums", "--page", "playground", "--papers", 3]
    said = run("export", tmp_path / "exam.pdf", *both)
    assert said.strip().endswith(f"too few different questions: {constant}")
    named = ["--drill", constant, "--papers", 30]
    assert "30 papers of 1 question\n" in run("export", tmp_path / "named.pdf", *named)
    one = run("export", tmp_path / "one.pdf", "--page", "sums")
    assert "too few" not in one


@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(n, marks=pytest.mark.slow) for n in (1, 2))]
)
def test_no_paper_has_two_equal_questions(seed: int) -> None:
    paper = drawn(varied(selected(), papers=1, each=3), seed, each=3)
    shown = [seen(one.question) for one in paper]
    assert len(set(shown)) == len(shown) > 3 * 60


def test_missing_packages_are_named(monkeypatch) -> None:
    monkeypatch.setattr(files, "find_spec", lambda name: None)
    with pytest.raises(ValueError, match=r"reportlab is not installed: .*\[exams\]"):
        files.check_installed("pdf")
