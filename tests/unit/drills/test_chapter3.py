"""The answers of chapter 3's drills, worked out another way from the numbers in their texts."""

from __future__ import annotations

import math
import re
from itertools import pairwise

import numpy as np
import pytest
from numbers_in_texts import drawn, numbers


def sigmoid(z: float) -> float:
    return 1 / (1 + math.exp(-z))


def test_one_neuron() -> None:
    for question in drawn("one-neuron"):
        w1, w2, bias, x1, x2 = numbers(question.text)
        assert question.asked.answer == pytest.approx(sigmoid(w1 * x1 + w2 * x2 + bias))


def test_output_errors_are_slopes_of_the_costs() -> None:
    for question in drawn("output-errors"):
        output, label = numbers(question.text)[:2]
        z, h = math.log(output / (1 - output)), 1e-6

        def slope(cost, z=z, h=h) -> float:
            return (cost(sigmoid(z + h)) - cost(sigmoid(z - h))) / (2 * h)

        squared = slope(lambda a, y=label: (a - y) ** 2 / 2)
        entropy = slope(lambda a, y=label: -math.log(a if y else 1 - a))
        found = np.ravel(question.asked.answer)
        assert found == pytest.approx([squared, entropy], abs=1e-6)


def test_hidden_error_is_the_slope_of_what_follows() -> None:
    for question in drawn("hidden-error"):
        a, w1, w2, d1, d2 = numbers(question.text)
        z, h = math.log(a / (1 - a)), 1e-6

        def after(z: float, w1=w1, w2=w2, d1=d1, d2=d2) -> float:
            return d1 * w1 * sigmoid(z) + d2 * w2 * sigmoid(z)

        slope = (after(z + h) - after(z - h)) / (2 * h)
        assert question.asked.answer == pytest.approx(slope, abs=1e-6)


def test_next_node_by_the_picture() -> None:
    for question in drawn("next-node"):
        costs, estimates = (
            [float(n) for n in re.findall(rf">{letter} = ([\d.]+)<", question.picture)]
            for letter in "gh"
        )
        sums = np.round(np.add(costs, estimates), 6)
        best = [name for name, f in zip("ABCDE", sums, strict=True) if f == sums.min()]
        assert list(question.asked.right) == best


def test_effective_steps() -> None:
    for question in drawn("effective-steps"):
        total, safe, blocked = numbers(question.text)
        assert question.asked.answer == total - safe - blocked


def test_path_length() -> None:
    for question in drawn("path-length"):
        points = np.reshape(numbers(question.text), (-1, 2))
        length = sum(math.dist(a, b) for a, b in pairwise(points))
        assert question.asked.answer == pytest.approx(length)


def test_degrees_of_danger_by_the_table_of_a_sensor_that_sees_30_centimetres() -> None:
    rows = [(0, 3), (3, 7), (7, 11), (11, 15), (15, 20), (20, 25), (25, 30), (30, 1e9)]
    for question in drawn("degrees-of-danger"):
        for metres, degree in zip(
            numbers(question.text), question.asked.answer[0], strict=True
        ):
            low, high = rows[7 - degree]
            assert low <= metres * 3 < high
