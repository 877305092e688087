"""Values as a linear function of features (Eq. (4.3)): SARSA (Algorithm 7) and Q-learning."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from robonav.progress import Progress
from robonav.validation import check_generator, check_real

from .episodes import EpisodeRunner, count, discretise_actions
from .exploration import EpsilonGreedy, Schedule, schedule
from .features import Features

RUNAWAY = 1e100  # far above any reward, far below what overflows


def with_bias(features: Features) -> Features:
    """The features with f_0 = 1 before them, so that the constant of Eq. (4.3) is a weight like the others."""

    def extended(state: Any) -> NDArray[np.float64]:
        found = features(state)
        return np.hstack([np.ones((len(found), 1)), found])

    return extended


@dataclass(frozen=True)
class LinearControlResult:
    """Weights learned from episodes, and how the learning went.

    Attributes
    ----------
    weights : (n,) one for each feature.
    features : ``features(state) -> (A, n)``.
    returns : (episodes,) rewards of each training episode, summed without discount.
    lengths : (episodes,) its steps.
    history : (episodes + 1, n) weights before the first episode and after each, if recorded.
    """

    weights: NDArray[np.float64]
    features: Features
    returns: NDArray[np.float64]
    lengths: NDArray[np.int64]
    history: NDArray[np.float64] | None = None

    def q(self, states: Iterable[Any]) -> NDArray[np.float64]:
        """Action values (k, A) of k states (Eq. (4.3))."""
        return np.stack([self.features(state) @ self.weights for state in states])


def linear_sarsa(
    env: gym.Env[Any, Any],
    episodes: int,
    features: Features,
    *,
    discount: float = 0.99,
    learning_rate: float | Schedule = 0.1,
    epsilon: float | Schedule = 0.1,
    max_steps: int = 10_000,
    seed: int | np.random.Generator = 0,
    record: bool = False,
    progress: Progress | None = None,
) -> LinearControlResult:
    """SARSA with linear function approximation (Algorithm 7).

    After each step every weight moves by ``alpha * delta * f_i(s, a)``, ``delta = r + gamma Q(s', a') - Q(s, a)``.

    Parameters
    ----------
    env : Gymnasium environment with A actions; its states may be anything that ``features`` takes.
    episodes : how many to play.
    features : ``features(state) -> (A, n)``, such as :class:`~robonav.mdp.OneHot` or :class:`~robonav.mdp.Tiles`;
        :func:`~robonav.mdp.with_bias` puts f_0 = 1 before them.
    discount : gamma, in [0, 1].
    learning_rate : alpha, a number in [0, 1] or a schedule over episodes. Where k features are on at a time, a step of
        alpha moves the value by k times alpha: divide by k.
    epsilon : chance of a blind action, in [0, 1], or a schedule over episodes.
    max_steps : steps after which an episode is cut off; the last state then still counts.
    seed : number or generator, for the environment and for the choices.
    record : keep ``history``, a copy of the weights for every episode.
    progress : called as ``progress(episodes done, episodes)``.

    Raises
    ------
    TypeError : if the actions are not discrete.
    ValueError : if ``features`` does not give one row for each action, always as long, or the weights grow beyond all
        bounds (a learning rate too large for the number of features that are on).
    """
    env, rng = discretise_actions(env), check_generator("seed", seed)
    discount = check_real("discount", discount, at_least=0, at_most=1)
    rate = schedule("learning_rate", learning_rate)
    features_of, weights = fitted(env, features)
    course = EpisodeRunner(
        env, episodes, max_steps=max_steps, rng=rng, progress=progress
    )
    choose, history = EpsilonGreedy(epsilon, rng), [weights.copy()]
    for state in course.episodes():
        choose.begin(course.number)
        alpha = rate(course.number)
        found = features_of(state)
        action = choose((found @ weights).tolist())
        while not course.over:
            state, reward, terminated = course.step(action)
            next_found = features_of(state)
            next_values = (next_found @ weights).tolist()
            next_action = choose(next_values)
            future = 0.0 if terminated else next_values[next_action]
            delta = bounded(reward + discount * future - found[action] @ weights)
            weights += alpha * delta * found[action]
            found, action = next_found, next_action
        if record:
            history.append(weights.copy())
    return learned(weights, features, course, history if record else None)


def linear_q_learning(
    env: gym.Env[Any, Any],
    episodes: int,
    features: Features,
    *,
    discount: float = 0.99,
    learning_rate: float | Schedule = 0.1,
    epsilon: float | Schedule = 0.1,
    max_steps: int = 10_000,
    seed: int | np.random.Generator = 0,
    record: bool = False,
    progress: Progress | None = None,
) -> LinearControlResult:
    """Q-learning with linear function approximation: Algorithm 7 with ``delta = r + gamma max Q(s', .) - Q(s, a)``.

    Parameters, result and errors are those of :func:`linear_sarsa`. Unlike there, nothing promises that the weights
    settle: learning about one policy from the steps of another, with shared features, can diverge (Baird 1995).
    """
    env, rng = discretise_actions(env), check_generator("seed", seed)
    discount = check_real("discount", discount, at_least=0, at_most=1)
    rate = schedule("learning_rate", learning_rate)
    features_of, weights = fitted(env, features)
    course = EpisodeRunner(
        env, episodes, max_steps=max_steps, rng=rng, progress=progress
    )
    choose, history = EpsilonGreedy(epsilon, rng), [weights.copy()]
    for state in course.episodes():
        choose.begin(course.number)
        alpha = rate(course.number)
        found = features_of(state)
        while not course.over:
            action = choose((found @ weights).tolist())
            state, reward, terminated = course.step(action)
            next_found = features_of(state)
            future = 0.0 if terminated else (next_found @ weights).max()
            delta = bounded(reward + discount * future - found[action] @ weights)
            weights += alpha * delta * found[action]
            found = next_found
        if record:
            history.append(weights.copy())
    return learned(weights, features, course, history if record else None)


def fitted(
    env: gym.Env[Any, int], features: Features
) -> tuple[Features, NDArray[np.float64]]:
    """The features, checked as they come, and a zero weight for each; ValueError if they do not fit the actions."""
    actions = count("env.action_space", env.action_space)
    shape = np.shape(features(env.reset(seed=0)[0]))
    if len(shape) != 2 or shape[0] != actions:
        raise ValueError(
            f"features must give shape ({actions}, n), one row for each action, got {shape}"
        )

    def checked(state: Any) -> NDArray[np.float64]:
        found = np.asarray(features(state))
        if found.shape != shape:
            raise ValueError(
                f"features must give shape {shape} for every state, as for the first, got {found.shape}"
            )
        return found

    return checked, np.zeros(shape[1])


def bounded(delta: float) -> float:
    """The error of a prediction, as long as learning has not run away."""
    if not abs(delta) < RUNAWAY:
        raise ValueError(
            "the weights grow without bound: learning_rate is too large for the number of features"
        )
    return delta


def learned(
    weights: NDArray[np.float64],
    features: Features,
    course: EpisodeRunner,
    history: list[NDArray[np.float64]] | None,
) -> LinearControlResult:
    """All of it as arrays."""
    kept = None if history is None else np.stack(history)
    return LinearControlResult(
        weights, features, np.array(course.returns), np.array(course.lengths), kept
    )
