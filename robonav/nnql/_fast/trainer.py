"""The training loop of chapter 4 for S robots, one for each seed.

With the agent of NNQL it is the twin of :func:`robonav.nnql.nnql`, Algorithm 8; other agents make it the twin of the
chapter's other methods.

All running robots take each step together. A robot whose episode has ended starts its next one at once. Its worlds and
its random numbers depend on its seed and the number of the episode alone, so that its training does not depend on which
seeds train beside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from inspect import unwrap

import numpy as np

from robonav.networks.policy import sample_actions
from robonav.progress import Progress
from robonav.robot import Sensing, Simulator, Transition, Worlds, run_episodes
from robonav.robot._fast import ARRIVED, COLLIDED, RUNNING

from .. import schedules
from ..schedules import Schedule, softmax_policy
from ..task import EXPLORING, NavigationTask, make_rng
from .agents import Agent, Experience
from .networks import Array, Rows

# Called in every step with arrays of this module, and so without the checks of its arguments.
geometric_schedule = unwrap(schedules.geometric_schedule)


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
        self._begin(everyone)

    def run(self, progress: Progress | None = None) -> None:
        """Continue until every robot has finished its episodes."""
        for step in run_episodes(self.simulator, self._choose, reflex=self.task.reflex):
            if step.asked.any():
                self._learn(step)
            if self.statistics.record:
                for row in step.robots:
                    self.tracks[row].append(self.simulator.poses[row].copy())
            ended = step.robots[step.outcome != RUNNING]
            if len(ended):
                self._next_episode(ended)
            if progress is not None:
                progress(int(self.episode.sum()), len(self.seeds) * self.episodes)

    def _choose(self, simulator: Simulator, sensing: Sensing, rows: Rows) -> Rows:
        """Actions (K,) of the softmax policies of ``rows`` (K,)."""
        self.inputs = self.task.encoder(sensing)
        self.values = self.agent.values(rows, self.inputs)
        temperature = geometric_schedule(self.temperature, self._fraction(rows))
        uniforms = self.uniforms[rows, simulator.steps[rows]]
        return sample_actions(softmax_policy(self.values, temperature), uniforms)

    def _fraction(self, rows: Rows) -> Array:
        """How much of the training was over when the present episodes began, 0 to 1."""
        fraction: Array = self.episode[rows] / max(self.episodes - 1, 1)
        return fraction

    def _learn(self, step: Transition) -> None:
        """Let the agents whose policy chose learn from the step, and count it."""
        rows, outcome = step.robots[step.asked], step.outcome[step.asked]
        before, after = step.sensing[step.asked], step.next_sensing[step.asked]
        rewards = np.asarray(self.task.reward(before, after, outcome), dtype=float)
        self.statistics.decisions[rows, self.episode[rows]] += 1
        self.statistics.returns[rows, self.episode[rows]] += rewards
        self.agent.observe(
            rows,
            Experience(
                inputs=self.inputs,
                values=self.values,
                actions=step.actions[step.asked],
                rewards=rewards,
                reached=self.task.encoder(after),
                terminal=(outcome == ARRIVED) | (outcome == COLLIDED),
                fraction=self._fraction(rows),
            ),
        )

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
