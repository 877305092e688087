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
    dqn_targets,
    nfq_targets,
    q_targets,
    shift,
    train_on_pairs,
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


def test_the_step_that_the_page_computes_by_hand():
    """The numbers of "One step by hand" on the page about NNQL."""
    weights = np.array([[1.0, -1.0], [-1.0, 1.0]])
    network = Network((weights, weights), (np.zeros(2), np.zeros(2)))
    state, next_state = np.eye(2)
    hidden, q = network.activations(state)[1:]
    np.testing.assert_allclose(hidden, [0.731, 0.269], atol=5e-4)
    np.testing.assert_allclose(q, [0.614, 0.386], atol=5e-4)
    target = q_targets(q, 0, 0.6, network.forward(next_state).max(), 0.5, 0.6)
    np.testing.assert_allclose(shift(target), [0.791, 0.386], atol=5e-4)
    trained = train_on_pairs(network, [state], [target], 1.0, 1, 0)
    np.testing.assert_allclose(trained.weights[1][0], [1.130, -0.952], atol=5e-4)
    np.testing.assert_allclose(trained.biases[1], [0.177, 0], atol=5e-4)
    np.testing.assert_allclose(trained.weights[0][:, 0], [1.035, -1.035], atol=5e-4)
    np.testing.assert_allclose(trained.biases[0], [0.035, -0.035], atol=5e-4)
    np.testing.assert_allclose(trained.forward(state), [0.685, 0.380], atol=5e-4)
    last = q_targets(trained.forward(next_state), 1, 1.0, 0.0, 0.5, 0.6)
    np.testing.assert_allclose(last[1], 0.805, atol=5e-4)


def test_the_targets_that_the_quiz_asks_for():
    """DQN and double DQN on the page that compares the methods: 0.64 and 0.34."""

    def linear(values):  # a network whose logits are these values in every state
        return as_module(
            Network(
                (np.zeros((1, 1)), np.zeros((2, 1))), (np.zeros(1), np.array(values))
            )
        )

    learns, older = linear([0.5, 0.7]), linear([0.9, 0.4])
    buffer = ReplayBuffer()
    buffer.append(np.ones(1), 0, 0.1, np.ones(1), False)
    for targets, wanted in ((dqn_targets, 0.64), (double_dqn_targets, 0.34)):
        found = targets(learns, older, buffer.all(), 0.6).item()
        assert found == pytest.approx(wanted)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"q": 0.5}, "q must have one value for each action"),
        ({"q": np.empty((2, 0))}, "q must have one value for each action"),
        ({"q": [[0.1, np.nan], [0, 0]]}, "q must hold finite numbers only"),
        ({"action": [0, 2]}, "action must lie between 0 and 1, got 0 to 2"),
        ({"action": 0.5}, "action must hold whole numbers"),
        ({"reward": [1.0, 0.0, 0.0]}, r"reward must be one number, or have shape \(2,\)"),
        ({"next_value": "high"}, "next_value must be an array of numbers, got str"),
        ({"learning_rate": [0.5, 1.5]}, "learning_rate must lie between 0 and 1"),
        ({"discount": 2.0}, "discount must be at least 0 and at most 1"),
    ],
)  # fmt: skip
def test_a_wrong_update_is_one_sentence(changes, sentence):
    given = {
        "q": np.zeros((2, 2)),
        "action": [0, 1],
        "reward": 0.0,
        "next_value": 0.0,
        "learning_rate": 0.5,
        "discount": 0.6,
    }
    with pytest.raises((ValueError, TypeError), match=sentence):
        q_targets(**(given | changes))


@pytest.mark.parametrize("rescale", [clip, shift])
def test_values_to_rescale_are_numbers_of_actions(rescale):
    for q in (0.5, [], [np.inf, 0.0]):
        with pytest.raises(ValueError, match="q must h"):
            rescale(q)
