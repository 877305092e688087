"""Refining demonstrations that contradict themselves: one action a state, by maximum a posteriori."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arguments import checked

Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Refined:
    """The result of a refinement of M steps.

    Attributes
    ----------
    actions : (M,) array of int
        The action given to each step: the same for all steps in the same state.
    changed : (M,) array of bool
        Whether that differs from the demonstrated action.
    states : int
        Number of different states among the steps.
    inconsistent : int
        Number of those in which more than one action was demonstrated.

    Examples
    --------
    >>> from robonav.nirl import most_frequent
    >>> most_frequent([7, 7, 7], [0, 0, 1], 2).changed
    array([False, False,  True])
    """

    actions: Ints
    changed: NDArray[np.bool_]
    states: int
    inconsistent: int


@checked
def most_frequent(states: ArrayLike, actions: ArrayLike, n_actions: int) -> Refined:
    """Give every state its most probable action, argmax_a P(s | a) P(a), Eq. (5.12).

    Both factors are counted from the demonstrations. P(s | a) P(a) = P(s, a) is then the share of the pair among all
    steps, so the action is the most frequent one in the state; of equally frequent actions it is the first.

    Parameters
    ----------
    states : (M, k) or (M,) array
        Equal rows are equal states.
    actions : (M,) array of int
        Demonstrated actions.
    n_actions : int
        A.

    Returns
    -------
    Refined

    Raises
    ------
    ValueError
        If there is no step, shapes do not fit, or an action does not exist.

    Examples
    --------
    >>> from robonav.nirl import most_frequent
    >>> most_frequent([7, 7, 7, 1], [0, 0, 1, 1], 2).actions
    array([0, 0, 0, 1])
    """
    counts, state_of_step = count_pairs(states, actions, n_actions)
    joint = counts / counts.sum()  # P(s | a) P(a) = P(s, a)
    best = joint.argmax(axis=1)  # Eq. (5.12)
    return _refined(best[state_of_step], counts, actions)


@checked
def map_uniform_prior(states: ArrayLike, actions: ArrayLike, n_actions: int) -> Refined:
    """Give every state the action under which it is likeliest, argmax_a P(s | a).

    Uses Eq. (5.12) with a uniform prior P(a). The thesis says that it too gives the most frequent action. It does
    not: an action demonstrated once here and nowhere else beats one demonstrated ten times here and a thousand times
    elsewhere.

    Parameters
    ----------
    states : (M, k) or (M,) array
        Equal rows are equal states.
    actions : (M,) array of int
        Demonstrated actions.
    n_actions : int
        A.

    Returns
    -------
    Refined

    Examples
    --------
    >>> from robonav.nirl import map_uniform_prior
    >>> map_uniform_prior([7, 7, 7, 1, 1, 1], [0, 0, 1, 0, 0, 0], 2).actions
    array([1, 1, 1, 0, 0, 0])
    """
    counts, state_of_step = count_pairs(states, actions, n_actions)
    likelihood = counts / np.maximum(counts.sum(axis=0), 1)  # P(s | a)
    best = likelihood.argmax(axis=1)
    return _refined(best[state_of_step], counts, actions)


def count_pairs(
    states: ArrayLike, actions: ArrayLike, n_actions: int
) -> tuple[Ints, Ints]:
    """How often each action occurs in each of D different states, (D, A), and the state of each step, (M,)."""
    rows = np.asarray(states)
    _, which = np.unique(rows, axis=0, return_inverse=True)
    which = which.reshape(len(rows))
    counts = np.zeros((which.max() + 1, n_actions), dtype=np.int64)
    np.add.at(counts, (which, np.asarray(actions)), 1)
    return counts, which


def _refined(refined: Ints, counts: Ints, actions: ArrayLike) -> Refined:
    inconsistent = int(((counts > 0).sum(axis=1) > 1).sum())
    return Refined(refined, refined != np.asarray(actions), len(counts), inconsistent)
