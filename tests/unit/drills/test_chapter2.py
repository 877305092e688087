"""The answers of chapter 2's drills, worked out another way from the numbers in their texts."""

from __future__ import annotations

import re

import numpy as np
import pytest
from numbers_in_texts import drawn, numbers


def test_discounted_return() -> None:
    for question in drawn("discounted-return"):
        *rewards, discount = numbers(question.text)
        total = sum(discount**k * reward for k, reward in enumerate(rewards))
        assert question.asked.answer == pytest.approx(total)


def test_return_backwards() -> None:
    for question in drawn("return-backwards"):
        _, following, _, reward, discount = numbers(question.text)
        assert question.asked.answer == pytest.approx(reward + discount * following)


def test_value_of_a_loop_is_a_geometric_series() -> None:
    for question in drawn("value-of-a-loop"):
        reward, stay, discount = numbers(question.text)
        series = sum(reward * (discount * stay) ** k for k in range(1000))
        assert question.asked.answer == pytest.approx(series)


def test_advantages_of_a_policy_have_mean_zero() -> None:
    for question in drawn("advantages"):
        probability, *q = numbers(question.text)
        value, *advantages = question.asked.answer[0]
        weights = np.array([probability, 1 - probability])
        assert weights @ advantages == pytest.approx(0)
        assert np.subtract(q, value) == pytest.approx(advantages)


def test_bellman_backup() -> None:
    for question in drawn("bellman-backup"):
        ahead, aside, discount = numbers(question.text)
        up, right, down = numbers(" ".join(re.findall(r">([\d.]+)<", question.picture)))
        expected = discount * (ahead * right + aside * up + aside * down)
        assert ahead + 2 * aside == pytest.approx(1)
        assert question.asked.answer == pytest.approx(expected)


def test_stopping_bound() -> None:
    for question in drawn("stopping-bound"):
        loss, discount = numbers(question.text)
        change = question.asked.answer
        assert 2 * discount / (1 - discount) * change == pytest.approx(loss)


def test_the_improved_cell_points_away_from_the_shortest_path() -> None:
    distance = dict(zip("ABCDEFH", (4, 3, 2, 3, 1, 2, 1), strict=True))
    position = dict(
        zip(
            "ABCDEFH",
            [(0, 0), (0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)],
            strict=True,
        )
    )
    at = {cell: name for name, cell in position.items()} | {(2, 2): "goal"}
    distance["goal"] = 0
    for question in drawn("improved-cell"):
        wrong = []
        for name, (i, j) in position.items():
            group = re.search(rf'data-place="{name}">(.*?)</g>', question.picture)
            assert group
            x0, y0, x1, y1 = map(
                float, re.search(r"M(\S+) (\S+)L(\S+) ([\d.]+)", group[1]).groups()
            )
            step = (i + int(np.sign(y1 - y0)), j + int(np.sign(x1 - x0)))
            reached = at.get(step, name)
            if distance[reached] != distance[name] - 1:
                wrong.append(name)
        assert wrong == list(question.asked.right)


def test_td_error() -> None:
    for question in drawn("td-error"):
        value, following, reward, discount, rate = numbers(question.text)
        new = (1 - rate) * value + rate * (reward + discount * following)
        assert question.asked.answer == pytest.approx(new)


def test_sarsa_and_q_learning() -> None:
    for question in drawn("sarsa-and-q-learning"):
        reward, old, a, b, discount, rate = numbers(question.text)
        taken = {"a": a, "b": b}[
            re.search(r"explores with action (\w)", question.text)[1]
        ]
        new = [old + rate * (reward + discount * q - old) for q in (taken, max(a, b))]
        assert np.ravel(question.asked.answer) == pytest.approx(new)


def test_monte_carlo_return() -> None:
    for question in drawn("monte-carlo-return"):
        steps = re.findall(r"([AB]) \((-?\d+)\)", question.text)
        asked = re.search(r"count for ([AB])", question.text)[1]
        discount = numbers(question.text)[-1]
        first = [state for state, _ in steps].index(asked)
        total = sum(discount**k * float(r) for k, (_, r) in enumerate(steps[first:]))
        assert question.asked.answer == pytest.approx(total)


def test_epsilon_greedy() -> None:
    for question in drawn("epsilon-greedy"):
        *q, epsilon = numbers(question.text)
        draws = 200_000
        rng = np.random.default_rng(0)
        explored = rng.integers(len(q), size=draws)
        taken = np.where(rng.random(draws) < epsilon, explored, np.argmax(q))
        share = np.bincount(taken, minlength=len(q)) / draws
        assert question.asked.answer[0] == pytest.approx(share, abs=0.006)
        assert sum(question.asked.answer[0]) == pytest.approx(1)


def test_belief_after_observation() -> None:
    for question in drawn("belief-after-observation"):
        (*given,) = numbers(question.text)
        belief, door = np.array(given[:3]), np.array(given[3:])
        rng = np.random.default_rng(0)
        places = rng.choice(3, p=belief, size=200_000)
        reported = places[rng.random(len(places)) < door[places]]
        share = np.bincount(reported, minlength=3) / len(reported)
        assert question.asked.answer[0] == pytest.approx(share, abs=0.008)


def test_belief_after_action() -> None:
    for question in drawn("belief-after-action"):
        moves, a, b, c = numbers(question.text)
        after = [a * (1 - moves), a * moves + b * (1 - moves), b * moves + c]
        assert question.asked.answer[0] == pytest.approx(after)


def test_probability_of_observation() -> None:
    for question in drawn("probability-of-observation"):
        left, accuracy = numbers(question.text)
        heard = left * accuracy + (1 - left) * (1 - accuracy)
        assert question.asked.answer == pytest.approx(heard)


def test_value_from_vectors() -> None:
    for question in drawn("value-from-vectors"):
        *entries, belief, rest = numbers(question.text)
        pairs = zip(entries[::2], entries[1::2], strict=True)
        best = max(belief * a + rest * b for a, b in pairs)
        assert question.asked.answer == pytest.approx(best)
