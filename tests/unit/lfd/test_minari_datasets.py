"""Demonstrations as Minari datasets and back, and datasets that Minari's own collector made."""

import gymnasium
import minari
import numpy as np
import pytest

from robonav.lfd import (
    concatenate,
    demonstrate,
    from_minari,
    record_demonstrations,
    to_minari,
)
from robonav.robot import Action, random_worlds, turn_to_clearer_side
from robonav.robot.environments import as_sensing

# Minari asks for an author, a licence and more of every dataset.
pytestmark = [
    pytest.mark.filterwarnings("ignore:.*set to None:UserWarning"),
    pytest.mark.filterwarnings("ignore:env_spec is None:UserWarning"),
    pytest.mark.filterwarnings(
        "ignore::pytest.PytestUnraisableExceptionWarning"
    ),  # its temporary folders
]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))


def assert_same(one, other):
    for name in ("trajectory", "actions", "poses", "outcome"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    for name in ("ranges", "walls", "target_region", "target_seen"):
        np.testing.assert_array_equal(
            getattr(one.sensing, name), getattr(other.sensing, name)
        )
    for name in ("kinds", "shapes", "centres", "starts", "targets", "keys"):
        np.testing.assert_array_equal(
            getattr(one.worlds, name), getattr(other.worlds, name)
        )
    assert (one.speed, one.worlds.size) == (other.speed, other.worlds.size)


def test_there_and_back():
    experts = demonstrate(random_worlds(3, obstacles=10, moving=2, seed=1))
    to_minari(experts, "robonav/experts-v0", author="a test")
    dataset = minari.load_dataset("robonav/experts-v0")
    assert dataset.total_episodes == 3
    assert dataset.total_steps == len(experts)
    assert_same(from_minari(dataset), experts)
    episode = dataset[0]
    assert episode.rewards.sum() == 1
    assert episode.terminations.tolist() == [False] * (len(episode.actions) - 1) + [
        True
    ]
    assert {Action.TO_TARGET, Action.TO_SECTOR} & {*episode.actions}


def test_episodes_of_other_endings():
    worlds = random_worlds(8, obstacles=10, seed=4)

    def ahead(simulator, robots):
        return np.zeros(len(robots), int)

    straight = record_demonstrations(ahead, worlds, max_steps=40)
    assert {"collided", "out of steps"} <= set(straight.outcome)
    assert_same(from_minari(to_minari(straight, "robonav/straight-v0")), straight)


@pytest.mark.slow
def test_what_minaris_collector_records():
    env = gymnasium.make("robonav/Navigation-v0", obstacles=10, speed=2.5)
    collector = minari.DataCollector(env, record_infos=True)
    seen = []
    for seed in (7, 8):
        observation, info = collector.reset(seed=seed)
        ended = False
        while not ended:
            action = int(turn_to_clearer_side(as_sensing(observation), None)[0])
            seen.append(np.array(info["pose"]))
            observation, _, terminated, truncated, info = collector.step(action)
            ended = terminated or truncated
    dataset = collector.create_dataset("robonav/rule-v0", algorithm_name="rule")
    collector.close()
    read = from_minari(dataset)
    np.testing.assert_allclose(read.poses, seen)
    assert read.speed == 2.5
    again = record_demonstrations(
        lambda simulator, robots: turn_to_clearer_side(simulator.sense()[robots], None),
        read.worlds,
        speed=2.5,
    )
    np.testing.assert_allclose(again.poses, read.poses)
    np.testing.assert_array_equal(again.outcome, read.outcome)


def test_a_dataset_of_another_environment_is_refused():
    env = minari.DataCollector(gymnasium.make("CartPole-v1"))
    env.reset(seed=0)
    env.step(env.action_space.sample())
    dataset = env.create_dataset("cartpole/one-v0")
    env.close()
    with pytest.raises(ValueError, match="observations of robonav/Navigation-v0"):
        from_minari(dataset)


def test_a_recording_is_continued_in_a_second_dataset():
    """Minari drops the seeds of episodes that are added, so the error says what to do instead."""
    collector = minari.DataCollector(
        gymnasium.make("robonav/Navigation-v0", max_episode_steps=20),
        record_infos=True,
    )

    def collect(seeds):
        for seed in seeds:
            collector.reset(seed=seed)
            ended = False
            while not ended:
                _, _, terminated, truncated, _ = collector.step(0)
                ended = terminated or truncated

    collect([1, 2])
    first = collector.create_dataset("robonav/first-v0")
    collect([3])
    second = collector.create_dataset("robonav/second-v0")
    both = concatenate([from_minari(first), from_minari(second)])
    assert len(both.worlds) == 3
    collect([4])
    collector.add_to_dataset(first)
    with pytest.raises(ValueError, match="keep each recording as a dataset"):
        from_minari(first)
