"""Asynchronous value iteration: one state at a time, in order or the most urgent first.

Both methods back up single states, which Python does slowly. Their loops therefore run compiled (``_fast``);
:func:`in_place_sweep` and :func:`prioritized_backups` are the same loops to be read, and a test holds both equal.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from ._arguments import checked
from .evaluation import History, warn_not_converged
from .models import FiniteMDP
from .solutions import Solution, first_values, greedy_policy, solution_of

Floats = NDArray[np.float64]


@checked
def in_place_value_iteration(
    mdp: FiniteMDP,
    tolerance: float = 1e-6,
    *,
    start: ArrayLike | None = None,
    max_iterations: int = 100_000,
    record: bool = False,
) -> Solution:
    """Value iteration whose sweeps use each new value at once (Gauss-Seidel): fewer sweeps, the same guarantee.

    A value changed early in a sweep changes later ones. A full backup after the sweep would move no value by more than
    the discount times the largest change, so the stopping rule of :func:`~robonav.mdp.value_iteration` holds here too.

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
    >>> from robonav.mdp import GridWorld, in_place_value_iteration, value_iteration
    >>> mdp = GridWorld("G . . . . .").mdp(discount=0.9)
    >>> in_place_value_iteration(mdp).iterations, value_iteration(mdp).iterations
    (2, 6)
    """
    from . import _fast

    values = first_values(mdp, start)
    limit, history = mdp.residual_for(tolerance), History(record)
    history.append(values)
    for iteration in range(1, max_iterations + 1):
        residual = _fast.in_place_sweep(*mdp.arrays, values)
        history.append(values)
        if residual <= limit:
            break
    else:
        warn_not_converged("in_place_value_iteration", iteration, residual, limit)
    policy = greedy_policy(mdp, values, tolerance)
    return solution_of(mdp, values, policy, iteration, residual, history, tolerance)


def in_place_sweep(mdp: FiniteMDP, values: Floats) -> float:
    """Back up all states in order, in place, each with the values as they are by then; return the largest change."""
    largest = 0.0
    for state in range(mdp.n_states):
        best = best_action_value(mdp, state, values)
        largest = max(largest, abs(best - values[state]))
        values[state] = best
    return largest


@checked
def prioritized_sweeping(
    mdp: FiniteMDP,
    tolerance: float = 1e-6,
    *,
    start: ArrayLike | None = None,
    max_backups: int = 100_000_000,
) -> Solution:
    """Prioritised sweeping: value iteration of one state at a time, the one with the largest possible error first.

    Stops when no state's error may exceed ``tolerance * (1 - discount) / 2`` (``tolerance`` without discount). The
    greedy policy then loses at most ``tolerance`` (Moore and Atkeson 1993, here with a known model).

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    tolerance : float
        Largest loss of value accepted, in units of reward.
    start : (S,) array, optional
        Values to start from; zeros by default. Without discount, the values of a policy that is greedy for them and
        sure to end.
    max_backups : int
        Number of backups of single states after which to give up.

    Returns
    -------
    Solution
        Its ``iterations`` counts backups of single states.

    Warns
    -----
    ConvergenceWarning
        If ``max_backups`` were not enough; the message says how large an error may still be.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, prioritized_sweeping
    >>> prioritized_sweeping(GridWorld(". . . . G").mdp(discount=0.9)).iterations
    9
    """
    from . import _fast

    values = first_values(mdp, start)
    priority = abs(mdp.action_values(values).max(axis=1) - values)
    limit = tolerance * (1 if mdp.discount == 1 else (1 - mdp.discount) / 2)
    backward = likeliest_predecessors(mdp)
    starts, states = unsigned(backward.indptr, backward.indices)
    backups, residual = _fast.prioritized_backups(
        *mdp.arrays,
        starts,
        states,
        backward.data,
        values,
        priority,
        np.argsort(-priority),
        limit,
        max_backups,
    )
    if residual > limit:
        warn_not_converged("prioritized_sweeping", backups, residual, limit)
    policy = greedy_policy(mdp, values, tolerance)
    return Solution(values, policy, backups, residual)


def prioritized_backups(
    mdp: FiniteMDP, values: Floats, limit: float, max_backups: int
) -> tuple[int, float]:
    """Back up the state with the largest priority, in place, until no priority exceeds ``limit``.

    The priority of a state bounds its Bellman error from above: a change of V(s') by d raises the priority of each
    predecessor s by at most discount * max over a of T(s, a, s') * d.

    Returns
    -------
    backups : int
        Number of backups done.
    largest : float
        Largest priority left.
    """
    backward = likeliest_predecessors(mdp)
    priority = abs(mdp.action_values(values).max(axis=1) - values)
    backups = 0
    while priority.max() > limit and backups < max_backups:
        state = int(priority.argmax())
        change = abs(best_action_value(mdp, state, values) - values[state])
        values[state] = best_action_value(mdp, state, values)
        priority[state] = 0.0
        before = slice(*backward.indptr[state : state + 2])
        likeliest = backward.data[before]  # max over a of T(s, a, s')
        priority[backward.indices[before]] += mdp.discount * likeliest * change
        backups += 1
    return backups, float(priority.max())


def best_action_value(mdp: FiniteMDP, state: int, values: Floats) -> float:
    """Backup of one state: max over a of r(s, a) + discount * sum over s' of T(s, a, s') V(s')."""
    own = slice(state * mdp.n_actions, (state + 1) * mdp.n_actions)
    return (mdp.rewards[state] + mdp.discount * (mdp.rows[own] @ values)).max()


def unsigned(*positions: NDArray[Any]) -> list[NDArray[Any]]:
    """Arrays of positions as ``_fast`` takes them."""
    return [part.view(f"u{part.itemsize}") for part in positions]


def likeliest_predecessors(mdp: FiniteMDP) -> sp.csr_array:
    """Largest probability of reaching s' from s by any action, (S, S): row s', column s."""
    likeliest = mdp.rows[:: mdp.n_actions]
    for action in range(1, mdp.n_actions):
        likeliest = likeliest.maximum(mdp.rows[action :: mdp.n_actions])
    return sp.csr_array(likeliest.T)
