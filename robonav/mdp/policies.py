"""Policies as arrays: one action a state, or one distribution over actions a state (section 2.2.1).

A deterministic policy is an array (S,) of action indices, a stochastic one an array (S, A) of probabilities.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array, check_real

SUM_TOLERANCE = 1e-8  # how far the sum of a distribution in float64 may be from 1


def sum_tolerance(dtype: np.dtype, terms: int) -> float:
    """Return how far the sum of a distribution of this type may be from 1: by the rounding of that many numbers.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.mdp.policies import sum_tolerance
    >>> sum_tolerance(np.dtype("float64"), 3), sum_tolerance(np.dtype("float32"), 3) < 1e-6
    (1e-08, True)
    """
    if dtype.kind != "f" or dtype.itemsize >= np.dtype(float).itemsize:
        return SUM_TOLERANCE
    return float(max(terms, 4) * np.finfo(dtype).eps)


def distributions(
    name: str, value: ArrayLike, shape: Sequence[int | str] | None = None
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Rows of probabilities (..., n) in float64, and for each row whether it is not a distribution (...).

    Rows of a narrower type, such as those of a network in float32, sum to 1 within the rounding of that type only.
    They are divided by their sums.

    Raises
    ------
    TypeError, ValueError
        If the value is not an array of finite numbers of this shape.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.mdp.policies import distributions
    >>> rows, wrong = distributions("policy", np.full((1, 3), 1 / 3, np.float32))
    >>> rows.sum(), wrong
    (np.float64(1.0), array([False]))
    """
    return normalised(check_array(name, value, shape=shape), np.asarray(value).dtype)


def normalised(
    rows: NDArray[np.float64], dtype: np.dtype
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Rows that came in this type, divided by their sums if it is a narrow one, and which are not distributions."""
    totals = rows.sum(axis=-1)
    tolerance = sum_tolerance(dtype, rows.shape[-1])
    wrong = (rows < 0).any(axis=-1) | (abs(totals - 1) > tolerance)
    if tolerance > SUM_TOLERANCE and not wrong.any():
        rows = rows / totals[..., np.newaxis]
    return rows, wrong


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

    Examples
    --------
    >>> as_deterministic_policy("policy", [1, 0], states=2, actions=2)
    array([1, 0])
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
        If its shape is neither (S,) nor (S, A), an action does not exist, or a row is not a distribution.

    Examples
    --------
    >>> as_policy([[0.5, 0.5], [1.0, 0.0]], states=2, actions=2)
    array([[0.5, 0.5],
           [1. , 0. ]])
    """
    if check_array("policy", policy).ndim == 1:
        return as_deterministic_policy("policy", policy, states, actions)
    given, wrong = distributions("policy", policy, (states, actions))
    if wrong.any():
        state = int(wrong.argmax())
        raise ValueError(
            f"policy must hold one distribution a state, got {given[state]} with sum {given[state].sum():.10g} "
            f"for state {state}"
        )
    return given


def probabilities(policy: ArrayLike, states: int, actions: int) -> NDArray[np.float64]:
    """The policy as probabilities (S, A), whichever of the two forms it comes in.

    Examples
    --------
    >>> probabilities([1, 0], states=2, actions=2)
    array([[0., 1.],
           [1., 0.]])
    """
    given = as_policy(policy, states, actions)
    return given if given.ndim == 2 else np.eye(actions)[given]


def as_distributions(name: str, value: ArrayLike, states: int) -> NDArray[np.float64]:
    """Distributions over S states, an array (..., S): beliefs.

    Raises
    ------
    TypeError, ValueError
        If the value is not an array of numbers, its last axis is not S, or a row is not a distribution.

    Examples
    --------
    >>> as_distributions("belief", [0.25, 0.75], states=2)
    array([0.25, 0.75])
    """
    given: NDArray[np.float64] = check_array(name, value)
    if given.ndim == 0 or given.shape[-1] != states:
        wanted = f"({states},)" if given.ndim <= 1 else f"(..., {states})"
        raise ValueError(f"{name} must have shape {wanted}, got {given.shape}")
    if (given < 0).any():
        raise ValueError(
            f"{name} must be a distribution over the {states} states, got a probability of {given.min():.10g}"
        )
    rows, wrong = normalised(given, np.asarray(value).dtype)
    if wrong.any():
        totals = given.sum(axis=-1).ravel()
        raise ValueError(
            f"{name} must be a distribution over the {states} states, got sum {totals[abs(totals - 1).argmax()]:.10g}"
        )
    return rows


def uniform(states: int, actions: int) -> NDArray[np.float64]:
    """The policy (S, A) that takes all actions with equal probability.

    Examples
    --------
    >>> uniform(states=2, actions=4)
    array([[0.25, 0.25, 0.25, 0.25],
           [0.25, 0.25, 0.25, 0.25]])
    """
    return np.full((states, actions), 1 / actions)


def greedy_action_mask(
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
    >>> from robonav.mdp import greedy_action_mask
    >>> greedy_action_mask([[1.0, 2.0, 2.0]])
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
    best = greedy_action_mask(action_values, tolerance=tolerance)
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
