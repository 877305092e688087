"""Values of policies: published values, simulation, and both ways to solve the equations."""

import warnings

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from robonav.errors import ConvergenceWarning
from robonav.mdp import (
    Cell,
    FiniteMDP,
    GridWorld,
    advantage,
    backward_induction,
    bellman_action_value_operator,
    bellman_optimality_operator,
    bellman_policy_operator,
    finite_horizon_evaluation,
    generalized_policy_iteration,
    in_place_value_iteration,
    is_optimal,
    iterative_policy_evaluation,
    modified_policy_iteration,
    policies,
    policy_action_values,
    policy_evaluation,
    policy_iteration,
    prioritized_sweeping,
    value_iteration,
)


def dirichlet_mdp(seed, *, states=8, actions=3, discount=0.9):
    rng = np.random.default_rng(seed)
    return FiniteMDP(
        rng.dirichlet(np.ones(states), (actions, states)),
        rng.normal(size=(states, actions)),
        discount,
    )


def two_exits():
    """The 4x4 grid of Sutton and Barto's Example 4.1: every step costs 1, two opposite corners end."""
    return GridWorld(
        "E...\n....\n....\n...E", legend={"E": Cell(ends=True)}, step_reward=-1
    ).mdp(1.0)


def test_random_walk_of_example_4_1():
    """Sutton and Barto (2018), Fig. 4.1: values of the uniform policy after k sweeps, and in the end."""
    mdp = two_exits()
    uniform = policies.uniform(16, 4)
    published = {
        1: [0.0, -1.0, -1.0, -1.0],
        2: [0.0, -1.7, -2.0, -2.0],
        3: [0.0, -2.4, -2.9, -3.0],
        10: [0.0, -6.1, -8.4, -9.0],
    }
    for sweeps, first_row in published.items():
        with pytest.warns(ConvergenceWarning):
            found = iterative_policy_evaluation(mdp, uniform, max_iterations=sweeps)
        np.testing.assert_allclose(
            found.values[:4], first_row, atol=0.0501
        )  # printed to one decimal, cut or rounded
    expected = [
        0,
        -14,
        -20,
        -22,
        -14,
        -18,
        -20,
        -20,
        -20,
        -20,
        -18,
        -14,
        -22,
        -20,
        -14,
        0,
    ]
    np.testing.assert_allclose(policy_evaluation(mdp, uniform), expected, atol=1e-9)


def test_walk_with_jumps_of_example_3_5():
    """Sutton and Barto (2018), Fig. 3.2: uniform policy, discount 0.9, two cells that jump and pay."""
    moves = ((-1, 0), (0, 1), (1, 0), (0, -1))
    transitions, rewards = np.zeros((4, 25, 25)), np.zeros((25, 4))
    for state in range(25):
        for action, (down, right) in enumerate(moves):
            row, column = state // 5 + down, state % 5 + right
            if state in (1, 3):
                transitions[action, state, {1: 21, 3: 13}[state]] = 1
                rewards[state, action] = {1: 10, 3: 5}[state]
            elif 0 <= row < 5 and 0 <= column < 5:
                transitions[action, state, 5 * row + column] = 1
            else:
                transitions[action, state, state] = 1
                rewards[state, action] = -1
    mdp = FiniteMDP(transitions, rewards, 0.9)
    published = [
        [3.3, 8.8, 4.4, 5.3, 1.5],
        [1.5, 3.0, 2.3, 1.9, 0.5],
        [0.1, 0.7, 0.7, 0.4, -0.4],
        [-1.0, -0.4, -0.4, -0.6, -1.2],
        [-1.9, -1.3, -1.2, -1.4, -2.0],
    ]
    values = policy_evaluation(mdp, policies.uniform(25, 4))
    np.testing.assert_allclose(values.reshape(5, 5), published, atol=0.05)
    best = policy_iteration(mdp).values.reshape(5, 5)
    np.testing.assert_allclose(best[0], [22.0, 24.4, 22.0, 19.4, 17.5], atol=0.05)
    np.testing.assert_allclose(best[4], [14.4, 16.0, 14.4, 13.0, 11.7], atol=0.05)


@settings(deadline=None)
@given(st.integers(0, 10_000), st.floats(0, 0.99), st.booleans())
def test_values_solve_the_bellman_equations(seed, discount, stochastic):
    mdp = dirichlet_mdp(seed, discount=discount)
    rng = np.random.default_rng(seed)
    policy = rng.dirichlet(np.ones(3), 8) if stochastic else rng.integers(3, size=8)
    values = policy_evaluation(mdp, policy)
    np.testing.assert_allclose(
        bellman_policy_operator(mdp, policy, values), values, atol=1e-9
    )
    q = policy_action_values(mdp, policy)
    probabilities = policies.probabilities(policy, 8, 3)
    np.testing.assert_allclose(
        (probabilities * q).sum(axis=1), values, atol=1e-9
    )  # Eq. (2.6)
    np.testing.assert_allclose(
        (probabilities * advantage(mdp, policy)).sum(axis=1), 0, atol=1e-9
    )  # of Eq. (2.8)


@settings(deadline=None)
@given(st.integers(0, 10_000), st.floats(0.1, 0.95), st.sampled_from([1.0, 1e-2, 1e-5]))
def test_sweeps_stop_within_the_tolerance(seed, discount, tolerance):
    mdp = dirichlet_mdp(seed, discount=discount)
    policy = np.random.default_rng(seed).integers(3, size=8)
    found = iterative_policy_evaluation(mdp, policy, tolerance=tolerance, record=True)
    assert abs(found.values - policy_evaluation(mdp, policy)).max() <= tolerance
    assert found.history.shape == (found.iterations + 1, 8)
    np.testing.assert_allclose(
        found.history[1:],
        [bellman_policy_operator(mdp, policy, before) for before in found.history[:-1]],
    )


@pytest.mark.parametrize("discount", [0.5, 0.99, 0.9999])
@pytest.mark.parametrize("local", [True, False])
def test_many_states_are_solved_to_rounding(discount, local):
    """Beyond elimination's reach: neighbours only (a long corridor), and successors anywhere."""
    states = 3000
    rng = np.random.default_rng(1)
    away = (
        rng.integers(-1, 2, (states, 3))
        if local
        else rng.integers(0, states, (states, 3))
    )
    reached = np.clip(np.arange(states)[:, None] + away, 0, states - 1)
    probabilities = rng.dirichlet(np.ones(3), states)
    transitions = sp.csr_array(
        (probabilities.ravel(), (np.repeat(np.arange(states), 3), reached.ravel())),
        (states, states),
    )
    mdp = FiniteMDP([transitions], rng.normal(size=(states, 1)), discount)
    values = policy_evaluation(mdp, np.zeros(states, dtype=int))
    wrong = abs(
        bellman_policy_operator(mdp, np.zeros(states, dtype=int), values) - values
    ).max()
    assert wrong <= 1e-13 * max(abs(values).max(), 1)


def test_values_are_the_mean_of_simulated_returns():
    mdp = dirichlet_mdp(0, discount=0.8)
    rng = np.random.default_rng(0)
    policy = rng.dirichlet(np.ones(3), 8)
    walkers = 20_000
    state, total = np.zeros(walkers, dtype=int), np.zeros(walkers)
    for step in range(60):
        action = (
            (rng.random((walkers, 1)) > policy[state].cumsum(axis=1))
            .sum(axis=1)
            .clip(max=2)
        )
        total += 0.8**step * mdp.rewards[state, action]
        reach = mdp.transitions[action, state].cumsum(axis=1)
        state = (rng.random((walkers, 1)) > reach).sum(axis=1).clip(max=7)
    error = total.std() / np.sqrt(walkers)
    assert abs(total.mean() - policy_evaluation(mdp, policy)[0]) < 4 * error


def test_without_discount_a_policy_that_never_ends_has_no_value():
    mdp = two_exits()
    always_up = np.zeros(16, dtype=int)
    with pytest.raises(
        ValueError,
        match=r"must not collect rewards forever where discount is 1, .* state 1 ",
    ):
        policy_evaluation(mdp, always_up)


def test_without_discount_waiting_for_nothing_is_worth_nothing():
    mdp = GridWorld("..G").mdp(1.0)
    np.testing.assert_array_equal(policy_evaluation(mdp, [3, 1, 0]), [0, 1, 0])


def test_optimality_is_recognised():
    """Theorem 2.2, both ways."""
    mdp = dirichlet_mdp(3)
    best = policy_iteration(mdp)
    assert is_optimal(mdp, best.policy)
    np.testing.assert_allclose(
        bellman_optimality_operator(mdp, best.values), best.values, atol=1e-9
    )
    other = best.policy.copy()
    other[2] = (other[2] + 1) % 3
    assert not is_optimal(mdp, other)


@settings(deadline=None)
@given(st.integers(0, 10_000), st.floats(0, 0.95))
def test_optimal_action_values_are_where_the_operator_on_them_rests(seed, discount):
    """Eq. (2.12), written out; its fixed point is Q*, Eqs. (2.9) to (2.11), and it brings any two closer by gamma."""
    mdp = dirichlet_mdp(seed, states=4, discount=discount)
    q, other = np.random.default_rng(seed).normal(size=(2, 4, 3))
    swept = bellman_action_value_operator(mdp, q)
    for s, a in np.ndindex(4, 3):
        ahead = sum(mdp.transitions[a, s, t] * max(q[t]) for t in range(4))
        assert swept[s, a] == pytest.approx(mdp.rewards[s, a] + discount * ahead)
    best = mdp.action_values(policy_iteration(mdp).values)
    np.testing.assert_allclose(
        bellman_action_value_operator(mdp, best), best, atol=1e-8
    )
    gap = abs(swept - bellman_action_value_operator(mdp, other)).max()
    assert gap <= discount * abs(q - other).max() + 1e-12
    with pytest.raises(ValueError, match=r"action_values must have shape \(4, 3\)"):
        bellman_action_value_operator(mdp, q[:, :2])


def test_giving_up_is_said_once_with_the_distance():
    with pytest.warns(
        ConvergenceWarning, match=r"gave up after 3 iterations: .* by 1, where 1e-06"
    ):
        iterative_policy_evaluation(two_exits(), np.full(16, 2), max_iterations=3)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        iterative_policy_evaluation(dirichlet_mdp(0), np.zeros(8, dtype=int))


@settings(max_examples=5, deadline=None)
@given(
    st.sampled_from(
        [
            {"tolerance": 0},
            {"tolerance": -1.0},
            {"max_iterations": 0},
            {"start": np.zeros(3)},
        ]
    )
)
def test_wrong_options_are_refused(options):
    with pytest.raises(ValueError, match=next(iter(options))):
        iterative_policy_evaluation(dirichlet_mdp(0), np.zeros(8, dtype=int), **options)


GRID = GridWorld("..G")


@pytest.mark.parametrize(
    "call",
    [
        *(
            value_iteration,
            policy_iteration,
            modified_policy_iteration,
            in_place_value_iteration,
            prioritized_sweeping,
        ),
        generalized_policy_iteration,
        *(
            lambda grid, f=f: f(grid, [1, 1, 0])
            for f in (policy_evaluation, iterative_policy_evaluation)
        ),
        *(
            lambda grid, f=f: f(grid, [1, 1, 0])
            for f in (policy_action_values, advantage, is_optimal)
        ),
        lambda grid: bellman_policy_operator(grid, [1, 1, 0], np.zeros(3)),
        lambda grid: bellman_optimality_operator(grid, np.zeros(3)),
        lambda grid: backward_induction(grid, 3),
        lambda grid: finite_horizon_evaluation(grid, [1, 1, 0], 3),
    ],
)
def test_a_grid_is_no_model_yet(call):
    with pytest.raises(TypeError, match="mdp must be FiniteMDP, got GridWorld"):
        call(GRID)
