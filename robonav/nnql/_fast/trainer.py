"""The training loop of chapter 4 for S robots, one a seed: Algorithm 8 with the agents of any method.

All running robots take each step together. A robot whose episode has ended starts its next one at once. Its worlds and
its random numbers depend on its seed and the number of the episode alone, so that its training does not depend on which
seeds train beside it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from robonav.networks.policy import sample_actions
from robonav.progress import Progress
from robonav.robot import Simulator, Worlds
from robonav.robot._fast import ARRIVED, COLLIDED, RUNNING

from ..schedules import Schedule, geometric_schedule, softmax_policy
from ..task import EXPLORING, NavigationTask, make_rng
from .agents import Agent, Decisions
from .networks import Array, Rows


class EpisodeStatistics:
    """How the training of S seeds went, episode by episode.

    Attributes
    ----------
    outcomes : (S, E) array of int
        Codes of how each episode ended, see :data:`robonav.robot.OUTCOMES`.
    steps, decisions : (S, E) arrays of int
        Seconds that an episode took, and how many of them the policy decided.
    returns : (S, E) array
        Sums of the rewards of these decisions.
    paths : S lists of E (steps + 1, 3) arrays
        Poses of every episode, if recorded.
    parameters : S lists of E (P,) arrays
        The network's parameters when an episode began, if recorded.
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
    """S robots in episodes ``first`` to ``last - 1`` of the E of their training.

    Parameters
    ----------
    agent : Agent
        What learns.
    task : NavigationTask
        What it trains on.
    seeds : (S,) sequence of int
        Seeds of the robots.
    episodes : int
        E.
    temperature : Schedule
        T of the softmax policy, from the first of the E episodes to the last.
    statistics : EpisodeStatistics
        Filled in as the robots go.
    first, last : int
        The episodes to run.
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
        self.agent, self.task, self.seeds = agent, task, seeds
        self.episodes, self.temperature = episodes, temperature
        self.statistics, self.first, self.last = statistics, first, last
        self.episode = np.full(len(seeds), first)
        self.uniforms = np.empty((len(seeds), task.max_steps))
        self.tracks: list[list[Array]] = [[] for _ in seeds]
        self.worlds = task.worlds(seeds, first, last)
        everyone = np.arange(len(seeds))
        self.simulator = Simulator(
            self._worlds_of(everyone), task.speed, max_steps=task.max_steps
        )
        self.sensing = self.simulator.sense()
        self._begin(everyone)

    def run(self, progress: Progress | None = None) -> None:
        """Continue until every robot has finished its episodes."""
        while (self.episode < self.last).any():
            self._step()
            over = self.simulator.outcome != RUNNING
            over &= self.episode < self.last
            if over.any():
                self._next_episode(np.flatnonzero(over))
            if progress is not None:
                progress(int(self.episode.sum()), len(self.seeds) * self.episodes)

    def _step(self) -> None:
        """One second of all running robots; those whose policy decides learn from it."""
        running = self.simulator.outcome == RUNNING
        commands = self.task.reflex(self.sensing, self.task.speed)
        rows = np.flatnonzero(running & (commands < 0))
        before, inputs, values = self.sensing[rows], np.empty(0), np.empty(0)
        if len(rows):
            inputs = self.task.encoder(before)
            values = self.agent.values(rows, inputs)
            commands[rows] = self._explore(rows, values)
        self.simulator.step(commands.clip(0))
        self.sensing = self.simulator.sense()
        if self.statistics.record:
            for row in np.flatnonzero(running):
                self.tracks[row].append(self.simulator.poses[row].copy())
        if len(rows):
            after, outcome = self.sensing[rows], self.simulator.outcome[rows]
            rewards = np.asarray(self.task.reward(before, after, outcome), dtype=float)
            self._learn(rows, inputs, values, commands[rows], rewards)

    def _explore(self, rows: Rows, values: Array) -> NDArray[np.int64]:
        """Actions (K,) of the softmax policy, from Q-values (K, A)."""
        temperature = geometric_schedule(self.temperature, self._fraction(rows))
        uniforms = self.uniforms[rows, self.simulator.steps[rows]]
        return sample_actions(softmax_policy(values, temperature), uniforms)

    def _fraction(self, rows: Rows) -> Array:
        """How much of the training was over when the present episodes began, 0 to 1."""
        fraction: Array = self.episode[rows] / max(self.episodes - 1, 1)
        return fraction

    def _learn(
        self,
        rows: Rows,
        inputs: Array,
        values: Array,
        actions: NDArray[np.int64],
        rewards: Array,
    ) -> None:
        """Let the agents of ``rows`` learn from the step just made, and count it."""
        self.statistics.decisions[rows, self.episode[rows]] += 1
        self.statistics.returns[rows, self.episode[rows]] += rewards
        outcome = self.simulator.outcome[rows]
        terminal = (outcome == ARRIVED) | (outcome == COLLIDED)
        reached = self.task.encoder(self.sensing[rows])
        self.agent.observe(
            rows,
            Decisions(inputs, values, actions, rewards, reached, terminal, self._fraction(rows)),
        )  # fmt: skip

    def _next_episode(self, rows: Rows) -> None:
        """Record the episodes of ``rows``, which have ended, and begin the next ones."""
        statistics, episode = self.statistics, self.episode[rows]
        statistics.outcomes[rows, episode] = self.simulator.outcome[rows]
        statistics.steps[rows, episode] = self.simulator.steps[rows]
        if statistics.record:
            for row in rows:
                statistics.paths[row].append(np.array(self.tracks[row]))
        self.episode[rows] += 1
        self.agent.end_episode(rows, self.episode[rows])
        fresh = rows[self.episode[rows] < self.last]
        if len(fresh):
            self.simulator.restart(fresh, self._worlds_of(fresh))
            self.sensing = self.simulator.sense()
            self._begin(fresh)

    def _worlds_of(self, rows: Rows) -> Worlds:
        episode = self.episode[rows] - self.first
        return self.worlds[rows * (self.last - self.first) + episode]

    def _begin(self, rows: Rows) -> None:
        """Draw the random numbers of the episodes that begin."""
        for row in rows:
            rng = make_rng(self.seeds[row], EXPLORING, int(self.episode[row]))
            self.uniforms[row] = rng.random(self.task.max_steps)
        if self.statistics.record:
            parameters = self.agent.networks.parameters()
            for row in rows:
                self.tracks[row] = [self.simulator.poses[row].copy()]
                self.statistics.parameters[row].append(parameters[row])
