"""Variants: every combination of knobs is an exercise of its own, and the book's answers do not solve it."""

import functools
import inspect
import itertools
import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from robonav.cli import app
from robonav.grading import variants
from robonav.grading.check import InProcessCalls, graded
from robonav.grading.course import Course, trusted
from robonav.grading.reference import Solutions, mistakes, solution

COURSE = Course.around(Path(__file__).parent)
ROBONAV = str(Path(sys.executable).with_name("robonav"))
LONG = [
    e for e in COURSE.exercises.values() if e.difficulty in ("open task", "project")
]
VARIED = [e for e in COURSE.exercises.values() if variants.knobs(COURSE, e)]


@pytest.fixture(scope="module", params=VARIED, ids=lambda exercise: exercise.name)
def exercise(request):
    """Each exercise with variants. Tests of the same one run one after the other, so that they share its variants."""
    return request.param


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The variants of an exercise that are tried: values, course and the reference of its answers.

    These are all of them. Of a long exercise, in which each answer drives, trains or searches, they have every two
    values together, and only the tests marked exhaustive try ``every`` one.
    """

    @functools.cache
    def written(exercise, values):
        folder = tmp_path_factory.mktemp(exercise.name)
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(os, "fsync", lambda file: None)  # many small files
            course = variants.write_values(COURSE, {exercise.id: dict(values)}, folder)
        return course, Solutions(course)

    def of(exercise, every=False):
        tried = variants.combinations(variants.knobs(COURSE, exercise))
        if exercise in LONG and not every:
            tried = variants.covering(tried)
        return [(values, *written(exercise, tuple(values.items()))) for values in tried]

    return of


def test_with_the_books_values_nothing_changes(exercise, tmp_path):
    values = variants.book(variants.knobs(COURSE, exercise))
    assert variants.rendered(COURSE, exercise, values) == variants.texts(
        COURSE, exercise
    )
    course = variants.write_values(COURSE, {exercise.id: values}, tmp_path)
    for folder, file in (
        ("solutions", exercise.file),
        ("solutions/wrong", exercise.file),
        ("exercises", exercise.file),
    ):
        ours, books = (c.root / folder / file for c in (course, COURSE))
        assert ours.read_bytes() == books.read_bytes()


def test_all_chapters_with_the_books_values_are_the_books(tmp_path):
    """Where every exercise of a chapter has knobs, tests and notebooks are the same bytes, too."""
    values = {e.id: variants.book(variants.knobs(COURSE, e)) for e in VARIED}
    course = variants.write_values(COURSE, values, tmp_path)
    for chapter, exercises in COURSE.chapters():
        if {e.id for e in exercises} <= set(values):
            for name in (
                f"tests/exercises/test_{chapter}.py",
                f"exercises/{chapter}.ipynb",
                f"solutions/nbgrader/source/{chapter}/{chapter}.ipynb",
            ):
                assert (course.root / name).read_bytes() == (
                    COURSE.root / name
                ).read_bytes()


def test_every_exercise_with_variants_has_three_knobs(exercise):
    of = variants.knobs(COURSE, exercise)
    assert len(of) >= 3
    assert len({knob.name for knob in of}) == len(of)
    assert all(len(set(knob.values)) >= 2 for knob in of)


def test_the_instructors_page_says_how_many_variants_there_are():
    others = [variants.product(variants.knobs(COURSE, e)) - 1 for e in VARIED]
    many = sum(number >= 11 for number in others)
    assert {number for number in others if number < 11} == {7}
    page = (COURSE.root / "book/instructors.md").read_text("utf-8")
    assert f"{many} of the {len(others)} exercises have 11 variants or more" in page


@pytest.mark.slow
def test_a_solution_passes_its_own_variant_and_no_other(
    exercise, made, passes, remembered
):
    """Of a long exercise, no variant's answer passes the book's exercise, and the book's answer passes no variant."""
    found = made(exercise)
    others = [values for values, _, _ in found[1:]] if exercise in LONG else ()
    passes_its_own_and_no_other(exercise, found, passes, remembered, without=others)


@pytest.mark.exhaustive
@pytest.mark.parametrize("exercise", LONG, ids=lambda exercise: exercise.name)
def test_so_it_is_for_all_pairs_of_a_long_exercise(exercise, made, passes, remembered):
    found = made(exercise, every=True)
    assert len(found) == variants.product(variants.knobs(COURSE, exercise))
    passes_its_own_and_no_other(exercise, found, passes, remembered)


def passes_its_own_and_no_other(exercise, found, passes, remembered, without=()):
    """Let every solution answer every variant; pairs of two variants that are both in ``without`` are left out."""
    functions = [remembered(solution(course, exercise)) for _, course, _ in found]
    for (values, course, known), function in zip(found, functions, strict=True):
        assert passes(course, known, exercise, function), values
    for (one, course, known), (two, function) in itertools.product(
        found, zip((values for values, _, _ in found), functions, strict=True)
    ):
        if one != two and not (one in without and two in without):
            assert not passes(course, known, exercise, function), (
                f"the solution of {two} passes {one}"
            )


@pytest.mark.slow
def test_known_mistakes_are_hinted_in_every_variant(exercise, made, passes):
    """Of a long exercise, in variants in which each value of each knob occurs."""
    found = made(exercise)
    tried = [values for values, _, _ in found]
    tried = with_each_value(tried) if exercise in LONG else variants.covering(tried)
    mistakes_are_hinted(exercise, found, tried[1:], passes)


@pytest.mark.exhaustive
@pytest.mark.parametrize("exercise", LONG, ids=lambda exercise: exercise.name)
def test_so_they_are_where_two_values_of_a_long_exercise_meet(exercise, made, passes):
    found = made(exercise)
    mistakes_are_hinted(exercise, found, [own for own, _, _ in found[1:]], passes)


def with_each_value(every):
    """The first combination, and as few others as give each value of each knob a place."""
    taken, missing = every[:1], {pair for values in every for pair in values.items()}
    missing -= taken[0].items()
    while missing:
        taken.append(max(every, key=lambda values: len(values.items() & missing)))
        missing -= taken[-1].items()
    return taken


def test_each_value_has_a_place():
    for exercise in LONG:
        every = variants.combinations(variants.knobs(COURSE, exercise))
        some = with_each_value(every)
        assert some[0] == every[0]
        assert len(some) < len(variants.covering(every))
        for name in every[0]:
            assert {own[name] for own in some} == {own[name] for own in every}


def mistakes_are_hinted(exercise, found, tried, passes):
    """Let every known mistake answer the variants with the ``tried`` values. The book's are in test_exercises."""
    for values, course, known in found:
        if values not in tried:
            continue
        assert len(mistakes(course, exercise)) >= 3
        for name, function in mistakes(course, exercise).items():
            if (
                exercise.difficulty == "open task"
            ):  # whose hints say what the robots did
                assert not passes(course, known, exercise, function), (name, values)
                continue
            with np.errstate(all="ignore"):
                result = graded(course, exercise, InProcessCalls(function), known)
            assert result["points"] < exercise.points, (name, values)
            said = {
                line.partition("Hint: ")[2]
                for line in result["feedback"].splitlines()
                if "Hint: " in line
            }
            hint = " ".join((inspect.getdoc(function) or "").split())
            assert said == {hint}, (name, values, result["feedback"])
            unsaid = result["feedback"].count("The same error as above.")
            failed = result["feedback"].count("✗")
            assert result["feedback"].count("Hint: ") + unsaid == failed


@pytest.mark.slow
def test_a_stub_scores_nothing_and_fits_the_page(exercise, made):
    for _, course, known in made(exercise):
        stub = course.stubs / exercise.file
        text = stub.read_text("utf-8")
        assert "SOLUTION" not in text
        too_wide = [line for line in text.splitlines() if len(line) > 88]
        assert [line for line in too_wide if not line.startswith("$$")] == []
        function = getattr(trusted(stub), exercise.name)
        result = graded(course, exercise, InProcessCalls(function), known)
        assert (result["points"], result["state"]) == (0, "missing")
        names = list(inspect.signature(function).parameters)
        assert course.parameters(exercise) == names
        assert all(f"{name} :" in text or f"{name}," in text for name in names)


@pytest.mark.slow
def test_every_variant_asks_for_something_else(exercise, made):
    asked = [
        (course.stubs / exercise.file).read_text("utf-8")
        for _, course, _ in made(exercise, every=True)
    ]
    assert len(set(asked)) == len(asked)


def test_a_secret_never_chooses_the_books_exercise_and_another_chooses_others(exercise):
    of = variants.knobs(COURSE, exercise)
    secrets = [f"term {number}" for number in range(6)]
    found = [variants.chosen(secret, exercise, of) for secret in secrets]
    assert found == [variants.chosen(secret, exercise, of) for secret in secrets]
    assert variants.book(of) not in found
    assert len({tuple(values.items()) for values in found}) > 1
    assert all(values[knob.name] in knob.values for values in found for knob in of)


def test_a_knob_of_few_parts_never_differs_alone():
    few = variants.Knob("few", ("a", "b"), ("?",), alone=False)
    exercise, of = VARIED[0], [few, variants.Knob("many", ("a", "b"), ("?",))]
    found = [variants.chosen(f"term {k}", exercise, of) for k in range(12)]
    assert {values["many"] for values in found} == {"b"}
    assert {values["few"] for values in found} == {"a", "b"}


@pytest.mark.slow
@pytest.mark.parametrize(("id", "share", "many"), [("3.2", 0.6, 10), ("6.2", 0.5, 6)])
def test_the_books_answer_earns_little_where_a_knob_changes_one_part(
    made, id, share, many
):
    exercise = COURSE.named(id)
    of = variants.knobs(COURSE, exercise)
    chosen = [variants.chosen(f"term {k}", exercise, of) for k in range(80)]
    found = made(exercise)
    function = solution(found[0][1], exercise)
    tried = [(course, known) for values, course, known in found if values in chosen]
    assert len(tried) == many
    for course, known in tried:
        result = graded(course, exercise, InProcessCalls(function), known)
        assert result["points"] <= share * exercise.points


def test_every_exercise_of_the_book_has_variants():
    assert variants.without_variants(COURSE) == []


def test_an_exercise_without_variants_is_named(monkeypatch):
    monkeypatch.setattr(variants, "knobs", lambda course, exercise: ())
    exercise = COURSE.named("2.2")
    for asked in (
        lambda: variants.chosen("x", exercise, ()),
        lambda: variants.rendered(COURSE, exercise, {}),
    ):
        with pytest.raises(ValueError, match=r"exercise 2\.2 has no variants yet"):
            asked()
    assert variants.without_variants(COURSE) == list(COURSE.exercises.values())


def test_fragments_that_stand_nowhere_or_overlap_are_refused(monkeypatch):
    exercise = COURSE.named("2.2")
    ties, *others = variants.knobs(COURSE, exercise)
    values = {knob.name: knob.values[-1] for knob in (ties, *others)}

    def refused(*of):
        monkeypatch.setattr(variants, "knobs", lambda course, exercise: of)
        return pytest.raises(ValueError, match="knob")

    stale = replace(ties, source=(("no such words", "others"),))
    with refused(stale, *others) as caught:
        variants.rendered(COURSE, exercise, values)
    assert "a text that does not stand there: 'no such words'" in str(caught.value)
    twice = replace(ties, name="again")
    with refused(ties, twice, *others) as caught:
        variants.rendered(COURSE, exercise, {**values, "again": "highest"})
    assert "knobs ties and again change the same place" in str(caught.value)
    with pytest.raises(ValueError, match="2 fragments, got"):
        replace(ties, source=(("one fragment",),))
    with pytest.raises(ValueError, match="an entry for each value but the first, 1"):
        replace(ties, hints=())


def run(*arguments, cwd=COURSE.root, **environment):
    done = subprocess.run(
        [ROBONAV, *map(str, arguments)],
        cwd=cwd,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
    )
    return done.returncode, done.stdout + done.stderr


@pytest.mark.slow
def test_a_wrong_input_is_one_sentence(tmp_path):
    (tmp_path / "full").mkdir()
    (tmp_path / "full/thesis.txt").write_text("precious")
    needs_both = "a variant needs both --variant and --out"
    code, said = run("exercises", "build", "--variant", "x")
    assert (code, needs_both in said, "Traceback" in said) == (2, True, False), said
    for arguments, sentence in (
        (["--out", tmp_path], needs_both),
        (["--variant", " ", "--out", tmp_path / "new"], "must be a text, got an empty"),
        (["--student", "ada"], needs_both),
        (
            ["--variant", "x", "--out", tmp_path / "new", "--student", "../ada"],
            "must be the name of a folder, got '../ada'",
        ),
        (["--variant", "x", "--out", tmp_path / "full"], "must be a new folder"),
        (["--variant", "x", "--out", COURSE.root], "must be a new folder"),
    ):
        build = ["exercises", "build", *map(str, arguments)]
        refused = CliRunner().invoke(app, build).exception
        assert isinstance(refused, ValueError)  # of which the command prints one line
        assert sentence in str(refused)
    assert (tmp_path / "full/thesis.txt").read_text() == "precious"


def test_no_variant_is_written_over_another(tmp_path):
    """One for all and one for each student are told apart, and the same one may be written again."""
    for name, secret in (("one", "autumn"), ("each/ada", "autumn/ada")):
        (tmp_path / name).mkdir(parents=True)
        mark = tmp_path / name / variants.MARK
        mark.write_text(json.dumps(variants._values(COURSE, secret)))
    there = sorted(tmp_path.rglob("*"))
    build = ["exercises", "build", "--variant"]
    for arguments, said in (
        (["spring", "--out", tmp_path / "one"], "one holds another variant"),
        (
            ["autumn", "--student", "ada", "--out", tmp_path / "one"],
            "one holds one variant for all students; choose another folder",
        ),
        (
            [
                "spring",
                "--student",
                "bo",
                "--student",
                "ada",
                "--out",
                tmp_path / "each",
            ],
            "ada holds another variant",
        ),
    ):
        done = CliRunner().invoke(app, [str(word) for word in build + arguments])
        assert isinstance(done.exception, ValueError), arguments
        assert said in str(done.exception)
    assert sorted(tmp_path.rglob("*")) == there
    variants.check_replaces_nothing(COURSE, "autumn", tmp_path / "one")
    (tmp_path / "one" / variants.MARK).write_text("torn")
    with pytest.raises(ValueError, match="holds another variant"):
        variants.check_replaces_nothing(COURSE, "autumn", tmp_path / "one")


@pytest.mark.slow
def test_a_term_with_a_variant(tmp_path):
    """An instructor builds it, students check and hand in, and the class is graded."""
    out, unpacked = tmp_path / "term", tmp_path / "home"
    code, said = run("exercises", "build", "--variant", "autumn", "--out", out)
    assert code == 0, said
    left_out = [e.id for e in variants.without_variants(COURSE)]
    assert ("left out" in said) == bool(left_out)
    assert all(id in said for id in left_out)
    again = variants.write(COURSE, "autumn", tmp_path / "again").root
    for path in again.rglob("*"):
        twin = out / path.relative_to(again)
        assert path.is_dir() or path.read_bytes() == twin.read_bytes()
    values = json.loads((out / "variant.json").read_text())
    assert list(values) == [e.id for e in VARIED]
    subprocess.run(
        [
            sys.executable,
            "-m",
            "zipfile",
            "-e",
            out / "robonav-exercises.zip",
            unpacked,
        ],
        check=True,
    )
    home = unpacked / "robonav-exercises"
    files = [path for path in home.rglob("*") if path.is_file()]
    assert not [path for path in files if "solution" in str(path.relative_to(home))]
    assert not [path for path in files if b"### BEGIN" in path.read_bytes()]
    assert not list(home.rglob("variant.json"))
    code, said = run("check", "2.2", cwd=home)
    assert (code, "Not begun: write improve" in said) == (1, True), said
    own = (out / "solutions/ch2/improve.py").read_text()
    (home / "exercises/ch2/improve.py").write_text(own)
    assert run("check", "2.2", cwd=home)[0] == 0
    books = (COURSE.solutions / "ch2/improve.py").read_text()
    (home / "exercises/ch2/improve.py").write_text(books)
    code, said = run("check", "2.2", cwd=home)
    assert (code, "Hint: " in said) == (1, True), said

    hand_in = {"ada": own, "bo": books}
    for name, text in hand_in.items():
        (tmp_path / f"class/{name}").mkdir(parents=True)
        (tmp_path / f"class/{name}/improve.py").write_text(text)
    grade = ["grade", tmp_path / "class", "--out", tmp_path / "graded", "--jobs", 1]
    if "--practice" not in grade and not _sandbox():
        grade.append("--practice")
    code, said = run(*grade, "--variant", "autumn", "--exercise", "2.2", "--similarity")
    assert code == 0, said
    assert "Pairs that are too alike: 0 of 1" in said
    assert "fewer than 3 exercises in common, too few to tell: 1" in said
    assert (tmp_path / "graded/similarity.html").exists()
    points = {
        name: {
            entry["id"]: entry["points"]
            for entry in json.loads(
                (tmp_path / f"graded/students/{name}/grade.json").read_text()
            )["exercises"]
        }
        for name in hand_in
    }
    assert points["ada"]["2.2"] == 4
    assert points["bo"]["2.2"] < 4
    assert set(points["ada"]) == set(values)
    code, said = run(*grade, "--variant", "spring")
    assert (code, "was graded with another variant" in said) == (2, True), said


@pytest.mark.slow
def test_each_student_has_exercises_of_their_own(tmp_path):
    from robonav.grading import sandbox_check
    from robonav.grading.classroom import GradingConfig, grade_class

    exercise, names = COURSE.named("2.2"), ("ada", "bo")
    of = variants.knobs(COURSE, exercise)
    secret = next(  # one with which the two differ
        text
        for text in map(str, range(100))
        if variants.chosen(f"{text}/ada", exercise, of)
        != variants.chosen(f"{text}/bo", exercise, of)
    )
    built = variants.EachStudent(COURSE, secret, tmp_path / "built")
    own = built.of("ada").solutions / exercise.file
    for name in names:  # bo hands in what ada wrote
        (tmp_path / "class" / name).mkdir(parents=True)
        (tmp_path / "class" / name / "improve.py").write_bytes(own.read_bytes())
    out = tmp_path / "graded"
    each = variants.for_each_student(COURSE, secret, tmp_path / "class", out)
    config = GradingConfig(COURSE, sandbox_check.best(), each=each)
    assert grade_class(config, tmp_path / "class", out, jobs=1) == []
    grades = {
        name: json.loads((out / f"students/{name}/grade.json").read_text())
        for name in names
    }
    points = {
        name: next(e["points"] for e in grade["exercises"] if e["id"] == "2.2")
        for name, grade in grades.items()
    }
    assert points["ada"] == exercise.points
    assert points["bo"] < exercise.points
    for name in names:
        used = variants.own_course(COURSE, out, name).solutions / exercise.file
        assert (
            used.read_bytes() == (built.of(name).solutions / exercise.file).read_bytes()
        )
    again = variants.for_each_student(COURSE, secret, tmp_path / "class", out)
    assert again.key() == each.key()
    for refused in (
        lambda: variants.for_each_student(COURSE, "x", tmp_path / "class", out),
        lambda: variants.course_for(COURSE, secret, tmp_path / "class", out),
    ):
        with pytest.raises(ValueError, match="was graded with"):
            refused()


@pytest.mark.sandbox
def test_gradescope_grades_a_variant(tmp_path):
    from robonav.grading import sandbox_check

    if fault := sandbox_check.fault("official"):
        pytest.skip(fault)
    exercise, own = COURSE.named("2.2"), tmp_path / "submission"
    values = variants.chosen("a text", exercise, variants.knobs(COURSE, exercise))
    for folder in ("source", "submission"):
        (tmp_path / folder).mkdir()
    (tmp_path / "venv").symlink_to(Path(sys.executable).parents[1])
    (tmp_path / "source/variant").write_text("a text\n")
    text = variants.rendered(COURSE, exercise, values).source
    (own / "improve.py").write_text(text)
    subprocess.run(
        [COURSE.solutions / "gradescope/run_autograder"],
        env={**os.environ, "AUTOGRADER_ROOT": str(tmp_path)},
        check=True,
        capture_output=True,
        timeout=300,
    )
    results = json.loads((tmp_path / "results/results.json").read_text())
    assert results["score"] == exercise.points


def _sandbox():
    from robonav.grading import sandbox_check

    return sandbox_check.best() != "practice"


def test_a_class_graded_without_a_variant_is_not_graded_with_one(tmp_path):
    (tmp_path / "out/students").mkdir(parents=True)
    with pytest.raises(ValueError, match="was graded without a variant"):
        variants.course_for(COURSE, "x", tmp_path / "class", tmp_path / "out")
    with pytest.raises(ValueError, match="must not lie in the class folder"):
        variants.course_for(COURSE, "x", tmp_path, tmp_path / "out")


@pytest.mark.slow
def test_a_class_is_graded_again_only_with_the_same_options(tmp_path):
    """All changes between no variant, one for all, and one for each student are refused before anything is graded."""
    options = {
        "plain": [],
        "one": ["--variant", "x"],
        "each": ["--variant", "x", "--each-student"],
    }
    said = {
        "plain": "was graded without a variant; choose another folder",
        "one": "was graded with --variant; give the same --variant again",
        "each": "was graded with --variant and --each-student; give both again",
    }
    (tmp_path / "class/ada").mkdir(parents=True)
    secret = tmp_path / "secret"
    secret.write_text("a long secret of this class\n")
    for before in options:
        out = tmp_path / before
        if before == "one":
            variants.course_for(COURSE, "x", tmp_path / "class", out)
        elif before == "each":
            variants.for_each_student(COURSE, "x", tmp_path / "class", out)
        (out / "students/ada").mkdir(parents=True)
        there = sorted(out.rglob("*"))
        for now, given in options.items():
            if now != before:
                arguments = ["grade", tmp_path / "class", "--out", out, "--secret"]
                arguments += [secret, *given]
                done = CliRunner().invoke(app, [str(word) for word in arguments])
                assert isinstance(done.exception, ValueError), (before, now)
                assert said[before] in str(done.exception), (before, now)
                assert sorted(out.rglob("*")) == there, (before, now)
    for before, way in (("plain", ""), ("one", variants.VARIANT)):
        variants.check_same_options(tmp_path / before, way)
    variants.check_same_options(tmp_path / "each", variants.VARIANT_EACH)
    variants.check_same_options(tmp_path / "new", "")


PAGE = """
import sys
sys.path.insert(0, {folder!r})
extensions = ["myst_nb", "sphinx_exercise", "sphinx_design", "course_exercises"]
myst_enable_extensions = ["dollarmath"]
nb_execution_mode = "off"
suppress_warnings = ["myst.xref_missing"]
"""


@pytest.mark.slow
def test_the_page_shows_the_variant(tmp_path):
    pytest.importorskip("sphinx_exercise")
    exercise = COURSE.named("2.2")
    values = variants.chosen("autumn", exercise, variants.knobs(COURSE, exercise))
    made = variants.write_values(COURSE, {"2.2": values}, tmp_path / "term")
    book = tmp_path / "book"
    book.mkdir()
    (book / "conf.py").write_text(PAGE.format(folder=str(COURSE.root / "book/_ext")))
    (book / "index.md").write_text((COURSE.root / "book/exercises-2.md").read_text())
    for page in ("dynamic-programming", "max-margin"):
        text = "---\norphan: true\n---\n# A page\n\n```{exercises}\n```\n"
        (book / f"{page}.md").write_text(text)
    subprocess.run(
        [sys.executable, "-m", "sphinx", "-q", "-b", "html", book, tmp_path / "built"],
        env={**os.environ, "EXERCISES": str(made.root)},
        check=True,
        capture_output=True,
    )
    page = (tmp_path / "built/index.html").read_text()
    assert "Improvement where actions tie" in page
    assert "A backup with rewards" not in page
    listed = (tmp_path / "built/dynamic-programming.html").read_text()
    assert "2.2 Improvement where actions tie" in listed
    assert "2.3" not in listed
    nothing = (tmp_path / "built/max-margin.html").read_text()
    assert "No exercise of this term belongs to this page." in nothing
