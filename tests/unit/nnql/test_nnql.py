"""The readable functions: equal to their fast twins on the robot, and at work on other environments."""

from functools import partial

import gymnasium
import numpy as np
import pytest

from robonav.networks import random_network
from robonav.nnql import (
    METHODS,
    NavigationTask,
    double_dqn_targets,
    dqn,
    navigate_greedily,
    network_environment,
    nfq,
    nnql,
    online,
    q_network,
    train,
    train_on_pairs,
)
from robonav.robot import Outcome

TWINS = [
    ("nnql", {"episodes": 10}, 1e-12),
    ("nnql", {"episodes": 6, "rescale": "clip", "passes": 1, "discount": 0.8}, 1e-12),
    ("online", {"episodes": 10}, 1e-12),
    ("nfq", {"episodes": 9, "episodes_per_fit": 3, "sweeps": 4, "epochs": 20}, 1e-12),
    # Adam divides by the size of a gradient, which magnifies the rounding of very small ones.
    ("dqn", {"episodes": 9, "batch_size": 16, "target_update_interval": 40}, 1e-6),
    (
        "dqn",
        {
            "episodes": 9,
            "batch_size": 16,
            "target_update_interval": 40,
            "targets": double_dqn_targets,
        },
        1e-6,
    ),
]


class Corridor(gymnasium.Env):
    """Five places in a row; action 1 goes right, 0 left; the right end gives 1 and ends the episode."""

    observation_space = gymnasium.spaces.Discrete(5)
    action_space = gymnasium.spaces.Discrete(2)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.place = int(self.np_random.integers(4))
        return self.place, {}

    def step(self, action):
        self.place = max(self.place + (1 if action == 1 else -1), 0)
        end = self.place == 4
        return self.place, float(end), end, False, {}


def corridor():
    limited = gymnasium.wrappers.TimeLimit(Corridor(), 30)
    return gymnasium.wrappers.FlattenObservation(limited)


def balancing():
    """CartPole with a reward that fits into [0, 1] at any discount: -1 for a fall, else 0.2."""
    env = gymnasium.make("CartPole-v1", max_episode_steps=200)

    class Falls(gymnasium.Wrapper):
        def step(self, action):
            state, _, fallen, late, info = self.env.step(action)
            return state, -1.0 if fallen else 0.2, fallen, late, info

    return Falls(env)


@pytest.mark.parametrize(("method", "settings", "tolerance"), TWINS)
@pytest.mark.parametrize("seed", [0, pytest.param(7, marks=pytest.mark.slow)])
def test_twin_equal_to_readable_function(method, settings, tolerance, seed):
    task = NavigationTask(max_steps=80)
    env, settings = task.environment(), dict(settings)
    network = METHODS[method](env, q_network(env, seed=seed), seed=seed, **settings)
    result = train(method, [seed, 3], settings.pop("episodes"), task=task, **settings)
    assert result.decisions[0].sum() > 50
    for readable, twin in zip(
        (*network.weights, *network.biases),
        (*result.network.weights, *result.network.biases),
        strict=True,
    ):
        np.testing.assert_allclose(twin[0], readable, rtol=tolerance, atol=tolerance)


def test_environment_goes_through_the_worlds_of_the_task():
    task = NavigationTask()
    env, worlds = task.environment(), task.worlds([4], 0, 3)
    states = [env.reset(seed=4 if k == 0 else None) for k in range(3)]
    for k, (_, info) in enumerate(states):
        np.testing.assert_array_equal(info["pose"][:2], worlds[k].starts[0])
    again, _ = env.reset(seed=4)
    np.testing.assert_array_equal(again, states[0][0])


@pytest.mark.parametrize(
    ("method", "settings"),
    [
        (nnql, {"episodes": 60}),
        (online, {"episodes": 150}),
        (nfq, {"episodes": 40, "sweeps": 10, "epochs": 100}),
        (dqn, {"episodes": 60, "gradient_step": 0.01, "target_update_interval": 50}),
        (
            partial(dqn, targets=double_dqn_targets),
            {"episodes": 60, "gradient_step": 0.01, "target_update_interval": 50},
        ),
    ],
)
def test_discrete_toy_environment(method, settings):
    """In a corridor every method finds the way to the right."""
    env = corridor()
    network = method(env, q_network(env, seed=1), seed=1, **settings)
    assert network.decide(np.eye(5)[:4]).tolist() == [1, 1, 1, 1]


@pytest.mark.slow
def test_cart_pole():
    """On an environment that has nothing of a robot, training makes episodes longer."""
    env = gymnasium.wrappers.RecordEpisodeStatistics(balancing())
    dqn(
        env,
        q_network(env, hidden=16, seed=0),
        episodes=90,
        discount=0.95,
        gradient_step=0.01,
        target_update_interval=100,
        seed=0,
    )
    lengths = np.array(env.length_queue)
    assert len(lengths) == 90
    assert lengths[-20:].mean() > 3 * lengths[:10].mean()


def test_greedy_navigation():
    env = corridor()
    network = nnql(env, q_network(env, seed=1), episodes=60, seed=1)
    assert [navigate_greedily(env, network, seed=k)[0] for k in range(5)] == [1.0] * 5


@pytest.mark.slow
def test_greedy_navigation_of_the_robot():
    task = NavigationTask()
    policy = train("nnql", seeds=[0], episodes=120, task=task)
    ended = [
        navigate_greedily(task.environment(), policy.network[0], seed=50 + k)[1]
        for k in range(20)
    ]
    assert sum(info["outcome"] == Outcome.ARRIVED for info in ended) >= 16


def test_descent_stops_when_the_cost_settles():
    network, state = random_network((4, 8, 2), seed=0), np.eye(4)[0]
    pairs = [state], [np.array([0.2, 0.9])]
    once = train_on_pairs(network, *pairs, 0.1, 1, 0.0)
    settled = train_on_pairs(network, *pairs, 0.1, 50, 100.0)
    twice = train_on_pairs(once, *pairs, 0.1, 1, 0.0)
    np.testing.assert_array_equal(settled.weights[0], twice.weights[0])


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"env": None}, "env must be a Gymnasium environment, got NoneType"),
        ({"network": None}, "network must be Network"),
        ({"episodes": 0}, "episodes must be at least 1"),
        ({"discount": 2}, "discount must be at least 0 and at most 1"),
        ({"learning_rate": 1.5}, "learning_rate must be greater than 0 and at most 1"),
        ({"seed": -1}, "seed must be at least 0"),
    ],
)
def test_wrong_argument(wrong, message):
    env = corridor()
    right = {"env": env, "network": q_network(env, seed=0), "episodes": 1, "seed": 0}
    with pytest.raises((ValueError, TypeError), match=message):
        nnql(**(right | wrong))


@pytest.mark.parametrize("learn", [nnql, online, nfq, dqn])
@pytest.mark.parametrize("sizes", [(5, 8, 2), (4, 8, 3)])
def test_network_that_does_not_fit_the_environment(learn, sizes):
    message = r"network must take the 4 numbers of a state and give 2 actions, got"
    with pytest.raises(ValueError, match=message):
        learn(
            gymnasium.make("CartPole-v1"),
            random_network(sizes, seed=0),
            episodes=1,
            seed=0,
        )


def test_environment_that_no_network_reads():
    class Words(Corridor):
        observation_space = gymnasium.spaces.Sequence(gymnasium.spaces.Discrete(5))

    with pytest.raises(TypeError, match=r"observations of a fixed size, got Sequence"):
        q_network(Words(), seed=0)
    with pytest.raises(TypeError, match=r"env\.action_space must be discrete"):
        q_network(gymnasium.make("Pendulum-v1"), seed=0)


class FromOne(gymnasium.Wrapper):
    """The corridor with actions 1 and 2. Any other action is an error."""

    def __init__(self):
        super().__init__(gymnasium.wrappers.TimeLimit(Corridor(), 30))
        self.action_space = gymnasium.spaces.Discrete(2, start=1)

    def step(self, action):
        assert self.action_space.contains(np.int64(action))
        return super().step(action - 1)


@pytest.mark.parametrize("method", METHODS.values())
def test_actions_numbered_from_one(method):
    """The environment gets its own numbers, and the networks are those of actions from 0."""
    networks = [
        method(env, q_network(env, seed=1), episodes=3, seed=1)
        for env in (FromOne(), corridor())
    ]
    for one, other in zip(*(network.weights for network in networks), strict=True):
        np.testing.assert_array_equal(one, other)
    total, _ = navigate_greedily(FromOne(), networks[0], seed=0)
    assert total == navigate_greedily(corridor(), networks[1], seed=0)[0]


@pytest.mark.parametrize("method", METHODS.values())
@pytest.mark.parametrize(
    ("name", "inputs", "actions"),
    [("robonav/Navigation-v0", 29, 6), ("FrozenLake-v1", 16, 4), ("Taxi-v4", 500, 6)],
)
def test_registered_environments_as_they_are(method, name, inputs, actions):
    env = gymnasium.make(name, max_episode_steps=60)
    start = q_network(env, seed=0)
    assert (start.sizes[0], start.sizes[-1]) == (inputs, actions)
    settings = {"batch_size": 4} if method is dqn else {}
    if method is nfq:
        settings = {"episodes_per_fit": 1}
    trained = method(env, start, episodes=2, seed=0, **settings)
    assert (trained.weights[0] != start.weights[0]).any()


def test_bounded_observations_are_scaled():
    env = network_environment(gymnasium.make("robonav/Navigation-v0"))
    states = [env.reset(seed=0)[0], *(env.step(0)[0] for _ in range(40))]
    assert env.observation_space.contains(states[0])
    assert np.min(states) == 0
    assert np.max(states) == 1
    plain = gymnasium.make("CartPole-v1")
    assert network_environment(plain) is plain

    class Mixed(Corridor):
        observation_space = gymnasium.spaces.Dict(
            {
                "bounded": gymnasium.spaces.Box(-2, 2, (1,)),
                "free": gymnasium.spaces.Box(-np.inf, np.inf, (1,)),
                "still": gymnasium.spaces.Box(3, 3, (1,)),
            }
        )

        def reset(self, *, seed=None, options=None):
            parts = {"bounded": 1.0, "free": 7.0, "still": 3.0}
            return {key: np.full(1, x, np.float32) for key, x in parts.items()}, {}

    assert network_environment(Mixed()).reset()[0].tolist() == [0.75, 7.0, 3.0]


@pytest.mark.parametrize("task", [gymnasium.make("CartPole-v1"), 3, "navigation"])
def test_task_of_another_type(task):
    kind = type(task).__name__
    with pytest.raises(TypeError, match=f"task must be NavigationTask, got {kind}"):
        train("nnql", seeds=1, episodes=1, task=task)


def test_episodes_go_through_a_task_s_maps_again_and_again():
    new, three = NavigationTask(), NavigationTask(n_worlds=3)
    first = new.worlds([4, 5], 0, 8)
    again = three.worlds([4, 5], 0, 8)
    for seed in (0, 8):  # the episodes of the second seed follow those of the first
        for episode in range(8):
            np.testing.assert_array_equal(
                again.centres[seed + episode], first.centres[seed + episode % 3]
            )
    np.testing.assert_array_equal(
        three.worlds([4], 4, 6).centres, first[[1, 2]].centres
    )
    with pytest.raises(ValueError, match="n_worlds must be at least 1, got 0"):
        NavigationTask(n_worlds=0)
