"""The folded answers to the labs of chapter 2 are what the package computes."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from robonav import mdp
from robonav.mdp.generalized_policy_iteration import suboptimality
from robonav.mdp.gridworld import STEPS

ROOMS = """
    S . . # . . .
    . . . # . X .
    . # . . . . .
    . # X . # . .
    . . . . # . G
"""
CORRIDOR = "..D.....D.D...."


def rooms(slip: float, cost: float) -> mdp.GridWorld:
    return mdp.GridWorld(ROOMS, slip=slip, step_reward=-cost)


def losses(discount: float, slip: float, cost: float) -> np.ndarray:
    """What the greedy policy of each sweep of value iteration loses, as the lab shows it."""
    model = rooms(slip, cost).mdp(discount)
    found = mdp.value_iteration(model, 0.02, record=True)
    best = mdp.policy_iteration(model).values
    judged = suboptimality(model, found.history, found.policies, best=best)
    return np.asarray(judged[1])


def test_arrows_are_optimal_long_before_the_values():
    lost = losses(0.9, 0.2, 0.04)
    assert len(lost) - 1 == 22
    assert np.flatnonzero(lost >= 5e-4).max() + 1 == 17


def test_optimal_arrows_may_get_worse_again():
    lost = losses(0.99, 0.2, 0)
    assert len(lost) - 1 == 101
    good = np.flatnonzero(lost < 5e-4)
    assert good[0] == 16
    assert good[1:].tolist() == list(range(37, 102))
    assert lost[17:37].max() == pytest.approx(0.018, abs=5e-4)


def test_policy_iteration_needs_at_most_ten_policies():
    def small(slip: float, cost: float) -> mdp.GridWorld:
        return mdp.four_by_three(slip=slip, step_reward=-cost)

    settings = product((rooms, small), (0.5, 0.9, 0.99), (0, 0.2, 0.5), (0, 0.04, 0.3))
    needed = []
    for world, discount, slip, cost in settings:
        model = world(slip, cost).mdp(discount)
        up = np.zeros(model.n_states, dtype=int)
        needed.append(mdp.policy_iteration(model, start=up).iterations)
    assert max(needed) == 10


def test_five_cells_step_into_a_pit():
    world = rooms(0.5, 0.3)
    policy = mdp.policy_iteration(world.mdp(0.99)).policy
    into = 0
    for state in np.flatnonzero(~world.terminal):
        row, column = world.cells[state] + STEPS[policy[state]]
        inside = 0 <= row < world.shape[0] and 0 <= column < world.shape[1]
        into += inside and world.rows[row][column] == "X"
    assert into == 5


def test_past_the_bad_exit_while_twelve_steps_are_left():
    plan = mdp.backward_induction(mdp.four_by_three().mdp(1.0), 30)
    up = [left for left in range(1, 31) if plan.policy[30 - left][9] == 0]
    assert up == list(range(1, 13))


def test_a_sure_robot_knows_its_cell_after_three_to_eight_steps():
    corridor = mdp.corridor(CORRIDOR, accuracy=1.0, slip=0.0)
    needed = []
    for start in range(len(CORRIDOR)):
        cell, belief, steps = start, corridor.uniform(), 0
        while belief.max() < 1 - 1e-9:
            cell, steps = min(cell + 1, len(CORRIDOR) - 1), steps + 1
            belief = corridor.update(belief, 1, int(CORRIDOR[cell] == "D"))
        needed.append(steps)
    assert (min(needed), max(needed)) == (3, 8)


def test_pushing_left_tells_the_place():
    corridor = mdp.corridor(CORRIDOR, accuracy=0.9, slip=0.1)
    blind, belief = mdp.without_sensing(corridor.mdp), corridor.uniform()
    assert mdp.entropy(belief) == pytest.approx(3.91, abs=5e-3)
    for _ in range(22):
        belief = blind.update(belief, 0, 0)
    assert mdp.entropy(belief) < 5e-3
