"""The answers of drills that practise a goal of their own, worked out another way from the numbers in their texts."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from numbers_in_texts import drawn, numbers
from scipy.optimize import minimize_scalar

from robonav import mdp

BOOK = Path(__file__).parents[3] / "book"


def test_what_the_check_finds() -> None:
    for question in drawn("what-the-check-finds"):
        aa, ab, ba, bb = numbers(question.text)[:4]
        gamma = float(re.search(r"\\gamma = ([\d.]+)", question.text)[1])
        if min(aa, ab, ba, bb) < 0:
            expected = "negative"
        elif abs(aa + ab - 1) > 1e-9 or abs(ba + bb - 1) > 1e-9:
            expected = "sum to 1"
        else:
            expected = "no discount" if gamma == 1 and bb < 1 else "nothing"
        assert expected in question.asked.right


def test_memory_of_a_model_entry_by_entry() -> None:
    for question in drawn("memory-of-a-model"):
        states, actions, reached = numbers(question.text)[:3]
        row = np.zeros(int(states)).nbytes
        kept = np.zeros(int(reached)).nbytes + np.zeros(int(reached), np.int32).nbytes
        expected = actions * states * row / 1e9, actions * states * kept / 1e6
        assert question.asked.answer[0] == pytest.approx(expected)


def test_along_the_edge_step_by_step() -> None:
    for question in drawn("along-the-edge"):
        steps = int(numbers(question.text)[0])
        epsilon = float(re.search(r"\\varepsilon = ([\d.]+)", question.text)[1])
        actions = int(re.search(r"any of its (\d+) actions", question.text)[1])
        walking, fallen = 1.0, 0.0
        for _ in range(steps):
            falls = walking * epsilon / actions
            walking, fallen = walking - falls, fallen + falls
        assert question.asked.answer == pytest.approx(fallen)


def test_weights_of_features_by_a_derivative() -> None:
    for question in drawn("weights-of-features"):
        w1, w2, f1, f2, reward, g1, g2, alpha, gamma = numbers(question.text)
        target = reward + gamma * (w1 * g1 + w2 * g2)

        def cost(a: float, b: float, f1=f1, f2=f2, target=target) -> float:
            return (target - a * f1 - b * f2) ** 2 / 2

        slopes = (
            (cost(w1 + 1e-5, w2) - cost(w1 - 1e-5, w2)) / 2e-5,
            (cost(w1, w2 + 1e-5) - cost(w1, w2 - 1e-5)) / 2e-5,
        )
        expected = w1 - alpha * slopes[0], w2 - alpha * slopes[1]
        assert question.asked.answer[0] == pytest.approx(expected, abs=1e-6)


def test_value_of_knowing_is_the_regret_without_it() -> None:
    for question in drawn("value-of-knowing"):
        left, a_left, a_right, b_left, b_right = numbers(question.text)
        lost = [
            left * (max(a_left, b_left) - x) + (1 - left) * (max(a_right, b_right) - y)
            for x, y in ((a_left, a_right), (b_left, b_right))
        ]
        assert question.asked.answer == pytest.approx(min(lost))


def test_soft_maximum_is_the_best_mean_plus_entropy() -> None:
    for question in drawn("soft-maximum-of-values"):
        a, b, temperature = numbers(question.text)

        def lost(p: float, a=a, b=b, temperature=temperature) -> float:
            entropy = -p * math.log(p) - (1 - p) * math.log(1 - p)
            return -(p * a + (1 - p) * b + temperature * entropy)

        best = minimize_scalar(lost, bounds=(1e-9, 1 - 1e-9), method="bounded")
        assert question.asked.answer == pytest.approx(-best.fun, abs=1e-4)


def test_gap_without_model() -> None:
    for question in drawn("gap-without-model"):
        feature, *p = numbers(question.text)
        own = ["F", "L30", "R30"].index(re.search(r"took (\w+)\.", question.text)[1])
        expected = [feature * ((k == own) - p[k]) for k in range(3)]
        assert question.asked.answer[0] == pytest.approx(expected)


def test_fitted_to_values_by_a_search() -> None:
    for question in drawn("fitted-to-values"):
        m1, m2, q1, q2 = numbers(question.text)[:4]
        theta = np.linspace(-1, 1, 20_001)
        cost = (theta * m1 - q1) ** 2 + (theta * m2 - q2) ** 2
        assert question.asked.answer == pytest.approx(theta[cost.argmin()], abs=2e-4)


def test_order_of_nirl_is_that_of_the_page() -> None:
    words = ["run episodes", "find", "stop", "compute the", "train the network"]
    algorithm = (BOOK / "nirl.md").read_text("utf-8").split(":label: alg-10")[1]
    algorithm = algorithm.lower()
    places = [algorithm.index(word) for word in words]
    assert places == sorted(places)
    for question in drawn("order-of-nirl"):
        order = [
            (
                numbers(step)[0],
                next(k for k, word in enumerate(words) if word in step.lower()),
            )
            for step in question.asked.steps
        ]
        assert order == sorted(set(order))
        for step in question.asked.steps:
            if "stop" in step:
                assert ("do not" in step) == (numbers(step)[-1] >= 0.1)


def test_left_open_is_what_the_page_s_table_says() -> None:
    page = (BOOK / "nirl.md").read_text("utf-8")
    rows = dict(
        re.findall(r"^\| ([^|]+?) \| ([^|]+?) \| [^|]+ \|$", page, re.MULTILINE)
    )
    names = {
        "learning rate of the values": r"learning rate of the values $\alpha$",
        "learning rate of the network": r"learning rate of the network $\sigma$",
        "discount": r"discount $\gamma$",
        "inverse temperature": r"inverse temperature $\eta$",
        "hidden units": "hidden units",
        "number of episodes in": "episodes an iteration, iterations",
        "number of iterations": "episodes an iteration, iterations",
        "range of the sensors": "sensor range, warning distance ($d_{bou}$, $d_{warn}$)",
        "warning distance": "sensor range, warning distance ($d_{bou}$, $d_{warn}$)",
        "seconds of an episode": "seconds of an episode, at most",
        "gradient steps": "gradient steps an iteration",
    }
    experts = (BOOK / "why-learn-the-reward.md").read_text("utf-8")
    assert "it makes 30 demonstrations" in experts
    assert "does not say how many obstacles these maps have" in experts
    rows |= {"demonstrations": "30", "obstacles": "not said"}
    names |= {"of obstacles": "obstacles", "of demonstrations": "demonstrations"}
    for question in drawn("left-open"):
        assert "what the thesis states: the table" in question.text
        wanted = "the thesis does not give" in question.text
        for option in question.asked.options:
            row = next(rows[full] for word, full in names.items() if word in option)
            open_ = row == "not said"
            assert (open_ == wanted) == (option == question.asked.right), option


def test_never_seen_step_by_step() -> None:
    for question in drawn("never-seen"):
        known, steps = numbers(question.text)[:5], numbers(question.text)[5:]
        assert question.asked.answer == pytest.approx(
            sum(step not in known for step in steps) / len(steps)
        )


def test_one_row_for_every_step_metre_by_metre() -> None:
    holds = {
        "at most": lambda x, y: x <= y,
        "less than": lambda x, y: x < y,
        "at least": lambda x, y: x >= y,
        "more than": lambda x, y: x > y,
    }
    for question in drawn("one-row-for-every-step"):
        rows = [
            re.findall(r"(at most|less than|at least|more than) (\d+) m", row)
            for row in re.findall(r"\*([^*]+)\*", question.text)
        ]
        assert [len(row) for row in rows] == [1, 2, 1]
        counts = [
            sum(all(holds[word](x, int(y)) for word, y in row) for row in rows)
            for x in range(11)
        ]
        expected = {
            (True, True): "exclusive and total",
            (True, False): "exclusive, but not total",
            (False, True): "total, but not exclusive",
            (False, False): "neither",
        }[max(counts) <= 1, min(counts) >= 1]
        assert expected in question.asked.right


def test_a_run_of_an_episode_line_by_line() -> None:
    words = ["chooses", "`step`", "target", "becomes"]
    for question in drawn("parts-of-an-episode"):
        states = re.search(r"states (\d+), (\d+) and (\d+)", question.text).groups()
        places = []
        for line in question.asked.steps:
            state = re.search(r"state (\d+)", line)[1]
            if "reset" in line:
                places.append(-1)
                assert state == states[0]
                continue
            kind = next(k for k, word in enumerate(words) if word in line)
            places.append(4 * (states.index(state) - (kind == 1)) + kind)
        assert places == sorted(set(places))


def test_what_a_checkpoint_holds() -> None:
    learned = re.compile("weights of the|number of episodes|replay|Adam")
    given = {
        "the random numbers drawn": "its random numbers, which begin anew",
        "how much the robot explored": "how much the robot explores",
        "the maps of": "the map of the episode",
        "Adam": "with Adam",
        "replay memory": "from a replay memory",
        "target network": "from a copy of the network",
        "pairs of the last": "an empty list of pairs",
    }
    for question in drawn("what-a-checkpoint-holds"):
        for part, said in given.items():
            if any(part in option for option in question.asked.options):
                online = part == "pairs of the last" and "online" in question.text
                assert ("the latest pair alone" if online else said) in question.text
        for option in question.asked.options:
            wanted = ("has to be" in question.text) == bool(learned.search(option))
            assert wanted == (option == question.asked.right)


def test_fair_or_not() -> None:
    fair = re.compile(
        r"trials each|tested in the same \d+ maps|the mean of \d+ runs is given"
        r"|all of them count|drove at the same speed"
    )
    for question in drawn("fair-or-not"):
        for option in question.asked.options:
            wanted = ("is unfair" in question.text) != bool(fair.search(option))
            assert wanted == (option == question.asked.right), option


def test_running_mean_of_a_list() -> None:
    for question in drawn("running-mean"):
        n, mean, new = numbers(question.text)
        returns = [mean] * int(n) + [new]
        assert question.asked.answer == pytest.approx(sum(returns) / len(returns))


def test_news_of_an_episode_as_a_matrix() -> None:
    """All targets are made of the old values, so one product gives them."""
    for question in drawn("news-of-an-episode"):
        *given, alpha, gamma = numbers(question.text)
        old, rewards = np.reshape(given, (2, 3))
        targets = rewards + gamma * np.eye(3, k=1) @ old
        assert question.asked.answer[0] == pytest.approx(old + alpha * (targets - old))


def test_admissible_or_consistent_by_the_definitions() -> None:
    found = set()
    for question in drawn("admissible-or-consistent"):
        first, second, x, y, end = numbers(question.text)
        steps = [(x, y, first), (y, end, second)]
        consistent = all(here <= there + step for here, there, step in steps)
        admissible = x <= first + second and y <= second
        wanted = ["neither", "but not consistent", "admissible and consistent"]
        expected = wanted[admissible + consistent]
        assert expected in question.asked.right
        found.add(expected)
    assert found == set(wanted)


def test_path_to_open_node() -> None:
    for question in drawn("path-to-open-node"):
        here, step, old, estimate = numbers(question.text)
        expected = sorted([here + step, old])[0] + estimate
        assert question.asked.answer == pytest.approx(expected)


def test_cautious_step_is_what_the_planner_pays() -> None:
    for question in drawn("cautious-step"):
        length, distance, caution = numbers(question.text)[:3]
        far = [(caution / 100) * (10 - distance) ** 2, 1]
        assert question.asked.answer == pytest.approx(length * sum(far))


def test_weight_of_share_gives_the_share() -> None:
    for question in drawn("weight-of-share"):
        first, second, share = numbers(question.text)
        theta = question.asked.answer
        odds = math.exp(theta * first) / math.exp(theta * second)
        assert odds / (1 + odds) == pytest.approx(share / 100)


def test_draws_of_a_decision_counted_iteration_by_iteration() -> None:
    for question in drawn("draws-of-a-decision"):
        added, kept, draws = numbers(question.text)
        each = draws / (added * kept)  # in one iteration
        assert question.asked.answer == pytest.approx(sum([each] * int(kept)))


def test_kept_policy_decision_by_decision() -> None:
    agree = []
    for question in drawn("kept-policy"):
        often, seldom, *hits = numbers(question.text)
        (f_a, l_a), (f_b, l_b) = np.reshape(hits, (2, 2))
        plain = "A" if f_a + l_a > f_b + l_b else "B"
        ahead = (f_a - f_b) / often + (l_a - l_b) / seldom
        expected = (
            f"accuracy keeps {plain}, balanced accuracy {'A' if ahead > 0 else 'B'}"
        )
        assert question.asked.right == expected
        agree.append(plain == expected[-1])
    assert 0.25 < np.mean(agree) < 0.75


def test_change_of_each_weight_counted_unit_by_unit() -> None:
    for question in drawn("change-of-each-weight"):
        inputs, hidden, outputs, first, second = numbers(question.text)
        weights = [0, 0]
        for layer, (before, units) in enumerate([(inputs, hidden), (hidden, outputs)]):
            for _ in range(int(units)):
                weights[layer] += int(before) + 1
        expected = 1000 * first / weights[0], 1000 * second / weights[1]
        assert question.asked.answer[0] == pytest.approx(expected)


def test_tiles_in_common_weight_by_weight() -> None:
    for question in drawn("tiles-in-common"):
        tilings, *given, one, same_tilings, error = numbers(
            question.text.replace("weights are 0", "")
        )
        count = int(tilings)
        assert (one, same_tilings) == (1, count)
        weights = dict.fromkeys(enumerate(given[:count]), error / count)
        value = sum(weights.get((k, tile), 0) for k, tile in enumerate(given[count:]))
        assert question.asked.answer == pytest.approx(value)


def test_weights_of_tilings_tile_by_tile() -> None:
    for question in drawn("weights-of-tilings"):
        tilings, side, also, actions = map(int, numbers(question.text))
        assert side == also
        low, high, tiles = (0, 0), (1, 1), (side, side)
        coding = mdp.Tiles(low, high, tiles, tilings, n_actions=actions)
        features = coding([0.3, 0.6])[0]
        assert question.asked.answer[0] == [features.size, (features != 0).sum()]


def test_rate_for_features_by_a_derivative() -> None:
    for question in drawn("rate-for-features"):
        active, value, target, rate = numbers(
            re.sub(r"are 1 and all others 0", "", question.text)
        )

        def cost(x: float, value=value, target=target) -> float:
            return (target - value - x) ** 2 / 2

        slope = (cost(1e-6) - cost(-1e-6)) / 2e-6
        expected = value - active * rate * slope
        assert question.asked.answer == pytest.approx(expected, abs=1e-5)


def test_target_of_expected_sarsa_action_by_action() -> None:
    for question in drawn("target-of-expected-sarsa"):
        reward, *values, epsilon, gamma = numbers(question.text)
        mean = 0.0
        for value in values:
            mean += value * (epsilon / 3 + (1 - epsilon) * (value == max(values)))
        assert question.asked.answer == pytest.approx(reward + gamma * mean)
