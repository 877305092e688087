"""Monte Carlo prediction and control."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import spaces

from robonav.mdp import (
    FiniteMDP,
    linear_decay,
    monte_carlo_control,
    monte_carlo_prediction,
    rollouts,
)

VISITS = ["first", "every"]


class Loop(gym.Env):
    """Singh and Sutton's example: from state 0 back to 0 with probability p, to the end otherwise; each step pays 1."""

    observation_space, action_space = spaces.Discrete(2), spaces.Discrete(1)
    p = 0.7

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        return 0, {}

    def step(self, action):
        ended = self.np_random.random() >= self.p
        return int(ended), 1.0, ended, False, {}


class Script(gym.Env):
    """Passes the states 0, 1, 0, 2, 0, 1 with rewards 1, 2, 4, 8, 16, 32, then ends in state 3."""

    observation_space, action_space = spaces.Discrete(4), spaces.Discrete(1)
    states = (0, 1, 0, 2, 0, 1, 3)

    def reset(self, *, seed=None, options=None):
        self.at = 0
        return 0, {}

    def step(self, action):
        self.at += 1
        return self.states[self.at], 2.0 ** (self.at - 1), self.at == 6, False, {}


def test_visits_counted_by_hand():
    """The return from step t on is 64 - 2 ** t without discount."""
    first, every = (
        monte_carlo_prediction(Script(), [0] * 4, 1, visit=visit, discount=1.0)
        for visit in VISITS
    )
    assert first.visits.tolist() == [1, 1, 1, 0]
    np.testing.assert_allclose(first.values, [63, 62, 56, np.nan])
    assert every.visits.tolist() == [3, 2, 1, 0]
    np.testing.assert_allclose(
        every.values, [(63 + 60 + 48) / 3, (62 + 32) / 2, 56, np.nan]
    )


@pytest.mark.parametrize("visit", VISITS)
def test_a_constant_rate_takes_the_visits_of_an_episode_in_their_order(visit):
    learned = monte_carlo_control(
        Script(), 1, visit=visit, learning_rate=0.5, discount=1.0
    )
    every = 63 / 8 + 60 / 4 + 48 / 2
    assert learned.q[0, 0] == pytest.approx(63 / 2 if visit == "first" else every)


def test_first_and_every_visit_of_one_episode():
    """After T steps in the loop the first visit's return is T, the mean over every visit (T + 1) / 2."""
    first, every = (
        monte_carlo_prediction(Loop(), [0, 0], 1, visit=visit, discount=1.0, seed=4)
        for visit in VISITS
    )
    steps = every.visits[0]
    assert steps > 2
    assert first.values[0] == steps
    assert every.values[0] == pytest.approx((steps + 1) / 2)
    assert first.visits.tolist() == [1, 0]
    assert every.visits[1] == 0
    assert np.isnan(first.values[1])


@pytest.mark.parametrize("visit", VISITS)
def test_both_tend_to_the_value(visit):
    predicted = monte_carlo_prediction(
        Loop(), [0, 0], 4000, visit=visit, discount=1.0, seed=0
    )
    assert predicted.values[0] == pytest.approx(1 / (1 - Loop.p), rel=0.04)


@pytest.mark.slow
@pytest.mark.parametrize("visit", VISITS)
def test_prediction_agrees_with_the_model_on_frozen_lake(visit):
    lake = gym.make("FrozenLake-v1", max_episode_steps=1000)
    mdp = FiniteMDP.from_gymnasium(lake, 0.9)
    blind = np.zeros(16)
    for _ in range(1000):
        blind = mdp.action_values(blind).mean(axis=1)
    predicted = monte_carlo_prediction(
        lake, np.full((16, 4), 0.25), 12_000, visit=visit, discount=0.9, seed=0
    )
    seen = predicted.visits > 500
    assert seen.sum() >= 8
    np.testing.assert_allclose(predicted.values[seen], blind[seen], atol=0.02)


@pytest.mark.parametrize("visit", VISITS)
def test_control_finds_the_way_over_firm_ice(visit):
    lake = gym.make("FrozenLake-v1", is_slippery=False)
    learned = monte_carlo_control(
        lake, 1500, visit=visit, discount=0.9, epsilon=linear_decay(1, 0.1, 700), seed=0
    )
    (walk,) = rollouts(lake, learned.policy, 1, seed=0)
    assert walk.rewards.sum() == 1
    assert len(walk.actions) == 6
    assert learned.q[0].max() <= 0.9**5 + 1e-12


def test_control_averages_what_followed():
    learned = monte_carlo_control(Loop(), 400, visit="first", discount=1.0, seed=9)
    assert learned.q[0, 0] == pytest.approx(learned.lengths.mean())
    assert learned.visits[0, 0] == 400


def test_a_constant_rate_weighs_new_returns_more():
    learned = monte_carlo_control(Loop(), 3, learning_rate=0.5, discount=1.0, seed=9)
    one, two, three = learned.lengths
    assert learned.q[0, 0] == pytest.approx(0.125 * one + 0.25 * two + 0.5 * three)


@pytest.mark.slow
def test_blackjack_is_learned_better_than_by_chance():
    table = gym.make("Blackjack-v1", sab=True)
    learned = monte_carlo_control(table, 8_000, discount=1.0, seed=0)
    hold, hit = learned.q.reshape(32, 11, 2, 2)[20, 1:, 0].T
    assert (hold > hit).all()  # at twenty nobody draws a card


class Switch(gym.Env):
    """Every step ends the episode; action 1 pays, action 0 does not."""

    observation_space, action_space = spaces.Discrete(1), spaces.Discrete(2)

    def reset(self, *, seed=None, options=None):
        return 0, {}

    def step(self, action):
        return 0, float(action), True, False, {}


def test_exploring_follows_its_schedule_over_episodes():
    learned = monte_carlo_control(
        Switch(), 200, epsilon=lambda n: float(n < 100), seed=0
    )
    assert 20 < learned.returns[:100].sum() < 80
    assert (learned.returns[100:] == 1).all()


def test_seeds_reproduce():
    first, again, other = (
        monte_carlo_control(Loop(), 50, seed=seed, record=True) for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(first.history, again.history)
    assert (first.lengths != other.lengths).any()
    assert first.history.shape == (51, 2, 1)
    predicted = monte_carlo_prediction(Loop(), [0, 0], 50, seed=1, record=True)
    assert predicted.history.shape == (51, 2)


def test_visit_is_first_or_every():
    with pytest.raises(ValueError, match="visit must be one of first, every"):
        monte_carlo_control(Loop(), 1, visit="last")
    with pytest.raises(ValueError, match="visit must be one of first, every"):
        monte_carlo_prediction(Loop(), [0, 0], 1, visit="last")
