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
        assert r"$\frac{2 \gamma}{1 - \gamma} \, d$" in question.text  # the theorem
        loss, discount = numbers(question.text)[-2:]
        change = question.asked.answer
        assert 2 * discount / (1 - discount) * change == pytest.approx(loss)


def distances(goal: tuple[int, int], free: set[tuple[int, int]]) -> dict[tuple, int]:
    """Steps to the goal from each cell."""
    found, reached = {goal: 0}, [goal]
    for i, j in reached:
        for cell in ((i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)):
            if cell in free and cell not in found:
                found[cell] = found[i, j] + 1
                reached.append(cell)
    return found


def test_the_improved_cell_points_away_from_the_shortest_path() -> None:
    for question in drawn("improved-cell"):
        cells = {
            (int(y) // 64, int(x) // 64)
            for x, y in re.findall(r'<rect x="(\d+)" y="(\d+)"', question.picture)
        }
        walls = {
            (int(y) // 64, int(x) // 64)
            for x, y in re.findall(
                r'<rect x="(\d+)" y="(\d+)"[^>]*fill="#888"', question.picture
            )
        }
        arrows = {}
        for name, group in re.findall(r'data-place="(\w)">(.*?)</g>', question.picture):
            x, y = map(int, re.search(r'x="(\d+)" y="(\d+)"', group).groups())
            x0, y0, x1, y1 = map(
                float, re.search(r"M(\S+) (\S+)L(\S+) ([\d.]+)", group).groups()
            )
            turn = (int(np.sign(y1 - y0)), int(np.sign(x1 - x0)))
            arrows[y // 64, x // 64] = (name, turn)
        (goal,) = cells - walls - set(arrows)
        steps = distances(goal, cells - walls)
        wrong = [
            name
            for (i, j), (name, (down, right)) in arrows.items()
            if steps.get((i + down, j + right), 99) != steps[i, j] - 1
        ]
        assert wrong == list(question.asked.right)
        assert 0 < float(re.search(r"\\gamma = ([\d.]+)", question.text)[1]) < 1


def test_a_run_of_policy_iteration_line_by_line() -> None:
    for question in drawn("order-of-policy-iteration"):
        rewards = re.findall(r"\\text\{\w+\}\) = (-?\d+)", question.text)
        table = np.reshape([float(r) for r in rewards], (3, 2))
        gamma = float(re.search(r"\\gamma = ([\d.]+)", question.text)[1])
        policy = re.search(r"with the actions ([a-z, ]+)\.", question.text)[1].split(
            ", "
        )
        happened: list[object] = []
        while "end" not in map(str, happened):
            values = np.zeros(3)
            for _ in range(300):
                values = np.array(
                    [
                        table[s, int(goes)] + gamma * values[(s + goes) % 3]
                        for s, goes in enumerate(name == "go" for name in policy)
                    ]
                )
            happened.append(values)
            better = [
                "stay"
                if table[s, 0] + gamma * values[s]
                > table[s, 1] + gamma * values[(s + 1) % 3]
                else "go"
                for s in range(3)
            ]
            happened.append("end" if better == policy else better)
            policy = better

        def place(line: str, happened=happened) -> int:
            if "changes no action" in line:
                return len(happened) - 1
            if "become" in line:
                actions = line.split("become ")[1].rstrip(".").split(", ")
                return [isinstance(one, list) and one == actions for one in happened].index(True)  # fmt: skip
            shown = numbers(line.split("are")[1])
            return next(
                k
                for k, one in enumerate(happened)
                if isinstance(one, np.ndarray) and np.allclose(one, shown, 1e-3, 1e-3)
            )

        places = [place(line) for line in question.asked.steps]
        assert places == sorted(set(places))


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
        if "reports no door" in question.text:
            door = 1 - door
        rng = np.random.default_rng(0)
        places = rng.choice(3, p=belief, size=200_000)
        reported = places[rng.random(len(places)) < door[places]]
        share = np.bincount(reported, minlength=3) / len(reported)
        assert question.asked.answer[0] == pytest.approx(share, abs=0.008)


def test_belief_after_action() -> None:
    for question in drawn("belief-after-action"):
        moves, *belief = numbers(question.text)
        shift = 1 if "action right" in question.text else -1
        after = [0.0, 0.0, 0.0]
        for place, probability in enumerate(belief):
            after[place] += probability * (1 - moves)
            after[min(max(place + shift, 0), 2)] += probability * moves
        assert question.asked.answer[0] == pytest.approx(after)


def test_probability_of_observation() -> None:
    for question in drawn("probability-of-observation"):
        left, accuracy = numbers(question.text)
        heard = left * accuracy + (1 - left) * (1 - accuracy)
        if "says right" in question.text:
            heard = 1 - heard
        assert question.asked.answer == pytest.approx(heard)


def test_value_from_vectors() -> None:
    for question in drawn("value-from-vectors"):
        *entries, belief, rest = numbers(question.text)
        pairs = zip(entries[::2], entries[1::2], strict=True)
        best = max(belief * a + rest * b for a, b in pairs)
        assert question.asked.answer == pytest.approx(best)
