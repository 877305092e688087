"""The conditions of section 4.5, which all experiments of chapter 4 share. They are in ``settings.toml``.

A run is one training seed: it trains a network and tests its greedy policy in new worlds. The worlds for training, for
tuning and for tests are all different.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from robonav.benchmark import BASELINES
from robonav.networks import NetworkPolicy
from robonav.nnql import (
    STARTS,
    TARGETS,
    NavigationTask,
    TrainingResult,
    double_dqn_targets,
    train,
)
from robonav.robot import NNQL_SENSORS, Encoder, Policy, Worlds

from ..runner.settings import Settings, read_settings
from ..runner.setup import Setup

FOLDER = Path(__file__).parent
CONDITIONS = read_settings(FOLDER / "settings.toml")
SETUP = Setup(**CONDITIONS["test"], ends={"starts": STARTS, "targets": TARGETS})
EPISODES: int = CONDITIONS["episodes"]
BLOCK: int = CONDITIONS["block"]
SEEDS_PER_BATCH: Mapping[str, int] = CONDITIONS["seeds_per_batch"]
SHORTENED: Mapping[str, float] = CONDITIONS["shortened"]
EVALUATION_TEMPERATURE: Mapping[str, float] = CONDITIONS["evaluation_temperature"]
THESIS = {name: Settings.of(values) for name, values in CONDITIONS["thesis"].items()}
VARIANTS: dict[str, dict[str, Any]] = {"dqn": {"targets": double_dqn_targets}}
"""What all trainings of a method have in common besides their hyperparameters: DQN is double DQN in every table."""
DECAYING = Settings.of(CONDITIONS["decaying"]["nnql"])

HYPERPARAMETERS = FOLDER / "hyperparameters.toml"
"""The hyperparameters of Table 4.3, as :mod:`robonav.experiments.chapter4.tuning` wrote them."""

ABOUT: Mapping[str, Any] = {
    "episodes": EPISODES,
    "navigations a run": SETUP.navigations,
    "first seed of the worlds": SETUP.test_seed,
}


@lru_cache(maxsize=1)
def tuned() -> dict[str, Settings]:
    """Return the tuned hyperparameters of each method.

    Returns
    -------
    dict
        Hyperparameters by method.

    Examples
    --------
    >>> from robonav.experiments.chapter4.setup import tuned
    >>> sorted(tuned())
    ['dqn', 'nfq', 'nnql', 'online']
    """
    found = read_settings(HYPERPARAMETERS)
    return {method: Settings.of(values) for method, values in found.items()}


def task(*, target: str = "number", **changes: Any) -> NavigationTask:
    """Return the training task of section 4.5, with one of the encodings of the target's sector.

    Parameters
    ----------
    target : str
        The encoding, as :class:`robonav.robot.Encoder` names it.
    **changes
        Other attributes of :class:`robonav.nnql.NavigationTask`.

    Returns
    -------
    NavigationTask

    Examples
    --------
    >>> from robonav.experiments.chapter4.setup import task
    >>> task(obstacles=20).obstacles
    20
    """
    encoder = Encoder(NNQL_SENSORS, walls=True, target=target)
    usual: dict[str, Any] = {"encoder": encoder, "reflex": SETUP.reflex}
    return NavigationTask(**(usual | changes))


def training(
    method: str,
    seed: int,
    scale: str,
    settings: Settings,
    *,
    length: float = 1.0,
    **changes: Any,
) -> TrainingResult:
    """One seed of a method.

    At the thesis's scale ``SEEDS_PER_BATCH`` seeds train together. Trainings are kept in memory, because several tables
    test the same networks.

    Parameters
    ----------
    method : str
        A method of :func:`robonav.nnql.train`.
    seed : int
        The seed.
    scale : str
        "quick" or "thesis".
    settings : Settings
        Hyperparameters.
    length : float
        The number of episodes relative to the usual number.
    **changes
        Changes of the :func:`task`, and the option ``record``.
    """
    batch = SEEDS_PER_BATCH[scale]
    episodes = round(EPISODES * length)
    whole = _training(method, batch_of(seed, batch), episodes, settings, **changes)
    return whole[seed % batch]


@lru_cache(maxsize=64)
def _training(
    method: str,
    seeds: range,
    episodes: int,
    settings: Settings,
    *,
    record: bool = False,
    **changes: Any,
) -> TrainingResult:
    options = dict(settings) | VARIANTS.get(method, {})
    where = task(target=options.pop("target"), **changes)
    return train(method, seeds, episodes, task=where, record=record, **options)


def batch_of(seed: int, size: int) -> range:
    """Return the seeds that train together with this one, in batches of a size."""
    first = seed - seed % size
    return range(first, first + size)


def trained_policy(name: str, seed: int, scale: str, **changes: Any) -> Policy:
    """Return a baseline, or the policy of one training with the tuned hyperparameters."""
    if name in BASELINES:
        return BASELINES[name]
    return training(name, seed, scale, tuned()[name], **changes).policies[0]


def evaluate(
    policy: Policy,
    worlds: Worlds,
    speed: float | None = None,
    *,
    temperature: float = EVALUATION_TEMPERATURE["nnql"],
) -> dict[str, float]:
    """Return the outcome rates of a greedy policy (Algorithm 9), and a network's success at a low temperature."""
    rates = SETUP.evaluate(policy, worlds, speed)
    if isinstance(policy, NetworkPolicy):
        nearly_greedy = replace(policy, temperature=temperature)
        success = SETUP.evaluate(nearly_greedy, worlds, speed)["success"]
        rates["success, low temperature"] = success
    return rates


def blocks(successes: ArrayLike, size: int = BLOCK) -> np.ndarray:
    """Count successes in blocks of episodes. An incomplete last block is dropped.

    Parameters
    ----------
    successes : (S, E) array of bool
        Of S seeds and E episodes.
    size : int
        Episodes in a block.

    Returns
    -------
    (S, E / size) array

    Examples
    --------
    >>> from robonav.experiments.chapter4.setup import blocks
    >>> blocks([[True, False, True, True, False]], size=2)
    array([[1, 2]])
    """
    arrived = np.asarray(successes)
    seeds, episodes = arrived.shape
    counts: np.ndarray = (
        arrived[:, : episodes // size * size].reshape(seeds, -1, size).sum(axis=2)
    )
    return counts
