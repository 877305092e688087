"""Generalized policy iteration: its two extremes are value and policy iteration, and it ends on both lines."""

import math

import numpy as np
import pytest

from robonav.errors import ConvergenceWarning
from robonav.mdp import (
    Cell,
    FiniteMDP,
    GridWorld,
    four_by_three,
    generalized_policy_iteration,
    policy_evaluation,
    policy_iteration,
    value_iteration,
)


@pytest.fixture
def mdp():
    return four_by_three().mdp(0.9)


@pytest.mark.parametrize("sweeps", [1, 2, 7, math.inf])
def test_it_ends_where_both_lines_meet(mdp, sweeps):
    trace = generalized_policy_iteration(mdp, sweeps=sweeps)
    best = policy_iteration(mdp)
    np.testing.assert_allclose(trace.values[-1], best.values, atol=1e-6)
    np.testing.assert_allclose(
        policy_evaluation(mdp, trace.policies[-1]), best.values, atol=1e-9
    )
    assert trace.evaluation_gap[-1] <= mdp.residual_for(1e-6)
    assert trace.greedy_gap[-1] <= 1e-9
    assert trace.improves.tolist() == [False, True] * (len(trace.improves) // 2)


@pytest.mark.parametrize("tolerance", [1e-4, 1.0, 10.0])
@pytest.mark.parametrize("sweeps", [1, 5, math.inf])
def test_promised_loss_with_terminal_states(sweeps, tolerance):
    for seed in range(8):
        rng = np.random.default_rng(seed)
        transitions = rng.dirichlet(np.full(10, 0.2), size=(3, 10))
        rewards = rng.normal(rng.choice([-3, 0, 3]), 1, size=(10, 3))
        transitions[:, :2], rewards[:2] = np.eye(10)[:2], 0
        mdp = FiniteMDP(transitions, rewards, discount=0.9)
        trace = generalized_policy_iteration(mdp, sweeps=sweeps, tolerance=tolerance)
        best = policy_iteration(mdp).values
        loss = best - policy_evaluation(mdp, trace.policies[-1])
        assert loss.max() <= tolerance + 1e-9


def test_each_half_step_moves_one_thing_only(mdp):
    trace = generalized_policy_iteration(mdp, sweeps=3)
    for i, improves in enumerate(trace.improves):
        moved = trace.policies if not improves else trace.values
        np.testing.assert_array_equal(moved[i], moved[i + 1])
        if improves:
            assert trace.greedy_gap[i + 1] <= 1e-9
        else:
            assert trace.evaluation_gap[i + 1] <= trace.evaluation_gap[i] + 1e-12


def test_one_sweep_is_value_iteration(mdp):
    swept = value_iteration(mdp, record=True)
    trace = generalized_policy_iteration(mdp, start_policy=swept.policies[0])
    evaluated = trace.values[1::2]
    shared = min(len(evaluated), swept.iterations)
    np.testing.assert_allclose(
        evaluated[:shared], swept.history[1 : shared + 1], atol=1e-12
    )


def test_exact_evaluation_is_policy_iteration(mdp):
    start = np.zeros(mdp.n_states, dtype=int)
    iterated = policy_iteration(mdp, start=start, record=True)
    trace = generalized_policy_iteration(mdp, sweeps=math.inf, start_policy=start)
    np.testing.assert_array_equal(trace.policies[1::2], iterated.policies)
    np.testing.assert_allclose(trace.values[1::2], iterated.history, atol=1e-12)


def test_gaps_are_zero_exactly_on_their_lines():
    mdp = FiniteMDP([[[1.0, 0], [0, 1]], [[0, 1], [1, 0]]], [[0, 0], [1, 0]], 0.5)
    trace = generalized_policy_iteration(
        mdp, sweeps=math.inf, start_policy=np.array([0, 0])
    )
    assert trace.evaluation_gap.tolist() == [
        1,
        0,
        1,
        0,
        0,
    ]  # off by the reward at first, then by what is new
    assert trace.greedy_gap.tolist() == [
        0,
        1,
        0,
        0,
        0,
    ]  # under V = (0, 2) going to state 1 promises 1
    assert trace.values[-1].tolist() == [1, 2]


def test_an_action_that_ties_stays():
    same = FiniteMDP(np.stack([np.full((4, 4), 0.25)] * 3), np.ones((4, 3)), 0.9)
    start = np.array([2, 1, 0, 1])
    assert (
        generalized_policy_iteration(same, start_policy=start).policies == start
    ).all()


@pytest.mark.parametrize("sweeps", [100, math.inf])
def test_it_ends_where_actions_tie_in_large_values(sweeps):
    """Most cells cannot reach the goal: all their actions have the value -1e8, to rounding."""
    walled = "##..#\n..#.#\n#....\n.#..#\n#.##G"
    grid = GridWorld(walled, legend={"G": Cell(ends=True)}, slip=0.2, step_reward=-1e5)
    trace = generalized_policy_iteration(
        grid.mdp(0.999), sweeps=sweeps, tolerance=0.1, max_rounds=500
    )
    assert (trace.policies[-1] == trace.policies[-2]).all()
    np.testing.assert_allclose(trace.values[-1][:-1], -1e8, atol=0.1)


def test_it_ends_only_when_no_action_changes_any_more(mdp):
    """With so large a tolerance the values are content from the first round on; the policy is not."""
    trace = generalized_policy_iteration(mdp, sweeps=3, tolerance=100)
    assert len(trace.values) > 3
    assert (trace.policies[-1] == trace.policies[-2]).all()


def test_without_discount_it_may_rest_too():
    mdp = GridWorld(". . X").mdp(1.0)
    for sweeps in (1, math.inf):
        trace = generalized_policy_iteration(
            mdp, sweeps=sweeps, start_policy=np.array([1, 1, 0])
        )
        np.testing.assert_array_equal(trace.values[-1], [0, 0, 0])


def test_giving_up_warns(mdp):
    told = r"gave up after 2 rounds: .* to move by 0\.\d+, where .* was asked for, and changed [1-9]\d* actions"
    with pytest.warns(ConvergenceWarning, match=told):
        trace = generalized_policy_iteration(mdp, max_rounds=2)
    assert len(trace.values) == 5


@pytest.mark.parametrize("sweeps", [0, 1.5, -math.inf])
def test_wrong_sweeps_are_refused(mdp, sweeps):
    with pytest.raises((ValueError, TypeError), match="sweeps must be"):
        generalized_policy_iteration(mdp, sweeps=sweeps)
