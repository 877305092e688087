"""Copies are told from honest answers, however they are disguised, and reading them is safe."""

import ast
import csv
import importlib.util
import io
import json
import random
import time
import zipfile
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robonav.cli import app
from robonav.grading import copies
from robonav.grading.check import InProcessCalls, graded
from robonav.grading.course import Course
from robonav.grading.fingerprints import fingerprint
from robonav.grading.reference import reference
from robonav.grading.similarity import FEWEST, THRESHOLD, pairs

COURSE = Course.around(Path(__file__).parent)
SIMILAR = Path(__file__).with_name("similar")


def module(path):
    spec = importlib.util.spec_from_file_location(f"similar_{path.stem}", path)
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


BENCHMARK = module(COURSE.root / "benchmarks/similarity.py")


@pytest.mark.parametrize("kind", ["honest", "translated"])
@pytest.mark.parametrize("name", BENCHMARK.EXERCISES.values())
def test_the_answers_of_the_measurement_are_right(kind, name):
    functions = vars(module(SIMILAR / kind / f"{name}.py"))
    own = {k: f for k, f in functions.items() if k.startswith(f"{name}_")}
    assert len(own) == (12 if kind == "honest" else 6)
    known = reference(COURSE)
    for function in own.values():
        result = graded(COURSE, COURSE.named(name), InProcessCalls(function), known)
        assert result["state"] == "correct", result["feedback"]


@pytest.mark.slow
def test_copies_are_found_and_honest_pairs_are_not():
    found = BENCHMARK.measured(15, 6)["reported"]
    assert found["honest"] <= 0.01
    assert all(found[how] >= 0.95 for how in BENCHMARK.DISGUISES)


@pytest.mark.parametrize("disguises", [BENCHMARK.DISGUISES[:3], ()])
@pytest.mark.parametrize("size", [3, 4, 6, 11])
@pytest.mark.slow
def test_a_ring_does_not_hide_itself(size, disguises):
    for found, ring in BENCHMARK.ringed(2, size, disguises):
        reported = [{pair.first, pair.second} for pair in found if pair.reported]
        assert len(reported) == size * (size - 1) // 2
        assert all(names <= ring for names in reported)


@pytest.mark.slow
def test_a_third_person_does_not_hide_a_copy_in_a_small_class():
    """Half of ten exercises are copied, and a third person has four of the same answers."""
    for size in (6, 8):
        found = BENCHMARK.measured(5, 10, copied=5, size=size, shared=4)["reported"]
        easy = [how for how in BENCHMARK.DISGUISES[:3] if how in found]
        assert [found[how] for how in easy] == [1.0] * len(easy), (size, found)
        assert found["honest"] <= 0.01


def test_equal_answers_to_few_exercises_make_no_ring():
    easy = one("def f(a):\n    return a.max(axis=1) + 5")
    class_of = {
        f"student {n}": dict.fromkeys(("2.1", "2.2", "2.3", "2.4"), easy)
        if n < 6
        else {id: one(f"def f(a):\n    return a ** {n + 7}") for id in ("2.1", "2.2", "2.3", "2.4")}
        for n in range(12)
    }  # fmt: skip
    assert not any(pair.reported for pair in pairs(class_of))


def test_the_page_says_what_was_measured():
    result = json.loads((COURSE.root / "benchmarks/similarity.json").read_text("utf-8"))
    assert (result["threshold"], result["fewest"]) == (THRESHOLD, FEWEST)
    page = (COURSE.root / "book/instructors.md").read_text("utf-8")
    rows = [*result["all copied"], result["half copied"], result["held out"]]
    for row in rows:
        share = {kind: 100 * value for kind, value in row["reported"].items()}
        easy = min(share[how] for how in BENCHMARK.DISGUISES if how != "translated")
        said = (
            f"| {easy:.1f} % | {share['translated']:.1f} % | "
            f"{share['honest']:.2f} % of {row['pairs']['honest']:,} |"
        )
        assert said in page
        assert share["honest"] <= 1
        if row["exercises"] >= 4 and row["copied"] == row["exercises"]:
            assert min(easy, share["translated"]) >= 95
    for row, beside in zip(result["sizes"], result["a third person"], strict=True):
        cells = [str(row["students"])]
        for one in (row, beside):
            share = {kind: 100 * value for kind, value in one["reported"].items()}
            easy = min(share[how] for how in BENCHMARK.DISGUISES if how != "translated")
            honest = f"{share['honest']:.2f} % of {one['pairs']['honest']:,}"
            cells += [f"{easy:.1f} %", f"{share['translated']:.1f} %", honest]
            assert easy >= 95
            assert share["honest"] <= 1 or row["students"] == 30
        assert f"| {' | '.join(cells)} |" in page
    assert f"{result['classes']} classes" in page
    for row in result["rings"]:
        share = {kind: 100 * value for kind, value in row["reported"].items()}
        assert (
            f"| {row['ring']} | {share['ring']:.1f} % | "
            f"{share['honest']:.2f} % of {row['pairs']['honest']:,} |"
        ) in page
        assert share["honest"] <= 1
        assert share["ring"] >= 95


def one(text, name="f"):
    return fingerprint(ast.parse(text), name)


@pytest.mark.parametrize(
    "other",
    [
        "def f(x, y):\n    '''Mine.'''\n    z = x + y  # so\n    if 5 > z:\n        z = 5\n    return z",
        "def f(u, v):\n    w = v + u\n    if w < 5: w = 5\n    return w",
        "import numpy as np\ndef f(u: float, v) -> float:\n    w: float = u + v\n    if w < 5: w = 5\n    return w",
    ],
)
def test_names_comments_order_and_annotations_do_not_count(other):
    first = one("def f(a, b):\n    c = a + b\n    if c < 5: c = 5\n    return c")
    second = one(other)
    assert first.structure == second.structure
    assert first.flow == second.flow


def test_an_answer_that_is_too_long_is_not_compared():
    with pytest.raises(ValueError, match="too long"):
        one("def f(x):\n" + "    x = x + 1\n" * 5000)


def handed_over(folder, students=range(8), exercises=None):
    """A class of eight, and one who copied from the first and renamed all."""
    for number in students:
        place = folder / f"student{number}/ch2"
        place.mkdir(parents=True)
        for name in exercises or BENCHMARK.EXERCISES.values():
            tree = ast.parse((SIMILAR / f"honest/{name}.py").read_text())
            own = next(n for n in tree.body if getattr(n, "name", "") == f"{name}_{number + 1}")  # fmt: skip
            own.name = name
            text = ast.unparse(own).replace("track_6(", "track(")
            imports = "import numpy as np\nfrom collections import defaultdict\n"
            (place / f"{name}.py").write_text(imports + text)
    return folder


def copied(folder, name="thief<b>"):
    place = folder / name
    place.mkdir()
    for path in (folder / "student0/ch2").glob("*.py"):
        tree = ast.parse(path.read_text())
        tree = BENCHMARK.Renamed(tree, random.Random(1)).visit(tree)
        (place / path.name).write_text("# <script>alert(1)</script>\n" + ast.unparse(tree))  # fmt: skip


@pytest.mark.slow
def test_a_class_is_compared_and_shown_side_by_side(tmp_path):
    folder = handed_over(tmp_path / "class")
    copied(folder)
    done = CliRunner().invoke(
        app, ["similarity", str(folder), "--out", str(tmp_path / "s.html")]
    )
    assert done.exit_code == 0, done.output
    text = (tmp_path / "s.csv").read_text("utf-8-sig")
    rows = list(csv.DictReader(io.StringIO(text)))
    assert [(row["first"], row["second"]) for row in rows][:1] == [
        ("student0", "thief<b>")
    ]
    assert len(rows) <= 1
    assert rows[0]["exercises"] == "10"
    page = (tmp_path / "s.html").read_text()
    assert "thief&lt;b&gt;" in page
    assert "thief<b>" not in page
    assert "<mark>" in page
    assert page.count("<details>") == 1


@pytest.mark.slow
def test_the_lines_of_a_ring_are_marked(tmp_path):
    folder = handed_over(tmp_path / "class")
    for number in range(4):
        copied(folder, f"thief{number}")
    found = copies.compare_class(COURSE, folder)
    assert len(found.pairs) == 10
    copies.write_comparison(found, COURSE, tmp_path / "s.html")
    for pair in (tmp_path / "s.html").read_text().split("<details>")[1:]:
        assert "<mark>" in pair


def test_few_exercises_tell_nothing(tmp_path):
    folder = handed_over(tmp_path / "class", exercises=["improve", "bounds"])
    copied(folder)
    assert copies.compare_class(COURSE, folder).pairs == []


def test_two_students_alone_are_not_compared_with_nothing():
    same = one("def f(a):\n    return a + 5")
    found = pairs({"ada": {"2.1": same}, "bo": {"2.1": same}})
    assert [pair.reported for pair in found] == [False]


def test_notebooks_and_zips_are_read_and_nothing_is_run(tmp_path):
    folder = tmp_path / "class"
    folder.mkdir()
    cell = "open('ran', 'w')\n%time\ndef improve(q, policy, tolerance):\n    return policy  # mine"
    notebook = {"cells": [{"cell_type": "code", "source": cell}], "nbformat": 4}
    (folder / "ada.ipynb").write_text(json.dumps(notebook))
    with zipfile.ZipFile(folder / "bo.zip", "w") as archive:
        archive.writestr("ch2/improve.py", "raise SystemExit\n" + cell.split("\n", 2)[2])  # fmt: skip
    found = copies.compare_class(COURSE, folder)
    assert found.answers["ada"]["2.2"].source == found.answers["bo"]["2.2"].source
    assert "# mine" in found.answers["bo"]["2.2"].source
    assert not (Path.cwd() / "ran").exists()


@pytest.mark.parametrize(
    "text",
    [
        pytest.param("def improve(:", id="syntax"),
        *(
            pytest.param(
                f"def improve(q, policy, tolerance):\n    return {value}",
                marks=pytest.mark.slow,
                id=name,
            )
            for name, value in {
                "brackets": "(" * 50_000,
                "minus": "-" * 400_000 + "1",
                "sum": "1+" * 200_000 + "1",
                "attributes": "q." * 100_000 + "x",
            }.items()
        ),
        pytest.param("\0" * 100, id="zeros"),
    ],
)
def test_a_hostile_file_ends_nothing_but_itself(tmp_path, text):
    folder = tmp_path / "class"
    for name in ("ada", "bo"):
        (folder / name).mkdir(parents=True)
        (folder / name / "improve.py").write_text(
            "def improve(q, policy, tolerance):\n    return policy"
        )
    (folder / "eve.py").write_text(text)
    begin = time.monotonic()
    found = copies.compare_class(COURSE, folder)
    assert {"ada", "bo"} <= {n for n, own in found.answers.items() if own}
    assert not found.answers.get("eve")
    assert time.monotonic() - begin < 60
