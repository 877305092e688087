"""Learning from each step: Q-learning (Algorithm 5), SARSA (Algorithm 6), expected SARSA, and TD(0)."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import ArrayLike

from robonav.progress import Progress

from ._arguments import checked
from .discrete_spaces import discretise_spaces, space_sizes
from .episodes import EpisodeRunner, policy_sampler
from .exploration import Schedule, schedule
from .tabular import ControlResult, PredictionResult, TabularTraining


@checked
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
    """One-step Q-learning, Algorithm 5, Eqs. (2.29) and (4.1).

    Learns the values of the best policy while it follows another. The thesis gives the same update in both equations.

    Parameters
    ----------
    env : gymnasium.Env
        S discrete states, A discrete actions.
    episodes : int
        Number of episodes.
    discount : float
        gamma, in [0, 1].
    learning_rate : float or Schedule
        alpha, in [0, 1], or a schedule over the visits of a state and action. Values converge if every pair is visited
        again and again and the schedule falls neither too fast nor too slowly (:func:`~robonav.mdp.harmonic_decay`,
        :func:`~robonav.mdp.polynomial_decay`).
    epsilon : float or Schedule
        Probability of a random action, in [0, 1], or a schedule over episodes.
    initial : float
        Value of every pair at the start. Above any possible return, it makes the agent try everything.
    max_steps : int
        Steps after which an episode is cut off. The last state then does not count as terminal: its value still counts.
    seed : int or numpy.random.Generator
        For the environment and for the choices.
    record : bool
        Whether to keep ``history``, a copy of the estimates for every episode, and the states passed.
    progress : callable, optional
        Called as ``progress(episodes done, episodes)``.

    Returns
    -------
    ControlResult

    Raises
    ------
    TypeError
        If ``env`` is not a Gymnasium environment or its spaces are not discrete.
    ValueError
        If a number is out of its range.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, q_learning
    >>> env = GridWorld("S . . G", step_reward=-1).environment()
    >>> q_learning(env, 50, learning_rate=0.5).policy[:3]
    array([1, 1, 1])
    """
    rates = learning_rate, epsilon
    training = TabularTraining(
        env, episodes, rates, initial, max_steps, seed, record, progress
    )
    q = training.q
    for state in training.episodes():  # 2 and 3
        while not training.done:  # 4
            action = training.choose(q[state])  # 5
            next_state, reward, terminated = training.step(action)  # 6
            future = 0.0 if terminated else max(q[next_state])
            error = reward + discount * future - q[state][action]
            q[state][action] += (
                training.step_size(state, action) * error
            )  # 7  Eqs. (2.29) and (4.1)
            state = next_state  # 8
    return training.result()


@checked
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
    """On-policy SARSA, Algorithm 6, Eqs. (2.30) and (4.2).

    Learns the values of the policy that it follows, exploration included. They tend to the optimal values only if
    ``epsilon`` falls to zero as well (Singh et al. 2000). The thesis gives the same update in both equations.

    Parameters
    ----------
    env : gymnasium.Env
        S discrete states, A discrete actions.
    episodes : int
        Number of episodes.
    discount : float
        gamma, in [0, 1].
    learning_rate : float or Schedule
        alpha, in [0, 1], or a schedule over the visits of a state and action. Values converge if every pair is visited
        again and again and the schedule falls neither too fast nor too slowly (:func:`~robonav.mdp.harmonic_decay`,
        :func:`~robonav.mdp.polynomial_decay`).
    epsilon : float or Schedule
        Probability of a random action, in [0, 1], or a schedule over episodes.
    initial : float
        Value of every pair at the start. Above any possible return, it makes the agent try everything.
    max_steps : int
        Steps after which an episode is cut off. The last state then does not count as terminal: its value still counts.
    seed : int or numpy.random.Generator
        For the environment and for the choices.
    record : bool
        Whether to keep ``history``, a copy of the estimates for every episode, and the states passed.
    progress : callable, optional
        Called as ``progress(episodes done, episodes)``.

    Returns
    -------
    ControlResult

    Raises
    ------
    TypeError
        If ``env`` is not a Gymnasium environment or its spaces are not discrete.
    ValueError
        If a number is out of its range.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, sarsa
    >>> env = GridWorld("S . . G", step_reward=-1).environment()
    >>> sarsa(env, 50, learning_rate=0.5).policy[:3]
    array([1, 1, 1])
    """
    rates = learning_rate, epsilon
    training = TabularTraining(
        env, episodes, rates, initial, max_steps, seed, record, progress
    )
    q = training.q
    for state in training.episodes():  # 2 and 3
        action = training.choose(q[state])  # 4
        while not training.done:  # 5
            next_state, reward, terminated = training.step(action)  # 6
            next_action = training.choose(q[next_state])  # 7
            future = 0.0 if terminated else q[next_state][next_action]
            error = reward + discount * future - q[state][action]
            q[state][action] += (
                training.step_size(state, action) * error
            )  # 8  Eqs. (2.30) and (4.2)
            state, action = next_state, next_action  # 9
    return training.result()


@checked
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
    """Expected SARSA (van Seijen et al. 2009): SARSA with the mean over the next action instead of one draw of it.

    The target varies less than SARSA's, so a larger learning rate works. In a deterministic environment a rate of 1 is
    the best.

    Parameters
    ----------
    env : gymnasium.Env
        S discrete states, A discrete actions.
    episodes : int
        Number of episodes.
    discount : float
        gamma, in [0, 1].
    learning_rate : float or Schedule
        alpha, in [0, 1], or a schedule over the visits of a state and action. Values converge if every pair is visited
        again and again and the schedule falls neither too fast nor too slowly (:func:`~robonav.mdp.harmonic_decay`,
        :func:`~robonav.mdp.polynomial_decay`).
    epsilon : float or Schedule
        Probability of a random action, in [0, 1], or a schedule over episodes.
    initial : float
        Value of every pair at the start. Above any possible return, it makes the agent try everything.
    max_steps : int
        Steps after which an episode is cut off. The last state then does not count as terminal: its value still counts.
    seed : int or numpy.random.Generator
        For the environment and for the choices.
    record : bool
        Whether to keep ``history``, a copy of the estimates for every episode, and the states passed.
    progress : callable, optional
        Called as ``progress(episodes done, episodes)``.

    Returns
    -------
    ControlResult

    Raises
    ------
    TypeError
        If ``env`` is not a Gymnasium environment or its spaces are not discrete.
    ValueError
        If a number is out of its range.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, expected_sarsa
    >>> env = GridWorld("S . . G", step_reward=-1).environment()
    >>> expected_sarsa(env, 50, learning_rate=0.5).policy[:3]
    array([1, 1, 1])
    """
    rates = learning_rate, epsilon
    training = TabularTraining(
        env, episodes, rates, initial, max_steps, seed, record, progress
    )
    q = training.q
    for state in training.episodes():
        while not training.done:
            action = training.choose(q[state])
            next_state, reward, terminated = training.step(action)
            future = 0.0 if terminated else training.choose.expected(q[next_state])
            error = reward + discount * future - q[state][action]
            q[state][action] += training.step_size(state, action) * error
            state = next_state
    return training.result()


@checked
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
    """TD(0) prediction: the values of a policy, each estimate updated towards the next (section 2.4.3).

    Parameters
    ----------
    env : gymnasium.Env
        S discrete states, A discrete actions.
    policy : (S,) array of ints or (S, A) array of probabilities
    episodes : int
        Number of episodes.
    discount : float
        gamma, in [0, 1].
    learning_rate : float or Schedule
        alpha, in [0, 1], or a schedule over the visits of a state.
    initial : float
        Value of every state at the start.
    max_steps : int
        Steps after which an episode is cut off. The last state then does not count as terminal: its value still counts.
    seed : int or numpy.random.Generator
        For the environment and for the choices.
    record : bool
        Whether to keep ``history``, a copy of the estimates for every episode, and the states passed.
    progress : callable, optional
        Called as ``progress(episodes done, episodes)``.

    Returns
    -------
    PredictionResult

    Raises
    ------
    TypeError
        If ``env`` is not a Gymnasium environment or its spaces are not discrete.
    ValueError
        If a number is out of its range, or the policy does not fit the environment.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, td_prediction
    >>> env = GridWorld("S . G").environment()
    >>> td_prediction(env, [1, 1, 1], 5, discount=0.5, learning_rate=1.0).values
    array([0.5, 1. , 0. ])
    """
    env, rng = discretise_spaces(env), np.random.default_rng(seed)
    (n_states, n_actions), rate = (
        space_sizes(env),
        schedule("learning_rate", learning_rate),
    )
    choose = policy_sampler(policy, n_states, n_actions, rng)
    runner = EpisodeRunner(
        env, episodes, max_steps=max_steps, rng=rng, record=record, progress=progress
    )
    values, visits = runner.watch([initial] * n_states), [0] * n_states
    for state in runner.episodes():
        while not runner.done:
            next_state, reward, terminated = runner.step(choose(state))
            future = 0.0 if terminated else values[next_state]
            error = reward + discount * future - values[state]
            values[state] += rate(visits[state]) * error
            visits[state] += 1
            state = next_state
    return PredictionResult(np.array(values), np.array(visits), runner.history)
