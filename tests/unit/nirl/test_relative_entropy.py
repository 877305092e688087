"""Relative-entropy IRL (Boularias et al. 2011): importance weights that matter, gradients, gridworlds."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.optimize import approx_fprime

from robonav.errors import ConvergenceWarning
from robonav.mdp import policies
from robonav.nirl import (
    dual,
    dual_gradient,
    hoeffding_slack,
    importance_weights,
    relative_entropy_weights,
)

RNG = np.random.default_rng(0)
SAMPLES = RNG.normal(size=(50, 3))
RATIOS = RNG.normal(size=50)
EXPERT = np.array([0.5, -0.4, 0.2])
THETAS = arrays(float, 3, elements=st.floats(-3, 3).map(lambda x: round(x, 3)))


@settings(deadline=None)
@given(THETAS, THETAS)
def test_two_weights_give_two_gradients(one, other):
    """The regression that matters: weights that cancel would give the same gradient for every theta."""
    slack = np.zeros(3)
    apart = dual_gradient(one, EXPERT, SAMPLES, RATIOS, slack) - dual_gradient(
        other, EXPERT, SAMPLES, RATIOS, slack
    )
    assert np.allclose(apart, 0, atol=1e-12) == (np.linalg.norm(one - other) < 1e-9)


@settings(deadline=None)
@given(THETAS.filter(lambda theta: (abs(theta) > 1e-2).all()))
def test_the_gradient_is_that_of_the_dual(theta):
    slack = np.array([0.1, 0.0, 0.3])
    numerical = approx_fprime(
        theta, lambda t: dual(t, EXPERT, SAMPLES, RATIOS, slack), 1e-6
    )
    np.testing.assert_allclose(
        dual_gradient(theta, EXPERT, SAMPLES, RATIOS, slack), numerical, atol=1e-4
    )


def test_importance_weights_undo_the_sampling():
    """Features of one policy's walks, weighted, give those of another policy."""
    uniform, biased = np.array([0.5, 0.5]), np.array([0.8, 0.2])
    rng = np.random.default_rng(4)
    actions = rng.random((20_000, 3)) < biased[1]
    samples = actions.sum(axis=1, keepdims=True).astype(float)
    log_ratios = 3 * np.log(0.5) - np.log(biased[actions.astype(int)]).sum(axis=1)
    assert uniform.sum() == 1
    assert importance_weights([0.0], samples, log_ratios) @ samples == pytest.approx(
        [1.5], abs=0.03
    )
    # and exp(theta f) turns a fair coin into one that falls on 1 with e^theta / (1 + e^theta)
    assert importance_weights([1.0], samples, log_ratios) @ samples == pytest.approx(
        [3 / (1 + np.exp(-1))], abs=0.05
    )


def test_it_finds_the_tilt_of_all_trajectories():
    """Every trajectory of a small world enumerated, tilted by a known reward, sampled with another policy."""
    rng, reward = np.random.default_rng(0), np.array([0.7, -0.4])
    transitions, features = (
        rng.dirichlet(np.ones(3), (2, 3)),
        rng.normal(size=(3, 2, 2)),
    )
    policy = rng.dirichlet(np.ones(2), 3)
    walks = [
        (states, actions)
        for states in product(range(3), repeat=3)
        for actions in product(range(2), repeat=3)
    ]
    seen = np.array(
        [
            sum(
                0.8**t * features[s, a]
                for t, (s, a) in enumerate(zip(*walk, strict=True))
            )
            for walk in walks
        ]
    )
    world = np.array(
        [
            np.prod(
                [
                    transitions[a, s, t]
                    for a, s, t in zip(acts, ss, ss[1:], strict=False)
                ]
            )
            for ss, acts in walks
        ]
    )
    ratio = np.array(
        [
            np.prod([0.5 / policy[s, a] for s, a in zip(*walk, strict=True)])
            for walk in walks
        ]
    )
    tilted = world * np.exp(seen @ reward)
    drawn = rng.choice(len(walks), 100_000, p=world / ratio / (world / ratio).sum())
    learned = relative_entropy_weights(
        tilted @ seen / tilted.sum(), seen[drawn], np.log(ratio[drawn])
    )
    np.testing.assert_allclose(learned.weights, reward, atol=0.05)


def test_the_maximum_has_no_gradient_left():
    learned = relative_entropy_weights(EXPERT, SAMPLES, RATIOS)
    np.testing.assert_allclose(learned.gap, 0, atol=1e-4)
    np.testing.assert_allclose(
        dual_gradient(learned.weights, EXPERT, SAMPLES, RATIOS, np.zeros(3)),
        0,
        atol=1e-4,
    )
    assert 1 < learned.effective_samples <= 50


def test_warning_when_l_bfgs_ended_before_the_maximum():
    with pytest.warns(
        ConvergenceWarning, match="after 1 iteration, and the gap"
    ) as caught:
        stopped = relative_entropy_weights(EXPERT, SAMPLES, RATIOS, iterations=1)
    assert caught[0].filename == __file__
    assert not stopped.converged
    assert abs(stopped.gap).max() > 0.01  # the slack is 0
    finished = relative_entropy_weights(EXPERT, SAMPLES, RATIOS)
    assert finished.converged
    assert abs(finished.gap).max() < 1e-3


def test_slack_keeps_the_gap_within_bounds_and_weights_sparse():
    slack = np.array([0.3, 0.3, 0.3])
    learned = relative_entropy_weights(EXPERT, SAMPLES, np.zeros(50), slack=slack)
    assert (abs(learned.gap) <= slack + 1e-4).all()
    silent = abs(learned.weights) < 1e-9
    assert silent.any()
    active = ~silent
    np.testing.assert_allclose(
        learned.gap[active], slack[active] * np.sign(learned.weights[active]), atol=1e-3
    )


def test_an_expert_that_no_sample_resembles_stays_finite():
    learned = relative_entropy_weights([10.0, 0, 0], SAMPLES, RATIOS)
    assert np.isfinite(learned.weights).all()


def test_no_samples_get_a_sentence():
    with pytest.raises(
        ValueError, match="samples must hold at least one trajectory, got none"
    ):
        relative_entropy_weights([1.0], np.empty((0, 1)), [])


def test_slack_shrinks_with_demonstrations():
    few, many = hoeffding_slack(SAMPLES, 10), hoeffding_slack(SAMPLES, 1000)
    np.testing.assert_allclose(few, 10 * many)
    np.testing.assert_allclose(few / np.ptp(SAMPLES, axis=0), np.sqrt(np.log(40) / 20))


def first_features(case, walks):
    """Discounted features of whole walks, (N, K)."""
    taken = case.task.features[walks.states, walks.actions]
    return np.einsum(
        "t,ntk->nk", case.task.discount ** np.arange(taken.shape[1]), taken
    )


def learn(case, policy, steps, slack):
    """From 500 walks of the expert and 20,000 of a sampling policy, equally long."""
    expert = first_features(
        case, case.task.rollout(case.expert, 500, steps, seed=9)
    ).mean(axis=0)
    walks = case.task.rollout(policy, 20_000, steps, seed=1)
    log_ratios = -np.log(4 * policy[walks.states, walks.actions]).sum(axis=1)
    return relative_entropy_weights(
        expert, first_features(case, walks), log_ratios, slack=slack
    )


@pytest.mark.parametrize("share", [0.5, 0.7])
def test_its_reward_makes_the_expert_again(terrain, share):
    """Sampled from a policy that does what the expert does in part of its steps: uniform ones hardly ever arrive."""
    policy = (1 - share) * policies.uniform(terrain.task.n_states, 4) + share * np.eye(
        4
    )[terrain.expert]
    learned = learn(terrain, policy, 30, 0.01)
    assert terrain.loss(terrain.best(learned.weights)) < 0.05


def test_random_rewards(scattered):
    learned = learn(scattered, policies.uniform(scattered.task.n_states, 4), 15, 0.1)
    assert scattered.loss(scattered.best(learned.weights)) < 0.05
