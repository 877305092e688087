"""The network by hand: forward propagation against a loop over neurons, stacks, what is refused."""

import math

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from robonav.networks import (
    CROSS_ENTROPY,
    Network,
    batch_gradient_descent,
    gradient_descent,
    gradient_descent_step,
    propagate,
    random_network,
    sigmoid,
    sigmoid_slope,
    squared_error_gradient,
    stacked,
    stochastic_gradient_descent,
)
from robonav.networks._fast.stacks import propagate_stack

SIZES = st.lists(st.integers(1, 5), min_size=2, max_size=4)


def neuron_by_neuron(network: Network, x: list[float]) -> list[float]:
    """Eq. (3.1) written out: one sum and one sigmoid a neuron."""
    for weight, bias in zip(network.weights, network.biases, strict=True):
        x = [
            1
            / (
                1
                + math.exp(
                    -(sum(w * value for w, value in zip(row, x, strict=True)) + b)
                )
            )
            for row, b in zip(weight, bias, strict=True)
        ]
    return x


@given(SIZES, st.integers(0, 1000))
def test_forward_is_the_sum_over_neurons(sizes, seed):
    network = random_network(sizes, seed=seed, spread=2)
    x = np.random.default_rng(seed).normal(size=(3, sizes[0]))
    expected = [neuron_by_neuron(network, list(row)) for row in x]
    np.testing.assert_allclose(network.forward(x), expected, rtol=1e-12)
    np.testing.assert_allclose(network.forward(x[0]), expected[0], rtol=1e-12)


def test_sigmoid_has_its_values_slope_and_no_overflow():
    z = np.array([-1000.0, -1.0, 0.0, 1.0, 1000.0])
    np.testing.assert_allclose(
        sigmoid(z), [0, 1 / (1 + math.e), 0.5, math.e / (1 + math.e), 1]
    )
    a, step = sigmoid(z), 1e-6
    np.testing.assert_allclose(
        sigmoid_slope(a),
        (sigmoid(z + step) - sigmoid(z - step)) / (2 * step),
        atol=1e-9,
    )


def test_activations_start_with_the_input_and_end_with_the_output():
    network = random_network((11, 8, 5), seed=1)
    x = np.random.default_rng(0).normal(size=(4, 11))
    layers = network.activations(x)
    assert [layer.shape for layer in layers] == [(4, 11), (4, 8), (4, 5)]
    np.testing.assert_array_equal(layers[0], x)
    np.testing.assert_array_equal(layers[-1], network.forward(x))
    np.testing.assert_allclose(sigmoid(network.logits(x)), layers[-1])


@given(SIZES, st.integers(1, 4), st.booleans())
def test_a_stack_answers_like_its_networks_one_by_one(sizes, count, own_inputs):
    networks = [random_network(sizes, seed=seed) for seed in range(count)]
    stack = stacked(networks)
    x = np.random.default_rng(0).normal(
        size=(count, 3, sizes[0]) if own_inputs else (3, sizes[0])
    )
    rows = x if own_inputs else [x] * count
    assert stack.stack == (count,)
    assert stack.sizes == tuple(sizes)
    np.testing.assert_allclose(
        stack.forward(x),
        [n.forward(row) for n, row in zip(networks, rows, strict=True)],
    )
    np.testing.assert_array_equal(stack[count - 1].weights[0], networks[-1].weights[0])
    np.testing.assert_allclose(
        stack.forward(np.ones(sizes[0])),
        [n.forward(np.ones(sizes[0])) for n in networks],
    )


def test_one_network_takes_inputs_of_any_leading_dimensions():
    network = random_network((3, 4, 2), seed=0)
    x = np.random.default_rng(0).normal(size=(2, 5, 3))
    np.testing.assert_allclose(network.forward(x)[1, 4], network.forward(x[1, 4]))
    assert network.decide(x).shape == (2, 5)


def test_torch_takes_the_same_forward_pass():
    network = random_network((3, 4, 2), seed=0)
    x = np.random.default_rng(0).normal(size=(5, 3))
    weights, biases = (
        [torch.tensor(array) for array in arrays]
        for arrays in (network.weights, network.biases)
    )
    _, z = propagate(weights, biases, torch.tensor(x), torch.sigmoid)
    np.testing.assert_allclose(z.numpy(), network.logits(x), rtol=1e-12)


@given(SIZES, st.integers(1, 40), st.integers(0, 1000))
def test_a_stack_of_one_propagates_as_its_network_does_to_the_bit(sizes, m, seed):
    network = random_network(sizes, seed=seed)
    x = np.random.default_rng(seed).normal(size=(m, sizes[0]))
    single, z = propagate(network.weights, network.biases, x)
    stack = stacked([network])
    activations, logits = propagate_stack(stack.weights, stack.biases, x)
    np.testing.assert_array_equal(logits[0], z)
    for one, other in zip(activations[1:], single[1:], strict=True):
        np.testing.assert_array_equal(one[0], other)


def test_decisions_survive_outputs_that_round_to_one():
    network = Network((np.array([[1.0], [2.0]]),), (np.zeros(2),))
    np.testing.assert_array_equal(network.forward([100.0]), [1, 1])
    assert network.decide([100.0]) == 1


def test_a_network_is_frozen_and_its_own():
    weight = np.ones((1, 2))
    network = Network((weight,), (np.zeros(1),))
    weight[0, 0] = 7
    assert network.weights[0][0, 0] == 1
    with pytest.raises(ValueError, match="read-only"):
        network.weights[0][0, 0] = 3


def test_random_weights_are_the_seeds_own_and_within_the_spread():
    first, again, other = (random_network((11, 8, 5), seed=seed) for seed in (3, 3, 4))
    for a, b, c in zip(
        first.weights + first.biases,
        again.weights + again.biases,
        other.weights,
        strict=False,
    ):
        np.testing.assert_array_equal(a, b)
        assert not np.array_equal(a, c)
    assert max(abs(first.weights[0]).max(), abs(first.biases[0]).max()) <= math.sqrt(
        6 / 19
    )
    assert abs(random_network((11, 8, 5), seed=3, spread=0.01).weights[1]).max() <= 0.01
    assert first.sizes == (11, 8, 5)


@pytest.mark.parametrize(
    ("weights", "biases", "message"),
    [
        ([], [], "one array for each layer"),
        ([np.ones((2, 3))], [], "one array for each layer"),
        ([np.ones(3)], [np.ones(1)], r"weights\[0\] must have shape"),
        ([np.ones((0, 3))], [np.ones(0)], r"weights\[0\] must have shape"),
        (
            [np.ones((2, 3)), np.ones((1, 3))],
            [np.ones(2), np.ones(1)],
            r"weights\[1\] must take the 2 units",
        ),
        (
            [np.ones((4, 2, 3)), np.ones((1, 2))],
            [np.ones((4, 2)), np.ones(1)],
            r"share its stack \(4,\)",
        ),
        ([np.ones((2, 3))], [np.ones(3)], r"biases\[0\] must have shape \(2,\)"),
        (
            [np.ones((4, 2, 3))],
            [np.ones((4, 2))],
            "NetworkStack holds several networks",
        ),
        (
            [np.array([[np.nan]])],
            [np.ones(1)],
            r"weights\[0\] must hold finite numbers",
        ),
    ],
)
def test_arrays_that_make_no_network_are_refused(weights, biases, message):
    with pytest.raises(ValueError, match=message):
        Network(tuple(weights), tuple(biases))


def test_wrong_arguments_get_a_sentence():
    network = random_network((3, 2), seed=0)
    with pytest.raises(ValueError, match="x must hold 3 inputs along its last axis"):
        network.forward(np.ones((3, 2)))
    with pytest.raises(ValueError, match="at least an input and an output layer"):
        random_network((3,), seed=0)
    with pytest.raises(ValueError, match="spread must be at least 0"):
        random_network((3, 2), seed=0, spread=-1)
    with pytest.raises(ValueError, match="all of the same sizes"):
        stacked([network, random_network((3, 3), seed=0)])


def same(one: Network, other: Network) -> None:
    for a, b in zip(
        (*one.weights, *one.biases), (*other.weights, *other.biases), strict=True
    ):
        np.testing.assert_array_equal(a, b)


@pytest.fixture
def examples():
    rng = np.random.default_rng(0)
    return rng.normal(size=(7, 3)), rng.random((7, 2))


def test_the_loop_takes_the_steps_of_the_recorded_training_to_the_bit(examples):
    start = random_network((3, 4, 2), seed=1)
    passed = [
        batch_gradient_descent(
            start, *examples, gradient_step=0.5, iterations=count, regularisation=0.1,
            cost_gradient=CROSS_ENTROPY.gradient,
        )
        for count in range(7)
    ]  # fmt: skip
    recorded = gradient_descent(
        start, *examples, gradient_step=0.5, iterations=6, regularisation=0.1,
        objective=CROSS_ENTROPY, record=True,
    )  # fmt: skip
    same(passed[-1], recorded.network)
    same(stacked(passed), recorded.networks)


def test_stochastic_descent_goes_once_through_the_examples_in_an_epoch(examples):
    x, y = examples
    start = expected = random_network((3, 4, 2), seed=1)
    trained = stochastic_gradient_descent(
        start, x, y, gradient_step=0.5, epochs=2, batch_size=3, seed=8
    )
    rng = np.random.default_rng(8)
    for _ in range(2):
        order = rng.permutation(7)
        for batch in (order[:3], order[3:6], order[6:]):
            gradient = squared_error_gradient(expected, x[batch], y[batch])
            expected = gradient_descent_step(expected, gradient, 0.5)
    same(trained, expected)


def test_the_loops_refuse_examples_that_do_not_fit(examples):
    x, y = examples
    for loop, options in (
        (batch_gradient_descent, {"iterations": 1}),
        (stochastic_gradient_descent, {"epochs": 1, "batch_size": 2, "seed": 0}),
    ):
        with pytest.raises(ValueError, match="x must"):
            loop(random_network((2, 2), seed=0), x, y, gradient_step=1, **options)
