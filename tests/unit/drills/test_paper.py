"""Papers to print: read back by pypdf, and each line of type measured."""

from __future__ import annotations

import io
import re

import pytest
from numbers_in_texts import question_of

from robonav.drills import DRILLS, Choice, Number, Place
from robonav.drills.export import (
    Paper,
    drawn,
    exam_pdf,
    selected,
    solutions_pdf,
    spread,
)
from robonav.drills.export import formula as formulas
from robonav.drills.export.answers import asked_text, options, points
from robonav.drills.export.paper import INDENT, MARGIN, SIZES, with_decimals
from robonav.drills.export.svg import MINUS, Label, read

pytest.importorskip("reportlab")
from robonav.drills.export.typeset import lines

SEEDS = range(6)
WIDTH = SIZES["a4"][0] - 2 * MARGIN - INDENT


def texts(content: bytes) -> list[str]:
    """The text of each page, in one line."""
    pypdf = pytest.importorskip("pypdf")
    pages = pypdf.PdfReader(io.BytesIO(content)).pages
    return [" ".join(page.extract_text().split()) for page in pages]


def words(markdown: str) -> list[str]:
    """Stretches of words that stand whole in a line or over two: what is between formulas and emphasis."""
    parts = re.split(r"\$[^$]*\$|[*`]", MINUS.sub("−", markdown))
    return [
        part for part in (" ".join(part.split()) for part in parts) if len(part) > 15
    ]


@pytest.fixture(scope="module")
def paper() -> Paper:
    return Paper(3, drawn(selected(), seed=3))


@pytest.fixture(scope="module")
def exam(paper: Paper) -> str:
    return " ".join(texts(exam_pdf([paper], "Robots")))


@pytest.fixture(scope="module")
def solutions(paper: Paper) -> str:
    return " ".join(texts(solutions_pdf([paper], "Robots")))


@pytest.mark.slow
def test_every_question_is_in_the_exam(paper, exam) -> None:
    for number, one in enumerate(paper.questions, start=1):
        assert f"{number}. {one.drill.title}" in exam
        for part in words(asked_text(one.question)):
            assert part[:15] in exam
            assert all(word in exam for word in part.split())
        if isinstance(one.question.asked, Choice):
            for option in options(one.question.asked):
                assert all(part[:15] in exam for part in words(option.text))


@pytest.mark.slow
def test_the_exam_says_no_answer(paper, exam) -> None:
    assert "Usual mistakes" not in exam
    assert "Solutions" not in exam
    for one in paper.questions:
        shown = " ".join([one.question.text, *getattr(one.question.asked, "steps", [])])
        for part in words(one.question.explanation):
            if len(part) > 40 and part not in shown:
                assert part not in exam
    units = {getattr(one.question.asked, "unit", "") for one in paper.questions}
    empty = (
        rf"(?:{'|'.join(sorted(units, reverse=True))}) ?(?:\d+\. [A-Z]|Robots Paper)"
    )
    fields = re.findall(r"(?:Answer|Order): (.{20})", exam)
    assert len(fields) > len(paper.questions) / 3
    assert [field for field in fields if not re.match(empty, field)] == []


@pytest.mark.slow
def test_solutions_have_answers_and_explanations(paper, solutions) -> None:
    assert solutions.count("Solutions of paper 3") > 1
    for one in paper.questions:
        asked = one.question.asked
        if isinstance(asked, Number):
            number = with_decimals(asked.answer, one.question.decimal_places)
            assert f"Answer: {number}" in solutions
        if isinstance(asked, Place):
            assert f"Answer: {' or '.join(asked.right)}" in solutions
        for part in words(one.question.explanation):
            assert all(word in solutions for word in part.split())


def test_points_are_added_up(paper, exam) -> None:
    total = sum(points(one.question.asked) for one in paper.questions)
    assert f"/ {total} " in exam


@pytest.mark.slow
def test_papers_differ_and_can_be_made_again() -> None:
    chosen = selected(drills=["td-error", "bellman-backup", "softmax"])
    papers = [Paper(seed, drawn(chosen, seed)) for seed in range(1, 41)]
    pages = texts(exam_pdf(papers, "Robots"))
    assert len(pages) % 2 == 0
    per_paper = len(pages) // len(papers)
    together = [
        " ".join(pages[k : k + per_paper]) for k in range(0, len(pages), per_paper)
    ]
    for paper, text in zip(papers, together, strict=True):
        assert f"Paper {paper.number}, page 1 of {per_paper}" in text
    stripped = {re.sub(r"Paper \d+", "", text) for text in together}
    assert len(stripped) == len(papers)
    assert exam_pdf(papers[:4]) == exam_pdf(papers[:4])
    alone = " ".join(texts(exam_pdf([Paper(17, drawn(chosen, 17))], "Robots")))
    number = together[16].index("1. ")
    assert together[16][number : number + 200] == alone[alone.index("1. ") :][:200]


@pytest.mark.parametrize("name", DRILLS)
def test_every_line_fits(name: str) -> None:
    for seed in SEEDS:
        question = question_of(name, seed)
        for text in (asked_text(question), question.explanation):
            assert all(line.width <= WIDTH for line in lines(text, WIDTH))


def test_few_formulas_need_mathtext(monkeypatch) -> None:
    """It is slow: two milliseconds a formula."""
    slow = []
    real = formulas._mathtext
    monkeypatch.setattr(
        formulas, "_mathtext", lambda *given: slow.append(given[0]) or real(*given)
    )
    every = {
        formula
        for drill in DRILLS.values()
        for question in (question_of(drill.name, seed) for seed in range(3))
        for text in (question.text, question.explanation)
        for formula in re.findall(r"\$([^$]+)\$", text)
    }
    for formula in every:
        formulas.pieces.__wrapped__(formula, 11.0)
    assert len(slow) < 0.02 * len(every), slow


def test_mathtext_sets_what_is_beyond() -> None:
    ((_, box, _),) = formulas.pieces(r"\frac{1}{2}", 11.0)
    assert {run.text for run in box.runs} == {"1", "2"}
    assert box.rules


def test_a_text_that_begins_with_a_number_is_no_list() -> None:
    (line,) = lines("1. Sense; 2. act.", 200.0)
    assert [run.text for run in line.runs] == ["1.", "Sense;", "2.", "act."]
    assert line.runs[0].x == 0


def test_signs_stand_as_in_tex() -> None:
    ((_, box, _),) = formulas.pieces("a - -2", 10.0)
    minus = [run.x for run in box.runs if run.text.startswith("−")]
    two = next(run.x for run in box.runs if run.text == "2")
    assert two - minus[1] < minus[1] - minus[0]


@pytest.mark.parametrize("name", DRILLS)
def test_pictures_name_their_places(name: str) -> None:
    question = question_of(name, 1)
    if question.picture:
        drawing = read(question.picture)
        shown = " ".join(
            shape.text for shape in drawing.shapes if isinstance(shape, Label)
        )
        if isinstance(question.asked, Place):
            for place in question.asked.places:
                assert place.split()[-1] in shown.split()
            assert "lick" not in asked_text(question)


def test_drills_are_spread_evenly() -> None:
    chosen = spread(selected(), 10)
    assert len({drill.name for drill in chosen}) == 10
    assert chosen[0] == selected()[0]
    assert chosen[-1] == selected()[-1]


def test_a_size_of_paper_is_known_or_refused() -> None:
    with pytest.raises(ValueError, match="paper must be one of a4, letter"):
        exam_pdf([], size="a5")
