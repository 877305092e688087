"""Copies are told from honest answers, however they are disguised, and reading them is safe."""

import ast
import csv
import importlib.util
import io
import itertools
import json
import random
import time
import zipfile
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robonav.cli import app
from robonav.grading import copies, variants
from robonav.grading.check import InProcessCalls, graded
from robonav.grading.course import Course
from robonav.grading.fingerprints import fingerprint
from robonav.grading.reference import reference
from robonav.grading.similarity import (
    FEWEST,
    NEAR,
    THRESHOLD,
    Likeness,
    Pair,
    pairs,
    patchworks,
)

COURSE = Course.around(Path(__file__).parent)
HONEST = COURSE.solutions / "honest"
TRANSLATED = Path(__file__).with_name("similar") / "translated"


def module(path):
    spec = importlib.util.spec_from_file_location(f"similar_{path.stem}", path)
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


BENCHMARK = module(COURSE.root / "benchmarks/similarity.py")


def right_answers(path, name, many):
    """Check that a file holds that many answers to an exercise, and that all are right."""
    functions = vars(module(path))
    own = {k: f for k, f in functions.items() if k.startswith(f"{name}_")}
    assert len(own) == many
    known = reference(COURSE)
    for function in own.values():
        result = graded(COURSE, COURSE.named(name), InProcessCalls(function), known)
        assert result["state"] == "correct", result["feedback"]


@pytest.mark.slow
@pytest.mark.parametrize("path", sorted(HONEST.rglob("*.py")), ids=lambda path: path.stem)  # fmt: skip
def test_the_honest_answers_are_right(path):
    exercise = COURSE.named(path.stem)
    assert path == HONEST / exercise.file
    many = 30 if exercise.id in BENCHMARK.EXERCISES else 8
    right_answers(path, path.stem, many)
    shapes = [one.structure for one in copies.honest_answers(COURSE, exercise.id)]
    assert len(shapes) == many
    assert all(a != b for a, b in itertools.combinations(shapes, 2))


@pytest.mark.parametrize("name", BENCHMARK.EXERCISES.values())
def test_the_translations_of_the_measurement_are_right(name):
    right_answers(TRANSLATED / f"{name}.py", name, 6)


@pytest.mark.slow
def test_copies_are_found_and_honest_pairs_are_not():
    found = BENCHMARK.measured(15, 6)["reported"]
    assert found["honest"] <= 0.01
    assert all(found[how] >= 0.95 for how in BENCHMARK.DISGUISES)


@pytest.mark.parametrize("disguises", [BENCHMARK.DISGUISES[:3], ()])
@pytest.mark.parametrize("size", [3, 4, 6, 11])
@pytest.mark.slow
def test_a_ring_does_not_hide_itself(size, disguises):
    false = 0
    for found, ring in BENCHMARK.ringed(2, size, disguises):
        reported = [{pair.first, pair.second} for pair in found if pair.reported]
        assert sum(names <= ring for names in reported) == size * (size - 1) // 2
        false += sum(not names <= ring for names in reported)
    assert false <= 1  # of up to 126 honest pairs; one in a hundred is expected


@pytest.mark.slow
def test_copies_are_found_in_a_class_of_three_and_beside_a_second_source_or_a_third_person():
    for size, more in (
        (3, {"exercises": 6, "sources": 2}),
        (5, {"exercises": 6, "sources": 2}),
        (5, {"exercises": 10, "copied": 5, "shared": 4}),
    ):
        found = BENCHMARK.measured(10, size=size, **more)["reported"]
        easy = [found[how] for how in BENCHMARK.DISGUISES[:3] if how in found]
        assert easy == [1.0] * len(easy), (size, more, found)
        assert found.get("honest", 0) <= 0.01
        assert found.get("patchwork", 1) >= 0.95


@pytest.mark.slow
def test_half_of_the_answers_translated_between_loops_and_arrays_are_found():
    found = BENCHMARK.measured(25, 6, copied=3, size=5)
    assert found["of"]["translated"] >= 10
    assert (
        found["reported"]["translated"] >= 0.8
    )  # the page has the rate of more classes


@pytest.mark.slow
def test_somebody_who_copies_each_answer_from_another_one_is_found_and_honest_students_are_not():
    found = BENCHMARK.measured(15, 4, size=6, sources=4)["reported"]
    assert found["patchwork"] >= 0.95
    assert found["honest student"] == 0
    assert found["renamed"] < 0.5  # no pair tells it


def test_equal_answers_to_few_exercises_make_no_ring():
    easy = one("def f(a):\n    return a.max(axis=1) + 5")
    class_of = {
        f"student {n}": dict.fromkeys(("2.1", "2.2", "2.3", "2.4"), easy)
        if n < 6
        else {id: one(f"def f(a):\n    return a ** {n + 7}") for id in ("2.1", "2.2", "2.3", "2.4")}
        for n in range(12)
    }  # fmt: skip
    assert not any(pair.reported for pair in pairs(class_of))


def shares(row):
    """The cells of a row in the page: copies with easy disguises, translated ones, and honest pairs."""
    share = {kind: 100 * value for kind, value in row["reported"].items()}
    easy = min(share[how] for how in BENCHMARK.DISGUISES if how != "translated")
    assert share["honest"] <= 1
    honest = f"{share['honest']:.2f} % of {row['of']['honest']:,}"
    return easy, share["translated"], f"{easy:.1f} % | {share['translated']:.1f} % | {honest}"  # fmt: skip


def test_the_page_says_what_was_measured():
    result = json.loads((COURSE.root / "benchmarks/similarity.json").read_text("utf-8"))
    assert (result["threshold"], result["fewest"]) == (THRESHOLD, FEWEST)
    page = (COURSE.root / "book/instructors.md").read_text("utf-8")
    assert f"{result['classes']} classes" in page
    for row in [*result["all copied"], *result["half copied"]]:
        easy, translated, cells = shares(row)
        half = "" if row["copied"] == row["exercises"] else f", of which {row['copied']} copied"  # fmt: skip
        assert f"| {row['exercises']}{half} | {cells} |" in page
        if row["exercises"] >= FEWEST:
            assert easy >= 95
            assert translated >= (95 if row["copied"] == row["exercises"] else 90)
    names = ("4", "4, of which 2 copied", "4, two from each of two", "4, in classes of thirty")  # fmt: skip
    for name, row in zip(names, result["held out"], strict=True):
        easy, translated, cells = shares(row)
        assert f"| {name} | {cells} |" in page
        assert easy >= 95
    for row in result["sizes"]:
        found = [shares(row[kind]) for kind in ("all", "half", "two sources")]
        cells = [f"{easy:.1f} % | {translated:.1f} %" for easy, translated, _ in found]
        honest = [100 * row[kind]["reported"]["honest"] for kind in ("all", "half", "two sources")]  # fmt: skip
        assert f"| {row['students']} | {' | '.join(cells)} | {max(honest):.2f} % |" in page  # fmt: skip
        assert min(easy for easy, _, _ in found) >= 95
        assert found[0][1] >= 95
        assert min(translated for _, translated, _ in found) >= 90
    least = min(
        row[kind]["reported"]["translated"]
        for row in result["sizes"]
        for kind in ("all", "half", "two sources")
    )
    two_of_four = result["held out"][1]["reported"]["translated"]
    assert f"up to {100 * (1 - least):.0f} % of the copies are missed" in page
    assert f"with two of four it is {100 * (1 - two_of_four):.0f} %" in page
    assert f"({result['held out'][3]['classes']} of thirty, and more of smaller ones)" in page  # fmt: skip
    assert "thirty to each of ten exercises, eight to each of fourteen others" in page
    assert len(BENCHMARK.EXERCISES) == 10
    assert len([*HONEST.rglob("*.py")]) == 24
    for row in result["each from another"]:
        share = {kind: 100 * value for kind, value in row["reported"].items()}
        rest = f"{share['honest student']:.1f} %" if "honest student" in share else "none there"  # fmt: skip
        assert f"| {row['students']} | {share['patchwork']:.1f} % | {rest} |" in page
    for row in result["a third person"]:
        easy, translated, _ = shares(row)
        assert f"| {row['students']} | {easy:.1f} % | {translated:.1f} % |" in page
        assert easy >= 95
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
            tree = ast.parse((HONEST / COURSE.named(name).file).read_text())
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
    reported = [row for row in rows if row["list"] == "reported"]
    assert [(row["first"], row["second"]) for row in reported] == [
        ("student0", "thief<b>")
    ]
    assert reported[0]["exercises"] == "10"
    below = [row for row in rows if row["list"] == "worth a look, not reported"]
    assert len(reported) + len(below) == len(rows)
    assert all(NEAR <= float(row["score"]) < THRESHOLD for row in below)
    page = (tmp_path / "s.html").read_text()
    assert "thief&lt;b&gt;" in page
    assert "thief<b>" not in page
    assert "<mark>" in page
    assert page.count("<details>") == len(rows)
    above, _, under = page.partition("<h2>Worth a look, not reported</h2>")
    assert above.count("<details>") == 1
    assert under.count("<details>") == len(below)


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


@pytest.mark.slow
def test_pairs_below_the_threshold_are_listed_and_marked_as_such(tmp_path):
    """Two of ten answers were copied, which is not enough to report the pair."""
    folder = handed_over(tmp_path / "class", students=range(4))
    for name in ("track", "battery"):
        text = (folder / f"student0/ch2/{name}.py").read_text()
        (folder / f"student1/ch2/{name}.py").write_text(text)
    found = copies.compare_class(COURSE, folder)
    names = {(pair.first, pair.second) for pair in found.near}
    assert ("student0", "student1") in names
    assert names.isdisjoint((pair.first, pair.second) for pair in found.pairs)
    copies.write_comparison(found, COURSE, tmp_path / "s.html")
    page = (tmp_path / "s.html").read_text()
    under = page.partition("<h2>Worth a look, not reported</h2>")[2]
    assert "<strong>student0</strong> and <strong>student1</strong>" in under


@pytest.mark.slow
def test_somebody_with_several_sources_is_listed_with_them(tmp_path):
    folder = handed_over(tmp_path / "class", students=range(4))
    for number, name in enumerate(("track", "battery", "targets", "first_visits", "encode", "forward")):  # fmt: skip
        text = (folder / f"student{1 + number % 3}/ch2/{name}.py").read_text()
        (folder / f"student0/ch2/{name}.py").write_text(text)
    found = copies.compare_class(COURSE, folder)
    assert [one.student for one in found.patchworks] == ["student0"]
    sources = found.patchworks[0].sources
    assert set(sources["student1"]) >= {"2.4", "2.6"}
    assert set(sources["student2"]) >= {"2.7", "3.2"}
    assert set(sources["student3"]) >= {"2.5", "3.1"}
    copies.write_comparison(found, COURSE, tmp_path / "s.html")
    assert "<h2>Answers like those of several others</h2>" in (tmp_path / "s.html").read_text()  # fmt: skip
    rows = [*csv.DictReader(io.StringIO((tmp_path / "s.csv").read_text("utf-8-sig")))]
    listed = {row["second"] for row in rows if row["list"] == "several sources"}
    assert listed == {"student1", "student2", "student3"}


def ada_and_others(*sources):
    """All pairs of ada with others, in whom she has sources: name, exercises, and the chance of each."""
    chances = {(other, id): 0.9 for other in "bcdefg" for id in ("2.1", "2.2", "2.3", "2.4", "2.5")}  # fmt: skip
    for other, ids, chance in sources:
        chances |= {(other, id): chance for id in ids}
    return [
        Pair("ada", other, 0.0, {id: Likeness(0, 0, chance) for (name, id), chance in chances.items() if name == other})
        for other in "bcdefg"
    ]  # fmt: skip


def test_one_source_and_a_chance_likeness_are_no_patchwork():
    first = ("b", ("2.1", "2.2", "2.3", "2.4"), 0.001)
    assert patchworks(ada_and_others(first, ("c", ("2.5",), 0.015))) == []
    found = patchworks(ada_and_others(first, ("c", ("2.5",), 0.001)))
    assert [one.student for one in found] == ["ada"]
    assert found[0].sources == {"b": ("2.1", "2.2", "2.3", "2.4"), "c": ("2.5",)}
    assert found[0].score > THRESHOLD


BOTH_FORMS = {
    "in repeated lists": "r = [0.0] * len(b)\n    r[0] += a * b\n    return r",
    "as an array": "r = np.zeros(len(b))\n    r[0] += a * b\n    return r",
    "in lists": "r = [[], []]\n    r[0].append(a * b)\n    return r",
    "in a list": "r = []\n    r.append(a * b)\n    return r",
}


@pytest.mark.parametrize(
    ("loop", "array"),
    [("in repeated lists", "as an array"), ("in lists", "in a list")],
)
def test_loops_and_arrays_have_the_same_flow(loop, array):
    flows = [one(f"def f(a, b):\n    {BOTH_FORMS[form]}").flow for form in (loop, array)]  # fmt: skip
    assert flows[0] == flows[1]


def test_a_mean_is_a_sum_and_a_division():
    flows = [one(f"def f(a):\n    return {mean}").flow for mean in ("sum(a) / len(a)", "np.mean(a)")]  # fmt: skip
    assert all(("sum", "0") in flow and ("div", "0", "") in flow for flow in flows)


def test_a_translation_that_reads_one_more_argument_has_most_of_the_flow():
    """An operation on the result of another one counts also without the arguments that it comes from."""
    first = one("def f(a, b, c):\n    return max(a * b) + c").flow
    second = one("def f(a, b, c):\n    x = b + 0 * c\n    return max(a * x) + c").flow
    assert ("of", "max", "mul") in first & second


@pytest.mark.slow
def test_the_lines_that_a_variant_forces_are_known(tmp_path):
    """With --variant, what the variant's own solution has is no sign of copying."""
    folder, out = tmp_path / "class", tmp_path / "spring"
    made = variants.write(COURSE, "spring", out)
    ids = ("2.1", "2.2", "2.5")
    for name in ("ada", "bo", "cy"):
        (folder / name).mkdir(parents=True)
    for id in ids:
        exercise = made.exercises[id]
        text = (made.solutions / exercise.file).read_text()
        for name in ("ada", "bo"):
            (folder / name / f"{exercise.name}.py").write_text(text)
        text = (COURSE.solutions / "otherwise" / exercise.file).read_text()
        (folder / "cy" / f"{exercise.name}.py").write_text(text)
    own = copies.compare_class(made, folder)
    book = copies.compare_class(COURSE, folder)
    of_both = [
        next(
            p for p in found.pairs + found.near if (p.first, p.second) == ("ada", "bo")
        )
        for found in (own, book)
    ]
    assert of_both[0].score < of_both[1].score
    scores = []
    for options in ([], ["--variant", "spring"]):
        command = ["similarity", str(folder), "--out", str(tmp_path / "s.html")]
        done = CliRunner().invoke(app, [*command, *options])
        assert done.exit_code == 0, done.output
        rows = [
            *csv.DictReader(io.StringIO((tmp_path / "s.csv").read_text("utf-8-sig")))
        ]
        scores += [float(row["score"]) for row in rows if (row["first"], row["second"]) == ("ada", "bo")]  # fmt: skip
    assert scores == [round(of_both[1].score, 2), round(of_both[0].score, 2)]


@pytest.mark.slow
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
