"""Every drill, with many seeds: a clear question, an answer that is right, and hints for usual mistakes alone."""

from __future__ import annotations

import json
import re
from collections import Counter

import numpy as np
import pytest
from drills import QUESTIONS, different_questions, packed
from numbers_in_texts import question_of
from scipy.stats import chi2

from robonav.drills import (
    DRILLS,
    Choice,
    Drill,
    Number,
    Order,
    Place,
    Question,
    Table,
)
from robonav.drills.markup import as_json, html
from robonav.drills.rounding import decimals, words

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


PLAIN_FORMULA = re.compile(
    r"\w [=+*/×<>] \S|\d ?/ ?\d|\b(rho|gamma|alpha(?! vectors)|theta|epsilon|eta|sigma|beta|lambda)\b"
)


def texts(question: Question) -> list[str]:
    """All texts of a question that a reader can see."""
    asked, hints = question.asked, [hint for hint, _ in mistakes(question)]
    shown: list[str] = []
    if isinstance(asked, Choice):
        shown = [*asked.options]
    elif isinstance(asked, Order):
        shown = [*asked.steps]
    elif isinstance(asked, Table):
        shown = [*asked.rows, *asked.columns]
    return [question.text, question.explanation, *hints, *shown]


def check(question: Question) -> None:
    assert question.clear
    assert question.judge(right_answer(question)).right
    if places := question.decimal_places:
        rounded = np.round(np.array(right_answer(question), float), places).tolist()
        assert question.judge(rounded).right
    assert any(hint for hint, _ in mistakes(question)), "no usual mistake has a hint"
    for hint, answer in mistakes(question):
        verdict = question.judge(answer)
        assert not verdict.right
        assert verdict.hint == hint
        assert re.search(r"[.?]$", hint), f"no sentence: {hint}"
    for text in texts(question):
        assert not PLAIN_FORMULA.search(re.sub(r"\$[^$]*\$|`[^`]*`", "", text)), text
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
        check(question_of(name, seed))


@pytest.mark.slow
@pytest.mark.parametrize("name", DRILLS)
def test_a_hundred_different_questions(name: str) -> None:
    """Different for a reader: options, steps and hints in another order make no other question."""
    different = different_questions(DRILLS[name])
    assert len(different) >= QUESTIONS
    for question in different:
        check(question)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", DRILLS)
def test_a_thousand_questions(name: str) -> None:
    for seed in range(FEW, SEEDS):
        check(DRILLS[name].question(seed))


CHOICES = [name for name in DRILLS if isinstance(DRILLS[name].question(0).asked, Choice)]  # fmt: skip
DRAWS = 150


@pytest.mark.parametrize("name", CHOICES)
def test_the_place_of_the_right_option_tells_nothing(name: str) -> None:
    """The right option is as often first, second, ... as chance would have it, by Pearson's test."""
    found: Counter[int] = Counter()
    expected: Counter[int] = Counter()
    for seed in range(DRAWS):
        asked = question_of(name, seed).asked
        assert isinstance(asked, Choice)
        found[asked.options.index(asked.right)] += 1
        expected.update(dict.fromkeys(range(len(asked.options)), 0))
        for place in range(len(asked.options)):
            expected[place] += 1 / len(asked.options)
    statistic = sum((found[k] - n) ** 2 / n for k, n in expected.items())
    assert statistic < chi2.ppf(0.999, len(expected) - 1), dict(found)


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


def test_options_without_an_order_of_their_own_are_shuffled() -> None:
    orders = {DRILLS["fair-or-not"].question(seed).asked.options for seed in range(9)}
    assert any(list(options) != sorted(options) for options in orders)
    asked = DRILLS["vote-of-neighbours"].question(0).asked
    assert asked.options == ("F", "L30", "R30")


def test_numbers_that_make_no_good_question_are_drawn_again() -> None:
    def draw(rng: np.random.Generator) -> Question | None:
        number = int(rng.integers(2))
        return Question("?", Number(1), "!") if number else None

    drill = Drill("odd", "page", "Title", draw)
    assert all(drill.question(seed).text == "?" for seed in range(9))


def test_what_pages_load_says_each_text_once() -> None:
    question = {
        "text": r'An <span class="math inline">\(x\)</span> again.',
        "answer": 1,
    }
    questions, shared = packed([question, {**question, "answer": 2}])
    assert questions == [{"text": "@0", "answer": 1}, {"text": "@0", "answer": 2}]
    assert shared == [r"An \(x\) again."]


@pytest.mark.parametrize(
    ("given", "hint"),
    [
        (0.7, "This is rounded too far: give two decimals."),
        (0.72, ""),
        (0.6, ""),
        (1.0, ""),
        (0.9, "Another mistake."),
    ],
)
def test_an_answer_that_is_rounded_too_far_is_told_so(given: float, hint: str) -> None:
    asked = Number(0.7234, wrong={"Another mistake.": 0.9})
    assert asked.judge(given).hint == hint
    assert asked.judge(given).right == (given == 0.72)
    other = Table(
        ["r"], ["c", "d"], [[0.7234, 2]], wrong={"Another mistake.": [[0.9, 2]]}
    )
    assert other.judge([[given, 2]]).hint == hint
    assert other.judge([[given, 3]]).hint == hint * (given == 0.9)


def test_a_usual_mistake_comes_before_rounding() -> None:
    asked = Number(0.7234, wrong={"A mistake.": 0.7})
    assert asked.judge(0.7).hint == "A mistake."


@pytest.mark.parametrize("name", DRILLS)
def test_rounding_to_the_decimals_that_are_asked_for_costs_nothing(name: str) -> None:
    """What a text asks for is what the tolerance allows, and no more."""
    for seed in range(FEW):
        question = question_of(name, seed)
        asked = question.asked
        if not isinstance(asked, Number | Table):
            continue
        named = re.search(r"(one|two|three|four) decimals?", question.text)
        said = question.decimals or (named[0] if named else "")
        rows = asked.answer if isinstance(asked, Table) else [[asked.answer]]
        if not said:  # whole numbers
            assert all(round(float(n), 8).is_integer() for row in rows for n in row)
            continue
        assert said == words(decimals(asked.tolerance))
        count = ["one", "two", "three", "four"].index(said.split()[0]) + 1
        rounded = [[round(float(n), count) for n in row] for row in rows]
        given = rounded if isinstance(asked, Table) else rounded[0][0]
        assert question.judge(given).right
