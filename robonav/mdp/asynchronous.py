"""Asynchronous value iteration: one state at a time, in order or the most urgent first.

The decorator ``planner`` is explained in ``dynamic_programming``. Python backs up single states slowly, so the compiled
twins of these loops run (``_fast_planners``); a test holds both equal.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .evaluation import error_limit
from .models import FiniteMDP
from .planner import planner
from .solutions import Solution, first_values, greedy_actions


@planner(start=first_values, limit=FiniteMDP.residual_for, twin="_fast_planners")
def in_place_value_iteration(
    mdp: FiniteMDP,
    tolerance: float = 1e-6,
    *,
    start: ArrayLike | None = None,
    max_iterations: int = 100_000,
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
    epsilon = mdp.residual_for(tolerance)  # as in value iteration
    values = np.zeros(mdp.n_states) if start is None else np.array(start)
    for iteration in range(1, max_iterations + 1):
        residual = 0.0
        for state in range(mdp.n_states):
            expected_next_values = mdp.transitions_from(state) @ values  # (A,)
            q = mdp.rewards[state] + mdp.discount * expected_next_values
            residual = max(residual, abs(q.max() - values[state]))
            values[state] = q.max()  # the states after this one use the new value
        if residual <= epsilon:
            break
    policy = greedy_actions(mdp, values, tolerance)
    return Solution(values, policy, iteration, residual, residual <= epsilon)


@planner(start=first_values, limit=error_limit, twin="_fast_planners", records=False)
def prioritized_sweeping(
    mdp: FiniteMDP,
    tolerance: float = 1e-6,
    *,
    start: ArrayLike | None = None,
    max_backups: int = 100_000_000,
) -> Solution:
    """Prioritised sweeping: value iteration of one state at a time, the one with the largest possible error first.

    The priority of a state is an upper bound on its Bellman error. When V(s') changes by d, the error of a predecessor
    s grows by ``discount * max over a of T(s, a, s') * d`` at most. Stops when no priority exceeds
    ``tolerance * (1 - discount) / 2`` (``tolerance`` without discount). The greedy policy then loses at most
    ``tolerance`` (Moore and Atkeson 1993, here with a known model).

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
    epsilon = error_limit(mdp, tolerance)
    values = np.zeros(mdp.n_states) if start is None else np.array(start)
    # row s', column s: max over a of T(s, a, s')
    likeliest = mdp.likeliest_predecessors()
    q = mdp.rewards + mdp.discount * mdp.expected_next_values(values)
    # an upper bound on each state's Bellman error
    priority = abs(q.max(axis=1) - values)
    backups = 0
    while priority.max() > epsilon and backups < max_backups:
        state = int(priority.argmax())
        expected_next_values = mdp.transitions_from(state) @ values  # (A,)
        best = (mdp.rewards[state] + mdp.discount * expected_next_values).max()
        change = abs(best - values[state])
        values[state], priority[state] = best, 0.0
        # the predecessors of the state
        row = slice(*likeliest.indptr[state : state + 2])
        predecessors, probabilities = likeliest.indices[row], likeliest.data[row]
        priority[predecessors] += mdp.discount * probabilities * change
        backups += 1
    policy, residual = greedy_actions(mdp, values, tolerance), float(priority.max())
    return Solution(values, policy, backups, residual, residual <= epsilon)
