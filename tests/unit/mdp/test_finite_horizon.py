"""Finite horizon: brute force over all plans, the limit of a long horizon, FrozenLake's 100 steps."""

import itertools

import gymnasium as gym
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robonav.mdp import (
    FiniteMDP,
    backward_induction,
    finite_horizon_evaluation,
    policy_iteration,
)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 1000), st.integers(0, 3), st.sampled_from([0.0, 0.5, 0.95]))
def test_no_plan_of_all_beats_it(seed, horizon, discount):
    """Every sequence of decision rules, one action a state and step, tried out."""
    rng = np.random.default_rng(seed)
    mdp = FiniteMDP(
        rng.dirichlet(np.ones(2), (2, 2)), rng.normal(size=(2, 2)), discount
    )
    final = rng.normal(size=2)
    best = np.full(2, -np.inf)
    for plan in itertools.product(
        itertools.product(range(2), repeat=2), repeat=horizon
    ):
        values = final
        for rule in reversed(plan):
            values = mdp.action_values(values)[np.arange(2), rule]
        best = np.maximum(best, values)
    found = backward_induction(mdp, horizon, final_values=final)
    assert found.values.shape == (horizon + 1, 2)
    assert found.policy.shape == (horizon, 2)
    np.testing.assert_allclose(found.values[0], best)


def test_a_long_horizon_comes_to_the_infinite_one():
    rng = np.random.default_rng(1)
    mdp = FiniteMDP(rng.dirichlet(np.ones(6), (3, 6)), rng.normal(size=(6, 3)), 0.8)
    best = policy_iteration(mdp)
    found = backward_induction(mdp, 200)
    np.testing.assert_allclose(found.values[0], best.values, atol=1e-9)
    np.testing.assert_allclose(
        finite_horizon_evaluation(mdp, best.policy, 200), best.values, atol=1e-9
    )


def test_frozen_lake_within_its_100_steps():
    """Less than the 14/17 without a limit; and the policy made for the limit beats the one made for eternity."""
    mdp = FiniteMDP.from_gymnasium(gym.make("FrozenLake-v1", is_slippery=True), 1.0)
    limited = backward_induction(mdp, 100)
    patient = finite_horizon_evaluation(mdp, policy_iteration(mdp).policy, 100)
    assert 0.73 < patient[0] < limited.values[0, 0] < 14 / 17
    assert (
        np.diff(limited.values[:, 0]) <= 1e-12
    ).all()  # the more steps to go, the better


def test_a_policy_earns_its_steps_and_what_stands_at_the_end():
    """By hand: from 0 to 1 and to and fro between them, 1 for each step out of 0, discount 0.5, 8 and 16 at the end."""
    mdp = FiniteMDP([[[0, 1], [1, 0]]], [[1], [0]], 0.5)
    np.testing.assert_allclose(
        finite_horizon_evaluation(mdp, [0, 0], 3, final_values=[8, 16]),
        [1 + 0.25 + 2, 0.5 + 1],
    )
    np.testing.assert_allclose(
        finite_horizon_evaluation(mdp, [0, 0], 0, final_values=[8, 16]), [8, 16]
    )


@pytest.mark.parametrize("horizon", [-1, 2.5])
def test_wrong_horizons_are_refused(horizon):
    mdp = FiniteMDP([[[1.0]]], [[1.0]], 0.5)
    with pytest.raises((ValueError, TypeError), match="horizon must be"):
        backward_induction(mdp, horizon)
