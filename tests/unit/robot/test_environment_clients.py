"""The environments in the hands of other libraries: Gymnasium's wrappers and vector environments, stable-baselines3."""

from __future__ import annotations

import copy
import json
import multiprocessing
import pickle
from functools import partial

import gymnasium
import joblib
import numpy as np
import pytest
from gymnasium import wrappers
from gymnasium.vector import AsyncVectorEnv, AutoresetMode, SyncVectorEnv
from gymnasium.wrappers import vector as vector_wrappers

from robonav.robot import (
    Action,
    Outcome,
    Reflex,
    neighbour_slip,
    random_worlds,
    save_worlds,
)
from robonav.robot.environments import NavigationEnv, as_sensing
from robonav.robot.vector_environment import NavigationVectorEnv

NAME = "robonav/Navigation-v0"


def assert_same(one, other, path=""):
    """Hold two answers of environments equal: tuples, dicts, and arrays of numbers or of dicts."""
    if isinstance(one, dict):
        assert one.keys() == other.keys(), path
        for key in one:
            assert_same(one[key], other[key], f"{path}/{key}")
    elif isinstance(one, tuple) or (
        isinstance(one, np.ndarray) and one.dtype.hasobject
    ):
        assert len(one) == len(other), path
        for k, pair in enumerate(zip(one, other, strict=True)):
            assert_same(*pair, f"{path}/{k}")
    else:
        np.testing.assert_array_equal(one, other, err_msg=path)
        assert np.asarray(one).dtype == np.asarray(other).dtype, path


def drive(env, steps=60, seed=0):
    """Step an environment, single or vector, and begin anew where an episode ends."""
    env.reset(seed=seed)
    env.action_space.seed(seed)
    resets_itself = "num_envs" in dir(env) or isinstance(env, wrappers.Autoreset)
    for _ in range(steps):
        observation, reward, terminated, truncated, info = env.step(
            env.action_space.sample()
        )
        if not resets_itself and (terminated or truncated):
            env.reset()
    return observation, reward, info


# --- What libraries do with observations ---------------------------------------------------------


def test_the_target_region_is_counted_from_0_here_and_from_1_in_sensing():
    env = gymnasium.make(NAME, obstacles=20)
    assert env.observation_space["target_region"] == gymnasium.spaces.Discrete(9)
    observation, _ = env.reset(seed=0)
    assert observation["target_region"] == 0  # the robot faces its target
    assert as_sensing(observation).target_region.tolist() == [1]
    batch = gymnasium.make_vec(NAME, 2, vectorization_mode="vector_entry_point")
    many, _ = batch.reset(seed=0)
    assert many["target_region"].tolist() == [0, 0]
    assert as_sensing(many).target_region.tolist() == [1, 1]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::UserWarning")
@pytest.mark.parametrize("algorithm", ["PPO", "DQN"])
def test_stable_baselines_trains_on_the_environment_as_it_is(algorithm):
    baselines = pytest.importorskip("stable_baselines3")
    env = gymnasium.make(NAME, max_episode_steps=30)
    settings = {
        "PPO": {"n_steps": 32, "batch_size": 32, "n_epochs": 1},
        "DQN": {"learning_starts": 10, "buffer_size": 100, "batch_size": 8},
    }[algorithm]
    model = getattr(baselines, algorithm)("MultiInputPolicy", env, seed=0, **settings)
    model.learn(64)
    observation, _ = env.reset(seed=0)
    action, _ = model.predict(observation, deterministic=True)
    assert isinstance(action, np.ndarray)
    env.step(action)


@pytest.mark.filterwarnings("error")
def test_the_checker_of_stable_baselines_has_nothing_to_say():
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    checker.check_env(gymnasium.make(NAME).unwrapped)


# --- Gymnasium's wrappers ------------------------------------------------------------------------

FLAT = wrappers.FlattenObservation
LOWS, HIGHS = np.zeros(29), np.ones(29)
WRAPPERS = {
    "AddRenderObservation": wrappers.AddRenderObservation,
    "Autoreset": wrappers.Autoreset,
    "ClipReward": lambda env: wrappers.ClipReward(env, -0.5, 0.5),
    "DelayObservation": lambda env: wrappers.DelayObservation(FLAT(env), 2),
    "DiscretizeObservation": lambda env: wrappers.DiscretizeObservation(
        wrappers.TransformObservation(
            env,
            lambda seen: seen["ranges"][:2].astype(np.float32),
            gymnasium.spaces.Box(0, 10, (2,), np.float32),
        ),
        bins=4,
    ),
    "DtypeObservation": lambda env: wrappers.DtypeObservation(FLAT(env), np.float32),
    "FilterObservation": lambda env: wrappers.FilterObservation(env, ["ranges"]),
    "FlattenObservation": FLAT,
    "FrameStackObservation": lambda env: wrappers.FrameStackObservation(env, 3),
    "GrayscaleObservation": lambda env: wrappers.GrayscaleObservation(
        wrappers.AddRenderObservation(env)
    ),
    "HumanRendering": None,  # needs pygame
    "MaxAndSkipObservation": lambda env: wrappers.MaxAndSkipObservation(FLAT(env), 2),
    "NormalizeObservation": lambda env: wrappers.NormalizeObservation(FLAT(env)),
    "NormalizeReward": wrappers.NormalizeReward,
    "ObstructView": None,  # of images
    "OrderEnforcing": wrappers.OrderEnforcing,
    "PassiveEnvChecker": wrappers.PassiveEnvChecker,
    "RecordEpisodeStatistics": wrappers.RecordEpisodeStatistics,
    "RenderCollection": wrappers.RenderCollection,
    "RepeatAction": lambda env: wrappers.RepeatAction(env, 2),
    "RescaleObservation": lambda env: wrappers.RescaleObservation(
        FLAT(env), LOWS, HIGHS
    ),
    "ReshapeObservation": lambda env: wrappers.ReshapeObservation(FLAT(env), (29, 1)),
    "StickyAction": lambda env: wrappers.StickyAction(env, 0.3),
    "TimeAwareObservation": wrappers.TimeAwareObservation,
    "TimeLimit": lambda env: wrappers.TimeLimit(env, 9),
    "TransformAction": lambda env: wrappers.TransformAction(
        env, lambda action: 5 - action, gymnasium.spaces.Discrete(6)
    ),
    "TransformObservation": lambda env: wrappers.TransformObservation(
        env, lambda seen: seen["ranges"], env.observation_space["ranges"]
    ),
    "TransformReward": lambda env: wrappers.TransformReward(env, np.sign),
    "AddWhiteNoise": None,  # of images
    "AtariPreprocessing": None,  # of Atari's games
    "ClipAction": None,  # of continuous actions
    "DiscretizeAction": None,  # of continuous actions
    "RescaleAction": None,  # of continuous actions
    "RecordVideo": None,  # needs moviepy
    "ResizeObservation": None,  # needs opencv
    "ArrayConversion": None,  # tested below
    "JaxToNumpy": None,  # of environments in JAX
    "JaxToTorch": None,  # of environments in JAX
    "NumpyToTorch": None,  # tested below
}


def test_no_wrapper_of_gymnasium_is_forgotten():
    assert set(wrappers.__all__) - {"vector"} <= set(WRAPPERS)


@pytest.mark.filterwarnings("ignore:.*precision lowered")
@pytest.mark.parametrize("name", [name for name, make in WRAPPERS.items() if make])
def test_wrappers_of_one_environment(name):
    draws = name in ("AddRenderObservation", "GrayscaleObservation", "RenderCollection")
    made = gymnasium.make(
        NAME,
        obstacles=20,
        max_episode_steps=20,
        render_mode="rgb_array" if draws else None,
    )
    env = WRAPPERS[name](made)
    observation, _ = env.reset(seed=0)
    assert env.observation_space.contains(observation)
    observation, *_ = drive(env, 3 if draws else 60)
    assert env.observation_space.contains(observation)


VECTOR_FLAT = vector_wrappers.FlattenObservation
VECTOR_WRAPPERS = {
    "ClipReward": lambda env: vector_wrappers.ClipReward(env, -0.5, 0.5),
    "DictInfoToList": vector_wrappers.DictInfoToList,
    "DtypeObservation": lambda env: vector_wrappers.DtypeObservation(
        VECTOR_FLAT(env), np.float32
    ),
    "FilterObservation": lambda env: vector_wrappers.FilterObservation(env, ["ranges"]),
    "FlattenObservation": VECTOR_FLAT,
    "NormalizeObservation": lambda env: vector_wrappers.NormalizeObservation(
        VECTOR_FLAT(env)
    ),
    "NormalizeReward": vector_wrappers.NormalizeReward,
    "RecordEpisodeStatistics": vector_wrappers.RecordEpisodeStatistics,
    "RescaleObservation": lambda env: vector_wrappers.RescaleObservation(
        VECTOR_FLAT(env), LOWS, HIGHS
    ),
    "ReshapeObservation": lambda env: vector_wrappers.ReshapeObservation(
        VECTOR_FLAT(env), (29, 1)
    ),
    "TransformAction": lambda env: vector_wrappers.TransformAction(
        env, lambda actions: 5 - actions, env.action_space
    ),
    "TransformReward": lambda env: vector_wrappers.TransformReward(env, np.sign),
    "VectorizeTransformReward": lambda env: vector_wrappers.VectorizeTransformReward(
        env, wrappers.TransformReward, func=np.sign
    ),
}


@pytest.mark.filterwarnings("ignore:.*precision lowered")
@pytest.mark.parametrize("mode", ["vector_entry_point", "sync"])
@pytest.mark.parametrize("name", VECTOR_WRAPPERS)
def test_wrappers_of_vector_environments(name, mode):
    made = gymnasium.make_vec(
        NAME, 3, vectorization_mode=mode, obstacles=20, max_episode_steps=20
    )
    env = VECTOR_WRAPPERS[name](made)
    drive(env)
    observation, _ = env.reset(seed=0)
    assert env.observation_space.contains(observation)
    env.close()


@pytest.mark.parametrize("mode", [None, "vector_entry_point", "sync"])
@pytest.mark.parametrize("name", ["NumpyToTorch", "ArrayConversion"])
def test_wrappers_that_move_everything_to_tensors(mode, name):
    pytest.importorskip("array_api_compat")
    import torch

    frameworks = {"env_xp": np, "target_xp": torch} if name == "ArrayConversion" else {}
    if mode is None:
        env = getattr(wrappers, name)(gymnasium.make(NAME), **frameworks)
        actions = torch.tensor(0)
    else:
        made = gymnasium.make_vec(NAME, 2, vectorization_mode=mode)
        env = getattr(vector_wrappers, name)(made, **frameworks)
        actions = torch.tensor([0, 4])
    env.reset(seed=0)
    observation, _, _, _, info = env.step(actions)
    tensors = [*observation.values(), *info.values()]
    assert all(isinstance(value, torch.Tensor) for value in tensors)
    assert (info["outcome"] == Outcome.RUNNING).all()


def test_statistics_of_episodes():
    env = vector_wrappers.RecordEpisodeStatistics(
        gymnasium.make_vec(NAME, 3, obstacles=0, max_episode_steps=5)
    )
    env.reset(seed=0)
    for _ in range(5):
        *_, info = env.step([0, 0, 0])
    assert info["episode"]["l"].tolist() == [5, 5, 5]
    assert info["outcome"].tolist() == [Outcome.OUT_OF_STEPS] * 3


# --- Gymnasium's vector environments -------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("context", multiprocessing.get_all_start_methods())
def test_other_processes(context):
    name = f"robonav:{NAME}"
    env = AsyncVectorEnv(
        [partial(gymnasium.make, name, obstacles=5)] * 2, context=context
    )
    native = gymnasium.make_vec(name, 2, obstacles=5)
    try:
        assert_same(env.reset(seed=3), native.reset(seed=3))
        for actions in ([0, 1], [4, 5], [3, 2]):
            assert_same(env.step(actions), native.step(actions))
    finally:
        env.close()


def episode(seed):
    env = gymnasium.make(f"robonav:{NAME}")
    env.reset(seed=seed)
    return [env.step(0)[4]["pose"] for _ in range(5)]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_joblib():
    parallel = joblib.Parallel(n_jobs=2)(joblib.delayed(episode)(k) for k in range(3))
    np.testing.assert_array_equal(parallel, [episode(k) for k in range(3)])


@pytest.mark.parametrize("mode", list(AutoresetMode))
@pytest.mark.parametrize("moving", [0, 3])
def test_each_autoreset_mode_is_that_of_gymnasium(mode, moving):
    settings = {"obstacles": 20, "moving": moving, "max_episode_steps": 25}
    n = 5
    native = NavigationVectorEnv(n, autoreset_mode=mode, **settings)
    synced = SyncVectorEnv(
        [partial(NavigationEnv, **settings)] * n, autoreset_mode=mode
    )
    assert native.metadata["autoreset_mode"] is synced.metadata["autoreset_mode"]
    assert_same(native.reset(seed=3), synced.reset(seed=3))
    rng, ends = np.random.default_rng(0), 0
    for step in range(120):
        actions = rng.integers(6, size=n)
        one, other = native.step(actions), synced.step(actions)
        assert_same(one, other, f"step {step}")
        ended = one[2] | one[3]
        ends += ended.sum()
        if mode is AutoresetMode.DISABLED and ended.any():
            with pytest.raises(ValueError, match="step: the episodes of robots"):
                native.step(actions)
            options = {"reset_mask": ended}
            assert_same(
                native.reset(options=options), synced.reset(options=dict(options))
            )
    assert ends > 10


@pytest.mark.parametrize("name", ["NextStep", "SameStep", "Disabled"])
def test_the_autoreset_mode_by_name(name):
    env = gymnasium.make_vec(NAME, 2, autoreset_mode=name)
    assert env.metadata["autoreset_mode"] is AutoresetMode(name)
    assert json.loads(env.spec.to_json())["kwargs"]["autoreset_mode"] == name
    assert NavigationVectorEnv.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP


def test_a_mask_resets_the_robots_it_chooses():
    env = NavigationVectorEnv(3, obstacles=20)
    with pytest.raises(ValueError, match="reset all robots first"):
        env.reset(options={"reset_mask": np.array([True, False, True])})
    env.reset(seed=0)
    for _ in range(3):
        *_, before = env.step([0, 0, 0])
    mask = np.array([True, False, True])
    _, info = env.reset(seed=[7, 8, 9], options={"reset_mask": mask})
    assert info["_pose"].tolist() == mask.tolist()
    *_, after = env.step([5, 5, 5])
    assert np.hypot(*(after["pose"][1, :2] - before["pose"][1, :2])) < 2.1
    fresh = NavigationVectorEnv(3, obstacles=20)
    fresh.reset(seed=[7, 8, 9])
    *_, expected = fresh.step([5, 5, 5])
    np.testing.assert_array_equal(after["pose"][mask], expected["pose"][mask])
    worlds = random_worlds(3, 20, seed=1)
    env.reset(options={"reset_mask": mask, "worlds": worlds})
    assert env.simulator.worlds[[0, 2]].digest() == worlds[[0, 2]].digest()


@pytest.mark.parametrize(
    "mask", [[True, False], np.array([1, 0, 1]), np.zeros(3, bool), "all"]
)
def test_bad_masks_are_refused_with_a_sentence(mask):
    env = NavigationVectorEnv(3)
    env.reset(seed=0)
    with pytest.raises(ValueError, match=r"options\['reset_mask'\] must be a bool arr"):
        env.reset(options={"reset_mask": mask})


@pytest.mark.parametrize(
    "seeds",
    [
        (4, 5, 6),
        [4, 5, 6],
        np.array([4, 5, 6]),
        np.array([4, 5, 6], dtype=np.uint8),
        range(4, 7),
        np.int64(4),
        4,
    ],
    ids=str,
)
def test_seeds_of_the_vector_environment(seeds):
    expected = NavigationVectorEnv(3).reset(seed=[4, 5, 6])
    assert_same(NavigationVectorEnv(3).reset(seed=seeds), expected)


# --- Options of gymnasium.make -------------------------------------------------------------------


def test_minus_one_is_no_limit():
    worlds = random_worlds(1, 0, seed=0)
    made = [
        gymnasium.make(NAME, worlds=worlds, reflex=None, max_episode_steps=-1),
        NavigationEnv(worlds=worlds, reflex=None, max_episode_steps=-1),
        NavigationEnv(worlds=worlds, reflex=None),
    ]
    for env in made:
        env.reset(seed=0)
        for _ in range(700):  # six turns of 60 degrees: in circles
            *_, terminated, truncated, _ = env.step(Action.L60)
            assert (terminated, truncated) == (False, False)
    batch = gymnasium.make_vec(
        NAME, 2, worlds=worlds, reflex=None, max_episode_steps=-1
    )
    batch.reset(seed=0)
    for _ in range(700):
        *_, terminated, truncated, _ = batch.step([Action.L60] * 2)
        assert not (terminated | truncated).any()


def test_the_specification_is_json_and_makes_the_same_environment(tmp_path):
    save_worlds(tmp_path / "worlds.npz", random_worlds(4, 8, seed=2))
    settings = {
        "worlds": str(tmp_path / "worlds.npz"),
        "speed": 2.5,
        "slip": neighbour_slip(0.2).tolist(),
        "noise": 0.1,
        "starts": [[10, 10]],
        "reward": "robonav.nnql:reward",
        "reflex": "sector",
        "max_episode_steps": 30,
    }
    for kwargs in ({}, settings):
        env = gymnasium.make(NAME, **kwargs)
        again = gymnasium.make(type(env.spec).from_json(env.spec.to_json()))
        assert_same(env.reset(seed=1), again.reset(seed=1))
        for action in (0, 1, 4, 0, 0):
            assert_same(env.step(action), again.step(action))
    assert env.unwrapped.settings.reflex == Reflex("sector")
    batch = gymnasium.make_vec(NAME, 2, **settings)
    assert json.loads(batch.spec.to_json())["kwargs"]["reward"] == settings["reward"]


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])  # fmt: skip
@pytest.mark.parametrize("number", [None, 3])
def test_copies_go_on_alike(copied, number):
    settings = {"moving": 3, "max_episode_steps": 15}
    if number is None:
        env, actions = gymnasium.make(NAME, **settings), 1
    else:
        env, actions = gymnasium.make_vec(NAME, number, **settings), [1] * number
    env.reset(seed=0)
    env.step(actions)
    twin = copied(env)
    for _ in range(10):
        assert_same(env.step(actions), twin.step(actions))
    assert_same(env.reset(), twin.reset())


@pytest.mark.parametrize(
    "action", [1, np.int64(1), np.array(1), np.uint8(1), Action.L30]
)
def test_an_action_may_be_any_whole_number(action):
    env, other = NavigationEnv(obstacles=20), NavigationEnv(obstacles=20)
    env.reset(seed=0)
    other.reset(seed=0)
    assert_same(env.step(action), other.step(1))
