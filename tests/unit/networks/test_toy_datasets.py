"""The two-input problems are what they say, and need the hidden units they are said to need."""

import numpy as np
import pytest

from robonav.networks.multilayer_perceptron import Network
from robonav.networks.optimisers import fit
from robonav.networks.toy_datasets import EXTENT, TOY_DATASETS, disc, field, xor


@pytest.mark.parametrize("problem", TOY_DATASETS.values(), ids=TOY_DATASETS)
def test_problems_are_balanced_bounded_and_their_seeds_own(problem):
    x, y = problem(400, seed=0)
    assert x.shape == (400, 2)
    assert y.shape == (400, 1)
    assert abs(x).max() <= EXTENT
    assert set(np.unique(y)) == {0, 1}
    assert 0.4 < y.mean() < 0.6
    np.testing.assert_array_equal(x, problem(400, seed=0)[0])
    assert not np.array_equal(x, problem(400, seed=1)[0])


def test_labels_follow_the_geometry():
    x, y = xor(200, seed=0)
    np.testing.assert_array_equal(y[:, 0], x.prod(axis=1) > 0)
    x, y = disc(200, seed=0)
    np.testing.assert_array_equal(y[:, 0], np.hypot(*x.T) < 0.6)


@pytest.mark.parametrize(
    "problem", ["xor", pytest.param("disc", marks=pytest.mark.slow)]
)
def test_no_line_parts_the_examples_but_a_few_hidden_units_do(problem):
    x, y = TOY_DATASETS[problem](200, seed=0)
    assert fit(x, y, hidden=(), regularisation=0.01).accuracies[-1] < 0.85
    assert (
        max(
            fit(x, y, hidden=4, regularisation=0.01, seed=seed).accuracies[-1]
            for seed in range(3)
        )
        == 1
    )


def test_field_is_the_network_over_the_square():
    slope = Network((np.array([[2.0, 0.0]]),), (np.zeros(1),))  # depends on x_1 alone
    answers = field(slope, resolution=5)
    assert answers.shape == (5, 5)
    np.testing.assert_allclose(
        answers[0], 1 / (1 + np.exp(-2 * np.linspace(-EXTENT, EXTENT, 5)))
    )
    np.testing.assert_allclose(np.ptp(answers, axis=0), 0)
