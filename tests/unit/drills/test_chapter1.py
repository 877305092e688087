"""The answers of the introduction's drills, worked out another way."""

from __future__ import annotations

import cmath
import itertools
import math
import re
from pathlib import Path

import pytest
from numbers_in_texts import drawn, numbers

from robonav.drills.chapter1.introduction import COMPETENCES
from robonav.drills.chapter1.processes import PROCESSES

PAGE = Path(__file__).parents[3] / "book" / "introduction.md"
LAID_OUT = re.compile(r"\b(wire|line|magnet|strip|rail)\b")
FIXED = re.compile(r"\b(bolted|brought)\b")


def test_guided_or_autonomous_by_the_words_of_the_text() -> None:
    for question in drawn("guided-or-autonomous"):
        way = question.text
        expected = (
            "guided"
            if LAID_OUT.search(way)
            else "arm"
            if FIXED.search(way)
            else "autonomous"
        )
        assert expected in question.asked.right


def test_competences_are_those_of_the_page_s_table() -> None:
    rows = re.findall(
        r"^\| ([a-z ]+) \| ([A-Z][^|]+\?) \|", PAGE.read_text("utf-8"), re.M
    )
    assert rows == [(name, question) for name, (question, *_) in COMPETENCES.items()]
    for question in drawn("which-competence"):
        asked = re.search(r"is ([a-z ]+) at work", question.text)
        if asked:
            found = {
                name
                for name, (_, *situations) in COMPETENCES.items()
                if question.asked.right in situations
            }
            assert found == {asked[1]}
        else:
            situation = question.text.partition(". Which competence of")[0]
            assert situation in COMPETENCES[question.asked.right]


NO_EXPERT = re.compile(r"Nobody knows|No expert|nobody has ever|no record|nobody shows")


def fitting_way(situation: str) -> str:
    """The way that fits, by the words of a situation."""
    if "may practise" in situation:
        return "Inverse reinforcement learning"
    return (
        "Reinforcement learning"
        if NO_EXPERT.search(situation)
        else "Learning from demonstration"
    )


def test_which_way_by_expert_and_trials() -> None:
    for question in drawn("which-way-to-learn"):
        asked = re.search(r"Where does (.*) fit best", question.text)
        if asked:
            fits = [
                option
                for option in question.asked.options
                if fitting_way(option).lower() == asked[1].lower()
            ]
            assert fits == [question.asked.right]
        else:
            assert question.asked.right == fitting_way(question.text)


def test_rounds_have_one_order() -> None:
    for question in drawn("one-round-in-order"):
        steps = list(question.asked.steps)
        assert any(
            steps == [line.text for line in lines if line.text in steps]
            for lines in PROCESSES.values()
        )
        right = [
            order
            for order in itertools.permutations(range(len(steps)))
            if question.judge(list(order)).right
        ]
        assert right == [tuple(range(len(steps)))]


def test_which_sensor_in_the_complex_plane() -> None:
    for question in drawn("which-sensor-reports"):
        heading, dx, dy = numbers(question.text)[:3]
        ahead = complex(dx, dy) / cmath.rect(1, math.radians(heading))
        sector = round(math.degrees(cmath.phase(ahead)) / 40) % 9 + 1
        assert question.asked.right == [f"sector {sector}"]


def test_situations_counted_one_by_one() -> None:
    for question in drawn("situations-to-list"):
        sensors, degrees = (
            int(re.search(rf"(\d+) {word}", question.text)[1])
            for word in ("sensors", "degrees")
        )
        sectors = int(re.search(r"(\d+) sectors", question.text)[1])
        total = 1
        for _ in range(sensors):
            total = sum(total for _ in range(degrees))
        assert question.asked.answer == pytest.approx(total * sectors)
