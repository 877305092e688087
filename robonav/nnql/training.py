"""Training of many seeds at once: the result, and the dispatch to the fast twins of this chapter's methods."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.networks import random_network
from robonav.networks.multilayer_perceptron import Network
from robonav.networks.network_stack import NetworkStack, stacked
from robonav.networks.policy import NetworkPolicy
from robonav.progress import Progress
from robonav.robot import OUTCOMES, Encoder
from robonav.validation import (
    check_argument,
    check_instance,
    check_integer,
    check_one_of,
)

from ._arguments import RULES
from ._fast.agents import make_agent
from ._fast.checkpoints import load_checkpoint, save_checkpoint
from ._fast.networks import BatchedNetworks, vectors_to_parameters
from ._fast.trainer import EpisodeStatistics, Trainer
from .dqn import dqn
from .nfq import nfq
from .nnql import nnql, online
from .task import ACTIONS, INITIAL, NavigationTask, make_rng

Array = NDArray[np.float64]

METHODS: dict[str, Callable[..., Network]] = {
    "nnql": nnql,
    "online": online,
    "nfq": nfq,
    "dqn": dqn,
}
"""The readable functions of this chapter, by name; :func:`train` runs their fast twins."""


@dataclass(frozen=True, eq=False)
class TrainingResult:
    """S trained networks and how their training went, over E episodes.

    Attributes
    ----------
    method : str
        "nnql", "online", "nfq" or "dqn".
    seeds : (S,) tuple of int
        The seeds.
    network : NetworkStack
        Stack (S,) of the trained networks.
    encoder : Encoder
        Turns what is sensed into the networks' inputs.
    outcomes : (S, E) array of str
        "arrived", "collided" or "out of steps".
    steps, decisions : (S, E) arrays of int
        Seconds that an episode took, and in how many of them the policy decided.
    returns : (S, E) array
        Sums of the rewards of these decisions.
    settings : dict
        Settings of the method, by name.
    history : NetworkStack or None
        Stack (S, E + 1) of the networks after 0, 1, ... E episodes, if recorded.
    paths : tuple or None
        For each seed, for each episode, poses (steps + 1, 3), if recorded.

    Examples
    --------
    >>> from robonav.nnql import train
    >>> result = train("nnql", seeds=2, episodes=3)
    >>> result.outcomes.shape, len(result.policies), len(result[1].seeds)
    ((2, 3), 2, 1)
    """

    method: str
    seeds: tuple[int, ...]
    network: NetworkStack
    encoder: Encoder
    outcomes: NDArray[np.str_]
    steps: NDArray[np.int64]
    decisions: NDArray[np.int64]
    returns: Array
    settings: dict[str, Any]
    history: NetworkStack | None = None
    paths: tuple[tuple[Array, ...], ...] | None = None

    def __getitem__(self, row: int) -> TrainingResult:
        """The training of one seed, the same as if it had trained alone."""
        if not 0 <= row < len(self.seeds):
            raise IndexError(f"row must be 0 to {len(self.seeds) - 1}, got {row}")
        own = slice(row, row + 1)
        return replace(
            self,
            seeds=self.seeds[own],
            network=self.network[own],
            outcomes=self.outcomes[own],
            steps=self.steps[own],
            decisions=self.decisions[own],
            returns=self.returns[own],
            history=None if self.history is None else self.history[own],
            paths=None if self.paths is None else self.paths[own],
        )

    @property
    def successes(self) -> NDArray[np.bool_]:
        """(S, E) whether the robot arrived."""
        return self.outcomes == "arrived"

    @cached_property
    def policies(self) -> tuple[NetworkPolicy, ...]:
        """The greedy policy of each seed."""
        return tuple(
            NetworkPolicy(self.network[row], self.encoder)
            for row in range(len(self.seeds))
        )


def train(
    method: str = "nnql",
    seeds: int | Sequence[int] = 16,
    episodes: int = 300,
    *,
    task: NavigationTask | None = None,
    hidden: int = 8,
    record: bool = False,
    checkpoint: str | Path | None = None,
    checkpoint_interval: int = 50,
    progress: Progress | None = None,
    **settings: Any,
) -> TrainingResult:
    """Train one network for each seed, by a method of this chapter.

    The networks train together, each as the readable function of that name (:func:`nnql`, :func:`online`, :func:`nfq`,
    :func:`dqn`) trains it in ``task.environment()``. All seeds step in one simulator, and compiled code trains their
    networks.

    Parameters
    ----------
    method : {"nnql", "online", "nfq", "dqn"}
        The method.
    seeds : int or sequence of int
        A number S for the seeds 0 to S - 1, or the seeds themselves.
    episodes : int
        Episodes E, each in a new world.
    task : NavigationTask, optional
        What to train on; by default the task of section 4.5.
    hidden : int
        Units of the hidden layer.
    record : bool
        Keep the networks and the paths of every episode.
    checkpoint : str or Path, optional
        File that training saves itself to, and continues from if the file is there.
    checkpoint_interval : int
        Episodes between two savings.
    progress : callable, optional
        Called as ``progress(episodes done, S * E)``.
    **settings
        Keyword arguments of the method's readable function, which also has their defaults.

    Returns
    -------
    TrainingResult
        With ``successes`` (S, E) and ``policies``, one for each seed.

    Raises
    ------
    ValueError, TypeError
        If an argument is out of bounds, or the checkpoint is of another training.

    Examples
    --------
    >>> from robonav.nnql import train
    >>> result = train("nnql", seeds=2, episodes=3, discount=0.7)
    >>> result.successes.shape, len(result.policies)
    ((2, 3), 2)
    """
    settings = method_settings(check_one_of("method", method, METHODS), settings)
    task = NavigationTask() if task is None else task
    check_instance("task", task, NavigationTask)
    seeds = check_seeds(seeds)
    check_integer("episodes", episodes, at_least=1)
    check_integer("checkpoint_interval", checkpoint_interval, at_least=1)
    sizes = (task.encoder.size, check_integer("hidden", hidden, at_least=1), ACTIONS)
    if record and checkpoint is not None:
        raise ValueError(
            "record must be False with a checkpoint, which does not hold the history"
        )
    networks = BatchedNetworks(
        stacked([random_network(sizes, seed=make_rng(seed, INITIAL)) for seed in seeds])
    )
    own = {name: value for name, value in settings.items() if name != "temperature"}
    agent = make_agent(method, networks, seeds, task.max_steps, sizes, own)
    statistics = EpisodeStatistics(len(seeds), episodes, record=record)
    temperature, settings = settings["temperature"], settings | {"hidden": hidden}
    identity = {
        "method": method, "seeds": seeds, "episodes": episodes, "task": task, "settings": settings,
    }  # fmt: skip
    done, interval = 0, episodes
    if checkpoint is not None:
        done = load_checkpoint(checkpoint, identity, agent, statistics)
        interval = checkpoint_interval
    while done < episodes:
        last = min(done + interval, episodes)
        Trainer(
            agent, task, seeds, episodes, temperature, statistics, first=done, last=last
        ).run(progress)  # fmt: skip
        done = last
        if checkpoint is not None:
            save_checkpoint(checkpoint, identity, agent, statistics, done)
    return _result(method, seeds, agent, task, sizes, statistics, settings)


def method_settings(method: str, given: dict[str, Any]) -> dict[str, Any]:
    """The settings of a method: those given, checked, and the defaults of its readable function."""
    parameters = inspect.signature(METHODS[method]).parameters.values()
    defaults = {p.name: p.default for p in parameters if p.default is not p.empty}
    for name in given:
        if name not in defaults:
            raise TypeError(
                f"{method} takes the settings {', '.join(defaults)}, got {name}"
            )
    merged = defaults | given
    return {
        name: check_argument(RULES, method, name, value)
        for name, value in merged.items()
    }


def check_seeds(seeds: int | Sequence[int]) -> tuple[int, ...]:
    """Seeds (S,), all different: 0 to S - 1 for a number S, or those given."""
    if isinstance(seeds, int | np.integer):
        return tuple(range(check_integer("seeds", seeds, at_least=1)))
    numbers = tuple(check_integer("seeds", seed, at_least=0) for seed in seeds)
    if not numbers or len(set(numbers)) < len(numbers):
        raise ValueError(
            f"seeds must be at least one, and all different, got {list(numbers)}"
        )
    return numbers


def _result(
    method: str,
    seeds: tuple[int, ...],
    agent: Any,
    task: NavigationTask,
    sizes: tuple[int, ...],
    statistics: EpisodeStatistics,
    settings: Any,
) -> TrainingResult:
    parameters = agent.networks.parameters()
    history, paths = None, None
    if statistics.record:
        past = np.array(
            [[*begun, parameters[k]] for k, begun in enumerate(statistics.parameters)]
        )
        history = vectors_to_parameters(past, sizes)
        paths = tuple(tuple(episodes) for episodes in statistics.paths)
    return TrainingResult(
        method,
        seeds,
        vectors_to_parameters(parameters, sizes),
        task.encoder,
        OUTCOMES[statistics.outcomes],
        statistics.steps,
        statistics.decisions,
        statistics.returns,
        settings,
        history,
        paths,
    )


def weight_changes(history: NetworkStack, *, absolute: bool = False) -> Array:
    """How much the weights of each layer changed in each episode, summed over the layer, biases included (Fig. 4.3).

    Parameters
    ----------
    history : NetworkStack
        Stack (S, E + 1), see :class:`TrainingResult`.
    absolute : bool
        Sum absolute instead of signed changes, which can cancel.

    Returns
    -------
    (S, E, layers) array
        The sums.

    Examples
    --------
    >>> from robonav.nnql import train, weight_changes
    >>> weight_changes(train("nnql", seeds=2, episodes=3, record=True).history).shape
    (2, 3, 2)
    """
    sums = []
    for weight, bias in zip(history.weights, history.biases, strict=True):
        moved = np.diff(np.concatenate([weight, bias[..., None]], axis=-1), axis=1)
        sums.append((np.abs(moved) if absolute else moved).sum(axis=(-2, -1)))
    return np.stack(sums, axis=-1)
