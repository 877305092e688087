"""The training loop of Algorithm 8, for S seeds at once and for every method of this chapter.

Each seed has its own worlds, its own chance and its own network, so its training does not depend on which seeds train
beside it. An agent says what is learned from a step; nothing else differs between the methods.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from robonav.networks.policy import sample_actions
from robonav.progress import Progress
from robonav.robot import (
    NNQL_SENSORS,
    REFLEX,
    Encoder,
    Sensing,
    Simulator,
    Worlds,
    draw_worlds,
    world_keys,
)
from robonav.robot._fast import ARRIVED, COLLIDED, RUNNING
from robonav.robot.environments import Reward
from robonav.validation import check_integer, check_positive

from .agents import Agent, Transitions
from .networks import Array, Rows
from .reward import reward
from .schedules import Schedule, geometric_schedule, softmax_policy

STARTS = ((10.0, 10.0), (90.0, 10.0))
TARGETS = ((90.0, 90.0), (10.0, 90.0))
ACTIONS = 5  # F, L30, L60, R30, R60; B is an instinct
WAITING = (
    9  # an outcome the simulator does not know: it leaves such a robot where it is
)

INITIAL, EXPLORING, WORLDS, REPLAYING = range(4)


def make_rng(seed: int, purpose: int, *more: int) -> np.random.Generator:
    """The generator of one seed for one purpose, such as exploring in one episode."""
    return np.random.default_rng([seed, purpose, *more])


@dataclass(frozen=True)
class NavigationTask:
    """What a robot trains on (section 4.5): worlds, speed, senses and reward.

    Attributes
    ----------
    obstacles, moving, starts, targets : of the worlds, see :func:`robonav.robot.random_worlds`.
    speed : of the robot in m/s.
    max_steps : seconds an episode lasts at most.
    encoder : how what is sensed becomes the network's inputs; as in Eq. (4.5), each brought within 1.
    reward : of a step, see :data:`robonav.robot.environments.Reward`.
    reflex : what the robot does before the policy is asked.
    """

    obstacles: int = 10
    moving: int = 0
    speed: float = 2.5
    max_steps: int = 400
    starts: Sequence[tuple[float, float]] = STARTS
    targets: Sequence[tuple[float, float]] = TARGETS
    encoder: Encoder = field(
        default_factory=lambda: Encoder(NNQL_SENSORS, walls=True, target="number")
    )
    reward: Reward = reward
    reflex: Callable[[Sensing, float], NDArray[np.int64]] = REFLEX

    def __post_init__(self) -> None:
        check_positive("speed", self.speed)
        check_integer("max_steps", self.max_steps, at_least=1)

    def worlds(self, seeds: Sequence[int], first: int, last: int) -> Worlds:
        """The worlds of episodes ``first`` to ``last`` of each seed, one seed after the other."""
        keys = [
            world_keys(last, int(make_rng(seed, WORLDS).integers(2**63)))[first:]
            for seed in seeds
        ]
        return draw_worlds(
            np.concatenate(keys), self.obstacles, self.moving, self.starts, self.targets
        )


class EpisodeStatistics:
    """How the training of S seeds went, episode by episode; arrays (S, E).

    Attributes
    ----------
    outcomes : codes of how each episode ended, see :data:`robonav.robot.OUTCOMES`.
    steps, decisions : seconds driven, and how many of them the policy decided.
    returns : sums of the rewards of these.
    paths : poses (steps + 1, 3) of every episode, for each seed, if recorded.
    parameters : of the network (P,) when an episode began, for each seed, if recorded.
    """

    def __init__(self, seeds: int, episodes: int, *, record: bool = False) -> None:
        shape = (seeds, episodes)
        self.outcomes = np.zeros(shape, np.int8)
        self.steps = np.zeros(shape, np.int64)
        self.decisions = np.zeros(shape, np.int64)
        self.returns = np.zeros(shape)
        self.record = record
        self.paths: list[list[Array]] = [[] for _ in range(seeds)]
        self.parameters: list[list[Array]] = [[] for _ in range(seeds)]


class Trainer:
    """S robots on their way through episodes ``first`` to ``last`` of the E that their training takes.

    Parameters
    ----------
    agent : what is learned.
    task : what the robot trains on.
    seeds : (S,) of the robots.
    episodes : E.
    temperature : T of the Boltzmann policy, from the first of the E episodes to the last.
    statistics : written as they go.
    """

    def __init__(
        self,
        agent: Agent,
        task: NavigationTask,
        seeds: Sequence[int],
        episodes: int,
        temperature: Schedule,
        statistics: EpisodeStatistics,
        *,
        first: int,
        last: int,
    ) -> None:
        self.agent, self.task, self.seeds, self.episodes = (
            agent,
            task,
            seeds,
            episodes,
        )
        self.temperature, self.statistics, self.first, self.last = (
            temperature,
            statistics,
            first,
            last,
        )
        self.episode = np.full(len(seeds), first)
        self.uniforms = np.empty((len(seeds), task.max_steps))
        self.tracks: list[list[Array]] = [[] for _ in seeds]
        self.worlds = task.worlds(seeds, first, last)
        everyone = np.arange(len(seeds))
        self.simulator = Simulator(
            self._worlds_of(everyone), task.speed, max_steps=task.max_steps
        )
        self._begin(everyone)

    def run(self, progress: Progress | None = None) -> None:
        """Go on until every robot has finished its episodes."""
        while (self.episode < self.last).any():
            asked = self._coast()
            if len(asked):
                self._decide(asked)
            if progress is not None:
                progress(int(self.episode.sum()), len(self.seeds) * self.episodes)

    def _coast(self) -> Rows:
        """Let reflexes drive until half the robots or more wait for their policy: these."""
        while True:
            self._turn_over()
            commands = self.task.reflex(self.sensing, self.task.speed)
            running = self.simulator.outcome == RUNNING
            asked = running & (commands < 0)
            if 2 * asked.sum() >= running.sum():
                return np.flatnonzero(asked)
            self._move(np.flatnonzero(running & ~asked), commands.clip(0))

    def _decide(self, rows: Rows) -> None:
        """One step of ``rows`` by their policy: lines 9 to 16 of Algorithm 8."""
        before, episode = self.sensing[rows], self.episode[rows]
        fraction = episode / max(self.episodes - 1, 1)
        inputs = self.task.encoder(before)
        values = self.agent.values(rows, inputs)
        probabilities = softmax_policy(
            values, geometric_schedule(self.temperature, fraction)
        )
        commands = np.zeros(len(self.seeds), np.int64)
        commands[rows] = sample_actions(
            probabilities, self.uniforms[rows, self.simulator.steps[rows]]
        )
        self._move(rows, commands)
        after, outcome = self.sensing[rows], self.simulator.outcome[rows]
        rewards = np.asarray(self.task.reward(before, after, outcome), dtype=float)
        self.statistics.decisions[rows, episode] += 1
        self.statistics.returns[rows, episode] += rewards
        terminal = (outcome == ARRIVED) | (outcome == COLLIDED)
        reached = self.task.encoder(after)
        self.agent.observe(
            rows,
            Transitions(
                inputs, values, commands[rows], rewards, reached, terminal, fraction
            ),
        )

    def _move(self, rows: Rows, commands: NDArray[np.int64]) -> None:
        """One second for ``rows``; for all others, running or not, time stands still."""
        simulator = self.simulator
        waiting = simulator.outcome == RUNNING
        waiting[rows] = False
        simulator.outcome[waiting] = WAITING
        simulator.step(commands)
        simulator.outcome[waiting] = RUNNING
        self.sensing = simulator.sense()
        if self.statistics.record:
            for row in rows:
                self.tracks[row].append(simulator.poses[row].copy())

    def _turn_over(self) -> None:
        """Close the episodes that have ended and begin the next."""
        over = np.flatnonzero(
            (self.simulator.outcome != RUNNING) & (self.episode < self.last)
        )
        if len(over) == 0:
            return
        self._note(over)
        self.episode[over] += 1
        self.agent.close(over, self.episode[over])
        fresh = over[self.episode[over] < self.last]
        if len(fresh):
            self.simulator.restart(fresh, self._worlds_of(fresh))
            self._begin(fresh)

    def _worlds_of(self, rows: Rows) -> Worlds:
        return self.worlds[
            rows * (self.last - self.first) + self.episode[rows] - self.first
        ]

    def _begin(self, rows: Rows) -> None:
        self.sensing = self.simulator.sense()
        for row in rows:
            draws = make_rng(self.seeds[row], EXPLORING, int(self.episode[row]))
            self.uniforms[row] = draws.random(self.task.max_steps)
        if self.statistics.record:
            for row in rows:
                self.tracks[row] = [self.simulator.poses[row].copy()]
                self.statistics.parameters[row].append(
                    self.agent.networks.parameters()[row]
                )

    def _note(self, rows: Rows) -> None:
        """Write down how the episodes of ``rows`` went."""
        statistics, episode = self.statistics, self.episode[rows]
        statistics.outcomes[rows, episode] = self.simulator.outcome[rows]
        statistics.steps[rows, episode] = self.simulator.steps[rows]
        if statistics.record:
            for row in rows:
                statistics.paths[row].append(np.array(self.tracks[row]))
