"""Policies as arrays: one action a state, or one distribution over actions a state (section 2.2.1).

A deterministic policy is an array (S,) of action indices, a stochastic one an array (S, A) of probabilities.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav import expect

SUM_TOLERANCE = 1e-8  # how far the probabilities of one distribution may be from summing to one


def checked(policy: ArrayLike, states: int, actions: int) -> NDArray:
    """The policy as an integer array (S,) or a float array (S, A).

    Raises
    ------
    TypeError : if it is no array of numbers, or of one dimension and not of whole numbers.
    ValueError : if its shape is neither (S,) nor (S, A), an action does not exist, or a row is no distribution.
    """
    given = expect.array("policy", policy, dtype=None)
    if given.ndim == 1:
        if given.dtype.kind not in "iu":
            raise TypeError(f"policy must hold whole numbers, one action a state, got {given.dtype}")
        given = expect.array("policy", given, shape=(states,), dtype=np.intp)
        if states and not (given.min() >= 0 and given.max() < actions):
            raise ValueError(f"policy must hold actions from 0 to {actions - 1}, got {given.min()} to {given.max()}")
        return given
    given = expect.array("policy", given, shape=(states, actions))
    wrong = (given < 0).any(axis=1) | (abs(given.sum(axis=1) - 1) > SUM_TOLERANCE)
    if wrong.any():
        state = int(wrong.argmax())
        raise ValueError(f"policy must hold one distribution a state, got {given[state]} for state {state}")
    return given


def probabilities(policy: ArrayLike, states: int, actions: int) -> NDArray[np.float64]:
    """The policy as probabilities (S, A), whichever of the two forms it comes in."""
    given = checked(policy, states, actions)
    return given if given.ndim == 2 else np.eye(actions)[given]


def uniform(states: int, actions: int) -> NDArray[np.float64]:
    """The policy (S, A) that takes every action alike."""
    return np.full((states, actions), 1 / actions)


def greedy_actions(action_values: ArrayLike, *, tolerance: float = 1e-9) -> NDArray[np.bool_]:
    """Which actions are greedy: (S, A) bools, true within ``tolerance`` of the best of each state (Eq. (2.16))."""
    q = expect.array("action_values", action_values, shape=("S", "A"))
    return q >= q.max(axis=1, keepdims=True) - expect.real("tolerance", tolerance, at_least=0)


def greedy_mixture(action_values: ArrayLike, *, tolerance: float = 1e-9) -> NDArray[np.float64]:
    """The stochastic policy (S, A) that chooses evenly among the greedy actions."""
    best = greedy_actions(action_values, tolerance=tolerance)
    return best / best.sum(axis=1, keepdims=True)
