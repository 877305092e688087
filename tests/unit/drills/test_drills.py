"""Every drill, with many seeds: a clear question, an answer that is right, and hints for usual mistakes alone."""

from __future__ import annotations

import json
import re
from collections import Counter

import pytest
from drills import QUESTIONS, different_questions

from robonav.drills import DRILLS, Choice, Number, Order, Place, Question, Table
from robonav.drills.markup import as_json, html

SEEDS = 1000
FEW = 25


def mistakes(question: Question) -> list[tuple[str, object]]:
    """The usual wrong answers of a question, with their hints."""
    asked = question.asked
    if isinstance(asked, Choice | Place):
        return [(hint, answer) for answer, hint in asked.wrong.items()]
    if isinstance(asked, Order):
        right = list(range(len(asked.steps)))
        swapped = []
        for i, j in asked.before:
            order = right.copy()
            order[i], order[j] = j, i
            swapped.append((asked.before[i, j], order))
        return swapped
    return [(hint, answer) for hint, answer in asked.wrong.items()]


def right_answer(question: Question) -> object:
    asked = question.asked
    if isinstance(asked, Number | Table):
        return asked.answer
    if isinstance(asked, Order):
        return list(range(len(asked.steps)))
    return asked.right if isinstance(asked, Choice) else asked.right[0]


def check(question: Question) -> None:
    assert question.clear
    assert question.judge(right_answer(question)).right
    for hint, answer in mistakes(question):
        verdict = question.judge(answer)
        assert not verdict.right
        assert verdict.hint == hint
        assert re.search(r"[.?]$", hint), f"no sentence: {hint}"
    shown = json.dumps(as_json(question))
    assert not re.search(r"\bnan\b|\binf\b|np\.|\+ -|- -", shown)
    assert "$" not in html(question.text) + html(question.explanation)
    assert not re.search(r"<(?:ol|ul|h\d|hr|pre|blockquote)\b", shown)
    assert question.explanation
    if isinstance(question.asked, Place):
        places = re.findall(r'data-place="([^"]+)"', question.picture)
        assert sorted(places) == sorted(question.asked.places)


@pytest.mark.parametrize("name", DRILLS)
def test_some_questions(name: str) -> None:
    for seed in range(FEW):
        check(DRILLS[name].question(seed))


@pytest.mark.slow
def test_most_drills_have_a_hundred_different_questions_and_all_but_orders_several() -> (
    None
):
    different = {name: len(different_questions(DRILLS[name])) for name in DRILLS}
    few = {name: number for name, number in different.items() if number < QUESTIONS}
    assert len(few) <= 40
    assert all(
        number >= 5 or isinstance(DRILLS[name].question(0).asked, Order)
        for name, number in few.items()
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", DRILLS)
def test_a_thousand_questions(name: str) -> None:
    for seed in range(SEEDS):
        check(DRILLS[name].question(seed))


def test_each_page_with_drills_has_four() -> None:
    numbers = Counter(drill.page for drill in DRILLS.values())
    assert {page for page, number in numbers.items() if number < 4} == set()


def test_the_same_seed_gives_the_same_question() -> None:
    for drill in DRILLS.values():
        assert as_json(drill.question(3)) == as_json(drill.question(3))


def test_each_drill_says_what_it_practises() -> None:
    for drill in DRILLS.values():
        assert drill.goal.endswith("."), drill.name
        assert drill.title


def test_a_drill_that_cannot_be_clear_says_so() -> None:
    from robonav.drills.registry import Drill

    asked = Number(1, wrong={"The same.": 1})
    drill = Drill("same", "page", "Title", lambda rng: Question("?", asked, "!"))
    with pytest.raises(RuntimeError, match="the drill same draws no question"):
        drill.question(0)


@pytest.mark.parametrize(
    "asked",
    [
        Number(1, tolerance=0.1, wrong={"Too near.": 1.15}),
        Number(1, tolerance=0.1, wrong={"One.": 2, "The other.": 2.1}),
        Number(float("nan")),
        Choice("a", wrong={"a": "The same."}),
        Place(["A"], right=["A"]),
        Place(["A", "B"], right=["A"], wrong={"A": "It is right."}),
        Order(["a", "a"]),
        Table(["r"], ["c"], [[1]], wrong={"The same.": [[1.001]]}),
    ],
)
def test_an_ambiguous_question_is_not_clear(asked: object) -> None:
    assert not Question("?", asked, "!").clear  # type: ignore[arg-type]
