"""The Gymnasium environments, single and vector."""

from __future__ import annotations

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv

import robonav
from robonav.robot import Action, make_world, random_worlds
from robonav.robot.environments import NavigationEnv, NavigationVectorEnv, as_sensing

NAME = "robonav/Navigation-v0"


def test_importing_robonav_registers_the_environment():
    assert robonav.__version__
    assert NAME in gymnasium.registry


@pytest.mark.parametrize("settings", [{}, {"obstacles": 0}, {"moving": 3, "noise": 0.2}, {"reflex": None}])
def test_checker_has_nothing_to_say(settings):
    check_env(gymnasium.make(NAME, **settings).unwrapped)


@pytest.mark.parametrize("mode", ["rgb_array", "human"])
def test_rendering(mode):
    import matplotlib as mpl

    mpl.use("Agg")
    env = gymnasium.make(NAME, render_mode=mode, moving=2)
    env.reset(seed=0)
    first = env.render()
    env.step(Action.F)
    second = env.render()
    if mode == "rgb_array":
        assert first.shape == (480, 480, 3)
        assert first.dtype == np.uint8
        assert (first != second).any()
    else:
        assert first is second is None
    env.close()


def equal(one, other):
    assert one.keys() == other.keys()
    for key in one:
        np.testing.assert_array_equal(one[key], other[key], err_msg=key)
        assert np.asarray(one[key]).dtype == np.asarray(other[key]).dtype, key


@pytest.mark.parametrize("settings", [{"obstacles": 15, "moving": 3}, {"obstacles": 25, "reflex": None, "noise": 0.3}])
def test_vector_environment_equals_gymnasiums_over_the_single_one(settings):
    n = 6
    settings = settings | {"max_episode_steps": 40}
    native = gymnasium.make_vec(NAME, n, vectorization_mode="vector_entry_point", **settings)
    synced = SyncVectorEnv([lambda: gymnasium.make(NAME, **settings)] * n)
    assert native.observation_space == synced.observation_space
    assert native.action_space == synced.action_space
    for one, other in zip(native.reset(seed=3), synced.reset(seed=3), strict=True):
        equal(one, other)
    rng = np.random.default_rng(0)
    seen = set()
    for _ in range(250):
        actions = rng.integers(6, size=n)
        one, other = native.step(actions), synced.step(actions)
        equal(one[0], other[0])
        for a, b in zip(one[1:4], other[1:4], strict=True):
            np.testing.assert_array_equal(a, b)
            assert a.dtype == b.dtype
        equal(one[4], other[4])
        seen.update(one[4]["outcome"])
        assert all(one[0][key] in space for key, space in native.observation_space.items())
    assert seen >= {"running", "collided", "out of steps"}


def test_autoreset_mode_is_declared():
    env = gymnasium.make_vec(NAME, 2, vectorization_mode="vector_entry_point")
    assert env.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP


def run(env, seed, steps=60):
    observation, info = env.reset(seed=seed)
    poses = [info["pose"]]
    for t in range(steps):
        observation, _, terminated, truncated, info = env.step(t % 5)
        poses.append(info["pose"])
        if terminated or truncated:
            observation, info = env.reset()
    return np.array(poses), observation


def test_same_seed_same_run_other_seed_other_run():
    env = gymnasium.make(NAME, obstacles=20, moving=3)
    (first, seen), (again, seen_again), (other, _) = run(env, 1), run(env, 1), run(env, 2)
    np.testing.assert_array_equal(first, again)
    equal(seen, seen_again)
    assert (first != other).any()


def test_rewards_and_outcomes():
    world = make_world(start=(80, 80), target=(90, 90))
    env = gymnasium.make(NAME)
    env.reset(options={"worlds": world})
    rewards = []
    for _ in range(20):
        _, reward, terminated, _, info = env.step(0)
        rewards.append(reward)
        if terminated:
            break
    assert info["outcome"] == "arrived"
    assert rewards[-1] == 1
    assert set(rewards[:-1]) == {0.0}

    env = gymnasium.make(NAME, reflex=None)
    env.reset(options={"worlds": make_world(circles=[(20, 20, 4)])})
    for _ in range(20):
        _, reward, terminated, _, info = env.step(0)
        if terminated:
            break
    assert info["outcome"] == "collided"
    assert reward == -1


def test_out_of_steps_is_truncation_single_and_vector():
    env = gymnasium.make(NAME, max_episode_steps=5)
    env.reset(seed=0)
    for _ in range(5):
        *_, terminated, truncated, info = env.step(0)
    assert (terminated, truncated, info["outcome"]) == (False, True, "out of steps")
    batch = gymnasium.make_vec(NAME, 3, vectorization_mode="vector_entry_point", max_episode_steps=5)
    batch.reset(seed=0)
    for _ in range(5):
        *_, terminated, truncated, info = batch.step(np.zeros(3, int))
    assert truncated.all()
    assert not terminated.any()
    assert info["outcome"].tolist() == ["out of steps"] * 3


def test_reflexes_are_reported_and_can_be_turned_off():
    env = NavigationEnv(obstacles=0)
    env.reset(seed=0)
    *_, info = env.step(Action.R60)
    assert info["reflex"] == Action.TO_TARGET
    np.testing.assert_allclose(info["pose"][2], np.pi / 4)
    env = NavigationEnv(obstacles=0, reflex=None)
    env.reset(seed=0)
    *_, info = env.step(Action.R60)
    assert info["reflex"] == -1
    np.testing.assert_allclose(info["pose"][2], np.pi / 4 - np.pi / 3)


def test_a_reward_of_ones_own():
    def nearness(before, after, outcome):
        return after.ranges.min(axis=1) - before.ranges.min(axis=1)

    env = NavigationVectorEnv(4, reward=nearness, obstacles=20)
    before, _ = env.reset(seed=0)
    for _ in range(30):
        after, reward, *_ = env.step(np.zeros(4, int))
        expected = after["ranges"].min(axis=1) - before["ranges"].min(axis=1)
        fresh = (reward == 0) & (expected != 0)
        np.testing.assert_array_equal(reward[~fresh], expected[~fresh])
        before = after


def test_given_worlds_are_the_worlds_driven():
    worlds = random_worlds(3, 5, seed=1)
    env = NavigationEnv(worlds=worlds, obstacles=0)
    for _ in range(5):
        env.reset()
        assert env.batch.simulator.worlds.digest() in [w.digest() for w in worlds]
    env = NavigationVectorEnv(2, obstacles=4, max_episode_steps=1)
    env.reset(options={"worlds": random_worlds(2, 9, seed=3)})  # more obstacles than the environment draws
    for _ in range(3):
        observation, *_ = env.step(np.zeros(2, int))
    assert as_sensing(observation).ranges.shape == (2, 9)


@pytest.mark.parametrize(
    ("settings", "error", "message"),
    [
        ({"speed": 0}, ValueError, "speed must be greater than 0"),
        ({"obstacles": -1}, ValueError, "obstacles must be at least 0"),
        ({"reward": 3}, TypeError, "reward must be callable"),
        ({"render_mode": "ansi"}, ValueError, "render_mode must be one of"),
        ({"worlds": random_worlds(0, seed=0)}, ValueError, "worlds must hold at least one"),
        ({"max_episode_steps": 0}, ValueError, "max_episode_steps must be at least 1"),
    ],
)
def test_bad_settings_are_refused_with_a_sentence(settings, error, message):
    with pytest.raises(error, match=message):
        NavigationEnv(**settings)


@pytest.mark.parametrize(("action", "error"), [(6, ValueError), (-1, ValueError), (1.5, TypeError)])
def test_unknown_actions_are_refused_with_a_sentence(action, error):
    env = NavigationEnv()
    env.reset(seed=0)
    with pytest.raises(error, match="action must be"):
        env.step(action)


def test_stepping_out_of_turn_is_refused():
    with pytest.raises(ValueError, match="call reset first"):
        NavigationVectorEnv(2).step([0, 0])
    env = NavigationEnv(max_episode_steps=1)
    env.reset(seed=0)
    env.step(0)
    with pytest.raises(ValueError, match="the episode has ended"):
        env.step(0)
