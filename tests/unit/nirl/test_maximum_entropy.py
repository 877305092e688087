"""Soft backups and maximum entropy (Ziebart et al. 2008, 2010)."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.optimize import check_grad, minimize
from scipy.special import softmax

from robonav.errors import ConvergenceWarning
from robonav.mdp.dynamic_programming import value_iteration
from robonav.mdp.models import FiniteMDP
from robonav.nirl import (
    boltzmann_policy,
    causal_entropy_ascent,
    causal_entropy_dual,
    empirical_expectations,
    initial_expectations,
    maximum_causal_entropy,
    occupancy_measure,
    soft_maximum,
    soft_value_iteration,
)


@pytest.mark.slow
def test_plain_ascent_comes_to_the_same(terrain):
    mu = initial_expectations(terrain.task, terrain.expert)
    fast = maximum_causal_entropy(terrain.task, mu, regularisation=1.0)
    plain = causal_entropy_ascent(
        terrain.task, mu, regularisation=1.0, gradient_step=0.3, iterations=20
    )
    assert abs(fast.weights).max() > 1
    np.testing.assert_allclose(plain, fast.weights, atol=1e-4)


@settings(deadline=None)
@given(arrays(float, 5, elements=st.floats(-100, 100)), st.floats(1e-3, 10))
def test_soft_maximum_lies_just_above_the_hard_one(q, temperature):
    soft = soft_maximum(q, temperature)
    assert q.max() - 1e-9 <= soft <= q.max() + temperature * np.log(5) + 1e-9


def test_soft_backup_becomes_the_hard_one_as_it_cools(scattered):
    mdp = scattered.task.with_reward(scattered.truth)
    hard = value_iteration(mdp, tolerance=1e-10).values
    errors = []
    for temperature in (1.0, 0.1, 0.01, 0.001):
        soft = soft_value_iteration(mdp, temperature=temperature).values
        assert (soft >= hard - 1e-8).all()
        errors.append((soft - hard).max())
    bound = np.array([1.0, 0.1, 0.01, 0.001]) * np.log(4) / (1 - mdp.discount)
    assert (np.array(errors) <= bound + 1e-8).all()
    assert (np.diff(errors) < 0).all()


def test_one_state_in_closed_form():
    """Two actions that stay: V = T log(e^(r0/T) + e^(r1/T)) / (1 - gamma)."""
    mdp = FiniteMDP(np.ones((2, 1, 1)), [[0.3, -0.7]], 0.9)
    soft = soft_value_iteration(mdp, temperature=0.5)
    assert soft.values[0] == pytest.approx(
        0.5 * np.log(np.exp(0.6) + np.exp(-1.4)) / 0.1
    )
    np.testing.assert_allclose(soft.policy, boltzmann_policy(soft.q, 2.0))


def test_no_policy_collects_more_reward_and_entropy():
    """An optimiser over all stochastic policies, scored by a linear system, comes to the soft values and no further."""
    rng = np.random.default_rng(0)
    transitions, rewards, temperature = (
        rng.dirichlet(np.ones(3), (2, 3)),
        rng.normal(size=(3, 2)),
        0.7,
    )
    soft = soft_value_iteration(
        FiniteMDP(transitions, rewards, 0.8), temperature=temperature
    )

    def value(logits):
        policy = softmax(logits.reshape(3, 2), axis=1)
        gained = (policy * (rewards - temperature * np.log(policy))).sum(axis=1)
        return np.linalg.solve(
            np.eye(3) - 0.8 * np.einsum("sa,ast->st", policy, transitions), gained
        )[0]

    found = minimize(lambda logits: -value(logits), rng.normal(size=6))
    assert -found.fun == pytest.approx(soft.values[0], abs=1e-6)
    np.testing.assert_allclose(
        softmax(found.x.reshape(3, 2), axis=1), soft.policy, atol=1e-3
    )


def test_a_budget_too_small_warns(scattered):
    with pytest.warns(ConvergenceWarning, match="gave up after 3 iterations"):
        soft_value_iteration(
            scattered.task.with_reward(scattered.truth), max_iterations=3
        )


def test_forward_pass_repeats_the_flow_of_visits(scattered):
    """Ziebart's forward pass, step by step: the probability of each state, summed with its discount."""
    task = scattered.task
    policy = np.random.default_rng(4).dirichlet(np.ones(task.n_actions), task.n_states)
    probability, visits = task.starts, np.zeros(task.n_states)
    for t in range(2000):
        visits += task.discount**t * probability
        flow = probability[:, None] * policy
        probability = np.einsum("sa,ast->t", flow, task.transitions)
    np.testing.assert_allclose(
        occupancy_measure(task, policy), visits[:, None] * policy, atol=1e-9
    )


def test_forward_pass_gives_the_feature_expectations(scattered):
    task = scattered.task
    occupancy = occupancy_measure(task, scattered.expert)
    np.testing.assert_allclose(
        np.einsum("sa,sak->k", occupancy, task.features),
        initial_expectations(task, scattered.expert),
    )
    assert occupancy.sum() == pytest.approx(1 / (1 - task.discount))


@pytest.mark.parametrize("regularisation", [0.0, 0.3])
def test_gradient_of_the_dual(terrain, regularisation):
    rng = np.random.default_rng(7)
    expert = initial_expectations(terrain.task, terrain.expert)
    error = check_grad(
        lambda theta: causal_entropy_dual(theta, terrain.task, expert, regularisation)[
            0
        ],
        lambda theta: causal_entropy_dual(theta, terrain.task, expert, regularisation)[
            1
        ],
        rng.normal(size=4),
    )
    assert error < 1e-4


def test_gradient_of_the_log_likelihood_is_the_gap(terrain):
    """d/dtheta of the soft value from the start is the soft policy's feature expectations."""
    task, rng = terrain.task, np.random.default_rng(3)

    def soft(theta):
        return soft_value_iteration(task.with_reward(theta))

    error = check_grad(
        lambda theta: task.starts @ soft(theta).values,
        lambda theta: initial_expectations(task, soft(theta).policy),
        rng.normal(size=4),
    )
    assert error < 1e-4


@pytest.mark.slow
def test_it_matches_the_features_of_a_soft_expert(terrain):
    """A soft driver's weights are found again, but for the one direction in which every policy earns the same.

    One unit for every step and 1 / (1 - gamma) on arrival add up to 1 / (1 - gamma) for every policy.
    """
    task = terrain.task
    driver = soft_value_iteration(task.with_reward(terrain.truth)).policy
    learned = maximum_causal_entropy(
        task, initial_expectations(task, driver), regularisation=0.0
    )
    assert learned.gaps[-1] < 1e-3
    pointless = np.array([1, 1, 1, 1 / (1 - task.discount)])
    gap = learned.weights - terrain.truth
    np.testing.assert_allclose(gap, gap[0] * pointless, atol=0.1)
    np.testing.assert_allclose(learned.policy, driver, atol=0.01)
    assert (np.diff(learned.dual_values) > -1e-6).all()


@pytest.mark.parametrize(
    "demonstrations", [None, pytest.param(100, marks=pytest.mark.slow)]
)
def test_its_reward_makes_the_expert_again(terrain, demonstrations):
    task = terrain.task
    if demonstrations is None:
        expert = initial_expectations(task, terrain.expert)
    else:
        walks = task.rollout(terrain.expert, demonstrations, 60, seed=2)
        expert = empirical_expectations(
            task.features[walks.states, walks.actions].reshape(-1, 4),
            walks.trajectory,
            task.discount,
        )
    learned = maximum_causal_entropy(task, expert, regularisation=1e-3)
    assert terrain.loss(terrain.best(learned.weights)) < 0.05


@pytest.mark.slow
def test_random_rewards(scattered):
    expert = initial_expectations(scattered.task, scattered.expert)
    learned = maximum_causal_entropy(scattered.task, expert, regularisation=1e-4)
    assert scattered.loss(scattered.best(learned.weights)) < 0.05


def test_an_optimisation_cut_short_warns(terrain):
    expert = initial_expectations(terrain.task, terrain.expert)
    with pytest.warns(ConvergenceWarning, match="ended after 1 iteration with"):
        found = maximum_causal_entropy(terrain.task, expert, iterations=1)
    assert not found.converged


@pytest.mark.parametrize("tolerance", [0.0, -1.0, np.nan])
def test_tolerance_must_be_positive(terrain, tolerance):
    expert = initial_expectations(terrain.task, terrain.expert)
    with pytest.raises(ValueError, match="tolerance must be"):
        maximum_causal_entropy(terrain.task, expert, tolerance=tolerance)
