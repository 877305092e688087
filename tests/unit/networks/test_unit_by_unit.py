"""The sums over units equal the passes with matrices."""

import numpy as np
import pytest

from robonav.networks import (
    action_probabilities,
    backpropagate_by_units,
    forward_by_units,
    random_network,
    squared_error_gradient,
)


def test_forward_passes_by_units_and_by_equations_of_the_robots_network():
    network, x = random_network((11, 8, 5), seed=3), np.linspace(-2, 2, 11)
    expected = network.forward(x)
    np.testing.assert_allclose(forward_by_units(network, x), expected, rtol=1e-12)
    np.testing.assert_allclose(action_probabilities(network, x), expected, rtol=1e-12)


@pytest.mark.parametrize("sizes", [(3, 1), (4, 3, 2), (3, 4, 3, 2)])
def test_backpropagation_by_units_and_with_matrices(sizes):
    network, x = random_network(sizes, seed=5), np.linspace(-1, 1, sizes[0])
    y = np.linspace(0, 1, sizes[-1])
    by_units = backpropagate_by_units(network, x, y)
    with_matrices = squared_error_gradient(network, x[None], y[None])
    for one, other in zip(
        [*by_units.weights, *by_units.biases],
        [*with_matrices.weights, *with_matrices.biases],
        strict=True,
    ):
        np.testing.assert_allclose(one, other, rtol=1e-12)
