"""The results of learning from episodes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .features import Features
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
        """Action values of several states, Eq. (4.3).

        Parameters
        ----------
        states : iterable
            k states, as the environment gives them.

        Returns
        -------
        (k, A) array

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.mdp import LinearControlResult, OneHot
        >>> none = np.zeros(0)
        >>> result = LinearControlResult(np.array([0.5, 0.0, 0.25, 1.0]), OneHot(2, 2), none, none)
        >>> result.q([0, 1])
        array([[0.5 , 0.25],
               [0.  , 1.  ]])
        """
        features = np.stack([self.features(state) for state in states])
        return features @ self.weights  # Eq. (4.3)
