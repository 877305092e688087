"""Action values as a linear function of features, Eq. (4.3): SARSA (Algorithm 7) and Q-learning."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from robonav.progress import Progress

from ._arguments import checked
from .discrete_spaces import count, discretise_actions
from .episodes import EpisodeRunner
from .exploration import EpsilonGreedy, Schedule, schedule
from .features import Features

DIVERGED = 1e100  # far above any reward, far below what overflows


def with_bias(features: Features) -> Features:
    """Put f_0 = 1 before the features, so that the constant is a weight like the others.

    Examples
    --------
    >>> from robonav.mdp import OneHot, with_bias
    >>> with_bias(OneHot(2, 1))(1)
    array([[1., 0., 1.]])
    """

    def extended(state: Any) -> NDArray[np.float64]:
        found = features(state)
        return np.hstack([np.ones((len(found), 1)), found])

    return extended


@dataclass(frozen=True, eq=False)
class LinearControlResult:
    """Weights learned from episodes, and the course of the learning.

    Attributes
    ----------
    weights : (n,) array
        One weight for each feature.
    features : callable
        ``features(state)`` is an (A, n) array.
    returns : (episodes,) array
        Sum of the rewards of each training episode, without discount.
    lengths : (episodes,) array of ints
        Number of its steps.
    history : (episodes + 1, n) array or None
        Weights before the first episode and after each, if recorded.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.mdp import LinearControlResult, OneHot
    >>> nothing = np.empty(0)
    >>> LinearControlResult(np.array([1.0, 2.0]), OneHot(1, 2), nothing, nothing).q([0])
    array([[1., 2.]])
    """

    weights: NDArray[np.float64]
    features: Features
    returns: NDArray[np.float64]
    lengths: NDArray[np.int64]
    history: NDArray[np.float64] | None = None

    def q(self, states: Iterable[Any]) -> NDArray[np.float64]:
        """Action values (k, A) of k states, Eq. (4.3)."""
        features = np.stack([self.features(state) for state in states])
        return features @ self.weights  # Eq. (4.3)


@checked
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
    """SARSA with linear function approximation, Algorithm 7.

    After each step every weight moves by ``alpha * delta * f_i(s, a)``, where ``delta`` is the error of Q(s, a),
    Eq. (4.3).

    Parameters
    ----------
    env : gymnasium.Env
        A discrete actions; its states may be anything that ``features`` takes.
    episodes : int
        Number of episodes.
    features : callable
        ``features(state)`` is an (A, n) array, such as :class:`~robonav.mdp.OneHot` or :class:`~robonav.mdp.Tiles`
        give; :func:`~robonav.mdp.with_bias` puts f_0 = 1 before them.
    discount : float
        gamma, in [0, 1].
    learning_rate : float or Schedule
        alpha, in [0, 1], or a schedule over episodes. Where k features are on at a time, a step of alpha moves the
        value by k times alpha: divide by k.
    epsilon : float or Schedule
        Probability of a random action, in [0, 1], or a schedule over episodes.
    max_steps : int
        Steps after which an episode is cut off. The last state then does not count as terminal: its value still counts.
    seed : int or numpy.random.Generator
        For the environment and for the choices.
    record : bool
        Whether to keep ``history``, a copy of the weights for every episode.
    progress : callable, optional
        Called as ``progress(episodes done, episodes)``.

    Returns
    -------
    LinearControlResult

    Raises
    ------
    TypeError
        If the actions are not discrete.
    ValueError
        If ``features`` does not give one row of the same length for each action, or the weights grow without bound (a
        learning rate too large for the number of features that are on).

    Examples
    --------
    >>> from robonav.mdp import GridWorld, OneHot, linear_sarsa
    >>> env = GridWorld("S . . G", step_reward=-1).environment()
    >>> result = linear_sarsa(env, 50, OneHot(4, 4), learning_rate=0.5)
    >>> result.q([0, 1, 2]).argmax(axis=1)
    array([1, 1, 1])
    """
    rates = learning_rate, epsilon
    training = LinearTraining(
        env, episodes, features, rates, max_steps, seed, record, progress
    )
    weights, f = training.weights, training.features  # 1: f(state) is (A, n)
    for state in training.episodes():  # 2
        phi = f(state)
        action = training.choose((phi @ weights).tolist())  # 3
        while not training.done:  # 4
            state, reward, terminated = training.step(action)  # 5 and 6
            next_phi = f(state)
            next_q = (next_phi @ weights).tolist()
            next_action = training.choose(next_q)  # 7
            future = 0.0 if terminated else next_q[next_action]
            delta = reward + discount * future - phi[action] @ weights  # 8
            weights += training.alpha * bounded(delta) * phi[action]  # 9 to 11
            phi, action = next_phi, next_action  # 12
    return training.result()


@checked
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
    """Q-learning with linear function approximation.

    It is Algorithm 7 with the largest next value in ``delta`` instead of that of the next action.

    Unlike for :func:`linear_sarsa`, nothing promises that the weights converge: learning about one policy from the
    steps of another, with shared features, can diverge (Baird 1995).

    Parameters
    ----------
    env : gymnasium.Env
        A discrete actions; its states may be anything that ``features`` takes.
    episodes : int
        Number of episodes.
    features : callable
        ``features(state)`` is an (A, n) array, such as :class:`~robonav.mdp.OneHot` or :class:`~robonav.mdp.Tiles`
        give; :func:`~robonav.mdp.with_bias` puts f_0 = 1 before them.
    discount : float
        gamma, in [0, 1].
    learning_rate : float or Schedule
        alpha, in [0, 1], or a schedule over episodes. Where k features are on at a time, a step of alpha moves the
        value by k times alpha: divide by k.
    epsilon : float or Schedule
        Probability of a random action, in [0, 1], or a schedule over episodes.
    max_steps : int
        Steps after which an episode is cut off. The last state then does not count as terminal: its value still counts.
    seed : int or numpy.random.Generator
        For the environment and for the choices.
    record : bool
        Whether to keep ``history``, a copy of the weights for every episode.
    progress : callable, optional
        Called as ``progress(episodes done, episodes)``.

    Returns
    -------
    LinearControlResult

    Raises
    ------
    TypeError
        If the actions are not discrete.
    ValueError
        If ``features`` does not give one row of the same length for each action, or the weights grow without bound (a
        learning rate too large for the number of features that are on).

    Examples
    --------
    >>> from robonav.mdp import GridWorld, OneHot, linear_q_learning
    >>> env = GridWorld("S . . G", step_reward=-1).environment()
    >>> result = linear_q_learning(env, 50, OneHot(4, 4), learning_rate=0.5)
    >>> result.q([0, 1, 2]).argmax(axis=1)
    array([1, 1, 1])
    """
    rates = learning_rate, epsilon
    training = LinearTraining(
        env, episodes, features, rates, max_steps, seed, record, progress
    )
    weights, f = training.weights, training.features  # f(state) is (A, n)
    for state in training.episodes():
        phi = f(state)
        while not training.done:
            action = training.choose((phi @ weights).tolist())
            state, reward, terminated = training.step(action)
            next_phi = f(state)
            future = 0.0 if terminated else (next_phi @ weights).max()
            delta = reward + discount * future - phi[action] @ weights
            weights += training.alpha * bounded(delta) * phi[action]
            phi = next_phi
    return training.result()


class LinearTraining(EpisodeRunner):
    """Episodes of a learner with weights, features that are checked, and epsilon-greedy exploration.

    ``weights`` start at zero, ``alpha`` is the learning rate of the episode, and ``choose(action_values)`` draws an
    action.
    """

    def __init__(
        self,
        env: gym.Env[Any, Any],
        episodes: int,
        features: Features,
        rates: tuple[float | Schedule, float | Schedule],
        max_steps: int,
        seed: int | np.random.Generator,
        record: bool,
        progress: Progress | None,
    ) -> None:
        env, rng = discretise_actions(env), np.random.default_rng(seed)
        learning_rate, epsilon = rates
        self._rate = schedule("learning_rate", learning_rate)
        self._features = features
        self.features = consistent_features(env, features)
        n_weights = self.features(env.reset(seed=0)[0]).shape[1]
        super().__init__(
            env,
            episodes,
            max_steps=max_steps,
            rng=rng,
            record=record,
            progress=progress,
        )
        self.choose = EpsilonGreedy(epsilon, rng)
        self.weights = self.watch(np.zeros(n_weights))
        self.alpha = 0.0

    def episodes(self) -> Iterator[Any]:
        """First state of each episode, for which the rates of learning and exploration are set."""
        for state in super().episodes():
            self.choose.begin(self.episode)
            self.alpha = self._rate(self.episode)
            yield state

    def result(self) -> LinearControlResult:
        """Everything as arrays."""
        return LinearControlResult(
            self.weights,
            self._features,
            np.array(self.returns),
            np.array(self.lengths),
            self.history,
        )


def consistent_features(env: gym.Env[Any, int], features: Features) -> Features:
    """The features, which raise a ValueError unless they have one row for each action and always the same shape."""
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

    return checked


def bounded(delta: float) -> float:
    """The error of a prediction, as long as learning has not diverged."""
    if not abs(delta) < DIVERGED:
        raise ValueError(
            "the weights grow without bound: learning_rate is too large for the number of features"
        )
    return delta
