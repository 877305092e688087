"""Policies as arrays: one action a state, or one distribution over actions a state (section 2.2.1).

A deterministic policy is an array (S,) of action indices, a stochastic one an array (S, A) of probabilities.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array, check_real

SUM_TOLERANCE = (
    1e-8  # how far the probabilities of one distribution may be from summing to one
)


def as_deterministic_policy(
    name: str, policy: ArrayLike, states: int, actions: int
) -> NDArray[np.intp]:
    """The policy as an integer array (S,).

    Raises
    ------
    TypeError
        If it does not hold whole numbers.
    ValueError
        If it has another shape, or an action does not exist.
    """
    check_array(name, policy, shape=(states,))
    if np.asarray(policy).dtype.kind not in "iu":
        raise TypeError(
            f"{name} must hold whole numbers, one action a state, got {np.asarray(policy).dtype}"
        )
    actions_taken = check_array(name, policy, shape=(states,), dtype=np.intp)
    if not (actions_taken.min() >= 0 and actions_taken.max() < actions):
        least, most = actions_taken.min(), actions_taken.max()
        raise ValueError(
            f"{name} must hold actions from 0 to {actions - 1}, got {least} to {most}"
        )
    return actions_taken


def as_policy(policy: ArrayLike, states: int, actions: int) -> NDArray:
    """The policy as an integer array (S,) or a float array (S, A).

    Raises
    ------
    TypeError
        If the policy is not an array of numbers, or has one dimension but holds no whole numbers.
    ValueError
        If its shape is neither (S,) nor (S, A), an action does not exist, or a row is no distribution.
    """
    if check_array("policy", policy).ndim == 1:
        return as_deterministic_policy("policy", policy, states, actions)
    given = check_array("policy", policy, shape=(states, actions))
    wrong = (given < 0).any(axis=1) | (abs(given.sum(axis=1) - 1) > SUM_TOLERANCE)
    if wrong.any():
        state = int(wrong.argmax())
        raise ValueError(
            f"policy must hold one distribution a state, got {given[state]} for state {state}"
        )
    return given


def probabilities(policy: ArrayLike, states: int, actions: int) -> NDArray[np.float64]:
    """The policy as probabilities (S, A), whichever of the two forms it comes in."""
    given = as_policy(policy, states, actions)
    return given if given.ndim == 2 else np.eye(actions)[given]


def as_distributions(name: str, value: ArrayLike, states: int) -> NDArray[np.float64]:
    """Distributions over S states, an array (..., S): beliefs.

    Raises
    ------
    TypeError, ValueError
        If the value is not an array of numbers, its last axis is not S, or a row is not a distribution.
    """
    given: NDArray[np.float64] = check_array(name, value)
    if given.ndim == 0 or given.shape[-1] != states:
        wanted = f"({states},)" if given.ndim <= 1 else f"(..., {states})"
        raise ValueError(f"{name} must have shape {wanted}, got {given.shape}")
    if (given < 0).any():
        raise ValueError(
            f"{name} must be a distribution over the {states} states, got a probability of {given.min():.10g}"
        )
    totals = given.sum(axis=-1)
    if (abs(totals - 1) > SUM_TOLERANCE).any():
        off = np.ravel(totals)[abs(np.ravel(totals) - 1).argmax()]
        raise ValueError(
            f"{name} must be a distribution over the {states} states, got sum {off:.10g}"
        )
    return given


def uniform(states: int, actions: int) -> NDArray[np.float64]:
    """The policy (S, A) that takes all actions with equal probability."""
    return np.full((states, actions), 1 / actions)


def greedy_actions(
    action_values: ArrayLike, *, tolerance: float = 1e-9
) -> NDArray[np.bool_]:
    """Which actions are greedy: those within ``tolerance`` of the best of each state.

    Parameters
    ----------
    action_values : (S, A) array
    tolerance : float

    Returns
    -------
    (S, A) array of bools

    Examples
    --------
    >>> from robonav.mdp import greedy_actions
    >>> greedy_actions([[1.0, 2.0, 2.0]])
    array([[False,  True,  True]])
    """
    q = check_array("action_values", action_values, shape=("S", "A"))
    return q >= q.max(axis=1, keepdims=True) - check_real(
        "tolerance", tolerance, at_least=0
    )


def greedy_mixture(
    action_values: ArrayLike, *, tolerance: float = 1e-9
) -> NDArray[np.float64]:
    """The stochastic policy that chooses uniformly among the greedy actions.

    Parameters
    ----------
    action_values : (S, A) array
    tolerance : float
        Actions within it of the best are greedy.

    Returns
    -------
    (S, A) array of probabilities

    Examples
    --------
    >>> from robonav.mdp import greedy_mixture
    >>> greedy_mixture([[1.0, 2.0, 2.0]])
    array([[0. , 0.5, 0.5]])
    """
    best = greedy_actions(action_values, tolerance=tolerance)
    return best / best.sum(axis=1, keepdims=True)


def optimal_values_of(action_values: ArrayLike) -> NDArray[np.float64]:
    """Value of each state if its best action is taken, Eq. (2.10).

    Parameters
    ----------
    action_values : (..., A) array

    Returns
    -------
    (...) array

    Examples
    --------
    >>> from robonav.mdp.policies import optimal_values_of
    >>> optimal_values_of([[1.0, 3.0], [0.5, 0.0]])
    array([3. , 0.5])
    """
    return np.max(action_values, axis=-1)  # Eq. (2.10)
