"""Max-margin: quadratic program against brute force and against subgradient steps; projection (Abbeel and Ng 2004)."""

import inspect

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.optimize import linprog

from robonav.nirl import (
    apprenticeship_learning,
    initial_expectations,
    max_margin_guess,
    maximum_margin,
    maximum_margin_subgradient,
    nearest_mixture,
    project,
    projection_guess,
)

POINTS = st.integers(1, 6).flatmap(
    lambda n: arrays(
        float, (n, 2), elements=st.floats(-3, 3).map(lambda x: round(x, 3))
    )
)


def brute_force(expert, others):
    """Try every direction of the plane."""
    angles = np.linspace(0, 2 * np.pi, 200_001)
    directions = np.stack([np.cos(angles), np.sin(angles)])
    return max(((expert - others) @ directions).min(axis=0).max(), 0.0)


@settings(deadline=None)
@given(POINTS)
def test_the_margin_is_the_widest_of_all_directions(others):
    expert = np.array([0.4, -0.2])
    found = maximum_margin(expert, others)
    assert found.margin == pytest.approx(brute_force(expert, others), abs=1e-4)
    assert np.linalg.norm(found.weights) <= 1 + 1e-9
    assert ((expert - others) @ found.weights).min() == pytest.approx(
        found.margin, abs=1e-9
    )


@pytest.mark.parametrize("seed", range(40))
def test_the_primal_and_its_dual_agree(seed):
    """The function as written, by a general solver, and the twin that runs."""
    rng = np.random.default_rng(seed)
    policies, features = rng.integers(1, 9, size=2)
    expert, others = rng.normal(size=features), rng.normal(size=(policies, features))
    written = inspect.unwrap(maximum_margin)(expert, others)
    ran = maximum_margin(expert, others)
    assert written.margin == pytest.approx(ran.margin, abs=1e-6)
    np.testing.assert_allclose(written.weights, ran.weights, atol=1e-5)


@pytest.mark.parametrize("find", [maximum_margin, inspect.unwrap(maximum_margin)])
def test_an_expert_among_the_others_has_no_margin(find):
    corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]
    for expert in ([0.25, 0.25], [0.0, 0.0], [0.5, 0.5]):
        found = find(np.array(expert), np.array(corners))
        assert (found.margin, found.weights.tolist()) == (0.0, [0.0, 0.0])


@settings(deadline=None, max_examples=20)
@given(arrays(float, (5, 3), elements=st.floats(-3, 3).map(lambda x: round(x, 2))))
def test_subgradient_steps_come_to_the_same(others):
    expert = np.array([2.0, -1.0, 0.5])
    exact = maximum_margin(expert, others).margin
    stepped = maximum_margin_subgradient(expert, others, iterations=3000).margin
    assert stepped <= exact + 1e-9
    assert stepped == pytest.approx(
        exact, abs=0.03 * np.linalg.norm(expert - others, axis=1).max()
    )


@settings(deadline=None)
@given(arrays(float, (4, 3), elements=st.floats(-2, 2).map(lambda x: round(x, 3))))
def test_no_margin_exactly_where_the_expert_is_a_mixture(others):
    """An independent library decides whether the expert lies in the convex hull."""
    expert = others.mean(axis=0) + np.array([0.3, 0.0, 0.0])
    hull = linprog(
        np.zeros(4),
        A_eq=np.vstack([others.T, np.ones(4)]),
        b_eq=[*expert, 1],
        bounds=(0, None),
    )
    margin = maximum_margin(expert, others).margin
    assume(not 0 < margin < 1e-5)
    assert (margin == 0) == hull.success


def test_an_expert_no_better_than_itself():
    same = maximum_margin([1.0, 2.0], [[1.0, 2.0]])
    assert same.margin == 0
    assert same.weights.tolist() == [0, 0]
    with pytest.raises(ValueError, match="at least one policy, got none"):
        maximum_margin([1.0], np.empty((0, 1)))


@settings(deadline=None)
@given(*[arrays(float, 3, elements=st.floats(-3, 3))] * 3)
def test_projection_is_the_nearest_point_between(mean, found, expert):
    reached = project(mean, found, expert)
    shares = np.linspace(0, 1, 2001)[:, None]
    tried = np.linalg.norm(mean + shares * (found - mean) - expert, axis=1).min()
    assert np.linalg.norm(reached - expert) <= tried + 1e-9


def test_the_nearest_mixture_of_a_square():
    corners = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    inside = nearest_mixture([0.25, 0.5], corners)
    np.testing.assert_allclose(inside @ corners, [0.25, 0.5], atol=1e-6)
    outside = nearest_mixture([2.0, 0.5], corners)
    np.testing.assert_allclose(outside, [0, 0.5, 0.5, 0], atol=1e-6)


@pytest.fixture(params=[projection_guess, max_margin_guess])
def guess(request):
    return request.param


def solver(case):
    def solve(weights):
        policy = case.best(weights)
        return policy, initial_expectations(case.task, policy)

    return solve


def learn(case, guess, expert, **options):
    solve = solver(case)
    first = np.zeros(case.task.n_states, dtype=int)
    start = first, initial_expectations(case.task, first)
    return apprenticeship_learning(expert, solve, start, guess=guess, **options)


def test_the_apprentice_matches_the_expert(terrain, guess):
    """With the expert's exact expectations: distances fall, and the mixture has the expert's value."""
    learned = learn(
        terrain,
        guess,
        initial_expectations(terrain.task, terrain.expert),
        iterations=30,
    )
    assert (np.diff(learned.distances) <= 1e-9).all()
    assert learned.distances[-1] < 1e-3
    values = np.array([terrain.value(policy) for policy in learned.policies])
    assert learned.mixture @ values == pytest.approx(
        terrain.value(terrain.expert), abs=1e-2
    )
    assert terrain.loss(learned.policies[learned.closest]) < 0.05
    assert len(learned.policies) == len(learned.weights) + 1 == len(learned.distances)


def test_the_apprentice_of_random_rewards(scattered, guess):
    learned = learn(
        scattered,
        guess,
        initial_expectations(scattered.task, scattered.expert),
        iterations=40,
    )
    assert scattered.loss(learned.policies[learned.closest]) < 0.05


def test_the_apprentice_of_demonstrations(terrain, guess):
    """From 200 walks instead of the model."""
    from robonav.nirl import empirical_expectations

    walks = terrain.task.rollout(terrain.expert, 200, 60, seed=5)
    taken = terrain.task.features[walks.states, walks.actions].reshape(-1, 4)
    expert = empirical_expectations(taken, walks.trajectory, terrain.task.discount)
    learned = learn(terrain, guess, expert, iterations=20)
    assert terrain.loss(learned.policies[learned.closest]) < 0.05


def test_both_ways_walk_the_same_first_step(terrain):
    """Against one policy, the widest margin and the projection point the same way."""
    expert = initial_expectations(terrain.task, terrain.expert)
    a, b = (
        learn(terrain, way, expert, iterations=1).weights[0]
        for way in (projection_guess, max_margin_guess)
    )
    np.testing.assert_allclose(a / np.linalg.norm(a), b / np.linalg.norm(b), atol=1e-6)


def test_a_projection_never_lies_beyond_the_best_policy(terrain):
    """So the bound in ``project`` changes nothing of the paper's method where rewards are solved exactly."""
    learned = learn(
        terrain,
        projection_guess,
        initial_expectations(terrain.task, terrain.expert),
        iterations=20,
    )
    mean = learned.expectations[0]
    for found in learned.expectations[1:]:
        share = (
            (found - mean) @ (learned.expert - mean) / ((found - mean) @ (found - mean))
        )
        assert 0 <= share <= 1
        mean = mean + share * (found - mean)
    assert np.linalg.norm(learned.expert - mean) == pytest.approx(learned.distances[-1])


def test_an_expert_met_at_once_ends_it(terrain, guess):
    first = initial_expectations(
        terrain.task, np.zeros(terrain.task.n_states, dtype=int)
    )
    learned = learn(terrain, guess, first)
    assert len(learned.policies) == 1
    assert learned.distances.tolist() == [0]


@pytest.mark.parametrize("guess", [projection_guess, max_margin_guess])
@pytest.mark.parametrize("seed", range(5))
def test_the_distance_keeps_the_bound_of_the_page(guess, seed):
    """After n policies it is at most D / sqrt(n), where D is the largest distance between two policies."""
    corners = np.random.default_rng(seed).normal(size=(30, 4))
    diameter = np.linalg.norm(corners[:, None] - corners, axis=2).max()
    expert = np.random.default_rng([seed, 1]).dirichlet(np.ones(30)) @ corners

    def solve(weights):
        k = int((corners @ weights).argmax())
        return k, corners[k]

    found = apprenticeship_learning(
        expert, solve, (0, corners[0]), guess=guess, tolerance=0.0, iterations=60
    )
    n = np.arange(1, len(found.distances) + 1)
    assert (found.distances <= diameter / np.sqrt(n) + 1e-9).all()


def test_two_policies_by_hand():
    """The numbers that the page works out by hand, for both methods."""
    expert, first, second = (
        np.array(mu) for mu in ([2.0, 2.0], [0.0, 2.0], [2.0, 0.0])
    )
    alone, both = (
        maximum_margin(expert, [first]),
        maximum_margin(expert, [first, second]),
    )
    np.testing.assert_allclose(alone.weights, [1, 0], atol=1e-12)
    assert alone.margin == pytest.approx(2)
    assert alone.weights @ (expert - second) == pytest.approx(0)
    np.testing.assert_allclose(both.weights, np.sqrt([0.5, 0.5]))
    assert both.margin == pytest.approx(np.sqrt(2))
    np.testing.assert_allclose(project(first, second, expert), [1, 1])
    weights, distance = projection_guess(expert, [first, second])
    np.testing.assert_allclose(weights, [1, 1])
    assert distance == pytest.approx(np.sqrt(2))
