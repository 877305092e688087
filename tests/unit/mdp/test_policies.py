"""Policies as arrays: both forms, ties, and what is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robonav.mdp import greedy_actions, greedy_mixture, policies


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
        best = greedy_actions(q, tolerance=tolerance)
        for row, flags in zip(q, best, strict=True):
            assert flags.tolist() == [max(row) - value <= tolerance for value in row]
    mixture = greedy_mixture(q)
    np.testing.assert_allclose(mixture.sum(axis=1), 1)
    np.testing.assert_allclose(
        (mixture * q).sum(axis=1), q.max(axis=1)
    )  # greedy in the sense below Eq. (2.13)


def test_what_is_no_rounding_breaks_a_tie():
    assert greedy_actions([[1.0, 1.0 - 1e-6]]).tolist() == [[True, False]]


def test_rounding_does_not_break_a_tie():
    assert greedy_actions([[0.1 + 0.2, 0.3]]).all()
    assert greedy_actions([[0.1 + 0.2, 0.3]], tolerance=0).tolist() == [[True, False]]
