"""The finite MDP: what it accepts, what it computes from its arrays, and Gymnasium's tables."""

from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from robonav.mdp import FiniteMDP, expected_rewards, value_iteration


def random_mdp(seed, *, states=6, actions=3, discount=0.9, sparse=False, spread=1.0):
    """A dense random model; ``spread`` below 1 leaves few likely successors."""
    rng = np.random.default_rng(seed)
    transitions = rng.dirichlet(np.full(states, spread), size=(actions, states))
    rewards = rng.normal(size=(states, actions))
    return FiniteMDP(
        [sp.csr_array(t) for t in transitions] if sparse else transitions,
        rewards,
        discount,
    )


def brute_backup(transitions, rewards, discount, values):
    """Eq. (2.15) as it is written, sum by sum."""
    actions, states, _ = transitions.shape
    q = np.zeros((states, actions))
    for s in range(states):
        for a in range(actions):
            q[s, a] = rewards[s, a] + discount * sum(
                transitions[a, s, t] * values[t] for t in range(states)
            )
    return q


@settings(deadline=None)
@given(st.integers(0, 10_000), st.booleans(), st.floats(0, 0.99))
def test_backup_is_the_equation(seed, sparse, discount):
    dense = random_mdp(seed, discount=discount)
    mdp = random_mdp(seed, discount=discount, sparse=sparse)
    values = np.random.default_rng(seed).normal(size=mdp.n_states)
    expected = brute_backup(dense.transitions, dense.rewards, discount, values)
    np.testing.assert_allclose(mdp.action_values(values), expected, atol=1e-12)
    assert (mdp.greedy(values) == expected.argmax(axis=1)).all()


@settings(deadline=None)
@given(st.integers(0, 10_000), st.booleans())
def test_chain_of_a_policy_averages_over_its_actions(seed, sparse):
    mdp = random_mdp(seed, sparse=sparse)
    rng = np.random.default_rng(seed)
    probabilities = rng.dirichlet(np.ones(mdp.n_actions), size=mdp.n_states)
    dense = random_mdp(seed).transitions
    transitions, rewards = mdp.induced_chain(probabilities)
    np.testing.assert_allclose(
        transitions.toarray(), np.einsum("sa,ast->st", probabilities, dense), atol=1e-12
    )
    np.testing.assert_allclose(rewards, (probabilities * mdp.rewards).sum(axis=1))
    actions = rng.integers(mdp.n_actions, size=mdp.n_states)
    transitions, rewards = mdp.induced_chain(actions)
    np.testing.assert_array_equal(
        transitions.toarray(), dense[actions, np.arange(mdp.n_states)]
    )
    np.testing.assert_array_equal(
        rewards, mdp.rewards[np.arange(mdp.n_states), actions]
    )


@pytest.mark.parametrize(
    "form", [sp.csr_matrix, sp.csr_array, sp.coo_array, sp.lil_matrix, sp.csc_array]
)
def test_every_sparse_form_serves(form):
    dense = random_mdp(3, spread=0.1).transitions
    dense = np.where(dense < 1e-3, 0, dense)
    dense /= dense.sum(axis=2, keepdims=True)
    mdp = FiniteMDP([form(t) for t in dense], np.zeros((6, 3)), 0.9)
    np.testing.assert_array_equal(
        mdp.rows.toarray(), dense.swapaxes(0, 1).reshape(-1, 6)
    )
    assert mdp.is_sparse
    assert len(mdp.transitions) == mdp.n_actions == 3


def test_wide_indices_serve_too():
    narrow = random_mdp(4, sparse=True)
    wide = [
        sp.csr_array((t.data, t.indices.astype(np.int64), t.indptr.astype(np.int64)))
        for t in narrow.transitions
    ]
    solution = value_iteration(FiniteMDP(wide, narrow.rewards, narrow.discount))
    np.testing.assert_array_equal(solution.values, value_iteration(narrow).values)


def test_later_changes_of_the_arrays_given_do_not_reach_it():
    transitions, rewards = np.eye(2)[None].copy(), np.zeros((2, 1))
    mdp = FiniteMDP(transitions, rewards, 0.5)
    transitions[0] = 0.5
    rewards[:] = 1
    assert (mdp.transitions == np.eye(2)).all()
    assert (mdp.rewards == 0).all()
    with pytest.raises(ValueError, match="read-only"):
        mdp.rewards[0, 0] = 1
    with pytest.raises(ValueError, match="read-only"):
        mdp.transitions[0, 0, 0] = 1


HALF, STAY = np.full((1, 2, 2), 0.5), np.eye(2)[None]


@pytest.mark.parametrize(
    ("transitions", "rewards", "discount", "sentence"),
    [
        (0.9 * STAY, [[0], [0]], 0.9, r"must sum to 1 .* got 0.9 at action 0, state 0"),
        (
            [sp.csr_array(STAY[0]), sp.csr_array([[1, 0], [0.5, 0.4]])],
            np.zeros((2, 2)),
            0.9,
            "action 1, state 1",
        ),
        ([[[1.5, -0.5], [0, 1]]], [[0], [0]], 0.9, "negative probabilities"),
        (
            [sp.csr_array([[1.5, -0.5], [0, 1]])],
            [[0], [0]],
            0.9,
            "negative probabilities",
        ),
        (HALF, [[0, 0]], 0.9, r"rewards must have shape \(2, 1\), got \(1, 2\)"),
        (HALF, [[np.nan], [0]], 0.9, "rewards must hold finite"),
        ([[[np.inf, 0], [0, 1]]], [[0], [0]], 0.9, "transitions must hold finite"),
        (
            [sp.csr_array([[np.nan, 0], [0, 1]])],
            [[0], [0]],
            0.9,
            "transitions must hold finite",
        ),
        (np.eye(2), [[0], [0]], 0.9, r"transitions must have shape \(A, S, S\)"),
        (
            np.ones((1, 2, 3)) / 3,
            [[0], [0]],
            0.9,
            r"transitions must have shape \(A, S, S\), got \(1, 2, 3\)",
        ),
        (
            [sp.eye_array(2), sp.eye_array(3)],
            np.zeros((2, 2)),
            0.9,
            r"got \(3, 3\) at action 1",
        ),
        (np.zeros((0, 2, 2)), np.zeros((2, 0)), 0.9, "at least one action"),
        (HALF, [[0], [0]], 1.1, "discount must be at least 0 and at most 1, got 1.1"),
        (HALF, [[0], [0]], np.nan, "discount must be finite"),
        (HALF, [[0], [0]], 1, "state 0 unable"),
        (STAY, [[0], [1]], 1, "terminal state .* got 1 with state 1 unable"),
    ],
)
def test_wrong_models_are_refused_in_one_sentence(
    transitions, rewards, discount, sentence
):
    with pytest.raises(ValueError, match=sentence):
        FiniteMDP(transitions, rewards, discount)


@pytest.mark.parametrize(
    "transitions", [sp.eye_array(2), [sp.eye_array(2), np.eye(2)], "nonsense"]
)
def test_wrong_types_are_refused(transitions):
    with pytest.raises(TypeError, match="transitions must"):
        FiniteMDP(transitions, np.zeros((2, 1)), 0.9)


def test_rewards_of_the_state_reached_are_averaged():
    transitions = random_mdp(5).transitions
    reached = np.random.default_rng(5).normal(size=transitions.shape)
    expected = np.einsum("ast,ast->sa", transitions, reached)
    np.testing.assert_allclose(expected_rewards(transitions, reached), expected)
    np.testing.assert_allclose(
        expected_rewards([sp.csr_array(t) for t in transitions], reached), expected
    )


def test_stopping_distance_at_both_ends():
    mdp = random_mdp(0, discount=0.5)
    assert mdp.residual_for(0.1) == pytest.approx(0.05)
    assert random_mdp(0, discount=0).residual_for(0.1) == np.inf


@pytest.mark.parametrize("values", [[np.nan, 0, 0, 0, 0, 0], [0.0] * 5, "values"])
def test_values_are_checked(values):
    with pytest.raises((ValueError, TypeError), match="values must"):
        random_mdp(0).greedy(values)


@pytest.mark.parametrize("discount", [0, 0.5, 1])
@pytest.mark.parametrize("tolerance", [-1, 0, np.nan])
def test_the_stopping_distance_is_of_a_tolerance(discount, tolerance):
    mdp = FiniteMDP(STAY, [[0], [0]], discount)
    with pytest.raises(ValueError, match="tolerance must be"):
        mdp.residual_for(tolerance)


def test_tables_of_gymnasium_become_models():
    mdp = FiniteMDP.from_gymnasium(gym.make("FrozenLake-v1", is_slippery=True), 0.9)
    assert (mdp.n_states, mdp.n_actions) == (16, 4)
    assert np.flatnonzero(mdp.terminal).tolist() == [5, 7, 11, 12, 15]
    assert mdp.rewards[14, 2] == pytest.approx(1 / 3)  # right, from beside the goal
    np.testing.assert_allclose(
        mdp.transitions[0].toarray()[0, [0, 4]], [2 / 3, 1 / 3]
    )  # left, in the corner


END, ON = (1.0, 0, 1.0, True), (1.0, 0, 0.0, False)


@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        (
            {0: {0: [END], 1: [ON]}},
            "always or never: .* got state 0, in which it may end and may go on",
        ),
        ({}, "as many actions in every state, and for at least one"),
        ({0: {}}, "as many actions in every state"),
        ({0: {0: [END]}, 1: {0: [END], 1: [END]}}, "as many actions in every state"),
        ({1: {0: [END]}}, "numbered from 0"),
        ({0: {1: [END]}}, "numbered from 0"),
        ({0: 5}, "numbered from 0"),
        ({0: {0: [(1.0, 4, 0.0, True)]}}, "states from 0 to 0, got 4"),
    ],
)
def test_tables_that_make_no_model_are_refused(table, sentence):
    with pytest.raises(ValueError, match=sentence):
        FiniteMDP.from_gymnasium(SimpleNamespace(P=table), 0.9)


def test_a_goal_passed_on_from_where_nobody_comes_is_an_end_all_the_same():
    """State 1 ends the episode that begins in 0. Only from 2, where no episode passes, would it go on."""
    table = {
        0: {0: [(1.0, 1, 1.0, True)]},
        1: {0: [(1.0, 0, 0.0, False)]},
        2: {0: [(1.0, 1, 0.0, False)]},
    }
    env = SimpleNamespace(P=table, initial_state_distrib=np.array([1.0, 0, 0]))
    assert FiniteMDP.from_gymnasium(env, 0.9).terminal.tolist() == [False, True, False]
    env.initial_state_distrib = np.array([0.5, 0, 0.5])
    with pytest.raises(
        ValueError, match="got state 1, in which it may end and may go on"
    ):
        FiniteMDP.from_gymnasium(env, 0.9)


def test_a_taxi_whose_passenger_changes_their_mind_is_refused():
    with pytest.raises(ValueError, match="fickle passenger is not in it"):
        FiniteMDP.from_gymnasium(gym.make("Taxi-v4", fickle_passenger=True), 0.9)


def test_an_environment_without_a_table_is_refused():
    with pytest.raises(ValueError, match="publish its transitions"):
        FiniteMDP.from_gymnasium(gym.make("CartPole-v1"), 0.9)


@pytest.mark.parametrize("kind", [np.asarray, sp.csr_matrix, sp.csr_array])
def test_an_array_of_matrices_as_objects_is_taken(kind):
    """As pymdptoolbox's ``mdptoolbox.example.forest`` and its kind make them."""
    mdp = random_mdp(3)
    matrices = np.empty(3, dtype=object)
    for action, matrix in enumerate(mdp.transitions):
        matrices[action] = kind(matrix)
    taken = FiniteMDP(matrices, mdp.rewards, mdp.discount)
    assert np.array_equal(taken.by_action.toarray(), mdp.by_action.toarray())
    matrices[1] = "text"
    with pytest.raises(TypeError, match="transitions must"):
        FiniteMDP(matrices, mdp.rewards, mdp.discount)


def test_a_forbidden_action_is_a_copy_of_an_allowed_one():
    """The documented form gives the values of the allowed actions alone; the form of other packages is refused."""
    mdp = random_mdp(4)
    forbidden = np.random.default_rng(4).random((6, 3)) < 0.5
    forbidden[np.arange(6), np.arange(6) % 3] = False
    transitions, rewards = mdp.transitions.copy(), mdp.rewards.copy()
    for state, action in np.argwhere(forbidden):
        transitions[action, state] = mdp.transitions[state % 3, state]
        rewards[state, action] = mdp.rewards[state, state % 3]
    found = value_iteration(FiniteMDP(transitions, rewards, 0.9), tolerance=1e-10)
    values = np.zeros(6)
    for _ in range(500):
        q = mdp.action_values(values)
        values = np.where(forbidden, -np.inf, q).max(axis=1)
    assert np.allclose(found.values, values, atol=1e-8)
    with pytest.raises(ValueError, match=r"got minus infinity.*the reward of an allow"):
        FiniteMDP(
            mdp.transitions, np.where(forbidden, -np.inf, mdp.rewards), discount=0.9
        )
