"""The numbers that the page "A neural network, by hand" works by hand are those of the package."""

from collections.abc import Callable

import numpy as np
import pytest

from robonav.networks import (
    Network,
    cross_entropy_gradient,
    gradient_descent_step,
    sigmoid_slope,
    squared_error_cost,
    squared_error_gradient,
)

SMALL = Network(
    weights=(np.array([[0.5, -0.5], [1, 0.5]]), np.array([[1.0, -1], [2, 1]])),
    biases=(np.array([0.5, -1]), np.array([0.0, -1])),
)
X, Y = np.array([[1.0, 2]]), np.array([[1.0, 0]])


@pytest.fixture
def worked(page_text: Callable[[str], str]) -> str:
    """The two sections with the passes by hand, and those on the costs."""
    text = page_text("neural-network")
    first, last = "### A forward pass by hand", "### With matrices"
    return text[text.index(first) : text.index(last)]


def test_forward_and_backward_pass(worked):
    _, hidden, output = SMALL.activations(X)
    by = squared_error_gradient(SMALL, X, Y)
    numbers = [
        hidden[0, 1],
        *output[0],
        *SMALL.logits(X)[0],
        *sigmoid_slope(output)[0],
        sigmoid_slope(hidden)[0, 1],
        *by.biases[1],
        *by.biases[0],
        *by.weights[1].ravel(),
        *by.weights[0].ravel(),
        squared_error_cost(SMALL, X, Y),
    ]
    missing = [f"{number:.4f}" for number in numbers if f"{number:.4f}" not in worked]
    assert missing == []


def test_errors_of_the_cross_entropy(page_text):
    by, text = cross_entropy_gradient(SMALL, X, Y), page_text("neural-network")
    for number in (*by.biases[1], by.biases[0][0]):
        assert f"{number:.4f}" in text


def test_one_step_lowers_the_cost():
    stepped = gradient_descent_step(SMALL, squared_error_gradient(SMALL, X, Y), 1.0)
    assert squared_error_cost(stepped, X, Y) < 0.29
