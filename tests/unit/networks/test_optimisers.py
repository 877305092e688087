"""Gradient descent against the thesis's step; L-BFGS against scipy and in convex problems."""

import numpy as np
import pytest
import torch
from scipy.optimize import minimize

from robonav.networks.costs import CROSS_ENTROPY, SQUARED_ERROR
from robonav.networks.multilayer_perceptron import Network, random_network
from robonav.networks.optimisers import fit, gradient_descent, lbfgs, one_hot
from robonav.networks.training_history import network_accuracy


def examples(m=200, inputs=11, actions=5, seed=0):
    """Inputs in [0, 1], labelled by a random rule that is not linear."""
    rng = np.random.default_rng(seed)
    x = rng.random((m, inputs))
    rule = random_network((inputs, 6, actions), seed=rng, spread=4)
    z = rule.logits(x)
    return x, one_hot(
        (z - np.median(z, axis=0)).argmax(axis=1), actions
    )  # every action is some example's


def flat(network: Network) -> np.ndarray:
    return np.concatenate(
        [array.ravel() for array in (*network.weights, *network.biases)]
    )


def scipy_optimum(start: Network, x, y, regularisation: float) -> float:
    """The least cost that scipy's BFGS finds from ``start``, gradients by torch: nothing of ours but the shapes."""
    shapes = [array.shape for array in (*start.weights, *start.biases)]
    lengths = [int(np.prod(shape)) for shape in shapes]
    layers = len(start.weights)
    inputs, labels = torch.tensor(x), torch.tensor(y)

    def cost(vector):
        parameters = torch.tensor(vector, requires_grad=True)
        parts = [
            part.view(shape)
            for part, shape in zip(parameters.split(lengths), shapes, strict=True)
        ]
        a = inputs
        for weight, bias in zip(parts[:layers], parts[layers:], strict=True):
            a = torch.sigmoid(torch.nn.functional.linear(a, weight, bias))
        value = torch.nn.functional.binary_cross_entropy(
            a, labels, reduction="sum"
        ) / len(x)
        value = value + regularisation / 2 / len(x) * sum(
            (weight**2).sum() for weight in parts[:layers]
        )
        value.backward()
        return value.item(), parameters.grad.numpy()

    return float(
        minimize(
            cost,
            flat(start),
            jac=True,
            method="BFGS",
            options={"maxiter": 5000, "gtol": 1e-9},
        ).fun
    )


def test_one_step_of_gradient_descent_is_the_thesis_step():
    x, y = examples(10, 3, 2)
    start = random_network((3, 4, 2), seed=0)
    rate, decay = 0.5, 0.1
    (w1, w2), (b1, b2) = start.weights, start.biases
    total = [np.zeros_like(w1), np.zeros_like(b1), np.zeros_like(w2), np.zeros_like(b2)]
    for x_i, y_i in zip(
        x, y, strict=True
    ):  # the loop of section 3.3.1, one example at a time
        a2 = 1 / (1 + np.exp(-(w1 @ x_i + b1)))
        a3 = 1 / (1 + np.exp(-(w2 @ a2 + b2)))
        d3 = -(y_i - a3) * a3 * (1 - a3)
        d2 = (w2.T @ d3) * a2 * (1 - a2)
        for sum_, part in zip(
            total, (np.outer(d2, x_i), d2, np.outer(d3, a2), d3), strict=True
        ):
            sum_ += part
    step = gradient_descent(
        start, x, y, gradient_step=rate, iterations=1, regularisation=decay
    ).network
    np.testing.assert_allclose(
        step.weights[0], w1 - rate * (total[0] / 10 + decay * w1)
    )
    np.testing.assert_allclose(
        step.weights[1], w2 - rate * (total[2] / 10 + decay * w2)
    )
    np.testing.assert_allclose(step.biases[0], b1 - rate * total[1] / 10)
    np.testing.assert_allclose(step.biases[1], b2 - rate * total[3] / 10)


@pytest.mark.parametrize("objective", [SQUARED_ERROR, CROSS_ENTROPY])
def test_small_steps_downhill_lower_the_cost_every_time(objective):
    x, y = examples(50, 4, 3)
    start = random_network((4, 5, 3), seed=0)
    history = gradient_descent(
        start, x, y, gradient_step=0.2, iterations=50, objective=objective
    )
    assert (np.diff(history.costs) < 0).all()


def test_identical_hidden_units_never_part():
    x, y = examples(50, 4, 3)
    start = random_network((4, 5, 3), seed=0, spread=0)
    trained = gradient_descent(start, x, y, gradient_step=1.0, iterations=30).network
    assert np.ptp(trained.weights[0], axis=0).max() < 1e-12
    assert abs(trained.weights[0]).max() > 0
    assert (
        np.ptp(lbfgs(start, x, y, iterations=20).network.weights[0], axis=0).max()
        < 1e-9
    )


@pytest.mark.parametrize("regularisation", [0.1, 1.0, 10.0])
def test_without_hidden_layers_lbfgs_reaches_the_one_optimum(regularisation):
    x, y = examples(100, 6, 3)
    trained = [
        fit(x, y, hidden=(), regularisation=regularisation, seed=seed)
        for seed in (0, 1)
    ]
    best = scipy_optimum(random_network((6, 3), seed=5), x, y, regularisation)
    for training in trained:
        assert training.costs[-1] == pytest.approx(best, abs=1e-9)
        slope = CROSS_ENTROPY.gradient(
            training.network, x, y, regularisation=regularisation
        )
        assert abs(flat(slope)).max() < 1e-6
        assert training.iterations < 300


@pytest.mark.slow
def test_with_a_hidden_layer_lbfgs_gets_as_low_as_scipy():
    """One iteration at a time, torch's line search would stall early if it were not given its evaluations."""
    x, y = examples(300)
    start = random_network((11, 8, 5), seed=0)
    ours = lbfgs(start, x, y, iterations=1000)
    assert ours.costs[-1] < scipy_optimum(start, x, y, 1.0) + 0.01
    assert (np.diff(ours.costs) <= 1e-12).all()


def test_history_tells_cost_and_accuracy_of_every_iteration():
    x, y = examples()
    seen = []
    training = fit(
        x,
        y,
        iterations=30,
        record=True,
        progress=lambda done, total: seen.append((done, total)),
    )
    assert training.iterations == 30
    assert seen == [(done, 30) for done in range(31)]
    assert training.networks is not None
    assert training.networks.stack == (31,)
    for row in (0, 7, 30):
        network = training.networks[row]
        assert training.costs[row] == pytest.approx(
            CROSS_ENTROPY.cost(network, x, y, regularisation=1.0)
        )
        assert training.accuracies[row] == network_accuracy(network, x, y)
    np.testing.assert_array_equal(flat(training.networks[-1]), flat(training.network))
    np.testing.assert_array_equal(
        flat(training.networks[0]), flat(random_network((11, 8, 5), seed=0))
    )
    assert fit(x, y, iterations=3).networks is None


def test_the_same_seed_trains_the_same_network():
    x, y = examples()
    first, again, other = (fit(x, y, iterations=40, seed=seed) for seed in (3, 3, 4))
    np.testing.assert_array_equal(flat(first.network), flat(again.network))
    assert not np.allclose(flat(first.network), flat(other.network))


def test_training_leaves_torch_as_it_was():
    threads, state = torch.get_num_threads(), torch.random.get_rng_state()
    fit(*examples(), iterations=2)
    assert torch.get_num_threads() == threads
    assert torch.equal(torch.random.get_rng_state(), state)


def test_learning_beats_the_commonest_answer():
    x, y = examples(600)
    training = fit(x[:400], y[:400], regularisation=0.1)
    assert (
        network_accuracy(training.network, x[400:], y[400:])
        > y[400:].mean(axis=0).max() + 0.1
    )


def test_accuracy_of_one_output_is_yes_above_one_half():
    yes_above_two = Network((np.array([[1.0]]),), (np.array([-2.0]),))
    assert (
        network_accuracy(
            yes_above_two, [[1.9], [2.1], [4.0], [0.0]], [[0.0], [1.0], [0.0], [1.0]]
        )
        == 0.5
    )


def test_two_hidden_layers_train():
    x, y = examples(60, 3, 2)
    training = fit(x, y, hidden=(4, 3), regularisation=0.01, iterations=100)
    assert training.network.sizes == (3, 4, 3, 2)
    assert training.costs[-1] < training.costs[0]


def test_no_iterations_give_the_network_back():
    x, y = examples(20, 3, 2)
    start = random_network((3, 2), seed=0)
    for training in (
        lbfgs(start, x, y, iterations=0),
        gradient_descent(start, x, y, gradient_step=1, iterations=0),
    ):
        np.testing.assert_array_equal(flat(training.network), flat(start))
        assert training.iterations == 0


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"x": np.ones(3)}, ValueError, r"x must have shape \(m, n\)"),
        ({"y": np.ones((3, 2))}, ValueError, r"y must have shape \(20, 2\)"),
        ({"y": np.full((20, 2), 2.0)}, ValueError, r"y must lie in \[0, 1\]"),
        ({"hidden": 0}, ValueError, "hidden must be at least 1"),
        ({"hidden": 2.5}, TypeError, "hidden must be a whole number"),
        ({"regularisation": -1}, ValueError, "regularisation must be at least 0"),
        ({"iterations": -1}, ValueError, "iterations must be at least 0"),
        ({"seed": "x"}, TypeError, "seed must be a whole number"),
    ],
)
def test_wrong_arguments_of_fit_get_a_sentence(change, error, message):
    x, y = examples(20, 3, 2)
    with pytest.raises(error, match=message):
        fit(**({"x": x, "y": y} | change))


def test_wrong_arguments_elsewhere_get_a_sentence():
    x, y = examples(20, 3, 2)
    with pytest.raises(ValueError, match="gradient_step must be greater than 0"):
        gradient_descent(
            random_network((3, 2), seed=0), x, y, gradient_step=0, iterations=1
        )
    with pytest.raises(ValueError, match=r"actions must lie in 0..4, got 0..5"):
        one_hot([0, 5], 5)
    np.testing.assert_array_equal(one_hot([3], 5), [[0, 0, 0, 1, 0]])


def test_lbfgs_is_a_function_before_and_after_its_first_call():
    """The module that holds the torch code must not take the function's name in the package."""
    import robonav.networks as networks

    x, y = examples(20, 3, 2)
    for _ in range(2):
        networks.lbfgs(random_network((3, 2), seed=0), x, y, iterations=1)
