"""From seeds to trained networks: the frame in which every method of this chapter trains."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, TypedDict

import numpy as np
from numpy.typing import NDArray

from robonav.networks.multilayer_perceptron import Network, random_network, stacked
from robonav.networks.policy import NetworkPolicy
from robonav.progress import Progress
from robonav.robot import OUTCOMES, Encoder
from robonav.validation import check_integer

from .agents import Agent
from .checkpoints import load_checkpoint, save_checkpoint
from .networks import CompiledNetworks, Networks, TorchNetworks, network_of
from .schedules import Schedule, check_schedule
from .trainer import (
    ACTIONS,
    INITIAL,
    EpisodeStatistics,
    NavigationTask,
    Trainer,
    make_rng,
)

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TrainingResult:
    """S trained networks and how their training went, over E episodes.

    Attributes
    ----------
    method : "nnql", "online", "nfq" or "dqn".
    seeds : (S,) whole numbers.
    network : stack (S,) of what was learned.
    encoder : how what is sensed becomes the networks' inputs.
    outcomes : (S, E) "arrived", "collided" or "out of steps".
    steps, decisions : (S, E) seconds an episode took, and in how many of them the policy decided.
    returns : (S, E) sums of the rewards of these decisions.
    settings : of the method, by name.
    history : stack (S, E + 1) of the networks after 0, 1, ... E episodes, if recorded.
    paths : for each seed, for each episode, poses (steps + 1, 3), if recorded.
    """

    method: str
    seeds: tuple[int, ...]
    network: Network
    encoder: Encoder
    outcomes: NDArray[np.str_]
    steps: NDArray[np.int64]
    decisions: NDArray[np.int64]
    returns: Array
    settings: dict[str, Any]
    history: Network | None = None
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
        """The greedy policy (Algorithm 9) of each seed."""
        return tuple(
            NetworkPolicy(self.network[row], self.encoder)
            for row in range(len(self.seeds))
        )


class Common(TypedDict, total=False):
    """What every method takes.

    Attributes
    ----------
    task : what the robot trains on.
    hidden : units of the hidden layer.
    device : "cpu" for compiled kernels, or a device that torch has, such as "cuda".
    record : keep the networks and the paths of every episode.
    checkpoint : file to save to as training goes on, and to go on from if it is there.
    every : episodes between two savings.
    progress : called as ``progress(episodes done, S * E)``.
    """

    task: NavigationTask
    hidden: int
    device: str
    record: bool
    checkpoint: str | Path | None
    every: int
    progress: Progress | None


def run_training(
    method: str,
    make_agent: Callable[[Networks, tuple[int, ...], NavigationTask], Agent],
    seeds: int | Sequence[int],
    episodes: int,
    *,
    temperature: Schedule,
    settings: dict[str, Any],
    task: NavigationTask | None = None,
    hidden: int = 8,
    device: str = "cpu",
    record: bool = False,
    checkpoint: str | Path | None = None,
    every: int = 50,
    progress: Progress | None = None,
) -> TrainingResult:
    """Train S networks by one method; see :class:`Common` for what is not said here.

    Parameters
    ----------
    method : its name.
    make_agent : from S networks with random weights, S seeds and the task, what learns.
    seeds : S, for the seeds 0 to S - 1; or the seeds themselves.
    episodes : E.
    temperature : T of the Boltzmann policy, from the first episode to the last.
    settings : of the method, kept with the result; a checkpoint of others is refused.

    Raises
    ------
    ValueError, TypeError : if an argument is out of bounds, or a checkpoint is of another training.
    """
    task = task or NavigationTask()
    numbers = check_seeds(seeds)
    check_integer("episodes", episodes, at_least=1)
    check_integer("every", every, at_least=1)
    sizes = (task.encoder.size, check_integer("hidden", hidden, at_least=1), ACTIONS)
    settings = {
        "temperature": check_schedule("temperature", temperature),
        "hidden": hidden,
        **settings,
    }
    start = stacked(
        [random_network(sizes, seed=make_rng(seed, INITIAL)) for seed in numbers]
    )
    networks: Networks = (
        CompiledNetworks(start) if device == "cpu" else TorchNetworks(start, device)
    )
    agent, statistics = (
        make_agent(networks, numbers, task),
        EpisodeStatistics(len(numbers), episodes, record=record),
    )
    identity = {
        "method": method,
        "seeds": numbers,
        "episodes": episodes,
        "task": task,
        "settings": settings,
    }
    done = 0
    if checkpoint is not None:
        if record:
            raise ValueError(
                "record must be False with a checkpoint, which does not hold the history"
            )
        done = load_checkpoint(checkpoint, identity, agent, statistics)
    while done < episodes:
        last = episodes if checkpoint is None else min(done + every, episodes)
        Trainer(
            agent,
            task,
            numbers,
            episodes,
            temperature,
            statistics,
            first=done,
            last=last,
        ).run(progress)
        done = last
        if checkpoint is not None:
            save_checkpoint(checkpoint, identity, agent, statistics, done)
    return _training(method, numbers, agent, task, sizes, statistics, settings)


def _training(
    method: str,
    seeds: tuple[int, ...],
    agent: Agent,
    task: NavigationTask,
    sizes: tuple[int, ...],
    statistics: EpisodeStatistics,
    settings: dict[str, Any],
) -> TrainingResult:
    parameters = agent.networks.parameters()
    history, paths = None, None
    if statistics.record:
        past = np.array(
            [
                [*begun, parameters[row]]
                for row, begun in enumerate(statistics.parameters)
            ]
        )
        history, paths = (
            network_of(past, sizes),
            tuple(tuple(drives) for drives in statistics.paths),
        )
    network = network_of(parameters, sizes)
    return TrainingResult(
        method, seeds, network, task.encoder, OUTCOMES[statistics.outcomes],
        statistics.steps, statistics.decisions, statistics.returns,
        settings, history, paths,
    )  # fmt: skip


def weight_changes(history: Network, *, absolute: bool = False) -> Array:
    """What the weights of each layer changed by in each episode, summed, biases included: (S, E, layers) (Fig. 4.3).

    Parameters
    ----------
    history : stack (S, E + 1), see :class:`Training`.
    absolute : sum sizes instead of signed changes, which can cancel.
    """
    sums = []
    for weight, bias in zip(history.weights, history.biases, strict=True):
        moved = np.diff(np.concatenate([weight, bias[..., None]], axis=-1), axis=1)
        sums.append((np.abs(moved) if absolute else moved).sum(axis=(-2, -1)))
    return np.stack(sums, axis=-1)


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
