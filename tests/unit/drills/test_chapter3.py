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
            for letter in "GH"
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
        readings, table = question.text.split("By Table 3.1, ")
        for metres, degree in zip(
            numbers(readings), question.asked.answer[0], strict=True
        ):
            low, high = rows[7 - degree]
            assert low <= metres * 3 < high
        told = {int(d): float(b) for d, b in re.findall(r"(\d) below (\S+) m", table)}
        assert told == {
            7 - k: round(high / 3, 2) for k, (_, high) in enumerate(rows[:-1])
        }


def confusion(picture: str) -> np.ndarray:
    """The counts in the picture of a confusion matrix, by row and column."""
    title = re.search(r'aria-label="([^"]*)"', picture)[1]
    return np.array(
        [
            [int(n) for n in row.split(",")]
            for row in re.findall(r"expert \w+: ([\d, ]+)", title)
        ]
    )


def test_accuracy_by_counting_states() -> None:
    for question in drawn("accuracy-of-two"):
        counts = confusion(question.picture)
        drawn_counts = re.findall(r">(\d+)<", question.picture)
        assert [int(n) for n in drawn_counts] == counts.ravel().tolist()
        states = [
            (i, j) for i in range(3) for j in range(3) for _ in range(counts[i, j])
        ]
        network = np.mean([expert == chosen for expert, chosen in states])
        straight = np.mean([expert == 0 for expert, _ in states])
        assert np.ravel(question.asked.answer) == pytest.approx([network, straight])


def test_least_recalled() -> None:
    for question in drawn("least-recalled"):
        missed = [
            1 - row[k] / sum(row) for k, row in enumerate(confusion(question.picture))
        ]
        assert question.asked.right == [("F", "L30", "R30")[int(np.argmax(missed))]]


def test_regularisation_is_chosen_on_other_demonstrations() -> None:
    for question in drawn("chosen-regularisation"):
        rows = re.findall(
            r"lambda = ([\d.]+)\$: \$[\d.]+\$ and \$([\d.]+)\$", question.text
        )
        best = min(rows, key=lambda row: float(row[1]))[0]
        assert question.asked.right == rf"$\lambda = {best}$"


def test_wilsons_condition_and_interval_agree() -> None:
    for question in drawn("rate-in-interval"):
        k, n, level, p = numbers(question.text)[:4]
        assert level == 95
        (gap,), (limit,), (inside,) = question.asked.answer
        assert gap == pytest.approx(abs(k / n - p))
        assert limit**2 * n / (p * (1 - p)) == pytest.approx(1.96**2)
        assert inside == (gap <= limit)


def test_perfect_test_solves_wilsons_condition() -> None:
    for question in drawn("perfect-test"):
        n = numbers(question.text)[0]
        p = question.asked.answer
        assert 1 - p == pytest.approx(1.96 * math.sqrt(p * (1 - p) / n), rel=1e-4)


def test_lucky_test_over_many_tests() -> None:
    rng = np.random.default_rng(0)
    for question in drawn("lucky-test")[:10]:
        one_in, maps = (int(n) for n in numbers(question.text))
        failed = rng.integers(one_in, size=(200_000, maps)) == 0
        share = 1 - failed.any(axis=1).mean()
        assert question.asked.answer == pytest.approx(share, abs=0.006)


def test_stacked_shapes() -> None:
    for question in drawn("stacked-shapes"):
        steps = np.reshape(numbers(question.text)[:9], (3, 3))
        rows = steps[:, 0].sum() - steps[:, 1:].sum()
        columns = 11 if "the number of the target's sector" in question.text else 12
        assert question.asked.answer == [[rows, columns], [rows, 5]]


def test_penalty() -> None:
    for question in drawn("penalty"):
        pairs, squares, _, decay = numbers(question.text)
        assert 2 * pairs * question.asked.answer == pytest.approx(decay * squares)


def test_two_bounds() -> None:
    for question in drawn("two-bounds"):
        assert all(f"${b}$" in question.text for b in (r"\varepsilon T^2", r"u \varepsilon T"))  # fmt: skip
        steps, error, cost = numbers(question.text)[-3:]
        assert cost == 1
        expected = [sum([error] * int(steps)) * steps, sum([error] * int(steps))]
        assert np.ravel(question.asked.answer) == pytest.approx(expected)


def test_compounding_over_many_episodes() -> None:
    rng = np.random.default_rng(0)
    for question in drawn("compounding")[:10]:
        error, steps = numbers(question.text)
        errs = rng.random((400_000, int(steps))) < error
        errors = np.logical_or.accumulate(errs, axis=1).sum(axis=1).mean()
        assert question.asked.answer == pytest.approx(errors, abs=0.01)


def test_dagger_examples() -> None:
    for question in drawn("dagger-examples"):
        first, added = re.search(
            r"give (.*?) effective pairs(.*)\. On", question.text
        ).groups()
        rounds = numbers(added.replace("Rounds 1, 2 and 3", ""))
        last = int(re.search(r"pi_(\d)", question.text)[1])
        assert question.asked.answer == numbers(first)[0] + sum(rounds[:last])


def test_labelled_state() -> None:
    for question in drawn("labelled-state"):
        nearest, reach = numbers(question.text.replace(r"\beta = 0", ""))
        expert = re.search(r"the expert (\w+)", question.text)[1]
        expected = f"the state, with {expert}" if nearest < reach else "nothing"
        assert question.asked.right == expected


def test_mixture_of_rounds_by_drawing_who_steers() -> None:
    rng = np.random.default_rng(0)
    for question in drawn("mixture-of-rounds")[:10]:
        decay = numbers(question.text)[0]
        for i, share in enumerate(question.asked.answer[0]):
            expert = (rng.random((200_000, i)) < decay).all(axis=1).mean()
            drawn_share = expert if "the *expert*" in question.text else 1 - expert
            assert share == pytest.approx(drawn_share, abs=0.006)


def test_share_of_other_data() -> None:
    for question in drawn("share-of-other-data"):
        _, few, _, control, _, _, aggregated = numbers(question.text)
        (more,), (other,) = question.asked.answer
        assert few + more == control
        assert control + other == aggregated


def test_vote_of_neighbours() -> None:
    for question in drawn("vote-of-neighbours"):
        pairs = re.findall(r"\$([\d.]+)\$ \((\w+)\)", question.text)
        k = int(numbers(question.text)[-1])
        voters = [name for _, name in sorted(pairs, key=lambda p: float(p[0]))[:k]]
        assert question.asked.right == max(voters, key=voters.count)


def test_a_run_of_training_line_by_line() -> None:
    words = ["has the activation", "output is", "output unit", "of the hidden", "deriv", "become"]  # fmt: skip
    for question in drawn("order-of-training"):
        w1, w2, x, label, step = numbers(question.text)
        happened = []
        for _ in range(2):
            hidden = sigmoid(w1 * x)
            output = sigmoid(w2 * hidden)
            error = output - label
            back = error * w2 * hidden * (1 - hidden)
            slopes = [back * x, error * hidden]
            w1, w2 = w1 - step * slopes[0], w2 - step * slopes[1]
            happened += [[hidden], [output], [error], [back], slopes, [w1, w2]]
        places = []
        for line in question.asked.steps:
            iteration, *shown = numbers(line)
            place = next(k for k, word in enumerate(words) if word in line)
            places.append(6 * (int(iteration) - 1) + place)
            assert shown == pytest.approx(happened[places[-1]], abs=6e-4)
        assert places == sorted(set(places))


def test_a_run_of_dagger_line_by_line() -> None:
    for question in drawn("order-of-dagger"):
        first, *added = (int(n) for n in numbers(question.text.replace("rounds 1 and 2", "")))  # fmt: skip
        happened = ["drives", f"cloned from {first}"]
        pairs = first
        for visited in added:
            happened += [f"visits {visited} ", f"in the {visited} "]
            pairs += visited
            happened += [f"grow to {pairs} ", f"trained on {pairs} "]
        places = [
            next(k for k, words in enumerate(happened) if words in line)
            for line in question.asked.steps
        ]
        assert places == sorted(set(places))
