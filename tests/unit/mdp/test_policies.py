"""Policies as arrays: both forms, ties, and what is refused."""

import copy
import pickle

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from robonav.mdp import (
    POMDP,
    FiniteMDP,
    exponential_decay,
    four_by_three,
    greedy_action_mask,
    greedy_mixture,
    harmonic_decay,
    linear_decay,
    policies,
    policy_evaluation,
    polynomial_decay,
)
from robonav.mdp.policies import distributions


def test_both_forms_say_the_same():
    np.testing.assert_array_equal(
        policies.probabilities([2, 0], 2, 3), [[0, 0, 1], [1, 0, 0]]
    )
    np.testing.assert_array_equal(
        policies.probabilities([[0.5, 0.5], [1, 0]], 2, 2), [[0.5, 0.5], [1, 0]]
    )
    np.testing.assert_array_equal(policies.uniform(2, 4), np.full((2, 4), 0.25))


@pytest.mark.parametrize(
    ("policy", "error", "sentence"),
    [
        ([0.0, 1.0], TypeError, "policy must hold whole numbers"),
        ([0, 3], ValueError, "policy must hold actions from 0 to 2, got 0 to 3"),
        ([0, -1], ValueError, "policy must hold actions from 0 to 2"),
        ([0, 1, 2], ValueError, r"policy must have shape \(2.*got \(3,\)"),
        (np.full((2, 3), 0.3), ValueError, "one distribution a state"),
        ([[2, -1, 0], [1, 0, 0]], ValueError, "one distribution a state"),
        (np.full((3, 3), 1 / 3), ValueError, r"policy must have shape \(2, 3\)"),
        (
            [[1, 0, 0], [1, 0]],
            TypeError,
            "policy must be an array of numbers, got list",
        ),
        (["up", "down"], TypeError, "policy must be an array of numbers, got list"),
        (1, ValueError, "policy must have shape"),
    ],
)
def test_what_is_no_policy_is_refused(policy, error, sentence):
    with pytest.raises(error, match=sentence):
        policies.as_policy(policy, 2, 3)


@settings(deadline=None)
@given(st.integers(0, 1000))
def test_greedy_actions_are_those_within_the_tolerance(seed):
    q = np.random.default_rng(seed).normal(size=(5, 4)).round(1)
    for tolerance in (0, 0.25):
        best = greedy_action_mask(q, tolerance=tolerance)
        for row, flags in zip(q, best, strict=True):
            assert flags.tolist() == [max(row) - value <= tolerance for value in row]
    mixture = greedy_mixture(q)
    np.testing.assert_allclose(mixture.sum(axis=1), 1)
    np.testing.assert_allclose(
        (mixture * q).sum(axis=1), q.max(axis=1)
    )  # greedy in the sense below Eq. (2.13)


def test_what_is_no_rounding_breaks_a_tie():
    assert greedy_action_mask([[1.0, 1.0 - 1e-6]]).tolist() == [[True, False]]


def test_rounding_does_not_break_a_tie():
    assert greedy_action_mask([[0.1 + 0.2, 0.3]]).all()
    assert greedy_action_mask([[0.1 + 0.2, 0.3]], tolerance=0).tolist() == [
        [True, False]
    ]


def softmax_in(dtype, rows, rng):
    weights = np.exp(rng.normal(size=rows)).astype(dtype)
    return weights / weights.sum(axis=-1, keepdims=True, dtype=dtype)


@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64])
def test_distributions_of_any_float_are_taken(dtype):
    rng = np.random.default_rng(0)
    model = FiniteMDP(softmax_in(dtype, (3, 6, 6), rng), np.zeros((6, 3)), 0.9)
    observations = softmax_in(dtype, (3, 6, 4), rng)
    pomdp = POMDP(model, observations)
    for _ in range(100):
        policy = softmax_in(dtype, (6, 3), rng)
        np.testing.assert_array_equal(policy_evaluation(model, policy), np.zeros(6))
        belief = pomdp.update(softmax_in(dtype, (6,), rng), 0, 0)
        assert belief.sum() == pytest.approx(1)
    if dtype != np.float16:  # scipy has no sparse matrices of half precision
        dense = softmax_in(dtype, (3, 6, 6), rng)
        FiniteMDP([sp.csr_array(matrix) for matrix in dense], np.zeros((6, 3)), 0.9)
    assert np.abs(np.sum(model.transitions, axis=-1) - 1).max() < 1e-12


def test_rounding_of_a_narrow_type_is_no_excuse_for_more():
    rows = np.array([[0.5, 0.4999]], dtype=np.float32)
    assert distributions("policy", rows)[1].all()
    assert distributions("policy", rows.astype(float))[1].all()
    almost = np.array([[0.5, 0.5 + 1e-7]])
    assert distributions("policy", almost)[1].all()
    assert not distributions("policy", almost.astype(np.float32))[1].any()
    with pytest.raises(ValueError, match=r"with sum 0.9999000132 for state 0"):
        policy_evaluation(FiniteMDP([[[1.0]], [[1.0]]], [[0.0, 0.0]], 0.9), rows)


def test_masks_and_forbidden_actions_are_refused_with_advice():
    transitions = np.full((2, 3, 3), 1 / 3)
    rewards = np.arange(6.0).reshape(3, 2)
    with pytest.raises(TypeError, match="rewards must be an array without a mask"):
        FiniteMDP(transitions, np.ma.masked_less(rewards, 2), 0.9)
    with pytest.raises(ValueError, match="Give a forbidden action the transitions"):
        FiniteMDP(transitions, np.where(rewards < 2, -np.inf, rewards), 0.9)


@pytest.mark.parametrize(
    "copied", [copy.deepcopy, lambda x: pickle.loads(pickle.dumps(x))]
)
def test_copies(copied):
    grid = four_by_three()
    grid.mdp(0.9)  # fills what is computed once
    twin = copied(grid)
    assert (twin.text, twin.legend, twin.slip) == (grid.text, grid.legend, grid.slip)
    np.testing.assert_array_equal(twin.start, grid.start)
    env = copied(grid.environment())
    assert env.reset(seed=1)[0] == grid.environment().reset(seed=1)[0]
    assert env.step(np.array(1))[0] in range(grid.n_states)
    model = copied(FiniteMDP(np.full((1, 2, 2), 0.5), np.zeros((2, 1)), 0.9))
    assert not model.rewards.flags.writeable
    assert not model.transitions.flags.writeable
    for rate in (
        linear_decay(1.0, 0.0, over=4),
        exponential_decay(1.0, 0.0, half_life=2),
        harmonic_decay(),
        polynomial_decay(0.7),
    ):
        assert [copied(rate)(n) for n in range(5)] == [rate(n) for n in range(5)]
