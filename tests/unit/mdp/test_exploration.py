"""Epsilon-greedy choice and falling rates."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from robonav.mdp import (
    GridWorld,
    epsilon_greedy,
    exponential_decay,
    harmonic_decay,
    linear_decay,
    polynomial_decay,
    q_learning,
)
from robonav.mdp.exploration import constant, epsilon_greedy_action, schedule

VALUES = arrays(
    float,
    st.tuples(st.integers(1, 6), st.integers(1, 5)),
    elements=st.sampled_from([-1.0, 0.0, 2.5]),
)


def test_epsilon_greedy_by_hand():
    np.testing.assert_allclose(
        epsilon_greedy([[1, 3, 2, 0], [5, 5, 0, 0]], 0.2),
        [[0.05, 0.85, 0.05, 0.05], [0.45, 0.45, 0.05, 0.05]],
    )


@settings(deadline=None)
@given(VALUES, st.floats(0, 1))
def test_epsilon_greedy_is_a_policy_that_favours_the_best(q, epsilon):
    policy = epsilon_greedy(q, epsilon)
    np.testing.assert_allclose(policy.sum(axis=1), 1)
    assert (policy >= epsilon / q.shape[1] - 1e-12).all()
    assert ((policy * q).sum(axis=1) >= q.mean(axis=1) - 1e-9).all()


@pytest.mark.parametrize("values", [[0.0, 1.0, 0.5], [2.0, 2.0, 1.0], [0.0, 0.0, 0.0]])
@pytest.mark.parametrize("epsilon", [0.0, 0.3, 1.0])
def test_the_quick_draw_follows_the_policy(values, epsilon):
    rng = np.random.default_rng(1)
    actions = [epsilon_greedy_action(values, epsilon, rng) for _ in range(20_000)]
    drawn = np.bincount(actions, minlength=3) / 20_000
    np.testing.assert_allclose(drawn, epsilon_greedy(values, epsilon), atol=0.015)


def test_linear_decay_by_hand():
    falling = linear_decay(1.0, 0.0, 10)
    np.testing.assert_allclose(
        [falling(episode) for episode in range(12)],
        [1, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0, 0],
        atol=1e-12,
    )


def test_decays_by_hand():
    assert constant(0.3)(10**6) == 0.3
    assert exponential_decay(1.0, 0.2, 5)(5) == pytest.approx(0.6)
    assert exponential_decay(1.0, 0.2, 5)(10) == pytest.approx(0.4)
    assert [harmonic_decay()(n) for n in range(3)] == [1, 1 / 2, pytest.approx(1 / 3)]
    assert harmonic_decay(0.5, 10)(10) == pytest.approx(0.25)
    assert polynomial_decay(0.5)(3) == pytest.approx(0.5)


@pytest.mark.parametrize("rate", [-0.1, 5.0, float("nan"), np.float64(2)])
@pytest.mark.parametrize(
    "make",
    [
        lambda rate: constant(rate),
        lambda rate: linear_decay(rate, 0.1, 10),
        lambda rate: linear_decay(0.1, rate, 10),
        lambda rate: exponential_decay(rate, 0.1, 10),
        lambda rate: exponential_decay(0.1, rate, 10),
        lambda rate: harmonic_decay(rate),
    ],
)
def test_rates_outside_their_range_are_refused(make, rate):
    with pytest.raises(
        ValueError, match=r"(value|start|end) must be (at least 0|finite)"
    ):
        make(rate)


@pytest.mark.parametrize("rate", [-0.1, 5.0, float("nan"), 2])
def test_rates_of_ones_own_schedule_are_checked_as_they_come(rate):
    falling = schedule("learning_rate", lambda n: 0.5 if n < 3 else rate)
    assert falling(2) == 0.5
    with pytest.raises(
        ValueError, match=r"learning_rate\(3\) must be (at least 0|finite)"
    ):
        falling(3)
    with pytest.raises(
        TypeError, match=r"learning_rate\(0\) must be a number, got 'fast'"
    ):
        schedule("learning_rate", lambda n: "fast")(0)


@pytest.mark.parametrize("epsilon", [-0.1, 1.1, float("nan")])
def test_epsilon_outside_its_range_is_refused(epsilon):
    env = GridWorld("S . G").environment()
    with pytest.raises(ValueError, match="epsilon must be"):
        q_learning(env, 1, epsilon=epsilon)
    with pytest.raises(ValueError, match=r"epsilon\(0\) must be"):
        q_learning(env, 1, epsilon=lambda episode: epsilon)
