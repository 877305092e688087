"""Asynchronous value iteration: states backed up in place, in order or the most urgent first."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from robonav.validation import check_instance, check_integer, check_positive

from .dynamic_programming import Solution, first_values, greedy_policy, stacked
from .evaluation import warn_unfinished
from .models import FiniteMDP


def in_place_value_iteration(
    mdp: FiniteMDP,
    tolerance: float = 1e-6,
    *,
    start: ArrayLike | None = None,
    max_iterations: int = 100_000,
    record: bool = False,
) -> Solution:
    """Value iteration whose sweeps use each new value at once (Gauss-Seidel): fewer sweeps, the same guarantee.

    A value changed early in a sweep changes later ones: a full backup after the sweep would move no value by more
    than discount times its largest change, so the stopping distance of ``value_iteration`` serves here too.

    Parameters, result and warning are those of ``value_iteration``.
    """
    from . import _fast

    check_instance("mdp", mdp, FiniteMDP)
    enough = mdp.residual_for(tolerance)
    values = first_values(mdp, start)
    history, chosen = (
        ([values.copy()], [greedy_policy(mdp, values, tolerance)])
        if record
        else ([], [])
    )
    for iterations in range(
        1, check_integer("max_iterations", max_iterations, at_least=1) + 1
    ):
        distance = _fast.in_place_sweep(*mdp.arrays, values)
        if record:
            history.append(values.copy())
            chosen.append(greedy_policy(mdp, values, tolerance))
        if distance <= enough:
            break
        if iterations == max_iterations:
            warn_unfinished("in_place_value_iteration", iterations, distance, enough)
    return Solution(
        values,
        greedy_policy(mdp, values, tolerance),
        iterations,
        distance,
        *stacked(history, chosen),
    )


def prioritized_sweeping(
    mdp: FiniteMDP,
    tolerance: float = 1e-6,
    *,
    start: ArrayLike | None = None,
    max_backups: int = 100_000_000,
) -> Solution:
    """Value iteration of one state at a time, always the one whose value may be furthest from its backup.

    The priority of a state bounds its Bellman error from above: a change of V(s') by d raises the bound of each
    predecessor by discount times max_a T(s, a, s') times d. Stops when no bound exceeds ``tolerance * (1 - discount)
    / 2`` (without discount ``tolerance``): the greedy policy is then within ``tolerance`` of optimal. Moore and
    Atkeson (1993), with a known model.

    Parameters
    ----------
    tolerance : largest loss of value accepted, in units of reward; positive.
    start : values (S,) to start from; zeros if not given. Without discount what the greedy policy for them earns.
    max_backups : backups of single states after which to give up.

    Returns
    -------
    Solution, whose ``iterations`` counts backups of single states.

    Warns
    -----
    ConvergenceWarning : if ``max_backups`` did not suffice; says how large the largest bound still was.
    """
    from . import _fast

    check_instance("mdp", mdp, FiniteMDP)
    enough = check_positive("tolerance", tolerance) * (
        1 if mdp.discount == 1 else (1 - mdp.discount) / 2
    )
    values = first_values(mdp, start)
    urgency = abs(mdp.action_values(values).max(axis=1) - values)
    backups, distance = _fast.prioritized_backups(
        *mdp.arrays,
        *_predecessors(mdp),
        values,
        urgency,
        np.argsort(-urgency),
        enough,
        check_integer("max_backups", max_backups, at_least=1),
    )
    if distance > enough:
        warn_unfinished("prioritized_sweeping", backups, distance, enough)
    return Solution(values, greedy_policy(mdp, values, tolerance), backups, distance)


def _predecessors(mdp: FiniteMDP) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """For each state s' its predecessors s and max_a T(s, a, s'), as starts, predecessors, weights of a CSR matrix."""
    likeliest = mdp.rows[:: mdp.n_actions]
    for action in range(1, mdp.n_actions):
        likeliest = likeliest.maximum(mdp.rows[action :: mdp.n_actions])
    backward = sp.csr_array(likeliest.T)
    starts, predecessors = (
        part.view(f"u{part.itemsize}") for part in (backward.indptr, backward.indices)
    )
    return starts, predecessors, backward.data
