"""Linear function approximation (Algorithm 7) and its features."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import spaces
from hypothesis import given, settings
from hypothesis import strategies as st

from robonav.mdp import (
    OneHot,
    Tiles,
    linear_q_learning,
    linear_sarsa,
    q_learning,
    rollouts,
    sarsa,
    with_bias,
)

UNIT = st.floats(0, 1)


def test_one_hot_is_one_number_for_each_pair():
    features = OneHot(3, 2)
    assert features(1).tolist() == [[0, 1, 0, 0, 0, 0], [0, 0, 0, 0, 1, 0]]
    assert with_bias(features)(1)[:, 0].tolist() == [1, 1]
    assert with_bias(features)(1).shape == (2, 7)


@pytest.mark.parametrize(
    ("linear", "tabular"), [(linear_sarsa, sarsa), (linear_q_learning, q_learning)]
)
def test_with_one_feature_a_pair_it_is_the_table(linear, tabular):
    cliff = gym.make("CliffWalking-v1")
    options = {"learning_rate": 0.5, "discount": 0.97, "seed": 3, "record": True}
    weights = linear(cliff, 40, OneHot(48, 4), **options)
    table = tabular(cliff, 40, **options)
    np.testing.assert_array_equal(weights.lengths, table.lengths)
    np.testing.assert_allclose(weights.q(range(48)), table.q, atol=1e-12)
    np.testing.assert_allclose(weights.history[-1], weights.weights)
    assert weights.history.shape == (41, 192)


def test_the_constant_is_a_weight_like_the_others():
    """One step, reward -1, all values 0 before: each active feature, f_0 included, moves by alpha * delta."""
    cliff = gym.make("CliffWalking-v1")
    learned = linear_sarsa(
        cliff, 1, with_bias(OneHot(48, 4)), learning_rate=0.1, max_steps=1, seed=0
    )
    moved = learned.weights[learned.weights != 0]
    assert learned.weights[0] == pytest.approx(0.1 * learned.returns[0])
    np.testing.assert_allclose(moved, [0.1 * learned.returns[0]] * 2)


class TwoRooms(gym.Env):
    """The step from room 0 leads to room 1, where the episode ends with reward 1."""

    observation_space, action_space = spaces.Discrete(2), spaces.Discrete(1)

    def reset(self, *, seed=None, options=None):
        return 0, {}

    def step(self, action):
        return 1, 1.0, True, False, {}


@pytest.mark.parametrize("learn", [linear_sarsa, linear_q_learning])
def test_what_comes_after_the_end_is_worth_nothing(learn):
    """Both rooms share their one feature, so that looking beyond the end would count the 1 again and again."""
    learned = learn(
        TwoRooms(),
        60,
        lambda state: np.ones((1, 1)),
        learning_rate=0.5,
        discount=1.0,
        seed=0,
    )
    assert learned.weights[0] == pytest.approx(1)


@pytest.mark.parametrize("learn", [linear_sarsa, linear_q_learning])
def test_the_learning_rate_follows_its_schedule_over_episodes(learn):
    """Half of the way to 1, none of it, a quarter of what is left."""
    rates = [0.5, 0.0, 0.25]
    learned = learn(
        TwoRooms(),
        3,
        OneHot(2, 1),
        learning_rate=rates.__getitem__,
        discount=1.0,
        seed=0,
        record=True,
    )
    np.testing.assert_allclose(learned.history[:, 0], [0, 0.5, 0.5, 0.625])


class Switch(gym.Env):
    """Every step ends the episode; action 1 pays, action 0 does not."""

    observation_space, action_space = spaces.Discrete(1), spaces.Discrete(2)

    def reset(self, *, seed=None, options=None):
        return 0, {}

    def step(self, action):
        return 0, float(action), True, False, {}


@pytest.mark.parametrize("learn", [linear_sarsa, linear_q_learning])
def test_exploring_follows_its_schedule_over_episodes(learn):
    """Blind for 100 episodes, then never again: from there on every episode pays."""
    learned = learn(
        Switch(), 200, OneHot(1, 2), epsilon=lambda n: float(n < 100), seed=0
    )
    assert 20 < learned.returns[:100].sum() < 80
    assert (learned.returns[100:] == 1).all()


@pytest.mark.parametrize("learn", [linear_sarsa, linear_q_learning])
def test_features_have_one_length(learn):
    with pytest.raises(
        ValueError,
        match=r"features must give shape \(1, 1\) for every state, .* got \(1, 2\)",
    ):
        learn(TwoRooms(), 1, lambda state: np.ones((1, 1 + state)), seed=0)


@pytest.mark.parametrize(
    ("state", "error", "sentence"),
    [
        (12, ValueError, "state must be at most 9, got 12"),
        (-1, ValueError, "state must be at least 0, got -1"),
        (1.5, TypeError, "state must be a whole number"),
    ],
)
def test_states_that_do_not_exist_have_no_features(state, error, sentence):
    with pytest.raises(error, match=sentence):
        OneHot(10, 4)(state)


@pytest.mark.parametrize("state", [0.3, [0.3], [0.3, 0.3, 0.3], [0.3, np.nan]])
def test_tiles_take_one_number_a_coordinate(state):
    with pytest.raises(ValueError, match="state must"):
        TILES.active(state)


def test_tilings_are_shifted_differently_in_each_direction():
    """A step back along one coordinate and on along the other keeps some tilings: with equal shifts it would lose all.

    Of eight tilings those let go whose shift takes them over an edge in either direction, counted here by hand.
    """
    k = np.arange(8)
    np.testing.assert_allclose(TILES.shifts, np.stack([k / 8, 3 * k % 8 / 8], axis=1))
    here, there = (
        set(TILES.active(at).tolist())
        for at in ((0.5, 0.8), (0.5 - 1 / 32, 0.8 + 1 / 20))
    )
    kept = [i for i in k if i / 8 >= 1 / 8 and 3 * i % 8 / 8 < 7 / 8]
    assert len(here & there) == len(kept) == 6


TILES = Tiles(low=(0.0, 0.0), high=(1.0, 2.0), tiles=(4, 5), tilings=8, n_actions=3)


@settings(deadline=None)
@given(UNIT, st.floats(0, 2))
def test_each_tiling_holds_the_state_in_one_tile(x, y):
    features = TILES((x, y))
    assert features.shape == (3, 3 * 8 * 5 * 6)
    blocks = features.reshape(3, 3, 8, 30)
    for action in range(3):
        np.testing.assert_array_equal(blocks[action, action].sum(axis=1), np.ones(8))
        assert features[action].sum() == 8


def test_neighbours_share_tiles_and_strangers_do_not():
    here = set(TILES.active((0.5, 1.0)).tolist())
    assert len(here & set(TILES.active((0.51, 1.0)).tolist())) >= 7
    assert not here & set(TILES.active((0.9, 1.9)).tolist())
    steps = [
        len(here & set(TILES.active((0.5 + shift / 32, 1.0)).tolist()))
        for shift in range(9)
    ]
    assert steps == [
        8,
        7,
        6,
        5,
        4,
        3,
        2,
        1,
        0,
    ]  # one tiling of the eight lets go at each eighth of a tile


def test_outside_counts_as_on_the_edge():
    np.testing.assert_array_equal(TILES.active((-3, 9)), TILES.active((0, 2)))


@pytest.mark.slow
def test_tiles_carry_what_was_learned_to_places_never_seen():
    """On the cliff with tiles over (row, column), values beyond the walk are learned too, and the goal is found."""
    cliff = gym.make("CliffWalking-v1")
    tiles = Tiles(low=(0, 0), high=(4, 12), tiles=(4, 6), tilings=4, n_actions=4)

    def features(state):
        return tiles(np.divmod(state, 12))

    learned = linear_sarsa(
        cliff, 400, features, learning_rate=0.05, discount=1.0, seed=0
    )
    (walk,) = rollouts(
        cliff, learned.q(range(48)).argmax(axis=1), 1, max_steps=60, seed=0
    )
    assert walk.terminated
    assert -25 < walk.rewards.sum() <= -13


@pytest.mark.slow
def test_any_observation_will_do():
    """A car on a hill: two real numbers, no table."""
    car = gym.make("MountainCar-v0")
    tiles = Tiles(
        low=(-1.2, -0.07), high=(0.6, 0.07), tiles=(8, 8), tilings=8, n_actions=3
    )
    learned = linear_sarsa(
        car,
        60,
        tiles,
        learning_rate=0.5 / 8,
        discount=1.0,
        epsilon=0.0,
        max_steps=2000,
        seed=0,
    )
    assert learned.q([np.array([-0.5, 0.0])]).shape == (1, 3)
    assert np.isfinite(learned.weights).all()


@pytest.mark.parametrize("learn", [linear_sarsa, linear_q_learning])
def test_too_large_a_step_is_named(learn):
    cliff = gym.make("CliffWalking-v1")
    tiles = Tiles(low=(0, 0), high=(4, 12), tiles=(2, 2), tilings=16, n_actions=4)
    with pytest.raises(ValueError, match="learning_rate is too large"):
        learn(
            cliff,
            200,
            lambda state: tiles(np.divmod(state, 12)),
            learning_rate=1.0,
            discount=1.0,
            seed=0,
        )


@pytest.mark.parametrize("learn", [linear_sarsa, linear_q_learning])
def test_features_must_fit_the_actions(learn):
    with pytest.raises(ValueError, match=r"features must give shape \(4, n\)"):
        learn(gym.make("CliffWalking-v1"), 1, OneHot(48, 3))


@pytest.mark.parametrize("learn", [linear_sarsa, linear_q_learning])
def test_seeds_reproduce(learn):
    lake = gym.make("FrozenLake-v1")
    first, again, other = (
        learn(lake, 40, OneHot(16, 4), epsilon=0.5, seed=seed) for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(first.weights, again.weights)
    np.testing.assert_array_equal(first.lengths, again.lengths)
    assert (first.lengths != other.lengths).any()


@pytest.mark.parametrize(
    "wrong",
    [
        {"low": (0.0,)},
        {"low": (1.0, 0.0)},
        {"tiles": (0, 3)},
        {"tiles": (4,)},
        {"tilings": 0},
        {"n_actions": 0},
    ],
)
def test_tiles_check_their_numbers(wrong):
    with pytest.raises(ValueError, match="must"):
        Tiles(
            **{
                "low": (0.0, 0.0),
                "high": (1.0, 1.0),
                "tiles": (2, 2),
                "tilings": 2,
                "n_actions": 2,
                **wrong,
            }
        )
