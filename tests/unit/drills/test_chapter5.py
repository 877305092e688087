"""The answers of chapter 5's drills, worked out another way from the numbers in their texts."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from numbers_in_texts import drawn, numbers
from scipy.optimize import minimize_scalar

from robonav.drills import DRILLS


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
        assert likelihoods[0] != pytest.approx(likelihoods[1])  # no action is as good
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


def rewards_of(option: str, table: np.ndarray, gamma: float) -> np.ndarray:
    """The reward that an option of the drill describes."""
    reward = table.copy()
    if "Phi" in option:
        a, b = numbers(option.split("with")[1])
        for state, other in ((0, 1), (1, 0)):
            phi = (a, b)
            for action, reached in enumerate((state, other)):
                shaped = "- \\Phi(s)" in option
                factor = gamma if shaped else 1
                reward[state, action] += factor * phi[reached] - shaped * phi[state]
    elif "but with" in option:
        state, action = re.search(r"R\(([AB]), \\text\{(\w+)\}\) = ", option).groups()
        reward["AB".index(state), ["stay", "go"].index(action)] = numbers(option)[-1]
    elif re.search(r"R [+-] \d", option):
        sign, number = re.search(r"R ([+-]) (\d+)", option).groups()
        reward += float(sign + number)
    else:
        factor = option.strip("$").removesuffix("R").strip()
        reward *= -1 if factor == "-" else float(factor)
    return reward


def best_of_four(reward: np.ndarray, gamma: float) -> tuple[int, int]:
    """The best of the four policies of two states, each solved as two linear equations."""

    def value(policy: tuple[int, int]) -> float:
        reached = [policy[0], 1 - policy[1]]
        matrix = np.eye(2) - gamma * np.eye(2)[reached]
        return float(
            np.linalg.solve(matrix, [reward[s, policy[s]] for s in (0, 1)]).sum()
        )

    return max(((a, b) for a in (0, 1) for b in (0, 1)), key=value)


def test_same_optimal_policy_among_all_four() -> None:
    for question in drawn("same-optimal-policy"):
        gamma, *entries = numbers(question.text)[:5]
        table = np.reshape(entries, (2, 2))
        policy = best_of_four(table, gamma)
        same = {
            option: best_of_four(rewards_of(option, table, gamma), gamma) == policy
            for option in question.asked.options
        }
        wanted = "makes the same" in question.text
        assert [o for o in same if same[o] == wanted] == [question.asked.right]


def test_target_has_moved_by_the_cheapest_way() -> None:
    for question in drawn("target-has-moved"):
        title = re.search(r'aria-label="([^"]+)"', question.picture)[1]
        rows = [part.split(": ")[1].split(", ") for part in title.split(". ")]
        cell = {
            (i, j): text for i, row in enumerate(rows) for j, text in enumerate(row)
        }
        entering = {
            c: numbers(text)[0] if "S" not in text[:1] else -9.0
            for c, text in cell.items()
        }
        entering = {
            c: 10.0 if cell[c].startswith("T") else r for c, r in entering.items()
        }
        start = next(c for c, text in cell.items() if text.startswith("S"))

        def best(
            at: tuple[int, int], seen: frozenset, cell=cell, entering=entering
        ) -> float:
            if cell[at].startswith("T"):
                return 0.0
            ways = [
                entering[n] + best(n, seen | {n})
                for n in (
                    (at[0] - 1, at[1]),
                    (at[0] + 1, at[1]),
                    (at[0], at[1] - 1),
                    (at[0], at[1] + 1),
                )
                if n in cell and n not in seen
            ]
            return max(ways, default=-math.inf)

        returns = {
            re.search(r"\((\w)\)", cell[n])[1]: entering[n]
            + best(n, frozenset({start, n}))
            for n in cell
            if abs(n[0] - start[0]) + abs(n[1] - start[1]) == 1
        }
        assert question.asked.right == [max(returns, key=returns.__getitem__)]


def test_rare_and_frequent() -> None:
    for question in drawn("rare-and-frequent"):
        forward, left, forward_there, left_there = numbers(question.text)[:4]
        p = forward / (forward + forward_there), left / (left + left_there)
        assert p[0] != pytest.approx(p[1])  # one of them is larger
        changed = left if p[0] >= p[1] else forward
        assert np.ravel(question.asked.answer) == pytest.approx([*p, changed])


def test_belief_over_rewards_by_log_odds() -> None:
    for question in drawn("belief-over-rewards"):
        text = re.sub(r"Q\([ab]\)|R_\d", "", question.text)
        times_a, times_b, a1, b1, a2, b2, eta, prior = numbers(text)
        odds = math.log(prior / (1 - prior))
        for sign, (a, b) in ((1, (a1, b1)), (-1, (a2, b2))):
            log_a = -math.log1p(math.exp(-eta * (a - b)))
            log_b = -math.log1p(math.exp(eta * (a - b)))
            odds += sign * (times_a * log_a + times_b * log_b)
        assert question.asked.answer == pytest.approx(1 / (1 + math.exp(-odds)))


def test_slipping_expert() -> None:
    names = ["R60", "R30", "F", "L30", "L60"]
    for question in drawn("slipping-expert"):
        chance = numbers(question.text)[0]
        at = names.index(re.search(r"expert means (\w+)", question.text)[1])
        beside = [k for k in (at - 1, at + 1) if 0 <= k < 5]
        expected = [
            1 - chance if k == at else chance / len(beside) * (k in beside)
            for k in range(5)
        ]
        assert np.ravel(question.asked.answer) == pytest.approx(expected)


def test_linear_reward() -> None:
    for question in drawn("linear-reward"):
        first, second, _, *weights = numbers(question.text.replace("(5.2)", ""))
        expected = np.reshape(weights[:4], (2, 2)) @ [first, second]
        assert question.asked.answer[0] == pytest.approx(expected)


def test_importance_weights_by_their_ratios() -> None:
    for question in drawn("importance-weights"):
        a, b, c, base = numbers(question.text)
        first, second, third = question.asked.answer[0]
        assert first + second + third == pytest.approx(1)
        assert first / second == pytest.approx(base ** (a - b))
        assert third / second == pytest.approx(base ** (c - b))


def test_gradient_of_the_dual_by_finite_differences() -> None:
    for question in drawn("gradient-of-the-dual"):
        expert, a, b, slack, base = numbers(question.text)
        theta = math.log(base) * (-1 if "-\\ln" in question.text else 1)

        def dual(t: float, a=a, b=b, expert=expert, slack=slack) -> float:
            return (
                t * expert
                - math.log((math.exp(t * a) + math.exp(t * b)) / 2)
                - slack * abs(t)
            )

        slope = (dual(theta + 1e-6) - dual(theta - 1e-6)) / 2e-6
        assert question.asked.answer == pytest.approx(slope, abs=1e-5)


def test_large_margin_step() -> None:
    for question in drawn("large-margin-step"):
        scores = dict(zip("abc", numbers(question.text)[:3], strict=True))
        own = scores.pop(re.search(r"expert takes (\w)", question.text)[1])
        missing = max(score + 1 - own for score in scores.values())
        assert question.asked.answer == pytest.approx(max(0, missing))


def test_one_step_of_lstd_has_an_error_without_a_component_along_the_basis() -> None:
    for question in drawn("one-step-of-lstd"):
        psi, after, *rest = numbers(question.text)
        last = 0.0 if "ends" in question.text else rest.pop(0)
        first_feature, second_feature, gamma = rest
        omega = question.asked.answer
        errors = (
            first_feature + gamma * after * omega - psi * omega,
            second_feature + gamma * last * omega - after * omega,
        )
        assert psi * errors[0] + after * errors[1] == pytest.approx(0, abs=1e-4)


def test_run_against_run() -> None:
    for question in drawn("run-against-run"):
        ours, theirs = np.reshape(numbers(question.text), (2, 3))
        won = [1 if a > b else 0.5 if a == b else 0 for a in ours for b in theirs]
        assert question.asked.answer == pytest.approx(sum(won) / 9)


def test_what_controls_show() -> None:
    for question in drawn("what-controls-show"):
        method, _, zero, cloning = numbers(question.text)[:4]
        expected = (
            "Nothing"
            if method - zero < 3
            else "without one"
            if method - cloning < 3
            else "does not reach"
        )
        assert expected in question.asked.right


AIMS = re.compile(r"people|camera|follow the walls|quiet|parcel|its back")
MOVES = re.compile(
    r"speed, so|twice|greatest turn|slippery|sideways|obstacles move|half as often"
)


def what_holds(change: str) -> str:
    """Words of the statement that is true after a change."""
    if AIMS.search(change):
        return "does not describe"
    return "may not" if MOVES.search(change) else "as good as before"


def test_after_a_change() -> None:
    for question in drawn("after-a-change"):
        text = question.text.partition("m/s.")[2]
        if "After which" in text:
            fits = [o for o in question.asked.options if what_holds(o) in text]
            assert fits == [question.asked.right]
        else:
            assert what_holds(text) in question.asked.right


@pytest.mark.parametrize("name", ["refined", "rare-and-frequent"])
def test_no_likelihood_ties_in_many_questions(name: str) -> None:
    for seed in range(600):
        question = DRILLS[name].question(seed)
        a_here, b_here, a_there, b_there = numbers(question.text)[:4]
        assert a_here * b_there != b_here * a_there, question.text
