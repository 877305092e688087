"""Q-learning, SARSA, expected SARSA and TD(0) against plans, closed forms and steps worked out by hand."""

import inspect
import re

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import spaces

from robonav.mdp import (
    FiniteMDP,
    expected_sarsa,
    harmonic_decay,
    linear_decay,
    monte_carlo_control,
    polynomial_decay,
    q_learning,
    rollouts,
    sarsa,
    td_prediction,
)

CONTROL = [q_learning, sarsa, expected_sarsa]


class Corridor(gym.Env):
    """Rooms 0 ... n - 1: action 0 goes left, 1 right; past either end the episode ends, on the right with reward 1."""

    action_space = spaces.Discrete(2)

    def __init__(self, rooms=5):
        self.rooms = rooms
        self.observation_space = spaces.Discrete(
            rooms + 1
        )  # the last one is where episodes end

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.room = self.rooms // 2
        return self.room, {}

    def step(self, action):
        self.room += 2 * action - 1
        ended = not 0 <= self.room < self.rooms
        return (
            self.rooms if ended else self.room,
            float(self.room == self.rooms),
            ended,
            False,
            {},
        )


class Ladder(gym.Env):
    """One state that pays 1 a step forever, cut off after 3 steps."""

    observation_space, action_space = spaces.Discrete(1), spaces.Discrete(1)

    def reset(self, *, seed=None, options=None):
        self.steps = 0
        return 0, {}

    def step(self, action):
        self.steps += 1
        return 0, 1.0, False, self.steps == 3, {}


def optimal_q(mdp, sweeps=2000):
    """Action values by plain repetition of Eq. (2.12): independent of the package's planners."""
    q = np.zeros((mdp.n_states, mdp.n_actions))
    for _ in range(sweeps):
        q = mdp.action_values(q.max(axis=1))
    return q


def policy_q(mdp, policy, sweeps=2000):
    """Action values of a stochastic policy by plain repetition of Eq. (2.15)."""
    q = np.zeros((mdp.n_states, mdp.n_actions))
    for _ in range(sweeps):
        q = mdp.action_values((policy * q).sum(axis=1))
    return q


@pytest.mark.parametrize("learn", CONTROL)
def test_a_reward_travels_one_room_back_an_episode(learn):
    learned = learn(Corridor(1), 1, learning_rate=0.5, epsilon=1.0, seed=0)
    action = int(learned.visits[0].argmax())
    np.testing.assert_allclose(learned.q[0, action], 0.5 * action)
    assert learned.visits.sum() == 1


@pytest.mark.parametrize("learn", CONTROL)
def test_what_comes_after_the_end_is_worth_nothing(learn):
    learned = learn(
        Corridor(1),
        50,
        learning_rate=1.0,
        epsilon=1.0,
        initial=7.0,
        discount=1.0,
        seed=0,
    )
    np.testing.assert_allclose(learned.q, [[0, 1], [7, 7]])


@pytest.mark.parametrize("learn", CONTROL)
def test_an_episode_cut_off_is_not_an_end(learn):
    learned = learn(Ladder(), 300, learning_rate=0.5, discount=0.5, seed=0)
    assert learned.q[0, 0] == pytest.approx(1 / (1 - 0.5))
    assert set(learned.lengths) == {3}


class Fork(gym.Env):
    """0 leads to 1; there action 0 pays 10 and action 1 nothing, and the episode ends."""

    observation_space, action_space = spaces.Discrete(3), spaces.Discrete(2)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.state = 0
        return 0, {}

    def step(self, action):
        self.state += 1
        return (
            self.state,
            10.0 * (self.state == 2 and action == 0),
            self.state == 2,
            False,
            {},
        )


@pytest.mark.parametrize(
    ("learn", "value"),
    [
        (q_learning, 0.9 * 10),  # the best that can follow
        (expected_sarsa, 0.9 * 0.5 * 10),  # the mean over a blind choice
    ],
)
def test_targets_by_hand(learn, value):
    learned = learn(Fork(), 200, discount=0.9, learning_rate=1.0, epsilon=1.0, seed=0)
    np.testing.assert_allclose(learned.q, [[value, value], [10, 0], [0, 0]])


def test_expected_sarsas_target_with_some_exploration():
    """With a learning rate of 1 and the second value known, it is 0.9 times 0.7 * 10 + 0.3 * 5."""
    learned = expected_sarsa(
        Fork(), 400, discount=0.9, learning_rate=1.0, epsilon=0.3, seed=0
    )
    np.testing.assert_allclose(learned.q[0], 0.9 * (0.7 * 10 + 0.3 * 5))


@pytest.mark.parametrize("learn", CONTROL)
def test_the_algorithm_as_written_runs_on_any_environment(learn):
    """Without its decorator it is a loop over a plain Gymnasium environment, and learns the way over firm ice."""
    lake = gym.make("FrozenLake-v1", is_slippery=False)
    q = [[0.0] * 4 for _ in range(16)]
    visits = [[0] * 4 for _ in range(16)]
    inspect.unwrap(learn)(
        lake,
        q,
        visits,
        600,
        discount=0.9,
        learning_rate=lambda n: 0.5,
        epsilon=linear_decay(1.0, 0.1, 400),
        rng=np.random.default_rng(0),
    )
    (walk,) = rollouts(lake, np.argmax(q, axis=1), 1, seed=0)
    assert walk.rewards.sum() == 1


@pytest.mark.parametrize("learn", [*CONTROL, td_prediction, monte_carlo_control])
def test_documented_parameters_are_those_of_the_signature(learn):
    documented = re.findall(r"^(\w+) : ", inspect.getdoc(learn), re.MULTILINE)
    assert documented == list(inspect.signature(learn).parameters)


def test_sarsas_target_is_the_action_that_follows():
    """With a learning rate of 1 the first value is 0.9 times 10 or 0, whichever was drawn, and 4.5 on average."""
    learned = sarsa(
        Fork(), 2000, discount=0.9, learning_rate=1.0, epsilon=1.0, seed=0, record=True
    )
    settled = learned.history[100:, 0]
    assert set(np.unique(settled)) == {0.0, 9.0}
    assert settled.mean() == pytest.approx(4.5, abs=0.4)


@pytest.mark.slow
def test_q_learning_tends_to_the_plan_on_frozen_lake():
    lake = gym.make("FrozenLake-v1", max_episode_steps=1000)
    planned = optimal_q(FiniteMDP.from_gymnasium(lake, 0.9))
    learned = q_learning(
        lake,
        12_000,
        discount=0.9,
        learning_rate=polynomial_decay(0.77),
        epsilon=0.5,
        seed=0,
    )
    seen = learned.visits.min(axis=1) > 300
    assert seen.sum() >= 9
    np.testing.assert_allclose(learned.q[seen], planned[seen], atol=0.03)


@pytest.mark.parametrize(
    "learn", [sarsa, pytest.param(expected_sarsa, marks=pytest.mark.slow)]
)
def test_sarsa_learns_the_value_of_exploring(learn):
    """With epsilon 1 the policy is blind whatever is learned, and its values are known."""
    lake = gym.make("FrozenLake-v1", max_episode_steps=1000)
    blind = policy_q(FiniteMDP.from_gymnasium(lake, 0.9), np.full((16, 4), 0.25))
    learned = learn(
        lake,
        12_000,
        discount=0.9,
        learning_rate=polynomial_decay(0.77),
        epsilon=1.0,
        seed=0,
    )
    seen = learned.visits.min(axis=1) > 500
    np.testing.assert_allclose(learned.q[seen], blind[seen], atol=0.02)


class Switch(gym.Env):
    """Every step ends the episode; action 1 pays, action 0 does not."""

    observation_space, action_space = spaces.Discrete(1), spaces.Discrete(2)

    def reset(self, *, seed=None, options=None):
        return 0, {}

    def step(self, action):
        return 0, float(action), True, False, {}


@pytest.mark.parametrize("learn", CONTROL)
def test_exploring_follows_its_schedule_over_episodes(learn):
    """Blind for 100 episodes, then never again: from there on every episode pays."""
    learned = learn(Switch(), 200, epsilon=lambda n: float(n < 100), seed=0)
    assert 20 < learned.returns[:100].sum() < 80
    assert (learned.returns[100:] == 1).all()


@pytest.mark.parametrize("learn", [sarsa, expected_sarsa])
def test_sarsa_tends_to_the_plan_where_exploring_fades(learn):
    """Singh et al. (2000): greedy in the limit, and every pair tried infinitely often."""
    fork = FiniteMDP(
        [[[0, 1, 0], [0, 0, 1], [0, 0, 1]]] * 2, [[0, 0], [10, 0], [0, 0]], 0.9
    )
    learned = learn(
        Fork(),
        4000,
        discount=0.9,
        learning_rate=polynomial_decay(0.77),
        epsilon=harmonic_decay(1.0, 50),
        seed=0,
    )
    np.testing.assert_allclose(
        learned.q, optimal_q(fork), atol=0.7
    )  # rare tries lag behind
    blind = learn(
        Fork(),
        4000,
        discount=0.9,
        learning_rate=polynomial_decay(0.77),
        epsilon=1.0,
        seed=0,
    )
    assert abs(blind.q - optimal_q(fork)).max() > 3


def best_while_exploring(mdp, epsilon, sweeps=5000):
    """Action values of the best among the policies that take a random action with probability epsilon."""
    q = np.zeros((mdp.n_states, mdp.n_actions))
    for _ in range(sweeps):
        q = mdp.action_values((1 - epsilon) * q.max(axis=1) + epsilon * q.mean(axis=1))
    return q


@pytest.mark.slow
@pytest.mark.parametrize(
    ("learn", "epsilon", "learning_rate", "reward"),
    [
        (q_learning, 0.1, 0.5, -13),  # along the edge, whatever exploring costs
        (expected_sarsa, 0.1, 0.5, -15),  # one row away
        (expected_sarsa, 0.2, 0.5, -17),  # along the far wall
        (sarsa, 0.2, harmonic_decay(0.5, 100), -17),
    ],
)
def test_the_cliff_is_walked_boldly_or_safely(learn, epsilon, learning_rate, reward):
    cliff = gym.make("CliffWalking-v1")
    learned = learn(
        cliff, 1500, discount=1.0, learning_rate=learning_rate, epsilon=epsilon, seed=0
    )
    (walk,) = rollouts(cliff, learned.policy, 1, max_steps=100, seed=0)
    assert walk.terminated
    assert walk.rewards.sum() == reward
    exact = best_while_exploring(
        FiniteMDP.from_gymnasium(cliff, 1.0), 0 if learn is q_learning else epsilon
    )
    (ideal,) = rollouts(cliff, exact.argmax(axis=1), 1, max_steps=100, seed=0)
    assert ideal.rewards.sum() == reward  # not luck: this is where the algorithm tends
    often = learned.visits > 1000
    assert often.sum() > 10
    np.testing.assert_allclose(learned.q[often], exact[often], atol=1.5)


def test_bold_costs_more_while_learning():
    cliff = gym.make("CliffWalking-v1")
    bold, safe = (
        learn(cliff, 500, discount=1.0, learning_rate=0.5, seed=0).returns
        for learn in (q_learning, sarsa)
    )
    assert bold[100:].mean() < safe[100:].mean() - 10


@pytest.mark.slow
def test_taxi_is_driven_optimally_from_every_start():
    taxi = gym.make("Taxi-v4")
    mdp = FiniteMDP.from_gymnasium(taxi, 0.99)
    planned = optimal_q(mdp, 400)
    learned = q_learning(
        taxi, 5000, discount=0.99, learning_rate=1.0, epsilon=0.0, initial=20.0, seed=0
    )
    starts = taxi.unwrapped.initial_state_distrib > 0
    greedy = np.eye(6)[learned.policy]
    achieved = (greedy * policy_q(mdp, greedy, 400)).sum(axis=1)
    assert starts.sum() == 300
    np.testing.assert_allclose(achieved[starts], planned.max(axis=1)[starts], atol=1e-6)


def test_td_finds_the_random_walk_of_sutton_and_barto():
    """Example 6.2: from the middle of five rooms, the probability to end on the right is 1/6 ... 5/6."""
    predicted = td_prediction(
        Corridor(5),
        np.full((6, 2), 0.5),
        4000,
        discount=1.0,
        learning_rate=harmonic_decay(0.5, 100),
        seed=1,
    )
    np.testing.assert_allclose(predicted.values[:5], np.arange(1, 6) / 6, atol=0.03)
    assert predicted.values[5] == 0


def test_td_prediction_ends_and_cuts_off_like_q_learning():
    ended = td_prediction(
        Corridor(1), [1, 1], 20, discount=1.0, learning_rate=1.0, initial=5.0, seed=0
    )
    np.testing.assert_allclose(ended.values, [1, 5])
    cut = td_prediction(Ladder(), [0], 300, discount=0.5, learning_rate=0.5, seed=0)
    assert cut.values[0] == pytest.approx(2)


@pytest.mark.parametrize("learn", CONTROL)
def test_seeds_reproduce(learn):
    lake = gym.make("FrozenLake-v1")
    first, again, other = (
        learn(lake, 60, epsilon=0.5, seed=seed, record=True) for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(first.history, again.history)
    np.testing.assert_array_equal(first.lengths, again.lengths)
    assert (first.lengths != other.lengths).any()
    generator = learn(lake, 60, epsilon=0.5, seed=np.random.default_rng(1), record=True)
    np.testing.assert_array_equal(generator.history, first.history)


def test_predictions_reproduce_too():
    lake, blind = gym.make("FrozenLake-v1"), np.full((16, 4), 0.25)
    first, again, other = (
        td_prediction(lake, blind, 60, seed=seed, initial=1.0, record=True)
        for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(first.history, again.history)
    assert (first.history != other.history).any()


@pytest.mark.parametrize("learn", CONTROL)
def test_the_record_begins_with_the_start_and_ends_with_the_result(learn):
    learned = learn(
        Corridor(4),
        30,
        initial=0.25,
        epsilon=linear_decay(1, 0, 20),
        seed=0,
        record=True,
    )
    assert learned.history.shape == (31, 5, 2)
    assert (learned.history[0] == 0.25).all()
    np.testing.assert_array_equal(learned.history[-1], learned.q)
    assert learned.visits.sum() == learned.lengths.sum()
    assert [
        len(walk) - 1 for walk in learned.visited_states
    ] == learned.lengths.tolist()
    assert {(walk[0], walk[-1]) for walk in learned.visited_states} == {(2, 4)}
    assert learned.returns.shape == learned.lengths.shape == (30,)
    np.testing.assert_array_equal(learned.policy, learned.q.argmax(axis=1))
    np.testing.assert_array_equal(learned.values, learned.q.max(axis=1))


@pytest.mark.parametrize("learn", CONTROL)
@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"discount": 1.5}, "discount must be at least 0 and at most 1"),
        ({"learning_rate": -0.1}, "learning_rate must be at least 0"),
        ({"epsilon": 2}, "epsilon must be at least 0"),
        ({"max_steps": 0}, "max_steps must be at least 1"),
        ({"seed": -1}, "seed must be at least 0"),
        ({"initial": float("nan")}, "initial must be finite"),
        ({"episodes": 0}, "episodes must be at least 1"),
    ],
)
def test_a_wrong_number_gets_one_clear_sentence(learn, options, message):
    with pytest.raises(ValueError, match=message):
        learn(Corridor(), **{"episodes": 1, **options})


def test_progress_is_told():
    heard = []
    q_learning(
        Corridor(), 3, seed=0, progress=lambda done, total: heard.append((done, total))
    )
    assert heard == [(1, 3), (2, 3), (3, 3)]
