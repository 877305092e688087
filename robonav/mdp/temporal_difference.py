"""Learning from each step: TD(0), Q-learning (Algorithm 5), SARSA (Algorithm 6), expected SARSA."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.progress import Progress
from robonav.validation import check_generator, check_real

from .episodes import EpisodeRunner, discretise_spaces, policy_sampler, space_sizes
from .exploration import EpsilonGreedy, Schedule, schedule


@dataclass(frozen=True)
class ControlResult:
    """Action values learned from episodes, and how the learning went.

    Attributes
    ----------
    q : (S, A) action values.
    visits : (S, A) how often each was updated.
    returns : (episodes,) rewards of each training episode, summed without discount.
    lengths : (episodes,) its steps.
    history : (episodes + 1, S, A) ``q`` before the first episode and after each, if recorded.
    visited_states : the states passed in each episode, (steps + 1,), if recorded.
    """

    q: NDArray[np.float64]
    visits: NDArray[np.int64]
    returns: NDArray[np.float64]
    lengths: NDArray[np.int64]
    history: NDArray[np.float64] | None = None
    visited_states: tuple[NDArray[np.int64], ...] | None = None

    @cached_property
    def policy(self) -> NDArray[np.int64]:
        """(S,) the greedy action of each state, the first where several tie."""
        return self.q.argmax(axis=1)

    @cached_property
    def values(self) -> NDArray[np.float64]:
        """(S,) value of the best action, Eq. (2.10)."""
        return self.q.max(axis=1)


@dataclass(frozen=True)
class PredictionResult:
    """State values of one policy, estimated from episodes.

    Attributes
    ----------
    values : (S,); NaN where there is no estimate.
    visits : (S,) how often each was updated.
    history : (episodes + 1, S) values before the first episode and after each, if recorded.
    """

    values: NDArray[np.float64]
    visits: NDArray[np.int64]
    history: NDArray[np.float64] | None = None


class QTable:
    """Action values while they are being learned: nested lists, which Python reads one entry of faster than arrays."""

    def __init__(
        self,
        shape: tuple[int, int],
        *,
        initial: float,
        learning_rate: float | Schedule,
        record: bool,
    ) -> None:
        states, actions = shape
        self.q = [[check_real("initial", initial)] * actions for _ in range(states)]
        self.visits = [[0] * actions for _ in range(states)]
        self._rate = schedule("learning_rate", learning_rate)
        self._history = [np.array(self.q)] if record else None

    def learn(self, state: int, action: int, target: float) -> None:
        """Move one value towards a target by the learning rate, which may depend on how often that was done before."""
        rate = self._rate(self.visits[state][action])
        self.visits[state][action] += 1
        self.q[state][action] += rate * (target - self.q[state][action])

    def keep(self) -> None:
        """Write the values down, if a history is wanted."""
        if self._history is not None:
            self._history.append(np.array(self.q))

    def learned(self, course: EpisodeRunner) -> ControlResult:
        """All of it as arrays."""
        return ControlResult(
            np.array(self.q),
            np.array(self.visits),
            np.array(course.returns),
            np.array(course.lengths),
            None if self._history is None else np.stack(self._history),
            None
            if self._history is None
            else tuple(map(np.array, course.visited_states)),
        )


def q_learning(
    env: gym.Env[Any, Any],
    episodes: int,
    *,
    discount: float = 0.99,
    learning_rate: float | Schedule = 0.1,
    epsilon: float | Schedule = 0.1,
    initial: float = 0.0,
    max_steps: int = 10_000,
    seed: int | np.random.Generator = 0,
    record: bool = False,
    progress: Progress | None = None,
) -> ControlResult:
    """One-step Q-learning (Algorithm 5; Eqs. (2.29), (4.1)): learn what the best policy earns while following another.

    Parameters
    ----------
    env : Gymnasium environment with discrete observations and actions.
    episodes : how many to play.
    discount : gamma, in [0, 1].
    learning_rate : alpha, a number in [0, 1] or a schedule over the visits of a state and action (0 at the first).
        Values converge if every pair is visited for ever and the schedule falls neither too fast nor too slowly
        (:func:`~robonav.mdp.harmonic_decay`, :func:`~robonav.mdp.polynomial_decay`).
    epsilon : chance of a blind action, in [0, 1], or a schedule over episodes.
    initial : value of every pair at the start; above what can be earned, it makes the agent try everything.
    max_steps : steps after which an episode is cut off, whatever the environment says. The last state is then not
        taken for a terminal one: its value still counts.
    seed : number or generator, for the environment and for the choices.
    record : keep ``history``, a copy of ``q`` for every episode, and ``walks``.
    progress : called as ``progress(episodes done, episodes)``.

    Returns
    -------
    ControlResult with ``q`` (S, A), ``visits``, ``returns``, ``lengths``, and ``history`` and ``walks`` if recorded.

    Raises
    ------
    TypeError : if ``env`` is no Gymnasium environment or its spaces are not discrete.
    ValueError : if a number is out of its range.
    """
    env, rng = discretise_spaces(env), check_generator("seed", seed)
    discount = check_real("discount", discount, at_least=0, at_most=1)
    table = QTable(
        space_sizes(env), initial=initial, learning_rate=learning_rate, record=record
    )
    course = EpisodeRunner(
        env, episodes, max_steps=max_steps, rng=rng, record=record, progress=progress
    )
    choose, q = EpsilonGreedy(epsilon, rng), table.q
    for state in course.episodes():
        choose.begin(course.number)
        while not course.over:
            action = choose(q[state])
            successor, reward, terminated = course.step(action)
            future = 0.0 if terminated else max(q[successor])
            table.learn(state, action, reward + discount * future)
            state = successor
        table.keep()
    return table.learned(course)


def sarsa(
    env: gym.Env[Any, Any],
    episodes: int,
    *,
    discount: float = 0.99,
    learning_rate: float | Schedule = 0.1,
    epsilon: float | Schedule = 0.1,
    initial: float = 0.0,
    max_steps: int = 10_000,
    seed: int | np.random.Generator = 0,
    record: bool = False,
    progress: Progress | None = None,
) -> ControlResult:
    """SARSA (Algorithm 6; Eqs. (2.30), (4.2)): learn what the policy earns that is being followed, exploring included.

    Parameters, result and errors are those of :func:`q_learning`. The values tend to the optimal ones only if, besides,
    ``epsilon`` falls to zero (Singh et al. 2000).
    """
    env, rng = discretise_spaces(env), check_generator("seed", seed)
    discount = check_real("discount", discount, at_least=0, at_most=1)
    table = QTable(
        space_sizes(env), initial=initial, learning_rate=learning_rate, record=record
    )
    course = EpisodeRunner(
        env, episodes, max_steps=max_steps, rng=rng, record=record, progress=progress
    )
    choose, q = EpsilonGreedy(epsilon, rng), table.q
    for state in course.episodes():
        choose.begin(course.number)
        action = choose(q[state])
        while not course.over:
            successor, reward, terminated = course.step(action)
            next_action = choose(q[successor])
            future = 0.0 if terminated else q[successor][next_action]
            table.learn(state, action, reward + discount * future)
            state, action = successor, next_action
        table.keep()
    return table.learned(course)


def expected_sarsa(
    env: gym.Env[Any, Any],
    episodes: int,
    *,
    discount: float = 0.99,
    learning_rate: float | Schedule = 0.1,
    epsilon: float | Schedule = 0.1,
    initial: float = 0.0,
    max_steps: int = 10_000,
    seed: int | np.random.Generator = 0,
    record: bool = False,
    progress: Progress | None = None,
) -> ControlResult:
    """Expected SARSA (van Seijen et al. 2009): SARSA with the mean over the next action in place of one draw of it.

    Parameters, result and errors are those of :func:`q_learning`. The target varies less than SARSA's, so that a larger
    learning rate does; where nothing in the world is random, a rate of 1 is the best.
    """
    env, rng = discretise_spaces(env), check_generator("seed", seed)
    discount = check_real("discount", discount, at_least=0, at_most=1)
    table = QTable(
        space_sizes(env), initial=initial, learning_rate=learning_rate, record=record
    )
    course = EpisodeRunner(
        env, episodes, max_steps=max_steps, rng=rng, record=record, progress=progress
    )
    choose, q = EpsilonGreedy(epsilon, rng), table.q
    for state in course.episodes():
        choose.begin(course.number)
        while not course.over:
            action = choose(q[state])
            successor, reward, terminated = course.step(action)
            future = 0.0 if terminated else choose.expected(q[successor])
            table.learn(state, action, reward + discount * future)
            state = successor
        table.keep()
    return table.learned(course)


def td_prediction(
    env: gym.Env[Any, Any],
    policy: ArrayLike,
    episodes: int,
    *,
    discount: float = 0.99,
    learning_rate: float | Schedule = 0.1,
    initial: float = 0.0,
    max_steps: int = 10_000,
    seed: int | np.random.Generator = 0,
    record: bool = False,
    progress: Progress | None = None,
) -> PredictionResult:
    """TD(0) (2.4.3): the values of a policy, each estimate learning from the next one without waiting for the end.

    ``V(s) += alpha * (r + gamma * V(s') - V(s))``

    Parameters
    ----------
    env : Gymnasium environment with S discrete states and A actions.
    policy : (S,) of action numbers, or (S, A) of probabilities.
    learning_rate : a number in [0, 1] or a schedule over the visits of a state.
    initial : value of every state at the start.

    The others are those of :func:`q_learning`.

    Returns
    -------
    PredictionResult with ``values`` (S,), ``visits`` (S,), and ``history`` (episodes + 1, S) if recorded.
    """
    env, rng = discretise_spaces(env), check_generator("seed", seed)
    discount = check_real("discount", discount, at_least=0, at_most=1)
    rate = schedule("learning_rate", learning_rate)
    states, actions = space_sizes(env)
    choose = policy_sampler(policy, states, actions, rng)
    course = EpisodeRunner(
        env, episodes, max_steps=max_steps, rng=rng, progress=progress
    )
    values, visits = [check_real("initial", initial)] * states, [0] * states
    history = [np.array(values)]
    for state in course.episodes():
        while not course.over:
            successor, reward, terminated = course.step(choose(state))
            target = reward + discount * (0.0 if terminated else values[successor])
            values[state] += rate(visits[state]) * (target - values[state])
            visits[state] += 1
            state = successor
        if record:
            history.append(np.array(values))
    return PredictionResult(
        np.array(values), np.array(visits), np.stack(history) if record else None
    )
