"""Episodes, discrete spaces, policies as choosers."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import spaces
from hypothesis import given, settings
from hypothesis import strategies as st

from robonav.mdp import discounted_return, rollouts
from robonav.mdp.interaction import chooser, count, number, numbered

REWARDS = st.lists(st.floats(-10, 10), min_size=1, max_size=30)


@settings(deadline=None)
@given(REWARDS, st.floats(0, 1))
def test_discounted_return_is_the_sum_of_its_definition(rewards, discount):
    expected = [
        sum(discount**later * reward for later, reward in enumerate(rewards[step:])) for step in range(len(rewards))
    ]
    np.testing.assert_allclose(discounted_return(rewards, discount), expected, atol=1e-9)


def test_discounted_return_of_nothing_is_nothing():
    assert discounted_return([], 0.9).shape == (0,)


@pytest.mark.parametrize(
    "space",
    [
        spaces.Discrete(5),
        spaces.Discrete(5, start=-2),
        spaces.MultiDiscrete([3, 4, 2]),
        spaces.Tuple([spaces.Discrete(3), spaces.Discrete(4, start=1), spaces.MultiDiscrete([2, 2])]),
    ],
)
def test_every_element_of_a_space_gets_its_own_number(space):
    space.seed(0)
    size = count("space", space)
    seen = {}
    for _ in range(60 * size):
        element = space.sample()
        seen.setdefault(number(space, element), set()).add(str(element))
    assert sorted(seen) == list(range(size))
    assert all(len(elements) == 1 for elements in seen.values())


def test_frozen_lake_is_left_alone_and_blackjack_is_numbered():
    lake = gym.make("FrozenLake-v1")
    assert numbered(lake) is lake
    blackjack = numbered(gym.make("Blackjack-v1"))
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


def test_an_endless_episode_is_cut_off():
    (episode,) = rollouts(Shifted(), [0, 0], 1, max_steps=7, seed=0)
    assert len(episode.actions) == 7
    assert len(episode.states) == 8
    assert not episode.terminated


@pytest.mark.parametrize("env", [gym.make("CartPole-v1"), gym.make_vec("FrozenLake-v1", num_envs=2), "FrozenLake-v1"])
def test_what_is_not_discrete_is_refused(env):
    with pytest.raises(TypeError, match="env"):
        rollouts(env, [0], 1, seed=0)


def test_a_stochastic_policy_draws_as_often_as_it_says():
    policy = np.array([[0.2, 0.5, 0.3], [0.0, 0.0, 1.0]])
    choose = chooser(policy, 2, 3, np.random.default_rng(0))
    drawn = np.bincount([choose(0) for _ in range(30_000)], minlength=3) / 30_000
    np.testing.assert_allclose(drawn, policy[0], atol=0.01)
    assert {choose(1) for _ in range(1000)} == {2}


def test_frozen_lake_without_slipping_is_walked_to_the_goal():
    lake = gym.make("FrozenLake-v1", is_slippery=False)
    path = [1, 0, 0, 0, 1, 0, 0, 0, 2, 1, 0, 0, 0, 2, 2, 0]  # down, down, right, down, right, right
    (episode,) = rollouts(lake, path, 1, seed=0)
    assert episode.states.tolist() == [0, 4, 8, 9, 13, 14, 15]
    assert episode.rewards.sum() == 1


def test_rollouts_reproduce():
    lake = gym.make("FrozenLake-v1")
    policy = np.full((16, 4), 0.25)
    first, again, other = (rollouts(lake, policy, 20, seed=seed) for seed in (5, 5, 6))
    assert [e.states.tolist() for e in first] == [e.states.tolist() for e in again]
    assert [e.states.tolist() for e in first] != [e.states.tolist() for e in other]
