"""Features and feature expectations: exact against series, sampled against exact (Eq. (5.3)-(5.6), (5.13))."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from robonav.mdp.evaluation import policy_evaluation
from robonav.nirl import (
    RewardFreeMDP,
    all_action_features,
    discounted_feature_sums,
    empirical_expectations,
    feature_expectations,
    initial_expectations,
    state_action_features,
)


def test_each_action_has_its_own_block():
    blocks = all_action_features([[1.0, 2.0]], 3)
    np.testing.assert_array_equal(
        blocks[0], [[1, 2, 0, 0, 0, 0], [0, 0, 1, 2, 0, 0], [0, 0, 0, 0, 1, 2]]
    )
    np.testing.assert_array_equal(
        state_action_features([[1.0, 2.0]], [2], 3), blocks[:, 2]
    )


@settings(deadline=None)
@given(
    arrays(float, (4, 3), elements=st.floats(-5, 5)),
    arrays(np.int64, 4, elements=st.integers(0, 4)),
)
def test_a_reward_over_blocks_is_linear_in_the_state_for_each_action(phi, chosen):
    theta = np.arange(15.0).reshape(5, 3)
    np.testing.assert_allclose(
        all_action_features(phi, 5) @ theta.ravel(), phi @ theta.T, atol=1e-9
    )
    np.testing.assert_allclose(
        state_action_features(phi, chosen, 5) @ theta.ravel(),
        (phi @ theta.T)[range(4), chosen],
        atol=1e-9,
    )


def test_an_action_out_of_range_gets_a_sentence():
    with pytest.raises(
        ValueError, match="actions must lie between 0 and 4, got 0 to 7"
    ):
        state_action_features(np.ones((2, 3)), [0, 7], 5)


def test_exact_expectations_are_the_sum_of_the_series():
    rng = np.random.default_rng(0)
    transitions = rng.dirichlet(np.ones(3), (2, 3))
    task = RewardFreeMDP(
        transitions, rng.normal(size=(3, 2, 4)), 0.9, np.full(3, 1 / 3)
    )
    policy = rng.dirichlet(np.ones(2), 3)
    total, weight = np.zeros((3, 2, 4)), 1.0
    pair = np.eye(6).reshape(3, 2, 3, 2)
    for _ in range(400):
        total += weight * np.einsum("saij,ijk->sak", pair, task.features)
        state = np.einsum("saij,jit->sat", pair, transitions)
        pair = np.einsum("sat,tu->satu", state, policy)
        weight *= 0.9
    np.testing.assert_allclose(feature_expectations(task, policy), total, atol=1e-12)


@pytest.mark.parametrize("weights", [[1.0, -2.0, 0.5, 3.0], [0.0, 0.0, 1.0, 0.0]])
def test_equal_expectations_equal_values(terrain, weights):
    """Eq. (5.4): theta . mu is the value of the policy, for any reward."""
    policy = np.random.default_rng(1).dirichlet(np.ones(4), terrain.task.n_states)
    value = terrain.task.starts @ policy_evaluation(
        terrain.task.with_reward(weights), policy
    )
    assert initial_expectations(terrain.task, policy) @ weights == pytest.approx(value)


@pytest.mark.slow
def test_sampled_expectations_approach_the_exact_ones(terrain):
    walks = terrain.task.rollout(terrain.expert, 4000, 80, seed=1)
    features = terrain.task.features[walks.states, walks.actions].reshape(-1, 4)
    estimate = empirical_expectations(features, walks.trajectory, terrain.task.discount)
    parts = discounted_feature_sums(
        features, walks.trajectory, terrain.task.discount
    ).reshape(4000, 80, 4)[:, 0]
    standard_error = parts.std(axis=0) / np.sqrt(4000)
    exact = initial_expectations(terrain.task, terrain.expert)
    assert (abs(estimate - exact) < 4 * standard_error + 1e-3).all()


def test_discounted_to_go_by_hand():
    features = np.array([[1.0], [2.0], [4.0], [8.0], [16.0]])
    to_go = discounted_feature_sums(features, [0, 0, 0, 7, 7], 0.5)
    np.testing.assert_allclose(to_go[:, 0], [1 + 1 + 1, 2 + 2, 4, 8 + 8, 16])
    np.testing.assert_allclose(
        empirical_expectations(features, [0, 0, 0, 7, 7], 0.5), [(3 + 16) / 2]
    )


def test_one_trajectory_is_enough_and_none_is_not():
    assert empirical_expectations([[1.0, 2.0]], [0], 0.65).tolist() == [1, 2]
    with pytest.raises(ValueError, match="at least one trajectory, got none"):
        empirical_expectations(np.empty((0, 2)), [], 0.65)


def test_a_torn_trajectory_gets_a_sentence():
    with pytest.raises(ValueError, match="keep the steps of one trajectory together"):
        discounted_feature_sums(np.ones((3, 1)), [0, 1, 0], 0.65)


def test_walks_follow_the_transitions():
    """A ring in which action 1 goes on and action 0 stays, for sure."""
    stay, go = np.eye(4), np.roll(np.eye(4), 1, axis=1)
    task = RewardFreeMDP(
        np.stack([stay, go]), np.zeros((4, 2, 1)), 0.5, np.array([0, 0, 1.0, 0])
    )
    walks = task.rollout(np.array([1, 1, 1, 0]), 2, 4, seed=0)
    np.testing.assert_array_equal(walks.states, [[2, 3, 3, 3]] * 2)
    np.testing.assert_array_equal(walks.actions, [[1, 0, 0, 0]] * 2)
    np.testing.assert_array_equal(walks.trajectory, [0, 0, 0, 0, 1, 1, 1, 1])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"starts": np.array([0.5, 0.1])}, "starts must be probabilities"),
        ({"discount": 1.0}, "discount must be .*less than 1"),
        ({"features": np.zeros((3, 2, 1))}, "must have shape"),
    ],
)
def test_a_task_that_cannot_be_gets_a_sentence(change, message):
    good = {
        "transitions": np.stack([np.eye(2)] * 2),
        "features": np.zeros((2, 2, 1)),
        "discount": 0.9,
        "starts": np.array([0.5, 0.5]),
    }
    with pytest.raises(ValueError, match=message):
        RewardFreeMDP(**{**good, **change})
