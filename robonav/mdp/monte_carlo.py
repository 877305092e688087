"""Learning from whole episodes: Monte Carlo prediction and control (section 2.4.2)."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from typing import Any, Literal

import gymnasium as gym
import numpy as np
from numpy.typing import ArrayLike

from robonav.progress import Progress

from ._arguments import checked
from .discrete_spaces import discretise_spaces, space_sizes
from .episodes import EpisodeRunner, discounted_return, policy_sampler
from .exploration import Schedule, harmonic_decay
from .tabular import ControlResult, PredictionResult, TabularTraining

Visit = Literal["first", "every"]


def counted_visits(passed: Sequence[Hashable], visit: Visit) -> Iterator[int]:
    """Steps whose returns count: all of them, or only the first of each element passed."""
    seen: set[Hashable] = set()
    for step, element in enumerate(passed):
        if visit == "every" or element not in seen:
            seen.add(element)
            yield step


@checked
def monte_carlo_prediction(
    env: gym.Env[Any, Any],
    policy: ArrayLike,
    episodes: int,
    *,
    visit: Visit = "first",
    discount: float = 0.99,
    max_steps: int = 10_000,
    seed: int | np.random.Generator = 0,
    record: bool = False,
    progress: Progress | None = None,
) -> PredictionResult:
    """Monte Carlo prediction: the value of a state is the mean of the returns that followed it.

    Parameters
    ----------
    env : gymnasium.Env
        S discrete states, A discrete actions.
    policy : (S,) array of ints or (S, A) array of probabilities
    episodes : int
        Number of episodes.
    visit : {"first", "every"}
        ``"first"`` counts a state once an episode, which is unbiased; ``"every"`` counts each visit, which is biased
        for few episodes and right in the limit (Singh and Sutton 1996).
    discount : float
        gamma, in [0, 1].
    max_steps : int
        Steps after which an episode is cut off. It then counts as if no more rewards had come.
    seed : int or numpy.random.Generator
        For the environment and for the choices.
    record : bool
        Whether to keep ``history``, a copy of the estimates for every episode, and the states passed.
    progress : callable, optional
        Called as ``progress(episodes done, episodes)``.

    Returns
    -------
    PredictionResult
        Its ``values`` are NaN for states that were never visited; its ``visits`` count the returns averaged.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, monte_carlo_prediction
    >>> env = GridWorld("S . G").environment()
    >>> monte_carlo_prediction(env, [1, 1, 1], 5, discount=0.5).values
    array([0.5, 1. , nan])
    """
    env, rng = discretise_spaces(env), np.random.default_rng(seed)
    n_states, n_actions = space_sizes(env)
    runner = EpisodeRunner(
        env, episodes, max_steps=max_steps, rng=rng, record=record, progress=progress
    )
    choose = policy_sampler(policy, n_states, n_actions, rng)
    values, visits = np.full(n_states, np.nan), np.zeros(n_states, dtype=np.int64)
    runner.watch(values)
    for start in runner.episodes():
        episode = runner.rollout(start, choose)
        returns = discounted_return(episode.rewards, discount)
        passed = episode.states[:-1].tolist()
        for step in counted_visits(passed, visit):
            state = passed[step]
            visits[state] += 1
            mean = 0.0 if visits[state] == 1 else values[state]
            values[state] = mean + (returns[step] - mean) / visits[state]
    return PredictionResult(values, visits, runner.history)


@checked
def monte_carlo_control(
    env: gym.Env[Any, Any],
    episodes: int,
    *,
    visit: Visit = "first",
    discount: float = 0.99,
    learning_rate: float | Schedule | None = None,
    epsilon: float | Schedule = 0.1,
    initial: float = 0.0,
    max_steps: int = 10_000,
    seed: int | np.random.Generator = 0,
    record: bool = False,
    progress: Progress | None = None,
) -> ControlResult:
    """Monte Carlo control: average the returns after each action, and act epsilon-greedily on the averages.

    Parameters
    ----------
    env : gymnasium.Env
        S discrete states, A discrete actions.
    episodes : int
        Number of episodes.
    visit : {"first", "every"}
        Whether the first or every visit of a state and action in an episode counts.
    discount : float
        gamma, in [0, 1].
    learning_rate : float or Schedule, optional
        Weight of a new return, in [0, 1], or a schedule over the visits of the pair. By default 1, 1/2, 1/3, ...,
        which is the plain average. A constant forgets the returns of policies abandoned long ago.
    epsilon : float or Schedule
        Probability of a random action, in [0, 1], or a schedule over episodes.
    initial : float
        Value of every pair at the start. Above any possible return, it makes the agent try everything.
    max_steps : int
        Steps after which an episode is cut off. It then counts as if no more rewards had come.
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
    >>> from robonav.mdp import GridWorld, monte_carlo_control
    >>> env = GridWorld("S . . G", step_reward=-1).environment()
    >>> monte_carlo_control(env, 50, max_steps=50).policy[:3]
    array([1, 1, 1])
    """
    rate = harmonic_decay() if learning_rate is None else learning_rate
    training = TabularTraining(
        env, episodes, (rate, epsilon), initial, max_steps, seed, record, progress
    )
    q = training.q
    for start in training.episodes():
        episode = training.rollout(start, lambda state: training.choose(q[state]))
        returns = discounted_return(episode.rewards, discount).tolist()
        states, actions = episode.states[:-1].tolist(), episode.actions.tolist()
        pairs = list(zip(states, actions, strict=True))
        for step in counted_visits(pairs, visit):
            state, action = pairs[step]
            error = returns[step] - q[state][action]
            q[state][action] += training.step_size(state, action) * error
    return training.result()
