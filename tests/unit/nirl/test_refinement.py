"""MAP refinement on made-up demonstrations that contradict themselves (Eq. (5.12)), and the Boltzmann policy (5.10)."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from robonav.nirl import boltzmann_policy, map_uniform_prior, most_frequent

# State 7: action 0 ten times, action 1 twice. Action 0 is common elsewhere, action 1 stands nowhere else.
STATES = np.array([7] * 12 + [3] * 90)
SHOWN = np.array([0] * 10 + [1] * 2 + [0] * 90)


def test_counting_takes_the_most_frequent_action():
    refined = most_frequent(STATES, SHOWN, 5)
    assert set(refined.actions) == {0}
    assert refined.changed.sum() == 2
    assert (refined.states, refined.inconsistent) == (2, 1)


def test_the_likelihood_alone_takes_the_rare_action():
    """P(state 7 | action 1) = 1 and P(state 7 | action 0) = 0.1: ten right labels are turned into wrong ones."""
    refined = map_uniform_prior(STATES, SHOWN, 5)
    assert set(refined.actions[STATES == 7]) == {1}
    assert set(refined.actions[STATES == 3]) == {0}
    assert refined.changed.sum() == 10


def test_states_of_several_numbers():
    states = np.array([[0, 1], [0, 1], [0, 1], [1, 0]])
    refined = most_frequent(states, [2, 2, 4, 4], 5)
    assert refined.actions.tolist() == [2, 2, 2, 4]


@settings(deadline=None)
@given(
    arrays(np.int64, 30, elements=st.integers(0, 4)),
    arrays(np.int64, 30, elements=st.integers(0, 4)),
)
def test_refined_demonstrations_are_consistent_and_stay_so(states, actions):
    once = most_frequent(states, actions, 5)
    for state in set(states):
        mine = once.actions[states == state]
        assert len(set(mine)) == 1
        assert (actions[states == state] == mine[0]).sum() == np.bincount(
            actions[states == state]
        ).max()
    again = most_frequent(states, once.actions, 5)
    assert not again.changed.any()
    assert again.inconsistent == 0


def test_nothing_to_refine_gets_a_sentence():
    with pytest.raises(
        ValueError, match="actions must hold at least one step, got none"
    ):
        most_frequent(np.empty((0, 3), dtype=int), [], 5)
    with pytest.raises(
        ValueError, match="actions must lie between 0 and 4, got 0 to 6"
    ):
        most_frequent([1, 1], [0, 6], 5)


def test_boltzmann_by_hand():
    np.testing.assert_allclose(
        boltzmann_policy([[0.0, np.log(2)]], 1.0), [[1 / 3, 2 / 3]]
    )
    np.testing.assert_allclose(
        boltzmann_policy([[0.0, np.log(2)]], 2.0), [[1 / 5, 4 / 5]]
    )
    np.testing.assert_allclose(boltzmann_policy([[0.3, 5.0, -9.0]], 0.0), [[1 / 3] * 3])


@settings(deadline=None)
@given(arrays(float, (2, 5), elements=st.floats(-50, 50)), st.floats(0, 1000))
def test_boltzmann_is_a_distribution_that_ranks_like_its_values(q, eta):
    action_probabilities = boltzmann_policy(q, eta)
    np.testing.assert_allclose(action_probabilities.sum(axis=1), 1)
    assert (
        action_probabilities.max(axis=1)
        == action_probabilities[range(2), q.argmax(axis=1)]
    ).all()


def test_eta_must_not_be_negative():
    with pytest.raises(ValueError, match="inverse_temperature must be at least 0"):
        boltzmann_policy([[1.0, 2.0]], -1.0)
