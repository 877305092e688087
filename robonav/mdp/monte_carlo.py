"""Learning from whole episodes: Monte Carlo prediction and control (2.4.2)."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from typing import Any, Literal

import gymnasium as gym
import numpy as np
from numpy.typing import ArrayLike

from robonav.progress import Progress
from robonav.validation import check_generator, check_one_of, check_real

from .episodes import (
    EpisodeRunner,
    discounted_return,
    discretise_spaces,
    policy_sampler,
    space_sizes,
)
from .exploration import EpsilonGreedy, Schedule, harmonic_decay
from .temporal_difference import ControlResult, PredictionResult, QTable

Visit = Literal["first", "every"]


def counted_visits(passed: Sequence[Hashable], visit: Visit) -> Iterator[int]:
    """The steps whose returns count: all of them, or for each thing passed only the first time it was."""
    seen: set[Hashable] = set()
    for step, thing in enumerate(passed):
        if visit == "every" or thing not in seen:
            seen.add(thing)
            yield step


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
    """The values of a policy, each the average of the returns that followed the state.

    Parameters
    ----------
    env : Gymnasium environment with S discrete states and A actions.
    policy : (S,) of action numbers, or (S, A) of probabilities.
    episodes : how many to play.
    visit : ``"first"`` counts a state once an episode, which is unbiased; ``"every"`` each time it is passed, which is
        biased in the short run and right in the long one (Singh and Sutton 1996).
    discount : gamma, in [0, 1].
    max_steps : steps after which an episode is cut off; it then counts as if nothing more had come.
    seed : number or generator, for the environment and for the choices.
    record : keep ``history``.
    progress : called as ``progress(episodes done, episodes)``.

    Returns
    -------
    PredictionResult with ``values`` (S,), NaN where a state was never passed, and ``visits`` (S,).
    """
    env, rng = discretise_spaces(env), check_generator("seed", seed)
    discount = check_real("discount", discount, at_least=0, at_most=1)
    check_one_of("visit", visit, ("first", "every"))
    states, actions = space_sizes(env)
    course = EpisodeRunner(
        env, episodes, max_steps=max_steps, rng=rng, progress=progress
    )
    choose = policy_sampler(policy, states, actions, rng)
    values, visits = np.full(states, np.nan), np.zeros(states, dtype=np.int64)
    history = [values.copy()]
    for start in course.episodes():
        episode = course.walk(start, choose)
        returns = discounted_return(episode.rewards, discount)
        passed = episode.states[:-1]
        for step in counted_visits(passed.tolist(), visit):
            state = passed[step]
            visits[state] += 1
            known = 0.0 if visits[state] == 1 else values[state]
            values[state] = known + (returns[step] - known) / visits[state]
        if record:
            history.append(values.copy())
    return PredictionResult(values, visits, np.stack(history) if record else None)


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
    """On-policy Monte Carlo control: average what followed each action, and act epsilon-greedily on the averages.

    Parameters
    ----------
    visit : ``"first"`` or ``"every"`` visit of a state and action in an episode.
    learning_rate : weight of a new return, a number in [0, 1] or a schedule over the visits of the pair; left out, it
        is 1, 1/2, 1/3, ...: the plain average. A constant forgets what was earned by policies long abandoned.
    max_steps : steps after which an episode is cut off; it then counts as if nothing more had come.

    The others, and the result, are those of :func:`~robonav.mdp.q_learning`.
    """
    env, rng = discretise_spaces(env), check_generator("seed", seed)
    discount = check_real("discount", discount, at_least=0, at_most=1)
    check_one_of("visit", visit, ("first", "every"))
    rate = harmonic_decay() if learning_rate is None else learning_rate
    table = QTable(space_sizes(env), initial=initial, learning_rate=rate, record=record)
    course = EpisodeRunner(
        env, episodes, max_steps=max_steps, rng=rng, record=record, progress=progress
    )
    choose, q = EpsilonGreedy(epsilon, rng), table.q
    for start in course.episodes():
        choose.begin(course.number)
        episode = course.walk(start, lambda state: choose(q[state]))
        returns = discounted_return(episode.rewards, discount).tolist()
        pairs = list(
            zip(episode.states[:-1].tolist(), episode.actions.tolist(), strict=True)
        )
        for step in counted_visits(pairs, visit):
            table.learn(*pairs[step], returns[step])
        table.keep()
    return table.learned(course)
