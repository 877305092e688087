"""What tabular learners share: their table, their exploration and their results."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from robonav.progress import Progress

from .discrete_spaces import discretise_spaces, space_sizes
from .episodes import EpisodeRunner
from .exploration import EpsilonGreedy, Schedule, schedule
from .policies import optimal_values_of


@dataclass(frozen=True, eq=False)
class ControlResult:
    """Action values learned from episodes, and the course of the learning.

    Attributes
    ----------
    q : (S, A) array
        Action values.
    visits : (S, A) array of ints
        Number of updates of each pair.
    returns : (episodes,) array
        Sum of the rewards of each training episode, without discount.
    lengths : (episodes,) array of ints
        Number of its steps.
    history : (episodes + 1, S, A) array or None
        ``q`` before the first episode and after each, if recorded.
    visited_states : tuple of (steps + 1,) arrays or None
        The states of each episode, if recorded.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, q_learning
    >>> result = q_learning(GridWorld("S . G").environment(), 20, learning_rate=0.5)
    >>> result.q.shape, result.policy[:2], len(result.returns)
    ((3, 4), array([1, 1]), 20)
    """

    q: NDArray[np.float64]
    visits: NDArray[np.int64]
    returns: NDArray[np.float64]
    lengths: NDArray[np.int64]
    history: NDArray[np.float64] | None = None
    visited_states: tuple[NDArray[np.int64], ...] | None = None

    @cached_property
    def policy(self) -> NDArray[np.int64]:
        """Greedy action (S,) of each state, the first where several tie."""
        return self.q.argmax(axis=1)

    @cached_property
    def values(self) -> NDArray[np.float64]:
        """Value (S,) of the best action of each state."""
        return optimal_values_of(self.q)


@dataclass(frozen=True, eq=False)
class PredictionResult:
    """State values of one policy, estimated from episodes.

    Attributes
    ----------
    values : (S,) array
        NaN where there is no estimate.
    visits : (S,) array of ints
        Number of updates of each state.
    history : (episodes + 1, S) array or None
        Values before the first episode and after each, if recorded.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, monte_carlo_prediction
    >>> env = GridWorld("S . G").environment()
    >>> monte_carlo_prediction(env, [1, 1, 1], 5, discount=0.5).values
    array([0.5, 1. , nan])
    """

    values: NDArray[np.float64]
    visits: NDArray[np.int64]
    history: NDArray[np.float64] | None = None


class TabularTraining(EpisodeRunner):
    """Episodes of a learner with a table of action values and epsilon-greedy exploration.

    The table ``q`` is a nested list, of which Python reads single entries faster than of arrays. ``choose(q[state])``
    draws an action, and ``step_size(state, action)`` is the learning rate for the visit that it counts.
    """

    def __init__(
        self,
        env: gym.Env[Any, Any],
        episodes: int,
        rates: tuple[float | Schedule, float | Schedule],
        initial: float,
        max_steps: int,
        seed: int | np.random.Generator,
        record: bool,
        progress: Progress | None,
    ) -> None:
        env, rng = discretise_spaces(env), np.random.default_rng(seed)
        learning_rate, epsilon = rates
        self._rate = schedule("learning_rate", learning_rate)
        super().__init__(
            env,
            episodes,
            max_steps=max_steps,
            rng=rng,
            record=record,
            progress=progress,
        )
        self.choose = EpsilonGreedy(epsilon, rng)
        states, actions = space_sizes(env)
        self.q = self.watch([[initial] * actions for _ in range(states)])
        self.visits = [[0] * actions for _ in range(states)]

    def episodes(self) -> Iterator[int]:
        """First state of each episode, for which the exploration rate is set."""
        for state in super().episodes():
            self.choose.begin(self.episode)
            yield state

    def step_size(self, state: int, action: int) -> float:
        """Learning rate for this visit of a pair; it may depend on the number of earlier visits."""
        rate = self._rate(self.visits[state][action])
        self.visits[state][action] += 1
        return rate

    def result(self) -> ControlResult:
        """Everything as arrays."""
        passed = tuple(map(np.array, self.visited_states)) if self._record else None
        return ControlResult(
            np.array(self.q),
            np.array(self.visits),
            np.array(self.returns),
            np.array(self.lengths),
            self.history,
            passed,
        )
