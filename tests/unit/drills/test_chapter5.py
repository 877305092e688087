"""The answers of chapter 5's drills, worked out another way from the numbers in their texts."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from numbers_in_texts import drawn, numbers
from scipy.optimize import minimize_scalar


def test_of_one_trajectory() -> None:
    for question in drawn("of-one-trajectory"):
        *features, gamma = numbers(question.text)
        first, second, third = np.reshape(features, (3, 2))
        expected = first + gamma * (second + gamma * third)
        assert question.asked.answer[0] == pytest.approx(expected)


def test_of_two_trajectories() -> None:
    for question in drawn("of-two-trajectories"):
        parts = re.findall(r"\$([^$]*)\$", question.text)
        gamma = numbers(parts[-1])[-1]
        sums = [
            sum(gamma**k * f for k, f in enumerate(numbers(part))) for part in parts[:2]
        ]
        assert question.asked.answer == pytest.approx(sum(sums) / 2)


def test_value_of_features() -> None:
    for question in drawn("value-of-features"):
        m1, m2, t1, t2 = numbers(question.text)
        assert question.asked.answer == pytest.approx(m1 * t1 + m2 * t2)


def test_refined() -> None:
    for question in drawn("refined"):
        text = question.text[: question.text.index("Which")]
        left, right, left_there, right_there = numbers(text)
        frequent = int(right > left)
        likelihoods = left / (left + left_there), right / (right + right_there)
        uniform = int(likelihoods[1] > likelihoods[0])
        assert np.ravel(question.asked.answer).tolist() == [frequent, uniform]


def test_margin_of_one_over_all_directions() -> None:
    angles = np.linspace(0, 2 * math.pi, 100_001)
    directions = np.column_stack([np.cos(angles), np.sin(angles)])
    for question in drawn("margin-of-one"):
        expert, found = np.reshape(numbers(question.text)[:4], (2, 2))
        leads = directions @ (expert - found)
        best = directions[leads.argmax()]
        expected = [*best, leads.max()]
        assert question.asked.answer[0] == pytest.approx(expected, abs=1e-3)


def test_best_of_three() -> None:
    for question in drawn("best-of-three"):
        expert, *others = np.reshape(numbers(question.text), (3, 2))
        margins = {
            option: min(float(np.dot(numbers(option), expert - o)) for o in others)
            for option in question.asked.options
        }
        assert question.asked.right == max(margins, key=margins.__getitem__)


def test_projection_is_the_nearest_point() -> None:
    for question in drawn("projection"):
        mean, found, expert = np.reshape(numbers(question.text), (3, 2))

        def distance(share: float, mean=mean, found=found, expert=expert) -> float:
            return float(np.linalg.norm(mean + share * (found - mean) - expert))

        share = minimize_scalar(distance, bounds=(0, 1), method="bounded").x
        expected = mean + share * (found - mean)
        assert question.asked.answer[0] == pytest.approx(expected, abs=1e-3)


def test_into_the_ball() -> None:
    for question in drawn("into-the-ball"):
        weights = np.array(numbers(question.text)[:2])
        expected = weights / max(1, math.hypot(*weights))
        assert question.asked.answer[0] == pytest.approx(expected)


def test_boltzmann() -> None:
    for question in drawn("boltzmann"):
        a, b, eta = numbers(question.text)
        odds = math.exp(eta * (a - b))
        assert question.asked.answer[0][0] / question.asked.answer[0][
            1
        ] == pytest.approx(odds)


def test_sarsa_target() -> None:
    for question in drawn("sarsa-target"):
        text = re.sub(r"Q\([^)]*\)", "", question.text)
        q, reward, following, alpha, gamma = numbers(text)
        new = (1 - alpha) * q + alpha * (reward + gamma * following)
        assert question.asked.answer == pytest.approx(new)


def test_two_accuracies() -> None:
    for question in drawn("two-accuracies"):
        often, seldom, hit, rare = numbers(question.text)[:4]
        plain, balanced = (
            (hit + rare) / (often + seldom),
            (hit / often + rare / seldom) / 2,
        )
        assert question.asked.answer[0] == pytest.approx([plain, balanced])


def test_scaled_rewards() -> None:
    for question in drawn("scaled-rewards"):
        rewards = numbers(question.text)[:3]
        largest = max(map(abs, rewards))
        expected = [0.5 + r / largest / 2 for r in rewards]
        assert question.asked.answer[0] == pytest.approx(expected)
