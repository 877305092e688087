"""Planning with a known model: Algorithms 1 and 2 of the thesis, and modified policy iteration (section 2.3)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from . import policies, undiscounted
from .arguments import validated
from .evaluation import (
    History,
    evaluation_residual,
    starting_values,
    warn_not_converged,
)
from .linear_solver import solve
from .models import FiniteMDP
from .rounding import gains_and_rounding, warn_if_hidden

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
    array([1, 1, 1, 0, 0, 0, 0, 0, 1, 0, 3])
    """

    values: Floats
    policy: Actions
    iterations: int
    residual: float
    history: Floats | None = None
    policies: Actions | None = None


@validated
def value_iteration(
    mdp: FiniteMDP,
    tolerance: float = 1e-6,
    *,
    start: ArrayLike | None = None,
    max_iterations: int = 100_000,
    record: bool = False,
) -> Solution:
    """Value iteration, Algorithm 2, Eq. (2.26).

    Stops when a sweep changes no value by more than ``tolerance * (1 - discount) / (2 * discount)``. The greedy policy
    then loses at most ``tolerance`` in every state, and the values are within half of that (Puterman 2005, Theorem
    6.3.1). Without discount there is no such bound, and ``tolerance`` itself is used.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    tolerance : float
        Largest loss of value accepted, in units of reward.
    start : (S,) array, optional
        Values to start from; zeros by default. Without discount, the values of a policy that is greedy for them and
        sure to end.
    max_iterations : int
        Number of sweeps after which to give up.
    record : bool
        Whether to keep ``history``, (iterations + 1, S), and the greedy policy of each of its rows.

    Returns
    -------
    Solution

    Warns
    -----
    ConvergenceWarning
        If ``max_iterations`` sweeps were not enough; the message says how far the values still moved.

    Examples
    --------
    >>> from robonav.mdp import four_by_three, value_iteration
    >>> solution = value_iteration(four_by_three().mdp(discount=0.95))
    >>> solution.iterations, solution.values.round(2)[:4]
    (25, array([0.69, 0.78, 0.87, 0.  ]))
    """
    values = first_values(mdp, start)  # 1 and 2
    history = History(record)
    history.append(values)
    for iteration in range(1, max_iterations + 1):  # 3
        before = values
        q = mdp.action_values(before)  # r(s, a) + discount * sum over s' of T V(s')
        values = q.max(axis=1)  # 4  Eq. (2.26)
        history.append(values)  # 5
        residual = abs(values - before).max()
        if residual <= mdp.residual_for(tolerance):  # 6
            break
    else:
        limit = mdp.residual_for(tolerance)
        warn_not_converged("value_iteration", iteration, residual, limit)
    policy = greedy_policy(mdp, values, tolerance)  # 7  Eq. (2.25)
    return solution_of(mdp, values, policy, iteration, residual, history, tolerance)


@validated
def policy_iteration(
    mdp: FiniteMDP,
    tolerance: float = 1e-9,
    *,
    start: ArrayLike | None = None,
    max_iterations: int = 1000,
    record: bool = False,
) -> Solution:
    """Policy iteration, Algorithm 1, with each policy evaluated exactly.

    Actions are switched only if the gain exceeds ``tolerance * (1 - discount)`` and the floating-point error. Each
    switch is then a strict improvement, so the loop terminates even with ties. Without discount there is no bound on
    the loss, and only the floating-point error counts.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    tolerance : float
        Largest loss of value accepted, in units of reward.
    start : (S,) array of ints, optional
        Policy to start from. By default the shortest path to a terminal state where there is one, and the action with
        the largest immediate reward elsewhere. Without discount it must be sure to end.
    max_iterations : int
        Number of policies after which to give up.
    record : bool
        Whether to keep ``history``, the values of each policy, and ``policies``, both (iterations, S).

    Returns
    -------
    Solution

    Raises
    ------
    ValueError
        If, without discount, rewards can be collected forever.

    Warns
    -----
    ConvergenceWarning
        If ``max_iterations`` policies were not enough; the message says by how much the last could be improved. Also
        if rounding near discount 1 hides gains that are worth more than the tolerance.

    Examples
    --------
    >>> from robonav.mdp import four_by_three, policy_iteration
    >>> solution = policy_iteration(four_by_three().mdp(discount=0.95))
    >>> solution.iterations, solution.policy
    (3, array([1, 1, 1, 0, 0, 0, 0, 0, 1, 0, 3]))
    """
    policy = first_policy(mdp, start)  # 1 and 2
    values = np.zeros(mdp.n_states)  # 3
    smallest = tolerance * (1 - mdp.discount)
    history, chosen = History(record), History(record)
    for iteration in range(1, max_iterations + 1):  # 4
        values = evaluated(mdp, policy, values)  # 5 to 7: solves Eq. (2.5)
        history.append(values)
        chosen.append(policy)
        gains, rounding = gains_and_rounding(mdp, policy, values, smallest)  # Q - V
        limit = max(smallest, rounding)
        gain = gains.max(axis=1)
        if gain.max() <= limit:  # 11
            warn_if_hidden(rounding, smallest, mdp.discount)
            break
        if iteration == max_iterations:
            warn_not_converged("policy_iteration", iteration, gain.max(), limit)
            break
        improved = gains.argmax(axis=1)  # 8 and 9  Eq. (2.25)
        policy = np.where(gain > limit, improved, policy)
    residual = float(gain.max())
    return Solution(values, policy, iteration, residual, history.rows, chosen.rows)


@validated
def modified_policy_iteration(
    mdp: FiniteMDP,
    tolerance: float = 1e-6,
    *,
    sweeps: int = 8,
    start: ArrayLike | None = None,
    max_iterations: int = 100_000,
    record: bool = False,
) -> Solution:
    """Modified policy iteration, between Algorithms 1 and 2.

    Each iteration improves the policy once and evaluates it by ``sweeps`` sweeps (0: value iteration; many: policy
    iteration). Stops when the changes of the improvement differ by at most ``tolerance * (1 - discount) / discount``
    between states. The greedy policy then loses at most ``tolerance``, and the values, shifted by the middle of the
    bounds on what is still missing, are within half of that (Puterman 2005, section 6.6). Without discount no value
    may change by more than ``tolerance``.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    tolerance : float
        Largest loss of value accepted, in units of reward.
    sweeps : int
        Evaluation sweeps after each improvement.
    start : (S,) array, optional
        Values to start from. By default values so small that every policy improves on them. Without discount, the
        values of a policy that is greedy for them and sure to end.
    max_iterations : int
        Number of improvements after which to give up.
    record : bool
        Whether to keep ``history``, (iterations + 1, S), and the greedy policy of each of its rows.

    Returns
    -------
    Solution

    Warns
    -----
    ConvergenceWarning
        If ``max_iterations`` improvements were not enough; the message says how far the values still moved.

    Examples
    --------
    >>> from robonav.mdp import four_by_three, modified_policy_iteration
    >>> solution = modified_policy_iteration(four_by_three().mdp(discount=0.95))
    >>> solution.values.round(2)[:4]
    array([0.69, 0.78, 0.87, 0.  ])
    """
    values = values_below(mdp) if start is None else first_values(mdp, start)
    history = History(record)
    history.append(values)
    limit = evaluation_residual(mdp, tolerance)
    for iteration in range(1, max_iterations + 1):
        q = mdp.action_values(values)
        change = q.max(axis=1) - values
        values = q.max(axis=1)  # improve  Eqs. (2.25) and (2.26)
        residual = spread(mdp, change)
        if residual <= limit:
            break
        transitions, rewards = mdp.induced_chain(q.argmax(axis=1))
        for _ in range(sweeps):  # evaluate  Eq. (2.24)
            values = rewards + mdp.discount * (transitions @ values)
        history.append(values)
    else:
        warn_not_converged("modified_policy_iteration", iteration, residual, limit)
    policy = greedy_policy(mdp, values, tolerance)
    if residual <= limit:
        values = shifted_to_middle(mdp, values, change)
        history.append(values)
    return solution_of(mdp, values, policy, iteration, residual, history, tolerance)


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


def shifted_to_middle(mdp: FiniteMDP, values: Floats, change: Floats) -> Floats:
    """Middle of the bounds on the optimal values after a sweep with these changes (Puterman 2005, section 6.6)."""
    if mdp.discount == 1:
        return values
    missing = mdp.discount / (1 - mdp.discount) * (change.min() + change.max()) / 2
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
