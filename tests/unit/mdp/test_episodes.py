"""Episodes, discrete spaces, policies as choosers."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import spaces
from hypothesis import given, settings
from hypothesis import strategies as st

from robonav.mdp import (
    OneHot,
    discounted_return,
    linear_q_learning,
    linear_sarsa,
    monte_carlo_prediction,
    q_learning,
    rollouts,
    sarsa,
    td_prediction,
)
from robonav.mdp.discrete_spaces import discretise_spaces, element, number, space_size
from robonav.mdp.episodes import policy_sampler

REWARDS = st.lists(st.floats(-10, 10), min_size=1, max_size=30)


@settings(deadline=None)
@given(REWARDS, st.floats(0, 1))
def test_discounted_return_is_the_sum_of_its_definition(rewards, discount):
    expected = [
        sum(discount**later * reward for later, reward in enumerate(rewards[step:]))
        for step in range(len(rewards))
    ]
    np.testing.assert_allclose(
        discounted_return(rewards, discount), expected, atol=1e-9
    )


def drawn_as(element):
    """An element of a discrete space as text, whatever its numbers are kept in."""
    return (
        " ".join(str(part) for piece in element for part in np.ravel(piece))
        if np.iterable(element)
        else str(element)
    )


def test_discounted_return_of_nothing_is_nothing():
    assert discounted_return([], 0.9).shape == (0,)


@pytest.mark.parametrize(
    "space",
    [
        spaces.Discrete(5),
        spaces.Discrete(5, start=-2),
        spaces.MultiDiscrete([3, 4, 2]),
        spaces.Tuple(
            [
                spaces.Discrete(3),
                spaces.Discrete(4, start=1),
                spaces.MultiDiscrete([2, 2]),
            ]
        ),
    ],
)
def test_every_element_of_a_space_gets_its_own_number(space):
    space.seed(0)
    size = space_size("space", space)
    seen = {}
    for _ in range(60 * size):
        drawn = space.sample()
        seen.setdefault(number(space, drawn), set()).add(drawn_as(drawn))
    assert sorted(seen) == list(range(size))
    assert all(len(elements) == 1 for elements in seen.values())
    for place, elements in seen.items():
        assert space.contains(element(space, place))
        assert elements == {drawn_as(element(space, place))}


def test_frozen_lake_is_left_alone_and_blackjack_is_wrapped():
    lake = gym.make("FrozenLake-v1")
    assert discretise_spaces(lake) is lake
    blackjack = discretise_spaces(gym.make("Blackjack-v1"))
    assert blackjack.observation_space == spaces.Discrete(32 * 11 * 2)
    state, _ = blackjack.reset(seed=1)
    assert blackjack.observation_space.contains(state)


class Shifted(gym.Env):
    """States and actions that start at 10: action 11 ends the episode with reward 1."""

    observation_space = spaces.Discrete(2, start=10)
    action_space = spaces.Discrete(2, start=10)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        return 10, {}

    def step(self, action):
        assert self.action_space.contains(action)
        return 11, float(action - 10), action == 11, False, {}


def test_states_and_actions_may_start_anywhere():
    (episode,) = rollouts(Shifted(), [1, 1], 1, seed=0)
    assert episode.states.tolist() == [0, 1]
    assert episode.rewards.tolist() == [1]
    assert episode.terminated


class TwoWheels(gym.Env):
    """An action is a pair; the episode ends when both parts are at their largest, with the reward 10 a + b."""

    observation_space = spaces.Discrete(1)

    def __init__(self, action_space):
        self.action_space = action_space

    def reset(self, *, seed=None, options=None):
        return 0, {}

    def step(self, action):
        assert self.action_space.contains(action)
        one, other = map(int, action)
        return 0, float(10 * one + other), (one, other) == (1, 2), False, {}


@pytest.mark.parametrize(
    "actions",
    [
        spaces.MultiDiscrete([2, 3]),
        spaces.Tuple([spaces.Discrete(2), spaces.Discrete(3)]),
    ],
)
def test_actions_may_have_several_parts(actions):
    earned = [
        rollouts(TwoWheels(actions), [a], 1, max_steps=1, seed=0)[0].rewards[0]
        for a in range(6)
    ]
    assert earned == [0, 1, 2, 10, 11, 12]
    learned = q_learning(
        TwoWheels(actions), 200, discount=0.0, epsilon=1.0, learning_rate=1.0, seed=0
    )
    assert learned.q.tolist() == [earned]


class SeedKeeper(gym.Env):
    """Writes down the seeds it is given."""

    observation_space, action_space = spaces.Discrete(1), spaces.Discrete(1)

    def __init__(self):
        self.seeds = []

    def reset(self, *, seed=None, options=None):
        self.seeds += [] if seed is None else [seed]
        return 0, {}

    def step(self, action):
        return 0, 0.0, True, False, {}


@pytest.mark.parametrize("seed", [0, 1, 7])
def test_a_policy_is_never_tested_on_the_episodes_it_was_learned_from(seed):
    learning, testing = SeedKeeper(), SeedKeeper()
    for learn in (q_learning, sarsa):
        learn(learning, 1, seed=seed)
    for learn in (linear_q_learning, linear_sarsa):
        learn(learning, 1, OneHot(1, 1), seed=seed)
    for predict in (td_prediction, monte_carlo_prediction):
        predict(learning, [0], 1, seed=seed)
    for other in range(50):
        rollouts(testing, [0], 1, seed=other)
    assert not set(learning.seeds) & set(testing.seeds)
    assert max(learning.seeds) < min(testing.seeds)


def test_an_endless_episode_is_cut_off():
    (episode,) = rollouts(Shifted(), [0, 0], 1, max_steps=7, seed=0)
    assert len(episode.actions) == 7
    assert len(episode.states) == 8
    assert not episode.terminated


@pytest.mark.parametrize(
    "env",
    [
        gym.make("CartPole-v1"),
        gym.make_vec("FrozenLake-v1", num_envs=2),
        "FrozenLake-v1",
    ],
)
def test_what_is_not_discrete_is_refused(env):
    with pytest.raises(TypeError, match="env"):
        rollouts(env, [0], 1, seed=0)


def test_a_stochastic_policy_draws_as_often_as_it_says():
    policy = np.array([[0.2, 0.5, 0.3], [0.0, 0.0, 1.0]])
    choose = policy_sampler(policy, 2, 3, np.random.default_rng(0))
    drawn = np.bincount([choose(0) for _ in range(30_000)], minlength=3) / 30_000
    np.testing.assert_allclose(drawn, policy[0], atol=0.01)
    assert {choose(1) for _ in range(1000)} == {2}


def test_frozen_lake_without_slipping_is_walked_to_the_goal():
    lake = gym.make("FrozenLake-v1", is_slippery=False)
    path = [
        1,
        0,
        0,
        0,
        1,
        0,
        0,
        0,
        2,
        1,
        0,
        0,
        0,
        2,
        2,
        0,
    ]  # down, down, right, down, right, right
    (episode,) = rollouts(lake, path, 1, seed=0)
    assert episode.states.tolist() == [0, 4, 8, 9, 13, 14, 15]
    assert episode.rewards.sum() == 1


def test_rollouts_reproduce():
    lake = gym.make("FrozenLake-v1")
    policy = np.full((16, 4), 0.25)
    first, again, other = (rollouts(lake, policy, 20, seed=seed) for seed in (5, 5, 6))
    assert [e.states.tolist() for e in first] == [e.states.tolist() for e in again]
    assert [e.states.tolist() for e in first] != [e.states.tolist() for e in other]
