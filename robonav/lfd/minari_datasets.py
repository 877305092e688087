"""Demonstrations as Minari datasets, which libraries of offline reinforcement learning share.

An observation is one of ``robonav/Navigation-v0``. Minari keeps an observation after the last action as well, which
demonstrations do not: the last one is written twice. Rewards are those of the environment, 1 for an arrival and -1 for
a collision.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np

from robonav.robot import OUTCOMES, Action, Sensing, Worlds, concatenate_worlds
from robonav.robot.environment_settings import REWARD_OF_OUTCOME
from robonav.robot.environments import NavigationEnv, as_sensing
from robonav.validation import check_instance

from .demonstrations import Demonstrations

if TYPE_CHECKING:
    import minari

SENSED = tuple(field.name for field in fields(Sensing))
REWARDS = dict(zip(OUTCOMES.tolist(), REWARD_OF_OUTCOME.tolist(), strict=True))


def to_minari(
    demonstrations: Demonstrations, dataset_id: str, **about: Any
) -> minari.MinariDataset:
    """Write demonstrations as a Minari dataset, one episode for each trajectory.

    Parameters
    ----------
    demonstrations : Demonstrations
        By any expert. A trajectory without a step is an error.
    dataset_id : str
        Minari's name of the dataset, such as ``"robonav/experts-v0"``. There must be no dataset of this name.
    **about
        Further arguments of ``minari.create_dataset_from_buffers``, such as ``author`` and ``data_format``.

    Returns
    -------
    minari.MinariDataset
        The dataset. It is in Minari's folder, which the variable MINARI_DATASETS_PATH names.

    Raises
    ------
    ModuleNotFoundError
        If Minari is not installed: ``pip install "minari[hdf5]"``.
    ValueError
        If a trajectory has no step, or there is a dataset of this name.

    Examples
    --------
    >>> from robonav.lfd import demonstrate, from_minari, to_minari
    >>> from robonav.robot import random_worlds
    >>> experts = demonstrate(random_worlds(2, obstacles=10, seed=1))
    >>> dataset = to_minari(experts, "robonav/experts-v0")  # doctest: +SKIP
    >>> len(from_minari(dataset)) == len(experts)  # doctest: +SKIP
    True
    """
    import minari
    from minari.data_collector import EpisodeBuffer

    check_instance("demonstrations", demonstrations, Demonstrations)
    if (demonstrations.lengths == 0).any():
        empty = int(demonstrations.lengths.argmin())
        raise ValueError(
            f"demonstrations must hold a step of each trajectory, got none of {empty}"
        )
    several = [
        demonstrations.select_trajectories([number])
        for number in range(len(demonstrations.worlds))
    ]
    dataset = minari.create_dataset_from_buffers(
        dataset_id,
        [EpisodeBuffer(id=n, **_episode(one)) for n, one in enumerate(several)],
        observation_space=NavigationEnv().observation_space,
        action_space=gymnasium.spaces.Discrete(len(Action)),
        **about,
    )
    dataset.storage.update_episode_metadata(
        [
            {
                "world": _world_as_text(one.worlds),
                "speed": one.speed,
                "outcome": str(one.outcome[0]),
            }
            for one in several
        ]
    )
    return dataset


def from_minari(dataset: minari.MinariDataset) -> Demonstrations:
    """Read demonstrations from a Minari dataset.

    Parameters
    ----------
    dataset : minari.MinariDataset
        Written by :func:`to_minari`, or collected from ``robonav/Navigation-v0`` by ``minari.DataCollector`` with
        ``record_infos=True``. The worlds of a collected dataset are drawn again from the seeds of its episodes.

    Returns
    -------
    Demonstrations

    Raises
    ------
    ValueError
        If the observations are not those of the environment, the infos were not recorded, or an episode of a collected
        dataset has no seed.

    Examples
    --------
    >>> import minari
    >>> from robonav.lfd import from_minari, learn_policy
    >>> experts = from_minari(minari.load_dataset("robonav/experts-v0"))  # doctest: +SKIP
    >>> policy = learn_policy(experts)  # doctest: +SKIP
    """
    if dataset.observation_space != NavigationEnv().observation_space:
        raise ValueError(
            "dataset must hold observations of robonav/Navigation-v0, got those of "
            f"{dataset.observation_space}"
        )
    episodes = list(dataset.iterate_episodes())
    if any("pose" not in (episode.infos or {}) for episode in episodes):
        raise ValueError(
            "dataset must hold the infos of its episodes: collect it with record_infos=True"
        )
    about = list(dataset.storage.get_episode_metadata(range(len(episodes))))
    worlds, speed = _worlds(dataset, about)
    lengths = [len(episode.actions) for episode in episodes]
    return Demonstrations(
        worlds=worlds,
        trajectory=np.repeat(np.arange(len(episodes)), lengths),
        sensing=as_sensing(
            {
                name: np.concatenate(
                    [each.observations[name][:-1] for each in episodes]
                )
                for name in SENSED
            }
        ),
        actions=np.concatenate([_executed(episode) for episode in episodes]),
        poses=np.concatenate([episode.infos["pose"][:-1] for episode in episodes]),
        speed=speed,
        outcome=np.array(
            [_outcome(*pair) for pair in zip(episodes, about, strict=True)]
        ),
    )


def _episode(one: Demonstrations) -> dict[str, Any]:
    """Return the arrays of Minari's episode: T actions, and T + 1 observations and infos."""
    steps = len(one)
    once_more = np.append(np.arange(steps), steps - 1)
    rewards = np.zeros(steps)
    rewards[-1] = REWARDS[str(one.outcome[0])]
    ends = np.arange(steps) == steps - 1
    sensing = one.sensing[once_more]
    return {
        "observations": {
            "ranges": sensing.ranges,
            "walls": sensing.walls.astype(np.int8),
            "target_region": sensing.target_region - 1,
            "target_seen": sensing.target_seen.astype(np.int64),
        },
        "actions": one.actions,
        "rewards": rewards,
        "terminations": ends & (one.outcome[0] != "out of steps"),
        "truncations": ends & (one.outcome[0] == "out of steps"),
        "infos": {"pose": one.poses[once_more]},
    }


def _world_as_text(world: Worlds) -> str:
    """Return a batch of one world as JSON."""
    arrays = {field.name: getattr(world, field.name) for field in fields(Worlds)}
    return json.dumps(
        {name: np.asarray(value).tolist() for name, value in arrays.items()}
    )


def _worlds(
    dataset: minari.MinariDataset, about: Sequence[dict[str, Any]]
) -> tuple[Worlds, float]:
    """Return the worlds of all episodes and the robots' speed."""
    if all("world" in episode for episode in about):
        worlds = [Worlds(**json.loads(episode["world"])) for episode in about]
        return concatenate_worlds(worlds), float(about[0]["speed"])
    env = dataset.recover_environment().unwrapped
    worlds = []
    for episode in about:
        if episode.get("seed") is None:
            raise ValueError(
                "dataset must have a seed for each episode, got one without. Minari drops the seeds of episodes that "
                "are added to a dataset: keep each recording as a dataset, and concatenate the demonstrations"
            )
        env.reset(seed=int(episode["seed"]))
        worlds.append(env.world)
    return concatenate_worlds(worlds), float(env.settings.speed)


def _executed(episode: minari.EpisodeData) -> Any:
    """Return the actions that the robot executed: the reflex's where it acted."""
    reflex = episode.infos.get("reflex")
    if reflex is None:
        return episode.actions
    acted = np.asarray(reflex)[1:]  # the info of a step comes after its action
    return np.where(acted >= 0, acted, episode.actions)


def _outcome(episode: minari.EpisodeData, about: dict[str, Any]) -> str:
    """Return how an episode ended."""
    if "outcome" in about:
        return str(about["outcome"])
    ended = {1.0: "arrived", -1.0: "collided"}
    return ended.get(float(episode.rewards[-1]), "out of steps")
