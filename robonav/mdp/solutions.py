"""The result of a planner, and what all planners start from and end with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from . import policies, undiscounted
from .evaluation import History, starting_values
from .linear_solver import solve
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
    history: Floats | None = None
    policies: Actions | None = None


def first_values(
    mdp: FiniteMDP, start: ArrayLike | None, *, name: str = "start"
) -> Floats:
    """Values (S,) for sweeps to start from; without discount those of a policy that is sure to end."""
    values = starting_values(name, mdp, start)
    return values if mdp.discount < 1 else undiscounted.proper_values(mdp, values)


def values_below(mdp: FiniteMDP) -> Floats:
    """Values (S,) that no sweep lowers, so that modified policy iteration climbs steadily from them."""
    if mdp.discount == 1:
        return first_values(mdp, None)
    return np.where(mdp.terminal, 0, min(mdp.rewards.min(), 0) / (1 - mdp.discount))


def first_policy(mdp: FiniteMDP, start: ArrayLike | None) -> Actions:
    """Policy (S,) to start from: a proper one where there is one, else the largest immediate reward."""
    if start is None:
        steps, shortest = undiscounted.shortest_path_policy(mdp, mdp.terminal)
        return np.where(np.isfinite(steps), shortest, mdp.rewards.argmax(axis=1))
    policy = policies.as_deterministic_policy(
        "start", start, mdp.n_states, mdp.n_actions
    )
    if mdp.discount == 1:
        undiscounted.closed_classes(*mdp.induced_chain(policy), "start")
    return policy


def evaluated(mdp: FiniteMDP, policy: Actions, guess: Floats) -> Floats:
    """Values (S,) of a policy as ``policy_evaluation`` finds them, from a guess that is near them."""
    transitions, rewards = mdp.induced_chain(policy)
    if mdp.discount == 1:
        return undiscounted.policy_values(transitions, rewards, guess=guess)
    identity = sp.eye_array(mdp.n_states, format="csr")
    return solve(identity - mdp.discount * transitions, rewards, guess)


def greedy_policy(mdp: FiniteMDP, values: Floats, tolerance: float) -> Actions:
    """Greedy policy (S,) for optimal values known to within ``tolerance``; without discount one that ends."""
    if mdp.discount < 1:
        return mdp.greedy(values)
    return undiscounted.greedy_policy(mdp, values, tolerance)


def spread(mdp: FiniteMDP, change: Floats) -> float:
    """Difference between the largest and the least change of a value; without discount the largest change."""
    if mdp.discount == 1:
        return abs(change).max()
    return change.max() - change.min()


def shifted_to_middle(
    mdp: FiniteMDP, values: Floats, least: float, most: float
) -> Floats:
    """Middle of the bounds on the optimal values after a sweep whose changes lie from ``least`` to ``most``.

    The bounds are those of Puterman (2005, section 6.6). Terminal values are 0 exactly. Take the greedy policy before
    the shift: it moves all values but the terminal ones, and so could change which action is best.
    """
    if mdp.discount == 1:
        return values
    missing = mdp.discount / (1 - mdp.discount) * (least + most) / 2
    return np.where(mdp.terminal, 0, values + missing)


def solution_of(
    mdp: FiniteMDP,
    values: Floats,
    policy: Actions,
    iterations: int,
    residual: float,
    history: History,
    tolerance: float,
) -> Solution:
    """The result of a planner; with a recorded history also the greedy policy of each of its rows."""
    rows = history.rows
    if rows is None:
        return Solution(values, policy, iterations, float(residual))
    greedy = [greedy_policy(mdp, row, tolerance) for row in rows[:-1]]
    return Solution(
        values, policy, iterations, float(residual), rows, np.stack([*greedy, policy])
    )
