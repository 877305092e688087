"""SCIRL (Klein et al. 2012): LSTD-mu against the model, the heuristic, the classifier, gridworlds."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.optimize import approx_fprime

from robonav.nirl import (
    discounted_feature_sums,
    feature_expectations,
    heuristic_mu,
    large_margin_cost,
    lstd_mu,
    mean_by_pair,
    structured_classification,
)

RNG = np.random.default_rng(0)
MU = RNG.normal(size=(40, 3, 4))
SHOWN = RNG.integers(0, 3, 40)
EQUAL = np.full(40, 1 / 40)


@settings(deadline=None)
@given(arrays(float, 4, elements=st.floats(-2, 2)), st.floats(0, 1))
@pytest.mark.slow
def test_the_subgradient_is_that_of_the_cost(theta, ridge):
    def at(weights):
        return large_margin_cost(weights, MU, SHOWN, EQUAL, regularisation=ridge)[0]

    numerical = approx_fprime(theta, at, 1e-7)
    analytic = large_margin_cost(theta, MU, SHOWN, EQUAL, regularisation=ridge)[1]
    if not np.allclose(
        analytic, numerical, atol=1e-4
    ):  # at a kink it need only support the cost from below
        others = theta + np.random.default_rng(1).normal(size=(50, 4))
        assert all(
            at(other) >= at(theta) + analytic @ (other - theta) - 1e-9
            for other in others
        )


def test_a_separable_case_is_separated():
    rng = np.random.default_rng(3)
    mu, theta = rng.normal(size=(200, 4, 5)), rng.normal(size=5)
    demonstrated = (mu @ theta).argmax(axis=1)
    learned = structured_classification(mu, demonstrated)
    assert ((mu @ learned.weights).argmax(axis=1) == demonstrated).mean() > 0.97
    assert learned.costs[-1] < 0.5 * learned.costs[0]


@pytest.mark.slow
def test_weights_do_not_hang_on_the_unit_of_the_features():
    one = structured_classification(MU, SHOWN).weights
    other = structured_classification(1000 * MU, SHOWN).weights
    np.testing.assert_allclose(1000 * other, one, rtol=1e-6)


def test_only_the_shown_action_is_known():
    every = heuristic_mu([[2.0, 4.0], [6.0, 8.0]], [1, 0], 3, 0.5)
    np.testing.assert_allclose(
        every, [[[1, 2], [2, 4], [1, 2]], [[6, 8], [3, 4], [3, 4]]]
    )


def steps_of(case, walks, steps, policy, seed):
    """Walks as single steps: states, actions, and what followed each but the last."""
    drawn = case.task.rollout(policy, walks, steps, seed=seed)
    return (
        drawn.states[:, :-1].ravel(),
        drawn.actions[:, :-1].ravel(),
        drawn.states[:, 1:].ravel(),
        drawn,
    )


def lstd(case, walks, policy, seed):
    """LSTD-mu with one basis function a pair of state and action: (S, A, K)."""
    task = case.task
    states, actions, after, drawn = steps_of(case, walks, 40, policy, seed)
    pairs = np.eye(task.n_states * task.n_actions).reshape(
        task.n_states, task.n_actions, -1
    )
    omega = lstd_mu(
        pairs[states, actions], pairs[after, drawn.actions[:, 1:].ravel()], task.features[states, actions],
        task.discount, regularisation=1e-9,
    )  # fmt: skip
    return omega.reshape(task.n_states, task.n_actions, -1)


@pytest.mark.slow
def test_lstd_mu_finds_what_the_model_says(terrain):
    policy = np.full((terrain.task.n_states, 4), 0.25)
    estimate = lstd(terrain, 2000, policy, 1)
    exact = feature_expectations(terrain.task, policy)
    living = ~terrain.grid.terminal
    assert abs(estimate - exact)[living].max() < 0.15 * abs(exact).max()


def noisy(case, slips=0.25):
    """The expert with a hand that slips to any action now and then, so that all of them are seen."""
    return (1 - slips) * np.eye(4)[case.expert] + slips / 4


def test_scirl_with_exact_expectations(terrain):
    mu = feature_expectations(terrain.task, terrain.expert)
    living = ~terrain.grid.terminal
    learned = structured_classification(mu[living], terrain.expert[living])
    assert terrain.loss(terrain.best(learned.weights)) < 0.05


def test_scirl_with_lstd_mu(terrain):
    """Expectations of all actions learned from a slipping expert's steps; labels are what it meant to do."""
    mu = lstd(terrain, 500, noisy(terrain), 3)
    states = np.unique(terrain.task.rollout(noisy(terrain), 500, 40, seed=3).states)
    states = states[~terrain.grid.terminal[states]]
    learned = structured_classification(mu[states], terrain.expert[states])
    assert terrain.loss(terrain.best(learned.weights)) < 0.05


def test_scirl_with_monte_carlo(terrain):
    """The same with what followed each pair of state and action, averaged."""
    task, drawn = terrain.task, terrain.task.rollout(noisy(terrain), 3000, 40, seed=3)
    features = task.features[drawn.states, drawn.actions].reshape(-1, 4)
    pairs = (drawn.states * 4 + drawn.actions).ravel()
    mu = mean_by_pair(
        pairs,
        discounted_feature_sums(features, drawn.trajectory, task.discount),
        task.n_states * 4,
    )
    mu = mu.reshape(task.n_states, 4, -1)
    seen = np.isfinite(mu).all(axis=(1, 2)) & ~terrain.grid.terminal
    learned = structured_classification(mu[seen], terrain.expert[seen])
    assert terrain.loss(terrain.best(learned.weights)) < 0.05


def test_scirl_with_the_heuristic(scattered):
    """From the demonstrations alone. The heuristic suits an expert that goes somewhere good and stays.

    Any reward that is good everywhere separates it: the ridge chooses among those.
    """
    task, drawn = (
        scattered.task,
        scattered.task.rollout(scattered.expert, 40, 30, seed=4),
    )
    features = task.features[drawn.states, drawn.actions].reshape(drawn.states.size, -1)
    demonstrated = drawn.actions.ravel()
    to_go = discounted_feature_sums(features, drawn.trajectory, task.discount)
    learned = structured_classification(
        heuristic_mu(to_go, demonstrated, 4, task.discount),
        demonstrated,
        regularisation=1e-2,
    )
    assert scattered.loss(scattered.best(learned.weights)) < 0.05


def test_random_rewards(scattered):
    mu = feature_expectations(scattered.task, scattered.expert)
    learned = structured_classification(mu, scattered.expert)
    assert scattered.loss(scattered.best(learned.weights)) < 0.05


def test_no_steps_get_a_sentence():
    with pytest.raises(ValueError, match="at least one step, got none"):
        structured_classification(np.empty((0, 3, 2)), [])
    with pytest.raises(ValueError, match="at least one step, got none"):
        lstd_mu(np.empty((0, 2)), np.empty((0, 2)), np.empty((0, 2)), 0.9)
    with pytest.raises(
        ValueError, match="actions must lie between 0 and 2, got 0 to 5"
    ):
        structured_classification(np.ones((2, 3, 2)), [0, 5])


def test_an_action_never_shown_is_no_trouble():
    learned = structured_classification(MU, np.minimum(SHOWN, 1))
    assert np.isfinite(learned.weights).all()
