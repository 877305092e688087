"""The result of a planner, the values and policies that planners start from, and the policy that they end with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import policies, undiscounted
from ._arguments import check_state_values
from .models import FiniteMDP

Floats = NDArray[np.float64]
Actions = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Solution:
    """Optimal values and an optimal policy, as a planner found them.

    Attributes
    ----------
    values : (S,) array
        The optimal values, in units of reward.
    policy : (S,) array of ints
    iterations : int
        Number of sweeps over all states, or of policies evaluated.
    residual : float
        Largest change of a value that one more improvement still promised.
    converged : bool
        Whether the planner met its tolerance before it had done its largest number of iterations.
    history : (rows, S) array or None
        The values of each iteration, if recorded; see each planner.
    policies : (rows, S) array of ints or None
        The policy that goes with each row of ``history``.

    Examples
    --------
    >>> from robonav.mdp import four_by_three, value_iteration
    >>> solution = value_iteration(four_by_three().mdp(discount=0.95))
    >>> solution.policy
    array([1, 1, 1, 0, 0, 0, 0, 0, 3, 0, 3])
    """

    values: Floats
    policy: Actions
    iterations: int
    residual: float
    converged: bool
    history: Floats | None = None
    policies: Actions | None = None


def starting_values(name: str, mdp: FiniteMDP, given: ArrayLike | None) -> Floats:
    """A copy of the values to start from; zeros unless given.

    Examples
    --------
    >>> from robonav.mdp import four_by_three
    >>> starting_values("start", four_by_three().mdp(0.9), None).shape
    (11,)
    """
    if given is None:
        return np.zeros(mdp.n_states)
    return check_state_values(name, given, mdp.n_states)


def first_values(
    mdp: FiniteMDP, start: ArrayLike | None, *, name: str = "start"
) -> Floats:
    """Values (S,) for sweeps to start from; without discount those of a policy that is sure to end.

    Examples
    --------
    >>> from robonav.mdp import four_by_three
    >>> first_values(four_by_three().mdp(0.9), None).any()
    np.False_
    """
    values = starting_values(name, mdp, start)
    return values if mdp.discount < 1 else undiscounted.proper_values(mdp, values)


def first_values_below(mdp: FiniteMDP, start: ArrayLike | None) -> Floats:
    """Values (S,) to start from, by default ones that no sweep lowers: the least reward forever."""
    if mdp.discount == 1 or start is not None:
        return first_values(mdp, start)
    return np.where(mdp.terminal, 0, min(mdp.rewards.min(), 0) / (1 - mdp.discount))


def first_policy(mdp: FiniteMDP, start: ArrayLike | None) -> Actions:
    """Policy (S,) to start from: a proper one where there is one, else the largest immediate reward.

    Examples
    --------
    >>> from robonav.mdp import four_by_three
    >>> first_policy(four_by_three().mdp(0.9), None)
    array([1, 1, 1, 0, 0, 1, 0, 1, 1, 0, 0])
    """
    if start is None:
        return policy_to_start_from(mdp)
    policy = policies.as_deterministic_policy(
        "start", start, mdp.n_states, mdp.n_actions
    )
    if mdp.discount == 1:
        undiscounted.closed_classes(*mdp.induced_chain(policy), "start")
    return policy


def policy_to_start_from(mdp: FiniteMDP) -> Actions:
    """Policy (S,) that takes the shortest path to a terminal state, or the largest immediate reward if there is none.

    Examples
    --------
    >>> from robonav.mdp import four_by_three
    >>> policy_to_start_from(four_by_three().mdp(0.9))
    array([1, 1, 1, 0, 0, 1, 0, 1, 1, 0, 0])
    """
    steps, shortest = undiscounted.shortest_path_policy(mdp, mdp.terminal)
    return np.where(np.isfinite(steps), shortest, mdp.rewards.argmax(axis=1))


def greedy_actions(mdp: FiniteMDP, values: Floats, tolerance: float) -> Actions:
    """Greedy policy (S,) for optimal values known to within ``tolerance``; without discount one that ends.

    Examples
    --------
    >>> from robonav.mdp import FiniteMDP
    >>> mdp = FiniteMDP([[[1.0]], [[1.0]]], [[0.0, 1.0]], discount=0.5)
    >>> greedy_actions(mdp, np.array([2.0]), 1e-6)
    array([1])
    """
    if mdp.discount < 1:
        return mdp.greedy(values)
    return undiscounted.greedy_actions(mdp, values, tolerance)
