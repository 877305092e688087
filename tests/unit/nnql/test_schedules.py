"""The softmax policy in its limits, and schedules."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from robonav.networks.policy import sample_actions
from robonav.nnql import geometric_schedule, greedy_policy, softmax_policy
from robonav.nnql._arguments import check_schedule

values = arrays(float, (4, 5), elements=st.floats(-1e6, 1e6))


@given(values, st.floats(1e-300, 1e300))
def test_probabilities_sum_to_one_at_any_temperature(q, temperature):
    p = softmax_policy(q, temperature)
    np.testing.assert_allclose(p.sum(axis=1), 1)
    assert (p >= 0).all()
    np.testing.assert_array_equal(
        p.max(axis=1), p[np.arange(4), q.argmax(axis=1)]
    )  # the best is the likeliest


def test_it_is_equation_4_7():
    q, t = np.array([0.1, 0.5, 0.9, 0.2, 0.3]), 0.4
    np.testing.assert_allclose(
        softmax_policy(q, t), np.exp(q / t) / np.exp(q / t).sum()
    )


def test_cold_is_greedy_and_hot_is_uniform():
    q = np.array([0.1, 0.9, 0.3, 0.9 - 1e-6, 0.0])
    np.testing.assert_array_equal(greedy_policy(q), [0, 1, 0, 0, 0])  # Eq. (4.8)
    np.testing.assert_allclose(softmax_policy(q, 1e-12), [0, 1, 0, 0, 0], atol=1e-12)
    np.testing.assert_allclose(softmax_policy(q, 1e12), 0.2)


def test_equally_good_actions_share():
    np.testing.assert_allclose(
        greedy_policy([1.0, 1.0, 0.0, 1.0, -1.0]), [1 / 3, 1 / 3, 0, 1 / 3, 0]
    )
    np.testing.assert_allclose(
        softmax_policy([1.0, 1.0, 0.0, 1.0, -1.0], 1e-9), [1 / 3, 1 / 3, 0, 1 / 3, 0]
    )


def test_large_values_do_not_overflow():
    np.testing.assert_allclose(
        softmax_policy([1e300, 1e300, -1e300], 1e-300), [0.5, 0.5, 0]
    )


def test_a_temperature_a_row():
    q = np.array([[0.0, 1.0], [0.0, 1.0]])
    np.testing.assert_allclose(
        softmax_policy(q, np.array([1e-12, 1e12])), [[0, 1], [0.5, 0.5]]
    )


@pytest.mark.parametrize("temperature", [-1.0, 0.0, [1.0, 0.0]])
def test_a_temperature_is_positive(temperature):
    with pytest.raises(ValueError, match="temperature must be greater than 0, got"):
        softmax_policy([0.0, 1.0], temperature)


def test_choices_follow_the_probabilities():
    p = np.array([0.1, 0.0, 0.6, 0.05, 0.25])
    drawn = sample_actions(
        np.tile(p, (100_000, 1)), np.random.default_rng(0).random(100_000)
    )
    np.testing.assert_allclose(np.bincount(drawn, minlength=5) / 100_000, p, atol=0.006)


def test_the_ends_of_the_unit_interval_choose_possible_actions():
    p = np.array([[0.0, 0.5, 0.5, 0.0]] * 2)
    np.testing.assert_array_equal(
        sample_actions(p, np.array([0.0, np.nextafter(1, 0)])), [1, 2]
    )


def test_falling_goes_from_start_to_end_by_equal_factors():
    steps = geometric_schedule((0.8, 0.05), np.linspace(0, 1, 5))
    np.testing.assert_allclose(steps[[0, -1]], [0.8, 0.05])
    np.testing.assert_allclose(steps[1:] / steps[:-1], (0.05 / 0.8) ** 0.25)
    np.testing.assert_array_equal(geometric_schedule(0.3, np.linspace(0, 1, 5)), 0.3)


@pytest.mark.parametrize("span", [0, -1.0, (0.9, 0), (0.9,), (1, 2, 3), "hot", None])
def test_a_span_is_positive(span):
    with pytest.raises((ValueError, TypeError), match="temperature must"):
        check_schedule("temperature", span)


def test_a_wrong_schedule_is_one_sentence():
    with pytest.raises(ValueError, match="schedule must be a number, or its start and"):
        geometric_schedule((0.9, 0.5, 0.1), 0.5)
    with pytest.raises(ValueError, match="schedule must be greater than 0, got 0"):
        geometric_schedule((0.9, 0), 0.5)
    with pytest.raises(ValueError, match="fraction must lie between 0 and 1, got 2 to"):
        geometric_schedule((0.9, 0.1), 2)
