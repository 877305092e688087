"""Both costs and their gradients: against sums over neurons, finite differences and torch's autograd."""

import math

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st

from robonav.networks import (
    CROSS_ENTROPY,
    SQUARED_ERROR,
    Network,
    backpropagate,
    propagate,
    random_network,
)

OBJECTIVES = pytest.mark.parametrize(
    "objective", [SQUARED_ERROR, CROSS_ENTROPY], ids=["squared", "entropy"]
)
SHAPES = st.lists(st.integers(1, 4), min_size=2, max_size=4)


def problem(sizes, m, seed):
    rng = np.random.default_rng(seed)
    return (
        random_network(sizes, seed=rng, spread=1.5),
        rng.normal(size=(m, sizes[0])),
        rng.random((m, sizes[-1])),
    )


def with_entry(
    network: Network, layer: int, index: tuple, value: float, *, bias: bool
) -> Network:
    arrays = [array.copy() for array in (network.biases if bias else network.weights)]
    arrays[layer][index] = value
    return (
        Network(network.weights, tuple(arrays))
        if bias
        else Network(tuple(arrays), network.biases)
    )


def test_costs_are_the_sums_of_the_thesis():
    network, x, y = problem((3, 2, 2), 4, 0)
    p = network.forward(x)
    squares = sum(float(w) ** 2 for weight in network.weights for w in weight.flat)
    squared = sum((p[i, k] - y[i, k]) ** 2 / 2 for i in range(4) for k in range(2))
    entropy = -sum(
        y[i, k] * math.log(p[i, k]) + (1 - y[i, k]) * math.log(1 - p[i, k])
        for i in range(4)
        for k in range(2)
    )
    assert SQUARED_ERROR.cost(network, x, y, regularisation=0.3) == pytest.approx(
        squared / 4 + 0.3 / 2 * squares
    )
    assert CROSS_ENTROPY.cost(network, x, y, regularisation=0.3) == pytest.approx(
        entropy / 4 + 0.3 / 8 * squares
    )


def test_cross_entropy_is_finite_where_a_sigmoid_rounds_to_one():
    network = Network((np.array([[1.0]]),), (np.zeros(1),))
    assert CROSS_ENTROPY.cost(network, [[800.0]], [[0.0]]) == pytest.approx(800)


@OBJECTIVES
@settings(deadline=None)
@given(SHAPES, st.integers(1, 5), st.sampled_from([0.0, 0.7]), st.integers(0, 10_000))
def test_gradient_is_the_slope_of_the_cost(objective, sizes, m, regularisation, seed):
    network, x, y = problem(sizes, m, seed)
    slope = objective.gradient(network, x, y, regularisation=regularisation)
    step = 1e-5
    for bias in (False, True):
        arrays, slopes = (
            (network.biases, slope.biases) if bias else (network.weights, slope.weights)
        )
        for layer, array in enumerate(arrays):
            for index, value in np.ndenumerate(array):
                above, below = (
                    objective.cost(
                        with_entry(
                            network, layer, index, value + sign * step, bias=bias
                        ),
                        x,
                        y,
                        regularisation=regularisation,
                    )
                    for sign in (1, -1)
                )
                assert slopes[layer][index] == pytest.approx(
                    (above - below) / (2 * step), rel=1e-5, abs=1e-8
                )


@OBJECTIVES
@settings(deadline=None)
@given(SHAPES, st.integers(1, 8), st.sampled_from([0.0, 0.7]), st.integers(0, 10_000))
def test_gradient_is_what_autograd_finds(objective, sizes, m, regularisation, seed):
    network, x, y = problem(sizes, m, seed)
    weights = [torch.tensor(weight, requires_grad=True) for weight in network.weights]
    biases = [torch.tensor(bias, requires_grad=True) for bias in network.biases]
    _, z = propagate(weights, biases, torch.tensor(x), torch.sigmoid)
    p, labels = torch.sigmoid(z), torch.tensor(y)
    squares = sum(weight.square().sum() for weight in weights)
    if objective is SQUARED_ERROR:
        cost = ((p - labels) ** 2).sum() / 2 / m + regularisation / 2 * squares
    else:
        cost = (
            -(labels * p.log() + (1 - labels) * (1 - p).log()).sum()
            + regularisation / 2 * squares
        ) / m
    cost.backward()
    assert objective.cost(
        network, x, y, regularisation=regularisation
    ) == pytest.approx(cost.item(), rel=1e-10)
    slope = objective.gradient(network, x, y, regularisation=regularisation)
    for ours, theirs in zip(
        (*slope.weights, *slope.biases), (*weights, *biases), strict=True
    ):
        np.testing.assert_allclose(ours, theirs.grad.numpy(), rtol=1e-8, atol=1e-12)


@OBJECTIVES
def test_weight_decay_leaves_the_biases_alone(objective):
    network, x, y = problem((3, 4, 2), 6, 1)
    free, decayed = (
        objective.gradient(network, x, y, regularisation=strength)
        for strength in (0, 2.0)
    )
    for a, b in zip(free.biases, decayed.biases, strict=True):
        np.testing.assert_array_equal(a, b)
    share = (
        2.0 if objective is SQUARED_ERROR else 2.0 / 6
    )  # Eq. (3.9) has lambda, Eq. (3.22) lambda / m
    for a, b, weight in zip(
        free.weights, decayed.weights, network.weights, strict=True
    ):
        np.testing.assert_allclose(b - a, share * weight, rtol=1e-9)


def test_backpropagation_adds_up_single_examples():
    network, x, y = problem((3, 4, 2), 5, 2)
    a = network.activations(x)
    whole = backpropagate(network.weights, a, a[-1] - y)
    parts = [
        backpropagate(
            network.weights, [layer[i : i + 1] for layer in a], (a[-1] - y)[i : i + 1]
        )
        for i in range(5)
    ]
    np.testing.assert_allclose(whole.weights[0], sum(part.weights[0] for part in parts))
    np.testing.assert_allclose(whole.biases[0], sum(part.biases[0] for part in parts))


def test_equal_hidden_units_stay_equal():
    rng = np.random.default_rng(0)
    x, y = rng.normal(size=(20, 3)), rng.random((20, 2))
    same = random_network((3, 4, 2), seed=0, spread=0)
    slope = SQUARED_ERROR.gradient(same, x, y)
    assert np.ptp(slope.weights[0], axis=0).max() == 0
    assert np.ptp(slope.weights[1], axis=1).max() == 0


@pytest.mark.parametrize(
    ("x", "y", "message"),
    [
        (np.ones((2, 4)), np.ones((2, 2)), r"x must have shape \(m, 3\)"),
        (np.ones((2, 3)), np.ones((3, 2)), r"y must have shape \(2, 2\)"),
        (np.ones((0, 3)), np.ones((0, 2)), "at least one example"),
        (
            np.ones((2, 3)),
            np.full((2, 2), 1.5),
            r"y must lie in \[0, 1\], got values from 1.5 to 1.5",
        ),
    ],
)
def test_examples_that_do_not_fit_are_refused(x, y, message):
    with pytest.raises(ValueError, match=message):
        CROSS_ENTROPY.cost(random_network((3, 2), seed=0), x, y)
