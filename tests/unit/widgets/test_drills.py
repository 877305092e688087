"""The page judges answers as Python does, and remembers what is mastered."""

from __future__ import annotations

import numpy as np
import pytest
from drills import packed

from robonav.drills import DRILLS, Choice, Number, Order, Place, Question, Table
from robonav.drills.markup import as_json, html

SEEDS = 6
MASTERED, DAYS = 3, [1, 3, 7, 21, 60]


def answers(question, rng):
    """Some answers, right and wrong, as Python and as the page take them."""
    asked = question.asked
    if isinstance(asked, Choice):
        return [(option, k) for k, option in enumerate(asked.options)]
    if isinstance(asked, Place):
        return [(place, place) for place in asked.places]
    if isinstance(asked, Order):
        orders = [rng.permutation(len(asked.steps)).tolist() for _ in range(6)]
        return [(order, order) for order in [*orders, sorted(orders[0])]]
    tables = [asked.answer, *asked.wrong.values()]
    near = [np.round(np.asarray(table, float), 2).tolist() for table in tables]
    near += [np.round(np.asarray(asked.answer, float), k).tolist() for k in (0, 1)]
    return [(table, table) for table in near]


def test_unpacks_what_the_book_packs(node):
    for name in ("which-sensor-reports", "td-error", "fair-or-not", "refined"):
        drawn = [as_json(DRILLS[name].question(seed)) for seed in range(9)]
        questions, texts = packed(drawn)
        body = "return page.unpacked(data[0], data[1]);"
        assert node("drills", body, [questions, texts]) == drawn


@pytest.mark.slow
def test_judges_as_python_does(node):
    rng = np.random.default_rng(0)
    cases, expected = [], []
    for drill in DRILLS.values():
        for seed in range(SEEDS):
            question = drill.question(seed)
            for own, given in answers(question, rng):
                verdict = question.judge(own)
                cases.append([as_json(question)["asked"], given])
                expected.append({"right": verdict.right, "hint": html(verdict.hint)})
    found = node(
        "drills",
        "return data.map(([asked, given]) => page.judge(asked, given));",
        cases,
    )
    assert found == expected
    assert {verdict["right"] for verdict in found} == {True, False}


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("0.25", 0.25),
        (" 0,25 ", 0.25),
        ("-3", -3),
        ("−3", -3),
        (".5", 0.5),
        ("1e-3", 0.001),
    ],
)
def test_numbers_as_people_type_them(node, text, number):
    assert node("drills", "return page.typed(data);", text) == number


@pytest.mark.parametrize("text", ["", "abc", "1.2.3", "0x10", "Infinity", "1 2"])
def test_what_is_no_number(node, text):
    assert node("drills", "return Number.isNaN(page.typed(data));", text)


def test_mastered_after_three_and_due_ever_later(node):
    body = """
      const today = new Date("2026-01-01T12:00:00Z");
      const records = [];
      let record;
      for (const right of data) records.push((record = page.answered(record, right, today)));
      return records;
    """
    records = node("drills", body, [True] * 8 + [False])
    assert [record["streak"] for record in records] == [*range(1, 9), 0]
    first = np.datetime64("2026-01-01")
    waits = [
        int((np.datetime64(record["due"]) - first).astype(int)) for record in records
    ]
    assert waits == [0, 0, *DAYS, DAYS[-1], 0]
    assert (records[-1]["right"], records[-1]["wrong"]) == (8, 1)


def test_a_browser_that_keeps_nothing(node):
    body = """
      globalThis.localStorage = {
        getItem() { throw new Error("blocked"); }, setItem() { throw new Error("blocked"); } };
      return [page.remembered(), page.remember({})];
    """
    assert node("drills", body, None) == [{}, False]


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (Number(17.857), "(two decimals)"),
        (Number(0.1234, 0.0011), "(three decimals)"),
        (Number(53.13, 0.06), "(one decimal)"),
        (Number(4), ""),
        (Number(4, wrong={"Half of it is missing.": 2.5}), "(two decimals)"),
        (Number(4.2, 0.5), ""),
        (Number(0.1 + 0.2, 0.0), ""),
        (Table(["V"], ["A", "B"], [[1.0, 2.25]]), "(two decimals)"),
        (Table(["V"], ["A", "B"], [[1.0, 2.0]]), ""),
    ],
)
def test_a_form_says_how_many_decimals_count(node, asked, words) -> None:
    question = Question("What is $V(s)$?", asked, "So it is.")
    assert node("drills", "return page.decimals(data);", as_json(question)) == words
    question = Question("What is $V(s)$? Give three decimals.", asked, "So it is.")
    assert node("drills", "return page.decimals(data);", as_json(question)) == ""


@pytest.mark.slow
def test_pages_say_of_every_question_what_python_says(node) -> None:
    """The exports say what Python says."""
    drawn = [drill.question(seed) for drill in DRILLS.values() for seed in range(SEEDS)]
    drawn = [one for one in drawn if isinstance(one.asked, Number | Table)]
    body = "return data.map(page.decimals);"
    found = node("drills", body, [as_json(question) for question in drawn])
    assert found == [f"({one.decimals})" if one.decimals else "" for one in drawn]
    assert set(found) == {"", "(one decimal)", "(two decimals)"}


def test_what_has_waited_longest_is_due_first(node) -> None:
    records = {
        "late": {"streak": 3, "due": "2026-03-01"},
        "tomorrow": {"streak": 4, "due": "2026-03-06"},
        "today": {"streak": 0, "due": "2026-03-05"},
        "also-late": {"streak": 5, "due": "2026-03-01"},
        "latest": {"streak": 3, "due": "2025-12-31"},
        "gone": {"streak": 0, "due": "2025-01-01"},  # no drill of the book any more
    }
    names = ["today", "new", "late", "tomorrow", "latest", "also-late"]
    body = (
        """return page.dueDrills(data[0], data[1], new Date("2026-03-05T08:00:00Z"))"""
    )
    found = node("drills", body, [names, records])
    assert found == ["latest", "late", "also-late", "today"]


def test_says_when_the_next_drill_comes_back(node) -> None:
    records = {
        "a": {"streak": 4, "due": "2026-03-06"},
        "b": {"streak": 3, "due": "2026-02-07"},
    }
    body = "return page.nothingDue(data[0], data[1]);"
    told = node("drills", body, [["a", "b", "c"], records])
    assert told.endswith("The next drill comes back on 2026-02-07.")
    untried = node("drills", body, [["c"], records])
    assert untried.endswith("because you have not tried any drill yet.")
