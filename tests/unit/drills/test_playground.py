"""The answers of the playground's drills, worked out another way from the numbers in their texts."""

from __future__ import annotations

import re

import pytest
from numbers_in_texts import drawn, numbers


def test_noticed_late_second_by_second() -> None:
    for question in drawn("noticed-late"):
        speed, limit, gap = numbers(question.text)
        while gap >= limit:
            gap -= speed
        assert question.asked.answer == pytest.approx(gap)


def test_seconds_until_seen_by_both_positions() -> None:
    for question in drawn("seconds-until-seen"):
        speed, obstacle, approach, limit = numbers(question.text)
        position, seconds = 0.0, 0
        while obstacle - position >= limit:
            position, obstacle, seconds = (
                position + speed,
                obstacle - approach,
                seconds + 1,
            )
        assert question.asked.answer == seconds


def test_steps_of_an_episode_one_by_one() -> None:
    for question in drawn("steps-of-an-episode"):
        distance, limit, speed = numbers(question.text)
        steps = 0
        while distance > limit + 1e-9:
            distance, steps = distance - speed, steps + 1
        assert question.asked.answer == steps


STEPS = {"right": (0, 1), "up": (-1, 0), "down": (1, 0), "left": (0, -1)}


def test_without_memory_from_the_picture() -> None:
    for question in drawn("without-memory"):
        cells = re.findall(
            r'<rect x="(\d+)" y="(\d+)"[^>]*fill="(#888|transparent)"', question.picture
        )
        free = {
            (int(y) // 64, int(x) // 64): kind == "transparent" for x, y, kind in cells
        }
        names = iter(question.asked.places)
        letter = {cell: next(names) for cell, is_free in free.items() if is_free}
        order = re.search(r"order ([a-z, ]+), and", question.text)[1].split(", ")
        x, y = re.search(r'<text x="(\d+)" y="(\d+)"[^>]*>robot<', question.picture).groups()  # fmt: skip
        at = (int(y) // 64, int(x) // 64)
        for _ in range(int(numbers(question.text)[-1])):
            ahead = ((at[0] + STEPS[word][0], at[1] + STEPS[word][1]) for word in order)
            at = next(cell for cell in ahead if free.get(cell, False))
        assert question.asked.right == [letter[at]]
