"""The answers of chapter 6's drills, worked out another way from the numbers in their texts."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
import torch
from numbers_in_texts import drawn, numbers


def test_failures_avoided_in_a_hundred_maps() -> None:
    for question in drawn("failures-avoided"):
        rule, learned = numbers(question.text)[:2]
        left = (100 - learned) / (100 - rule)
        assert question.asked.answer == pytest.approx(1 - left)


def test_effects_by_least_squares() -> None:
    design = [[1, a, b, (2 * a - 1) * (2 * b - 1)] for a in (0, 1) for b in (0, 1)]
    for question in drawn("effects-of-two-changes"):
        rates = numbers(question.text)[:4]
        fitted = np.linalg.solve(np.array(design, float), rates)
        assert question.asked.answer[0] == pytest.approx(fitted[1:3])
        assert 0 <= min(rates) <= max(rates) <= 100


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


def test_sum_of_forces_by_a_derivative_of_the_potential() -> None:
    for question in drawn("sum-of-forces"):
        rho, eta, influence = (
            float(re.search(pattern, question.text)[1])
            for pattern in (r"reads \$([\d.]+)", r"eta = ([\d.]+)", r"rho_0 = ([\d.]+)")
        )

        def potential(x: float, rho=rho, eta=eta, influence=influence) -> float:
            return -x + eta / 2 * (1 / (rho - x) - 1 / influence) ** 2

        slope = (potential(1e-5) - potential(-1e-5)) / 2e-5
        assert question.asked.answer == pytest.approx(-slope, abs=1e-6)


def test_angle_of_the_clearance_by_a_right_angled_triangle() -> None:
    for question in drawn("angle-of-the-clearance"):
        distance, clearance = (float(n) for n in re.findall(r"\$([\d.]+)\$", question.text))  # fmt: skip
        along = math.sqrt(distance**2 - clearance**2)
        expected = math.degrees(math.atan2(clearance, along))
        assert question.asked.answer == pytest.approx(expected)


def test_cheapest_opening_by_adding_up() -> None:
    for question in drawn("cheapest-opening"):
        *degrees, target, keep = numbers(question.text.replace("°", " "))
        cost = {d: abs(d - target) + keep * abs(d) for d in degrees}
        assert question.asked.right == f"{min(cost, key=cost.get):g}°"


def test_best_of_the_window_by_adding_up() -> None:
    for question in drawn("best-of-the-window"):
        ways = dict(re.findall(r"(F|[LR][36]0) (\d+\.?\d*)", question.text))
        bearing = float(re.search(r"lies at (-?\d+)°", question.text)[1])
        heading, distance = (
            float(n) for n in re.search(r"scores \$([\d.]+) .* \+ ([\d.]+) \\, w", question.text).groups()
        )  # fmt: skip
        turns = {"F": 0, "L30": 30, "L60": 60, "R30": -30, "R60": -60}
        score = {
            name: heading * (1 - abs(bearing - turns[name]) / 180) + distance * float(way) / 10
            for name, way in ways.items() if float(way) >= 2
        }  # fmt: skip
        assert question.asked.right == max(score, key=score.get)


def test_leave_or_follow_by_the_distance_of_the_free_point() -> None:
    for question in drawn("leave-or-follow"):
        least, distance, free, step = numbers(question.text)
        leaves = distance - free < least - step
        assert ("leaves" in question.asked.right) == leaves


def test_step_of_the_gradient_by_a_small_change_of_the_score() -> None:
    for question in drawn("step-of-the-gradient"):
        probability, advantage, rate = numbers(question.text.replace("$", " "))

        def gain(change: float, p=probability, advantage=advantage) -> float:
            raised = p * math.exp(change)
            return advantage * math.log(raised / (raised + 1 - p))

        slope = (gain(1e-5) - gain(-1e-5)) / 2e-5
        assert question.asked.answer == pytest.approx(rate * slope, abs=1e-6)


def test_last_three_advantages_by_the_sums_of_the_errors() -> None:
    for question in drawn("last-three-advantages"):
        *_, end, v1, v2, v3, gamma, decay = numbers(question.text.replace("$", " "))
        errors = [gamma * v2 - v1, gamma * v3 - v2, end - v3]
        expected = [
            sum((gamma * decay) ** k * error for k, error in enumerate(errors[t:]))
            for t in range(3)
        ]
        assert question.asked.answer[0] == pytest.approx(expected)


def test_clipped_gain_by_cases() -> None:
    for question in drawn("clipped-gain"):
        before, now, advantage, clip = numbers(question.text.replace("$", " "))
        ratio = now / before
        limited = min(ratio, 1 + clip) if advantage > 0 else max(ratio, 1 - clip)
        assert question.asked.answer == pytest.approx(limited * advantage)


def test_push_of_the_gradient_by_a_small_change_of_the_ratio() -> None:
    words = {1: "likelier", -1: "less likely", 0: "nothing"}
    for question in drawn("push-of-the-gradient"):
        ratio, advantage, clip = numbers(question.text.replace("$", " "))

        def gain(rho: float, advantage=advantage, clip=clip) -> float:
            clipped = min(max(rho, 1 - clip), 1 + clip)
            return min(rho * advantage, clipped * advantage)

        slope = gain(ratio + 1e-3) - gain(ratio - 1e-3)
        pushed = 0 if abs(slope) < 1e-9 else int(math.copysign(1, slope))
        assert words[pushed] in question.asked.right


def test_data_of_a_training_by_counting() -> None:
    for question in drawn("data-of-a-training"):
        actors, steps, epochs, batches, updates = map(int, numbers(question.text))
        of_actors = sum(steps for _ in range(updates) for _ in range(actors))
        of_adam = len([0 for _ in range(updates * epochs) for _ in range(batches)])
        assert question.asked.answer[0] == [of_actors, of_adam]


def test_best_judge_by_the_least_cost_of_a_grid() -> None:
    for question in drawn("best-judge"):
        _, learner, _, expert = numbers(question.text.replace("$", " "))
        grid = [k / 1000 for k in range(1, 1000)]
        cost = [-learner * math.log(d) - expert * math.log(1 - d) for d in grid]
        best = grid[cost.index(min(cost))]
        assert question.asked.answer == pytest.approx(best, abs=6e-4)


def test_rewards_of_a_pair_by_logarithms() -> None:
    for question in drawn("rewards-of-a-pair"):
        (d,) = numbers(question.text.replace("$", " "))
        first, second, third = question.asked.answer[0]
        assert math.exp(-first) == pytest.approx(d)
        assert math.exp(second) == pytest.approx(1 - d)
        assert third == pytest.approx(first + second)


def test_cost_of_the_judge_by_the_product_of_probabilities() -> None:
    for question in drawn("cost-of-the-judge"):
        own, expert = numbers(question.text.replace("$", " "))
        assert math.exp(-question.asked.answer) == pytest.approx(own * (1 - expert))


def test_stay_or_end_by_adding_up() -> None:
    for question in drawn("stay-or-end"):
        d, *_, short, long = numbers(question.text.replace("$", " "))
        each = math.log(1 - d) if "log(1 - D)" in question.text else -math.log(d)
        returns = [sum(each for _ in range(int(n))) for n in (long, short)]
        longer = returns[0] > returns[1]
        assert ("longer" in question.asked.right) == longer


def test_nearest_moment_by_many_moments() -> None:
    for question in drawn("nearest-moment"):
        x0, y0, x1, y1 = numbers(question.text)[:4]
        moments = np.linspace(0, 1, 100_001)
        distances = np.hypot(x0 + moments * (x1 - x0), y0 + moments * (y1 - y0))
        assert question.asked.answer == pytest.approx(distances.min(), abs=1e-6)


def test_reading_of_another_robot_by_complex_numbers() -> None:
    for question in drawn("reading-of-another-robot"):
        x0, y0, x1, y1 = numbers(question.text)[:4]
        assert question.asked.answer == pytest.approx(
            abs(complex(x1 - x0, y1 - y0)) - 1
        )


def test_second_of_the_collision_by_counting_seconds() -> None:
    for question in drawn("second-of-the-collision"):
        speed, apart = numbers(question.text)[:2]
        gaps = apart - 2 * speed * np.arange(60)
        assert question.asked.answer == np.flatnonzero(gaps < 2)[0]


def test_gain_of_learning_together_by_a_hundred_robots() -> None:
    for question in drawn("gain-of-learning-together"):
        alone, together = numbers(question.text)[:2]
        saved = [robot for robot in range(100) if alone <= robot < together]
        failed = [robot for robot in range(100) if robot >= alone]
        assert question.asked.answer == pytest.approx(100 * len(saved) / len(failed))


def cells_of(picture: str) -> dict[tuple[int, int], tuple[str, tuple[int, int]]]:
    """The name and the arrow of each cell with an arrow, by row and column."""
    cells = {}
    for name, group in re.findall(r'data-place="(\w)">(.*?)</g>', picture):
        left, top = map(float, re.search(r'x="(\d+)" y="(\d+)"', group).groups())
        x0, y0, x1, y1 = map(
            float, re.search(r"M(\S+) (\S+)L(\S+) ([\d.]+)", group).groups()
        )
        turn = (int(np.sign(y1 - y0)), int(np.sign(x1 - x0)))
        cells[int(top) // 64, int(left) // 64] = (name, turn)
    return cells


def test_where_a_policy_must_err_by_walking_through_the_picture() -> None:
    """Shortest ways are found cell by cell from the goal; no package function of models takes part."""
    sides = [(-1, 0), (0, 1), (1, 0), (0, -1)]
    for question in drawn("where-a-policy-must-err"):
        cells = cells_of(question.picture)
        grey = {
            (int(float(y)) // 64, int(float(x)) // 64)
            for x, y in re.findall(r'<rect x="(\S+)" y="(\S+)"[^>]*fill="#888"', question.picture)
        }  # fmt: skip
        (goal,) = {(i, j) for i in range(3) for j in range(4)} - grey - set(cells)
        far, ring = {goal: 0}, [goal]
        while ring:
            ring = [
                (i + a, j + b) for i, j in ring for a, b in sides
                if (i + a, j + b) in cells and (i + a, j + b) not in far
            ]  # fmt: skip
            far |= dict.fromkeys(ring, max(far.values()) + 1)
        nearer = {
            cell: {(a, b) for a, b in sides if far.get((cell[0] + a, cell[1] + b), 99) < far[cell]}
            for cell in cells
        }  # fmt: skip
        senses = {(i, j): [(i + a, j + b) in far for a, b in sides] for i, j in cells}
        right = set()
        for cell, (name, arrow) in cells.items():
            assert arrow in nearer[cell]
            same = [nearer[c] for c in cells if senses[c] == senses[cell]]
            if not set.intersection(*same):
                right.add(name)
        assert set(question.asked.right) == right


def test_right_without_a_memory_by_counting_worlds() -> None:
    for question in drawn("right-without-a-memory"):
        left, worlds, turns = numbers(question.text)
        sides = [1] * int(left) + [0] * int(worlds - left)
        mean = sum(turns if side else 1 - turns for side in sides) / worlds
        best = max(sides.count(0), sides.count(1)) / worlds
        assert question.asked.answer[0] == pytest.approx([mean, best])


def test_window_that_reaches_back_by_a_list_of_states() -> None:
    for question in drawn("window-that-reaches-back"):
        distance, speed = numbers(question.text.replace("$", " "))
        passed = ["sign"]
        while (len(passed) - 1) * speed < distance:
            passed.append("corridor")
        lengths = [k for k in range(1, 50) if "sign" in passed[-k:]]
        assert question.asked.answer == min(lengths)


def test_numbers_in_a_window_one_after_the_other() -> None:
    for question in drawn("numbers-in-a-window"):
        k, encoded, *_ = map(int, numbers(question.text))
        parts = [encoded]
        for _ in range(k - 1):
            parts += [5, encoded]
        assert question.asked.answer == sum(parts)


def test_one_step_of_a_unit_by_torch_s_own() -> None:
    """In torch's unit the gates stand in the order r, z, n; its z is that of the page."""
    for question in drawn("one-step-of-a-unit"):
        h, x, wz, uz, w, u = numbers(re.sub(r"_z", "", question.text.replace("$", " ")))[:6]  # fmt: skip
        cell = torch.nn.GRUCell(1, 1, dtype=torch.float64)
        with torch.no_grad():
            cell.weight_ih[:] = torch.tensor([[0.0], [wz], [w]])
            cell.weight_hh[:] = torch.tensor([[0.0], [uz], [u]])
            cell.bias_ih.zero_()
            cell.bias_hh.zero_()
            cell.bias_ih[0] = 50.0  # the reset gate is 1
            after = cell(torch.tensor([[x]]).double(), torch.tensor([[h]]).double())
        assert question.asked.answer == pytest.approx(after.item())


def test_left_in_a_unit_by_logarithms() -> None:
    for question in drawn("left-in-a-unit"):
        stored, steps, z = numbers(question.text.replace("$", " "))[:3]
        share = math.exp(steps * math.log(z))
        assert question.asked.answer == pytest.approx(stored * share)


def test_stored_or_used_by_the_quadratic_equation() -> None:
    for question in drawn("stored-or-used"):
        worlds, read, taken = numbers(question.text)
        stored, used = (wilson(n, worlds)[0] > 0.5 for n in (read, taken))
        expected = ("does not hold", "does not use", "and the policy uses")
        assert expected[int(stored) + int(stored and used)] in question.asked.right
        assert stored or not used


def test_edge_of_a_circle_by_many_rays() -> None:
    for question in drawn("edge-of-a-circle"):
        radius, ahead, left = numbers(question.text)[:3]
        angles = np.radians(np.arange(0, 90, 0.002))
        across = abs(ahead * np.sin(angles) - left * np.cos(angles))
        first = np.degrees(angles[np.argmax(across <= radius)])
        assert question.asked.answer == pytest.approx(first, abs=0.004)


def test_around_a_ring_by_laying_the_ring_out_three_times() -> None:
    for question in drawn("around-a-ring"):
        lists = re.findall(r"= \(([-\d, ]+)\)", question.text)
        x, w = ([int(n) for n in found.split(",")] for found in lists)
        y = np.correlate(np.tile(x, 3), w, mode="same")[6:12]
        assert question.asked.answer[0] == [y[0], y[5]]


def test_numbers_of_weights_by_layers_of_torch() -> None:
    for question in drawn("numbers-of-weights"):
        sectors, units, channels, window = (
            int(re.search(pattern, question.text)[1])
            for pattern in (r"(\d+) sectors, with", r"has (\d+) units", r"has (\d+) windows", r"each (\d+) sectors")
        )  # fmt: skip
        layers = torch.nn.Linear(sectors, units), torch.nn.Conv1d(1, channels, window)
        assert question.asked.answer[0] == [
            sum(part.numel() for part in layer.parameters()) for layer in layers
        ]


def test_cells_that_a_unit_sees_by_the_gradient_of_a_unit() -> None:
    for question in drawn("cells-that-a-unit-sees"):
        layers, window, _, stride, *_ = (int(n) for n in numbers(question.text)[:4])
        width = float(re.search(r"is ([\d.]+) m wide", question.text)[1])
        one = torch.nn.Conv1d(1, 1, window, stride, bias=False).double()
        torch.nn.init.ones_(one.weight)
        row = torch.zeros(1, 1, 4000, dtype=torch.float64, requires_grad=True)
        found = row
        for _ in range(layers):
            found = one(found)
        found[0, 0, 0].backward()
        seen = int((row.grad != 0).sum())
        assert question.asked.answer == pytest.approx(seen * width)


def test_price_of_randomising_by_counting_a_thousand_episodes() -> None:
    for question in drawn("price-of-randomising"):
        plain, plain_noisy, randomised, noisy = (
            round(10 * n) for n in numbers(question.text)[:4]
        )
        cost, avoided = question.asked.answer[0]
        assert cost == pytest.approx((plain - randomised) / 10)
        failed = set(range(plain_noisy, 1000))
        left = set(range(noisy, 1000))
        assert avoided == pytest.approx(100 * len(failed - left) / len(failed))


def test_speed_of_a_wheel_by_complex_numbers() -> None:
    for question in drawn("speed-of-a-wheel"):
        degrees, forward, left, turn = numbers(question.text)[2:6]
        along = 1j * np.exp(1j * np.radians(degrees))
        moves = complex(forward, left) + turn * 0.7 * along
        rim = (moves * along.conjugate()).real
        assert question.asked.answer == pytest.approx(rim / 0.2)


def test_error_of_odometry_second_by_second() -> None:
    for question in drawn("error-of-odometry"):
        speed, seconds, share = numbers(question.text)[:3]
        believed = sum(speed for _ in range(int(seconds)))
        driven = sum(speed * (1 - share / 100) for _ in range(int(seconds)))
        assert question.asked.answer == pytest.approx(believed - driven)


def test_push_of_a_wheel_by_the_limit_that_counts() -> None:
    for question in drawn("push-of-a-wheel"):
        torque, radius, load, friction = numbers(question.text)[:4]
        slips = torque > friction * load * radius
        assert question.asked.answer == pytest.approx(
            friction * load if slips else torque / radius
        )
        assert question.explanation.endswith(
            "so the wheel slips." if slips else "so the wheel does not slip."
        )


def test_seconds_to_turn_around_by_small_steps() -> None:
    for question in drawn("seconds-to-turn-around"):
        speed, friction = numbers(question.text)[:2]
        steps = np.arange(0, 20, 1e-4)
        speeds = speed - friction * 9.81 * steps
        assert question.asked.answer == pytest.approx(
            steps[np.argmax(speeds <= -speed)], abs=2e-4
        )


def test_what_randomisation_brings_back_in_a_hundred_worlds() -> None:
    for question in drawn("brought-back"):
        simulator, plain, randomised = numbers(question.text)[:3]
        lost = [world for world in range(100) if plain <= world < simulator]
        back = [world for world in lost if world < randomised]
        assert question.asked.answer == pytest.approx(100 * len(back) / len(lost))
