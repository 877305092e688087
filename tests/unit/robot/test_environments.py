"""The Gymnasium environments, single and vector."""

from __future__ import annotations

import inspect
from functools import partial

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv

import robonav
from robonav.robot import (
    Action,
    Outcome,
    Reflex,
    make_world,
    neighbour_slip,
    random_worlds,
)
from robonav.robot.environments import NavigationEnv, as_sensing
from robonav.robot.vector_environment import NavigationVectorEnv

NAME = "robonav/Navigation-v0"


def test_importing_robonav_registers_the_environment():
    assert robonav.__version__
    assert NAME in gymnasium.registry


@pytest.mark.parametrize(
    "settings", [{}, {"obstacles": 0}, {"moving": 3, "noise": 0.2}, {"reflex": None}]
)
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


@pytest.mark.parametrize(
    "settings",
    [
        {"obstacles": 15, "moving": 3},
        {"obstacles": 25, "reflex": None, "noise": 0.3},
        {"obstacles": 10, "moving": 6, "slip": neighbour_slip(0.3), "speed": 3.3},
        {
            "obstacles": 10,
            "moving": 6,
            "slip": neighbour_slip(0.3),
            "reflex": Reflex("sector"),
        },
    ],
)
@pytest.mark.parametrize("limit", ["of the environment", "of the wrapper"])
def test_vector_environment_equals_gymnasiums_over_the_single_one(settings, limit):
    n = 6
    wrapped = limit == "of the wrapper"
    settings = settings | {"max_episode_steps": 40}
    native = gymnasium.make_vec(
        NAME, n, vectorization_mode="vector_entry_point", **settings
    )
    made = partial(gymnasium.make, NAME) if wrapped else NavigationEnv
    synced = SyncVectorEnv([lambda: made(**settings)] * n)
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
        seen.update(one[4]["outcome"].tolist())
        if wrapped:  # whose truncation the environment does not see
            one[4]["outcome"][one[3] & ~one[2]] = Outcome.RUNNING
        equal(one[4], other[4])
        assert all(
            one[0][key] in space for key, space in native.observation_space.items()
        )
    assert seen >= {Outcome.RUNNING, Outcome.COLLIDED, Outcome.OUT_OF_STEPS}


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
    (first, seen), (again, seen_again), (other, _) = (
        run(env, 1),
        run(env, 1),
        run(env, 2),
    )
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
    assert info["outcome"] == Outcome.ARRIVED
    assert rewards[-1] == 1
    assert set(rewards[:-1]) == {0.0}

    env = gymnasium.make(NAME, reflex=None)
    env.reset(options={"worlds": make_world(circles=[(20, 20, 4)])})
    for _ in range(20):
        _, reward, terminated, _, info = env.step(0)
        if terminated:
            break
    assert info["outcome"] == Outcome.COLLIDED
    assert reward == -1


def test_out_of_steps_is_truncation_single_and_vector():
    env = gymnasium.make(NAME, max_episode_steps=5)
    env.reset(seed=0)
    for _ in range(5):
        *_, terminated, truncated, info = env.step(0)
    assert (terminated, truncated) == (False, True)
    assert (
        info["outcome"] == Outcome.RUNNING
    )  # the wrapper cut the episode, not the robot
    env = NavigationEnv(max_episode_steps=5)
    env.reset(seed=0)
    for _ in range(5):
        *_, terminated, truncated, info = env.step(0)
    assert (terminated, truncated, info["outcome"]) == (
        False,
        True,
        Outcome.OUT_OF_STEPS,
    )
    batch = gymnasium.make_vec(
        NAME, 3, vectorization_mode="vector_entry_point", max_episode_steps=5
    )
    batch.reset(seed=0)
    for _ in range(5):
        *_, terminated, truncated, info = batch.step(np.zeros(3, int))
    assert truncated.all()
    assert not terminated.any()
    assert info["outcome"].tolist() == [Outcome.OUT_OF_STEPS] * 3


def test_a_limit_above_the_registered_one_holds():
    worlds = make_world(circles=[(20, 20, 4)])
    env = gymnasium.make(NAME, worlds=worlds, reflex=None, max_episode_steps=600)
    env.reset(seed=0)
    for step in range(1, 601):  # six turns of 60 degrees: in circles
        *_, terminated, truncated, _ = env.step(Action.L60)
        assert (terminated, truncated) == (False, step == 600)


def test_the_parameters_of_both_environments_are_listed():
    single = inspect.signature(NavigationEnv).parameters
    vector = inspect.signature(NavigationVectorEnv).parameters
    assert set(single) == set(vector) - {"num_envs", "autoreset_mode"}
    assert all(kind.kind is kind.KEYWORD_ONLY for kind in single.values())
    for name in set(single) - {"max_episode_steps"}:
        assert single[name].default == vector[name].default
        assert name in NavigationEnv.__doc__
    for heading in ("Action space", "Observation space", "Rewards", "Starting state",
                    "Episode end", "Options", "Information"):  # fmt: skip
        assert f"## {heading}\n" in NavigationEnv.__doc__


def test_reflexes_are_reported_and_can_be_turned_off():
    env = NavigationEnv(obstacles=0, reflex=Reflex("exact"))
    env.reset(seed=0)
    *_, info = env.step(Action.R60)
    assert info["reflex"] == Action.TO_TARGET
    np.testing.assert_allclose(info["pose"][2], np.pi / 4)
    env = NavigationEnv(obstacles=0, reflex=Reflex("sector"))
    env.reset(seed=0)
    *_, info = env.step(Action.R60)
    assert info["reflex"] == Action.TO_SECTOR
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
        assert env.world.digest() in [w.digest() for w in worlds]
    env = NavigationVectorEnv(2, obstacles=4, max_episode_steps=1)
    env.reset(
        options={"worlds": random_worlds(2, 9, seed=3)}
    )  # more obstacles than the environment draws
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
        (
            {"worlds": random_worlds(0, seed=0)},
            ValueError,
            "worlds must hold at least one",
        ),
        ({"max_episode_steps": 0}, ValueError, "max_episode_steps must be at least 1"),
    ],
)
def test_bad_settings_are_refused_with_a_sentence(settings, error, message):
    with pytest.raises(error, match=message):
        NavigationEnv(**settings)


@pytest.mark.parametrize(
    ("action", "error"), [(6, ValueError), (-1, ValueError), (1.5, TypeError)]
)
def test_unknown_actions_are_refused_with_a_sentence(action, error):
    env = NavigationEnv()
    env.reset(seed=0)
    with pytest.raises(error, match="action must be"):
        env.step(action)


def test_stepping_out_of_turn_is_refused():
    with pytest.raises(ValueError, match="call reset first"):
        NavigationVectorEnv(2).step([0, 0])
    with pytest.raises(ValueError, match="call reset first"):
        NavigationEnv().step(0)
    env = NavigationEnv(max_episode_steps=1)
    env.reset(seed=0)
    env.step(0)
    with pytest.raises(ValueError, match="the episode has ended"):
        env.step(0)


def test_given_worlds_stay_as_they_are():
    worlds = random_worlds(4, 10, 3, seed=1)
    before = worlds.digest()
    env = NavigationVectorEnv(4, max_episode_steps=3, moving=3)
    env.reset(seed=0, options={"worlds": worlds})
    for _ in range(10):
        env.step(np.zeros(4, int))
    assert worlds.digest() == before


def test_worlds_of_another_size_are_not_mixed_in():
    small = random_worlds(2, 0, seed=1, size=40, starts=[(5, 5)], targets=[(35, 35)])
    env = NavigationVectorEnv(2, max_episode_steps=1, obstacles=5)
    env.reset(seed=0, options={"worlds": small})
    env.step(np.zeros(2, int))
    with pytest.raises(
        ValueError,
        match="worlds must have the map size of those they replace, 40 m, got 100 m",
    ):
        env.step(np.zeros(2, int))
    assert env.simulator.worlds.size == 40


@pytest.mark.parametrize("vector", [False, True])
def test_what_a_reader_does_to_an_observation_changes_nothing(vector):
    def poses(spoil):
        env = (
            NavigationVectorEnv(1, obstacles=25)
            if vector
            else NavigationEnv(obstacles=25)
        )
        observation, info = env.reset(seed=3)
        seen = []
        for _ in range(20):
            if spoil:
                observation["ranges"] *= 0
                observation["walls"][...] = 1
            observation, _, terminated, _, info = env.step(
                np.zeros(1, int) if vector else 0
            )
            seen.append(np.ravel(info["pose"]))
            if np.all(terminated):
                break
        return np.array(seen)

    np.testing.assert_array_equal(poses(spoil=True), poses(spoil=False))


@pytest.mark.parametrize(
    ("settings", "error", "message"),
    [
        ({"obstacles": 20_000}, ValueError, r"obstacles \+ moving must be at most"),
        (
            {"moving_speeds": ("a", "b")},
            TypeError,
            "moving_speeds must be an array of numbers",
        ),
        ({"moving_speeds": (1,)}, ValueError, r"moving_speeds must have shape \(2,\)"),
        (
            {"moving_speeds": (0.9, 0.4)},
            ValueError,
            "moving_speeds must be the least and the greatest",
        ),
        ({"starts": 5}, ValueError, "starts must have shape"),
        ({"worlds": 3}, TypeError, "worlds must be Worlds, got int"),
        ({"worlds": "none.npz"}, FileNotFoundError, "none.npz"),
        ({"reward": "nothing"}, TypeError, "reward must be callable .* got 'nothing'"),
        ({"reflex": "left"}, ValueError, "reflex must be one of exact, sector, got"),
        ({"reflex": False}, TypeError, "reflex must be callable"),
        (
            {"max_episode_steps": 10**30},
            ValueError,
            "max_episode_steps must be at most",
        ),
    ],
)
def test_settings_that_would_fail_later_are_refused_at_once(settings, error, message):
    with pytest.raises(error, match=message):
        NavigationEnv(**settings)


def test_bad_rewards_options_and_seeds_are_refused_with_a_sentence():
    env = NavigationVectorEnv(3, reward=lambda before, after, outcome: 0.0)
    env.reset(seed=0)
    with pytest.raises(ValueError, match=r"reward must give an array of shape \(3,\)"):
        env.step(np.zeros(3, int))
    with pytest.raises(
        ValueError, match="options must be one of worlds, reset_mask, got 'world'"
    ):
        env.reset(options={"world": 1})
    with pytest.raises(TypeError, match=r"options\['worlds'\] must be Worlds"):
        env.reset(options={"worlds": "x"})
    with pytest.raises(TypeError, match="seed must be a whole number"):
        env.reset(seed=1.5)
    with pytest.raises(TypeError, match="lists of several lengths"):
        env.step([[1], [1, 2], 3])
    env.reset(seed=7)
    assert env.np_random_seed == 7
    with pytest.raises(ValueError, match="render: call reset first"):
        NavigationVectorEnv(2, render_mode="rgb_array").render()
    with pytest.raises(ValueError, match="render: call reset first"):
        NavigationEnv(render_mode="rgb_array").render()
    env = NavigationEnv(reward=lambda before, after, outcome: 0.0)
    env.reset(seed=0)
    with pytest.raises(ValueError, match=r"reward must give an array of shape \(1,\)"):
        env.step(0)
    with pytest.raises(ValueError, match=r"options\['worlds'\] must hold 1 worlds"):
        env.reset(options={"worlds": random_worlds(2, seed=0)})


@pytest.mark.parametrize(
    "given", [np.array([8]), np.array([-2]), np.array([0.0]), [1, 1], None]
)
def test_a_bad_reflex_of_ones_own_is_refused_with_a_sentence(given):
    message = "reflex must give an array of 1 whole numbers -1 to 7"
    env = NavigationEnv(reflex=lambda sensing, speed: given)
    env.reset(seed=0)
    with pytest.raises(ValueError, match=message):
        env.step(0)
    batch = NavigationVectorEnv(1, reflex=lambda sensing, speed: given)
    batch.reset(seed=0)
    with pytest.raises(ValueError, match=message):
        batch.step([0])


def test_the_array_of_ones_own_reflex_is_left_alone():
    always = np.full(3, Action.F)
    always.flags.writeable = False
    env = NavigationVectorEnv(
        3, max_episode_steps=2, reflex=lambda sensing, speed: always
    )
    env.reset(seed=0)
    for _ in range(4):
        *_, info = env.step(np.zeros(3, int))
    assert info["reflex"].tolist() == [0, 0, 0]
