"""Stacked networks against chapter 3's network, its backpropagation, and a plain loop."""

import numpy as np
import pytest

from robonav.networks.multilayer_perceptron import (
    Network,
    cross_entropy_gradient,
    random_network,
)
from robonav.networks.network_stack import stacked
from robonav.nnql import cross_entropy
from robonav.nnql._fast.networks import (
    BatchedNetworks,
    parameters_to_vectors,
    vectors_to_parameters,
)

SIZES = (24, 8, 5)


def stack(n=4, seed=0):
    return stacked([random_network(SIZES, seed=seed + k) for k in range(n)])


def pairs(networks, length=12, seed=1):
    """Examples with as many zeros as sensing has, and targets in [0, 1]."""
    rng = np.random.default_rng(seed)
    x = rng.random((networks, length, SIZES[0])) * (
        rng.random((networks, length, SIZES[0])) < 0.4
    )
    return x, rng.random((networks, length, SIZES[-1]))


def plain_descent(network: Network, x, y, gradient_step, passes, tolerance):
    """Eq. (4.12), example by example, with chapter 3's gradient; stops when the mean cost settles."""
    before, done = np.inf, 0
    for _ in range(passes):
        cost = 0.0
        for one, label in zip(x, y, strict=True):
            cost += cross_entropy(label, network.logits(one)) / len(x)
            slope = cross_entropy_gradient(network, one[None], label[None])
            network = Network(
                tuple(
                    w - gradient_step * d
                    for w, d in zip(network.weights, slope.weights, strict=True)
                ),
                tuple(
                    b - gradient_step * d
                    for b, d in zip(network.biases, slope.biases, strict=True)
                ),
            )
        done += 1
        if abs(before - cost) < tolerance:
            break
        before = cost
    return network, done


def test_logits_are_those_of_chapter_3():
    network, (x, _) = stack(), pairs(3)
    rows = np.array([3, 0, 2])
    z = BatchedNetworks(network).logits(rows, x)
    for k, row in enumerate(rows):
        np.testing.assert_allclose(z[k], network[int(row)].logits(x[k]), rtol=1e-12)


@pytest.mark.parametrize(("passes", "tolerance"), [(1, 0.0), (3, 0.0), (50, 0.02)])
def test_descent_is_a_plain_loop_over_the_pairs(passes, tolerance):
    network, (x, y) = stack(), pairs(4)
    networks, rows = BatchedNetworks(network), np.array([0, 2, 3])
    first, last, gradient_step = (
        np.array([0, 5, 3]),
        np.array([12, 12, 4]),
        np.array([0.3, 0.1, 0.5]),
    )
    networks.sgd(
        rows,
        x,
        y,
        first,
        last,
        gradient_step=gradient_step,
        passes=passes,
        tolerance=tolerance,
    )
    expected, took = [network[0], network[1], network[2], network[3]], []
    for k, row in enumerate(rows):
        own = slice(first[k], last[k])
        expected[row], done = plain_descent(
            network[int(row)],
            x[row, own],
            y[row, own],
            gradient_step[k],
            passes,
            tolerance,
        )
        took.append(done)
    np.testing.assert_allclose(
        networks.parameters(),
        parameters_to_vectors(stacked(expected)),
        rtol=1e-9,
        atol=1e-12,
    )
    if tolerance:
        assert len(set(took)) > 1  # they settled, each in its own time
        assert max(took) < passes


def test_no_network_hears_of_another():
    network, (x, y) = stack(), pairs(4)
    together, rows, zero = BatchedNetworks(network), np.arange(4), np.zeros(4, int)
    arguments = {"gradient_step": np.full(4, 0.3), "passes": 3, "tolerance": 1e-4}
    together.sgd(rows, x, y, zero, zero + 12, **arguments)
    for row in range(4):
        alone = BatchedNetworks(stacked([network[row]]))
        arguments["gradient_step"] = np.array([0.3])
        alone.sgd(
            np.array([0]),
            x[row : row + 1],
            y[row : row + 1],
            zero[:1],
            zero[:1] + 12,
            **arguments,
        )
        np.testing.assert_array_equal(together.parameters()[row], alone.parameters()[0])


@pytest.mark.parametrize("linear", [False, True])
def test_gradients_are_those_that_torch_derives(linear):
    import torch

    network, (x, _) = stack(), pairs(3)
    rng = np.random.default_rng(4)
    actions, targets = (
        rng.integers(5, size=(3, 12)),
        4 * rng.random((3, 12)) - 2 if linear else rng.random((3, 12)),
    )
    rows = np.array([1, 3, 0])
    gradients, costs = BatchedNetworks(network).gradients(
        rows, x, actions, targets, linear=linear
    )
    for k, row in enumerate(rows):
        leaves = [
            torch.tensor(a, requires_grad=True)
            for a in (*network[int(row)].weights, *network[int(row)].biases)
        ]
        w1, w2, b1, b2 = leaves
        z = torch.sigmoid(torch.tensor(x[k]) @ w1.T + b1) @ w2.T + b2
        taken = z.gather(1, torch.tensor(actions[k])[:, None])[:, 0]
        loss = (
            torch.nn.functional.huber_loss
            if linear
            else torch.nn.functional.binary_cross_entropy_with_logits
        )
        cost = loss(taken, torch.tensor(targets[k]))
        d1, d2, c1, c2 = torch.autograd.grad(cost, leaves)
        wanted = torch.cat([part.flatten() for part in (d1.T, c1, d2.T, c2)])
        np.testing.assert_allclose(gradients[k], wanted, rtol=1e-9, atol=1e-14)
        np.testing.assert_allclose(costs[k], cost.item(), rtol=1e-12)


def test_parameters_are_copied_in_and_out():
    network = stack()
    networks, rows = BatchedNetworks(network), np.array([2, 0])
    networks.parameters()[:] = 0
    np.testing.assert_array_equal(networks.parameters(), parameters_to_vectors(network))
    networks.apply_update(rows, parameters_to_vectors(network)[rows])
    np.testing.assert_array_equal(networks.parameters()[rows], 0)
    networks.load(rows, parameters_to_vectors(network)[rows])
    np.testing.assert_array_equal(networks.parameters(), parameters_to_vectors(network))


def test_there_and_back():
    network = stack()
    again = vectors_to_parameters(parameters_to_vectors(network), SIZES)
    for ours, theirs in zip(
        (*again.weights, *again.biases),
        (*network.weights, *network.biases),
        strict=True,
    ):
        np.testing.assert_array_equal(ours, theirs)
    np.testing.assert_array_equal(
        vectors_to_parameters(parameters_to_vectors(network)[2], SIZES).weights[1],
        network.weights[1][2],
    )
