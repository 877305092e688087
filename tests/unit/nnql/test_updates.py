"""Targets, rescaling, cost."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from robonav.networks import Network, sigmoid
from robonav.networks.torch_module import as_module
from robonav.nnql import (
    ReplayBuffer,
    clip,
    cross_entropy,
    double_dqn_targets,
    nfq_targets,
    q_targets,
    shift,
)

q_values = arrays(float, (6, 5), elements=st.floats(-3, 3))


@given(q_values, st.floats(0, 1), st.floats(0, 1))
def test_only_the_taken_action_moves(q, learning_rate, discount):
    actions, rewards, following = (
        np.arange(6) % 5,
        np.linspace(-1, 1, 6),
        np.linspace(0, 1, 6),
    )
    updated = q_targets(
        q, actions, rewards, following, learning_rate=learning_rate, discount=discount
    )
    for k, a in enumerate(actions):
        wanted = q[k, a] + learning_rate * (
            rewards[k] + discount * following[k] - q[k, a]
        )
        assert np.isclose(updated[k, a], wanted)
        others = np.arange(5) != a
        np.testing.assert_array_equal(updated[k, others], q[k, others])


def test_the_old_values_are_left_alone():
    q = np.full((1, 5), 0.5)
    q_targets(
        q,
        np.array([2]),
        np.array([1.0]),
        np.array([1.0]),
        learning_rate=1.0,
        discount=0.7,
    )
    np.testing.assert_array_equal(q, 0.5)


@given(q_values)
def test_both_rescalings_end_in_the_unit_interval(q):
    for scaled in (clip(q), shift(q)):
        assert scaled.min() >= 0
        assert scaled.max() <= 1


@given(q_values)
def test_shifting_keeps_the_order_of_actions(q):
    rows = np.arange(6)
    best = shift(q)[rows, q.argmax(axis=1)]
    np.testing.assert_allclose(best, shift(q).max(axis=1))


def test_what_lies_in_the_unit_interval_stays():
    q = np.array([[0.0, 0.25, 0.5, 0.75, 1.0]])
    np.testing.assert_array_equal(clip(q), q)
    np.testing.assert_array_equal(shift(q), q)


def test_the_two_readings_differ():
    q = np.array([[1.4, 0.2, 0.4, 0.6, 0.0]])
    np.testing.assert_allclose(clip(q), [[1.0, 0.2, 0.4, 0.6, 0.0]])
    np.testing.assert_allclose(shift(q), q / 1.4)


def test_the_cost_is_equation_4_11_as_mended():
    z, y = np.array([0.3, -1.2, 2.0, 0.0, -0.5]), np.array([1.0, 0.0, 0.3, 0.5, 0.9])
    q = 1 / (1 + np.exp(-z))
    np.testing.assert_allclose(
        cross_entropy(y, z), -(y * np.log(q) + (1 - y) * np.log(1 - q)).sum()
    )


def test_the_cost_is_least_at_its_target_and_the_printed_one_is_not():
    q = np.linspace(0.01, 0.99, 99)
    mended = cross_entropy(0.3, np.log(q / (1 - q))[:, None])
    printed = -(0.3 * np.log(q) + 0.7 * (1 - np.log(q)))
    assert np.isclose(q[mended.argmin()], 0.3)
    assert (
        q[printed.argmin()] == q[0]
    )  # the smaller Q, the smaller the printed cost, whatever the target


def test_the_cost_is_finite_where_the_network_is_certain():
    np.testing.assert_allclose(
        cross_entropy([[1.0, 0.0]], [[800.0, -800.0]]), 0, atol=1e-12
    )
    np.testing.assert_allclose(cross_entropy([[0.0]], [[800.0]]), 800)


def test_targets_from_the_replay_buffer_have_double_precision():
    ones = Network((np.zeros((8, 4)), np.zeros((2, 8))), (np.zeros(8), np.ones(2)))
    buffer = ReplayBuffer()
    buffer.append(np.eye(4)[0], 1, 0.1, np.eye(4)[1], False)
    transitions, module = buffer.all(), as_module(ones)
    double = double_dqn_targets(module, module, transitions, 0.7).item()
    fitted = nfq_targets(ones, transitions, 0.7).item()
    assert double == pytest.approx(0.1 + 0.7, abs=1e-15)
    assert fitted == pytest.approx(0.1 + 0.7 * sigmoid(1.0), abs=1e-15)
