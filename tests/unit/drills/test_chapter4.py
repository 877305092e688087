"""The answers of chapter 4's drills, worked out another way from the numbers in their texts."""

from __future__ import annotations

import itertools
import math
import re

import numpy as np
import pytest
from numbers_in_texts import drawn, numbers


def test_one_target() -> None:
    for question in drawn("one-target"):
        text = question.text
        taken = ["F", "L30", "L60"].index(re.search(r"robot took (\w+)", text)[1])
        *values, reward, alpha, gamma = numbers(text)
        q, following = values[:3], values[3:]
        new = (1 - alpha) * q[taken] + alpha * (reward + gamma * max(following))
        assert question.asked.answer == pytest.approx(new)


def test_rescaled() -> None:
    for question in drawn("rescaled"):
        q = numbers(question.text)[:3]
        low, high = min(*q, 0), max(*q, 1)
        clip = [min(max(value, 0), 1) for value in q]
        shift = [(value - low) / (high - low) for value in q]
        assert np.ravel(question.asked.answer) == pytest.approx([*clip, *shift])


def test_count_states_by_listing_them() -> None:
    for question in drawn("count-states")[:10]:
        sensors, degrees, regions = (int(n) for n in numbers(question.text))
        parts = [range(degrees)] * sensors + [range(regions), range(2)]
        count = sum(1 for _ in itertools.product(*parts))
        assert question.asked.answer == count


def test_cost_of_outputs() -> None:
    for question in drawn("cost-of-outputs"):
        t1, t2, o1, o2 = numbers(question.text)
        cost = sum(
            -t * math.log(o) - (1 - t) * math.log(1 - o)
            for t, o in ((t1, o1), (t2, o2))
        )
        assert question.asked.answer == pytest.approx(cost)


def test_two_targets() -> None:
    for question in drawn("two-targets"):
        reward, *values, gamma = numbers(question.text)
        own, other = values[:3], values[3:]
        plain = reward + gamma * max(other)
        double = reward + gamma * other[own.index(max(own))]
        assert np.ravel(question.asked.answer) == pytest.approx([plain, double])


def test_lifted_maximum_over_all_cases() -> None:
    for question in drawn("lifted-maximum"):
        value, error = numbers(question.text)
        cases = itertools.product((value - error, value + error), repeat=2)
        assert question.asked.answer == pytest.approx(np.mean([max(c) for c in cases]))


def test_softmax() -> None:
    for question in drawn("softmax"):
        a, b, temperature = numbers(question.text)
        weights = [math.exp(q / temperature) for q in (a, b)]
        expected = [weight / sum(weights) for weight in weights]
        assert question.asked.answer[0] == pytest.approx(expected)


def test_schedule_multiplies_by_one_factor() -> None:
    for question in drawn("schedule"):
        start, end, fraction = numbers(question.text)
        value, episodes = start, 1000
        factor = (end / start) ** (1 / episodes)
        for _ in range(round(fraction * episodes)):
            value *= factor
        assert question.asked.answer == pytest.approx(value)


def test_property_of_state() -> None:
    for question in drawn("property-of-state"):
        (nearest,) = numbers(question.text)
        name = "safe" if nearest >= 10 else "dangerous" if nearest < 5 else "cozy"
        assert question.asked.right == name


def test_potential_telescopes() -> None:
    for question in drawn("potential"):
        before, after, gamma = numbers(question.text)
        assert before + question.asked.answer == pytest.approx(gamma * after)
