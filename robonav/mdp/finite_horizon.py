"""Finite horizon: a fixed number of steps to go, planned backwards from the last (Eq. (2.27))."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import ArrayArgument

from ._arguments import checked
from .models import FiniteMDP

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FiniteHorizonSolution:
    """Optimal values and policy of the next H steps.

    Attributes
    ----------
    values : (H + 1, S) array
        ``values[t]`` holds with t steps done and H - t to go; ``values[H]`` are the final values.
    policy : (H, S) array of ints
        ``policy[t]`` holds the best actions with t steps done.

    Examples
    --------
    >>> from robonav.mdp import backward_induction, four_by_three
    >>> plan = backward_induction(four_by_three().mdp(discount=1.0), horizon=3)
    >>> plan.values.shape, plan.policy.shape
    ((4, 11), (3, 11))
    """

    values: Floats
    policy: NDArray[np.intp]


@checked
def backward_induction(
    mdp: FiniteMDP, horizon: int, *, final_values: ArrayArgument | None = None
) -> FiniteHorizonSolution:
    """Backward induction: optimal values and policy for each of the next ``horizon`` steps.

    Maximises the expected return J of Eq. (2.27), discounted by the model's discount.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    horizon : int
        Number of steps H.
    final_values : (S,) array, optional
        Value of standing in each state at the end; zeros by default.

    Returns
    -------
    FiniteHorizonSolution

    Examples
    --------
    >>> from robonav.mdp import FiniteMDP, backward_induction
    >>> mdp = FiniteMDP([[[1.0]], [[1.0]]], [[1.0, 2.0]], discount=0.5)
    >>> backward_induction(mdp, horizon=2).values.ravel()
    array([3., 2., 0.])
    """
    values = np.empty((horizon + 1, mdp.n_states))
    policy = np.empty((horizon, mdp.n_states), dtype=np.intp)
    values[horizon] = 0.0 if final_values is None else final_values
    for t in reversed(range(horizon)):
        q = mdp.rewards + mdp.discount * mdp.expected_next_values(values[t + 1])
        values[t], policy[t] = q.max(axis=1), q.argmax(axis=1)
    return FiniteHorizonSolution(values, policy)


@checked
def finite_horizon_evaluation(
    mdp: FiniteMDP,
    policy: ArrayLike,
    horizon: int,
    *,
    final_values: ArrayArgument | None = None,
) -> Floats:
    """Expected return of a policy in the next ``horizon`` steps, Eq. (2.27); discounted by the model's discount.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    policy : (S,) array of ints or (S, A) array of probabilities
    horizon : int
        Number of steps H.
    final_values : (S,) array, optional
        Value of standing in each state at the end; zeros by default.

    Returns
    -------
    (S,) array

    Examples
    --------
    >>> from robonav.mdp import FiniteMDP, finite_horizon_evaluation
    >>> mdp = FiniteMDP([[[1.0]]], [[1.0]], discount=0.5)
    >>> finite_horizon_evaluation(mdp, [0], horizon=3)
    array([1.75])
    """
    transitions, rewards = mdp.induced_chain(policy)
    values = np.zeros(mdp.n_states) if final_values is None else final_values
    for _ in range(horizon):
        values = rewards + mdp.discount * (transitions @ values)  # Eq. (2.27)
    return values
