"""Decorators of the learners: they check arguments and make the tables that a learner fills.

The decorators of this file turn an algorithm into the function that users call. That function

1. checks its arguments;
2. numbers the states and actions of the environment from 0;
3. makes the table of values or the weights that the algorithm changes, and the generator of random numbers;
4. wraps the environment in an :class:`EpisodeLog`, which seeds it, cuts long episodes off and keeps the records;
5. returns the result.

``inspect.unwrap(learner)`` is the algorithm as written. It runs on any Gymnasium environment that fits.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from functools import wraps
from typing import Any, Protocol, TypeVar

import gymnasium as gym
import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.documentation import documents, with_signature
from robonav.progress import Progress

from ._arguments import checked
from .discrete_spaces import discretise_actions, discretise_spaces, space_sizes
from .episodes import EpisodeLog, UniformNumbers, policy_sampler
from .exploration import Schedule, schedule
from .features import Features
from .learning_results import ControlResult, LinearControlResult, PredictionResult

R = TypeVar("R")

DIVERGED = (
    1e100  # a length of the weights far above any reward, far below what overflows
)


class ControlMethod(Protocol):
    """How a learner of a table of action values is called."""

    def __call__(
        self,
        env: gym.Env[Any, Any],
        episodes: int,
        *,
        discount: float = ...,
        learning_rate: float | Schedule | None = ...,
        epsilon: float | Schedule = ...,
        initial: float = ...,
        max_steps: int = ...,
        seed: int | np.random.Generator = ...,
        record: bool = ...,
        progress: Progress | None = ...,
        **options: Any,
    ) -> ControlResult: ...


class PredictionMethod(Protocol):
    """How a learner of the values of a policy is called."""

    def __call__(
        self,
        env: gym.Env[Any, Any],
        policy: ArrayLike,
        episodes: int,
        *,
        discount: float = ...,
        max_steps: int = ...,
        seed: int | np.random.Generator = ...,
        record: bool = ...,
        progress: Progress | None = ...,
        **options: Any,
    ) -> PredictionResult: ...


class LinearMethod(Protocol):
    """How a learner of weights is called."""

    def __call__(
        self,
        env: gym.Env[Any, Any],
        episodes: int,
        features: Features,
        *,
        discount: float = ...,
        learning_rate: float | Schedule = ...,
        epsilon: float | Schedule = ...,
        max_steps: int = ...,
        seed: int | np.random.Generator = ...,
        record: bool = ...,
        progress: Progress | None = ...,
    ) -> LinearControlResult: ...


def control_method(algorithm: Callable[..., None]) -> ControlMethod:
    """Make a learner of an algorithm that changes a table of action values.

    The algorithm is called as ``algorithm(env, q, visits, episodes, *, discount, learning_rate, epsilon, rng)``.
    ``q`` and ``visits`` are nested lists (S, A), of which Python reads single entries faster than of arrays.
    ``learning_rate`` and ``epsilon`` are schedules, and ``rng.random()`` gives the random numbers.
    """
    own = inspect.signature(algorithm).parameters["learning_rate"]
    has_own_rate = own.default is not own.empty

    def train(
        env: gym.Env[Any, Any],
        episodes: int,
        *,
        discount: float = 0.99,
        learning_rate: float | Schedule | None = 0.1,
        epsilon: float | Schedule = 0.1,
        initial: float = 0.0,
        max_steps: int = 10_000,
        seed: int | np.random.Generator = 0,
        record: bool = False,
        progress: Progress | None = None,
        **options: Any,
    ) -> ControlResult:
        env, rng = discretise_spaces(env), np.random.default_rng(seed)
        n_states, n_actions = space_sizes(env)
        q = [[initial] * n_actions for _ in range(n_states)]
        visits = [[0] * n_actions for _ in range(n_states)]
        if learning_rate is not None or not has_own_rate:
            options["learning_rate"] = schedule("learning_rate", learning_rate)
        options["epsilon"] = schedule("epsilon", epsilon)
        log = EpisodeLog(env, episodes, max_steps, rng, progress=progress)
        if record:
            log.record(lambda: np.array(q))
        numbers = UniformNumbers(rng)
        algorithm(log, q, visits, episodes, discount=discount, rng=numbers, **options)
        log.end_episode()
        return ControlResult(
            np.array(q),
            np.array(visits),
            np.array(log.returns),
            np.array(log.lengths),
            log.history,
            tuple(map(np.array, log.visited_states)) if record else None,
        )

    return public(train, algorithm, returns="ControlResult")


def prediction_method(algorithm: Callable[..., None]) -> PredictionMethod:
    """Make a learner of an algorithm that estimates the values of a policy.

    The algorithm is called as ``algorithm(env, policy, values, visits, episodes, *, discount)``. ``policy`` is a
    function from a state to an action, and ``values`` and ``visits`` are lists (S,). An algorithm with a
    ``learning_rate`` starts from estimates, ``initial``. One without averages returns: it has no estimate before the
    first visit of a state, and the result holds NaN there.
    """
    averages = "learning_rate" not in inspect.signature(algorithm).parameters

    def train(
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
        **options: Any,
    ) -> PredictionResult:
        env, rng = discretise_spaces(env), np.random.default_rng(seed)
        n_states, n_actions = space_sizes(env)
        values, visits = [initial] * n_states, [0] * n_states

        def estimates() -> NDArray[np.float64]:
            unknown = averages & (np.array(visits) == 0)
            return np.where(unknown, np.nan, values)

        if not averages:
            options["learning_rate"] = schedule("learning_rate", learning_rate)
        act = policy_sampler(policy, n_states, n_actions, rng)
        log = EpisodeLog(env, episodes, max_steps, rng, progress=progress)
        if record:
            log.record(estimates)
        algorithm(log, act, values, visits, episodes, discount=discount, **options)
        log.end_episode()
        return PredictionResult(estimates(), np.array(visits), log.history)

    left_out = {"learning_rate", "initial"} if averages else set()
    return public(train, algorithm, returns="PredictionResult", without=left_out)


def linear_method(algorithm: Callable[..., None]) -> LinearMethod:
    """Make a learner of an algorithm that changes the weights of features.

    The algorithm is called as ``algorithm(env, features, weights, episodes, *, discount, learning_rate, epsilon,
    rng)``. ``weights`` is an array (n,), and ``learning_rate`` and ``epsilon`` are schedules over episodes.
    """

    def train(
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
        env, rng = discretise_actions(env), np.random.default_rng(seed)
        shape = shape_of_features(env, features)
        weights = np.zeros(shape[1])
        log = EpisodeLog(env, episodes, max_steps, rng, progress=progress)
        if record:
            log.record(weights.copy)
        algorithm(
            log,
            checked_features(features, shape, weights),
            weights,
            episodes,
            discount=discount,
            learning_rate=schedule("learning_rate", learning_rate),
            epsilon=schedule("epsilon", epsilon),
            rng=UniformNumbers(rng),
        )
        log.end_episode()
        check_weights(weights)
        returns, lengths = np.array(log.returns), np.array(log.lengths)
        return LinearControlResult(weights, features, returns, lengths, log.history)

    linear = {name: f"{name}, linear" for name in ("env", "learning_rate", "record")}
    return public(train, algorithm, returns="LinearControlResult", other=linear)


def shape_of_features(env: gym.Env[Any, int], features: Features) -> tuple[int, int]:
    """Return the shape (A, n) of the features of the first state, and refuse features without a row for each action."""
    n_actions = int(env.action_space.n)  # type: ignore[attr-defined]
    shape = np.shape(features(env.reset(seed=0)[0]))
    if len(shape) != 2 or shape[0] != n_actions:
        raise ValueError(
            f"features must give shape ({n_actions}, n), one row for each action, got {shape}"
        )
    return n_actions, shape[1]


def checked_features(
    features: Features, shape: tuple[int, int], weights: NDArray[np.float64]
) -> Features:
    """Let the features raise a ValueError if their shape changes or the weights have grown without bound."""

    def find(state: Any) -> NDArray[np.float64]:
        """The features of a state, checked."""
        check_weights(weights)
        found = np.asarray(features(state))
        if found.shape != shape:
            raise ValueError(
                f"features must give shape {shape} for every state, as for the first, got {found.shape}"
            )
        return found

    return find


def check_weights(weights: NDArray[np.float64]) -> None:
    """Raise a ValueError if learning has diverged."""
    if not weights @ weights < DIVERGED**2:
        raise ValueError(
            "the weights grow without bound: learning_rate is too large for the number of features"
        )


def public(
    train: Callable[..., R],
    algorithm: Callable[..., None],
    *,
    returns: str,
    without: Iterable[str] = (),
    other: dict[str, str] | None = None,
) -> Any:
    """Give ``train`` the name of the algorithm, the algorithm's own options, and the documentation of all parameters.

    Parameters
    ----------
    train : callable
        Takes the parameters that the learners of one kind share.
    algorithm : callable
        Its keyword-only parameters with a default are added to those of ``train``. If ``train`` has one of the same
        name, its default becomes None, and the algorithm's own default holds.
    returns : str
        The type of the result.
    without : iterable of str
        Parameters of ``train`` that the algorithm has no use for.
    other : dict, optional
        Entries of :data:`DOCUMENTATION` to use in place of those of the same name as the parameter.
    """
    shared = inspect.signature(train).parameters
    left_out = {"options", *without}
    parameters = {name: p for name, p in shared.items() if name not in left_out}
    for name, p in inspect.signature(algorithm).parameters.items():
        if p.default is not p.empty:
            parameters[name] = (
                shared[name].replace(default=None) if name in shared else p
            )
    signature = inspect.Signature(list(parameters.values()), return_annotation=returns)
    checked_train = checked(with_signature(train, signature))
    learner = with_signature(wraps(algorithm)(checked_train), signature)
    said = {name: DOCUMENTATION[(other or {}).get(name, name)] for name in parameters}
    return documents(said, returns=returns, raises=RAISES)(learner)


DOCUMENTATION = {
    "env": """gymnasium.Env
    S discrete states, A discrete actions.""",
    "env, linear": """gymnasium.Env
    A discrete actions; its states may be anything that ``features`` takes.""",
    "policy": "(S,) array of ints or (S, A) array of probabilities",
    "episodes": """int
    Number of episodes.""",
    "features": """callable
    ``features(state)`` is an (A, n) array, such as :class:`~robonav.mdp.OneHot` or :class:`~robonav.mdp.Tiles` give;
    :func:`~robonav.mdp.with_bias` puts f_0 = 1 before them.""",
    "visit": """{"first", "every"}
    ``"first"`` counts the return from the first visit in an episode, which is unbiased; ``"every"`` counts the return
    from each visit, which is biased for few episodes and right in the limit (Singh and Sutton 1996).""",
    "discount": """float
    gamma, in [0, 1].""",
    "learning_rate": """float or Schedule
    alpha, in [0, 1], or a schedule over the visits of the entry that is updated. Values converge if every entry is
    visited again and again and the schedule falls neither too fast nor too slowly
    (:func:`~robonav.mdp.harmonic_decay`, :func:`~robonav.mdp.polynomial_decay`).""",
    "learning_rate, linear": """float or Schedule
    alpha, in [0, 1], or a schedule over episodes. Where k features are on at a time, a step of alpha moves the value by
    k times alpha: divide by k.""",
    "epsilon": """float or Schedule
    Probability of a random action, in [0, 1], or a schedule over episodes.""",
    "initial": """float
    Value of every entry at the start. Above any possible return, it makes an agent try everything.""",
    "max_steps": """int
    Steps after which an episode is cut off. The last state does not count as terminal then.""",
    "seed": """int or numpy.random.Generator
    For the environment and for the choices.""",
    "record": """bool
    Whether to keep ``history``, a copy of the estimates for every episode, and the states visited.""",
    "record, linear": """bool
    Whether to keep ``history``, a copy of the weights for every episode.""",
    "progress": """callable, optional
    Called as ``progress(episodes done, episodes)``.""",
}
"""Type and description of each parameter of a learner."""

RAISES = """TypeError
    If ``env`` is not a Gymnasium environment or its spaces are not discrete.
ValueError
    If a number is out of its range, or the policy or the features do not fit the environment."""
