"""The answers of the conclusions' drills, worked out another way from the numbers in their texts."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numbers_in_texts import drawn, numbers


def test_failures_avoided_in_a_hundred_maps() -> None:
    for question in drawn("failures-avoided"):
        rule, learned = numbers(question.text)[:2]
        left = (100 - learned) / (100 - rule)
        assert question.asked.answer == pytest.approx(1 - left)


def test_effects_by_least_squares() -> None:
    design = [[1, a, b, (2 * a - 1) * (2 * b - 1)] for a in (0, 1) for b in (0, 1)]
    for question in drawn("effects-of-two-changes"):
        fitted = np.linalg.solve(np.array(design, float), numbers(question.text)[:4])
        assert question.asked.answer[0] == pytest.approx(fitted[1:3])


def test_fields_in_a_row_by_the_powers_of_a_matrix() -> None:
    for question in drawn("fields-in-a-row"):
        rule, learned, fields = (int(n) for n in numbers(question.text)[:3])
        for rate, answer in zip((rule, learned), question.asked.answer[0], strict=True):
            step = np.diag(np.full(fields, rate / 100), 1)
            chain = np.linalg.matrix_power(step, fields)
            assert answer == pytest.approx(chain[0, fields])


def wilson(arrived: float, maps: float) -> tuple[float, float]:
    """The roots of (p - k/n)^2 = z^2 p (1 - p) / n."""
    z, rate = 1.959964, arrived / maps
    a, b, c = 1 + z**2 / maps, -(2 * rate + z**2 / maps), rate**2
    root = math.sqrt(b**2 - 4 * a * c)
    return (-b - root) / (2 * a), (-b + root) / (2 * a)


def test_more_than_chance_by_the_quadratic_equation() -> None:
    for question in drawn("more-than-chance"):
        maps, first, second = numbers(question.text)[:3]
        low, high = wilson(first, maps)
        other_low, other_high = wilson(second, maps)
        expected = (
            "first" if low > other_high else "second" if other_low > high else "not"
        )
        assert expected in question.asked.right
