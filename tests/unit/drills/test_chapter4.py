"""The answers of chapter 4's drills, worked out another way from the numbers in their texts."""

from __future__ import annotations

import itertools
import math
import re

import numpy as np
import pytest
from numbers_in_texts import drawn, numbers
from scipy.stats import mannwhitneyu


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
    for question in drawn("count-states")[:5]:
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
        count = ["Two", "Three"].index(question.text.split()[0]) + 2
        cases = itertools.product((value - error, value + error), repeat=count)
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
        readings, told = question.text.split("Which property")
        nearest, (reach, near) = min(numbers(readings)), numbers(told)
        name = "safe" if nearest >= reach else "dangerous" if nearest < near else "cozy"
        if "has arrived" in question.text:
            name = "winning"
        if "has collided" in question.text:
            name = "failure"
        assert question.asked.right == name


def test_potential_telescopes() -> None:
    for question in drawn("potential"):
        before, after, gamma = numbers(question.text)
        assert before + question.asked.answer == pytest.approx(gamma * after)


def test_last_step() -> None:
    for question in drawn("last-step"):
        q, reward, following, _, alpha, gamma, *_ = numbers(question.text)
        if "stopped" not in question.text:
            following = 0
        new = (1 - alpha) * q + alpha * (reward + gamma * following)
        assert question.asked.answer == pytest.approx(new)


def test_descents_of_episode_by_counting() -> None:
    for question in drawn("descents-of-episode"):
        decisions = int(numbers(question.text)[0])
        passes = 1 + ["one pass", "two passes", "three passes"].index(
            re.search(r"\w+ pass(es)?", question.text)[0]
        )
        nnql, online = 0, 0
        for pairs in range(1, decisions + 1):
            nnql += passes * pairs
            online += passes
        assert question.asked.answer == [[nnql], [online]]


def test_pairs_so_far() -> None:
    for question in drawn("pairs-so-far"):
        ranges = [float(n) for n in re.findall(r">([\d.]+) m<", question.picture)]
        count = numbers(question.text)[-1]
        kept = 0
        for step, metres in enumerate(ranges, start=1):
            kept += metres < 10
            if kept == count:
                break
        assert question.asked.right == [str(step)]


def test_errors_of_outputs() -> None:
    for question in drawn("errors-of-outputs"):
        *q, target, alpha = numbers(question.text.partition("what is the error")[0])
        taken = ["F", "L30", "L60"].index(re.search(r"takes (\w+)", question.text)[1])
        new = list(q)
        new[taken] = (1 - alpha) * q[taken] + alpha * target
        low, high = min(*new, 0), max(*new, 1)
        expected = [
            (n - low) / (high - low) - old for n, old in zip(new, q, strict=True)
        ]
        assert question.asked.answer[0] == pytest.approx(expected)


def test_output_weights_follow_the_slope_of_the_cost() -> None:
    for question in drawn("output-weights"):
        output, target, *hidden, sigma = numbers(question.text)
        z, h = math.log(output / (1 - output)), 1e-6

        def cost(z: float, target=target) -> float:
            q = 1 / (1 + math.exp(-z))
            return -target * math.log(q) - (1 - target) * math.log(1 - q)

        slopes = [(cost(z + h * a) - cost(z - h * a)) / (2 * h) for a in (*hidden, 1)]
        expected = [-sigma * slope for slope in slopes]
        assert question.asked.answer[0] == pytest.approx(expected, abs=1e-6)


def test_memory_of_a_value() -> None:
    for question in drawn("memory-of-a-value"):
        wrong, updates, alpha = numbers(question.text)
        for _ in range(int(updates)):
            wrong += alpha * (0 - wrong)
        assert question.asked.answer == pytest.approx(wrong)


def test_sums_of_changes() -> None:
    for question in drawn("sums-of-changes"):
        changes = numbers(question.text)
        up, down = (sum(c for c in changes if c * s > 0) for s in (1, -1))
        assert np.ravel(question.asked.answer) == pytest.approx([up + down, up - down])


def test_round_forever_is_a_long_sum() -> None:
    for question in drawn("round-forever"):
        k, *rewards, gamma = numbers(question.text)
        assert k == len(rewards)
        total = sum(gamma**t * rewards[t % len(rewards)] for t in range(600))
        assert question.asked.answer == pytest.approx(total)


def test_circle_against_target() -> None:
    for question in drawn("circle-against-target"):
        reward, steps, _, gamma = numbers(question.text)
        circle = sum(gamma**t * reward for t in range(600))
        target = math.prod([gamma] * (int(steps) - 1))
        assert np.ravel(question.asked.answer) == pytest.approx([circle, target])
        better = "the circle" if circle > target else "the target"
        assert f"makes {better} optimal" in question.explanation


def test_reward_that_pays_makes_both_equal() -> None:
    for question in drawn("reward-that-pays"):
        steps, prize, gamma = numbers(question.text)
        circle = sum(gamma**t * question.asked.answer for t in range(600))
        assert circle == pytest.approx(prize * gamma ** (steps - 1))


def test_farthest_target_by_logarithms() -> None:
    for question in drawn("farthest-target"):
        reward, prize, gamma = numbers(question.text)
        exponent = math.log(reward / (1 - gamma) / prize) / math.log(gamma)
        assert question.asked.answer == math.ceil(exponent)


def test_cause_of_symptom_by_the_table_of_the_page() -> None:
    for question in drawn("cause-of-symptom"):
        text, right = question.text, question.asked.right
        if "All but one" in text:
            expected = "a learning rate that does not fall"
        elif "collide" in text:
            expected = "a reward that is too rare"
        else:
            trained = numbers(text)[0]
            if trained > 90:
                expected = "nearly equal values"
            elif "never end" in text:
                expected = "a reward that pays near obstacles only"
            else:
                expected = "a high temperature to the end of the training"
        assert right == expected


def test_lead_after_rescaling() -> None:
    for question in drawn("lead-after-rescaling"):
        second, best = sorted(numbers(question.text))[-2:]
        clipped = max(0, 1 - second)
        shifted = 1 - second / best
        assert np.ravel(question.asked.answer) == pytest.approx([clipped, shifted])


def test_caught_in_a_circle_by_following_the_arrows() -> None:
    for question in drawn("caught-in-a-circle"):
        cells = {}
        for name, group in re.findall(r'data-place="(\w)">(.*?)</g>', question.picture):
            left, top = map(float, re.search(r'x="(\d+)" y="(\d+)"', group).groups())
            x0, y0, x1, y1 = map(
                float, re.search(r"M(\S+) (\S+)L(\S+) ([\d.]+)", group).groups()
            )
            turn = (int(np.sign(y1 - y0)), int(np.sign(x1 - x0)))
            cells[int(top) // 64, int(left) // 64] = (name, turn)
        here = next(
            cell
            for cell, (name, _) in cells.items()
            if f"starts in {name}." in question.text
        )
        visited = []
        for _ in range(60):
            name, (down, right) = cells[here]
            visited.append(name)
            here = (here[0] + down, here[1] + right)
        circle = set(visited[-20:])
        assert set(question.asked.right) == circle
        assert set(question.asked.wrong) == set(visited) - circle


def test_rounds_until_it_leaves_on_average() -> None:
    rng = np.random.default_rng(0)
    for question in drawn("rounds-until-it-leaves")[:10]:
        on, out, temperature = numbers(question.text.replace("$1 / p$", ""))
        p = math.exp(out / temperature)
        p /= p + math.exp(on / temperature)
        mean = rng.geometric(p, size=400_000).mean()
        assert question.asked.answer == pytest.approx(mean, rel=0.02)


def test_targets_of_nfq() -> None:
    for question in drawn("targets-of-nfq"):
        *pairs, gamma = numbers(question.text)
        expected = []
        for k, (reward, value) in enumerate(np.reshape(pairs, (3, 2))):
            target = reward if k == 2 else reward + gamma * value
            expected.append(min(max(target, 0), 1))
        assert question.asked.answer[0] == pytest.approx(expected)


def test_pairs_of_methods_by_running_through_the_episodes() -> None:
    for question in drawn("pairs-of-methods"):
        episodes, decisions, batch = (int(n) for n in numbers(question.text))
        transitions, pairs = 0, 0
        for _ in range(episodes):
            pairs = 0
            for _ in range(decisions):
                pairs, transitions = pairs + 1, transitions + 1
        assert np.ravel(question.asked.answer).tolist() == [
            1,
            pairs,
            transitions,
            batch,
        ]


def test_better_robot_is_the_statistic_of_mann_and_whitney() -> None:
    for question in drawn("better-robot"):
        rates = numbers(question.text)
        statistic = mannwhitneyu(rates[:4], rates[4:]).statistic
        assert question.asked.answer == pytest.approx(statistic / 12)


def test_a_run_of_nnql_line_by_line() -> None:
    words = ["gives $", "draws", "reward is", "line 13", "shifted", "the list has", "trained on"]  # fmt: skip
    for question in drawn("order-of-nnql"):
        first = numbers(question.text)[0]
        places = [
            7 * int(numbers(line)[0] - first)
            + next(k for k, word in enumerate(words) if word in line)
            for line in question.asked.steps
        ]
        assert places == sorted(set(places))
        for number in (first, first + 1):
            said = {
                words[k % 7]: numbers(line.split(":")[1])
                for k, line in zip(places, question.asked.steps, strict=True)
                if numbers(line)[0] == number
            }
            if {"gives $", "draws", "reward is", "line 13"} <= set(said):
                run = " ".join(question.asked.steps)
                name = re.search(rf"{number:g}: the softmax policy draws (\w+)", run)[1]
                taken = ["F", "L30", "L60"].index(name)
                reward, following = said["reward is"]
                new = 0.2 * said["gives $"][taken] + 0.8 * (reward + 0.6 * following)
                assert said["line 13"][-1] == pytest.approx(new, abs=6e-3)
