"""Compiled twins of the planners: each sweep is one pass over the model, in the kernels of ``_fast``.

A twin is called as its algorithm in ``dynamic_programming`` or ``asynchronous`` is. On sparse models it gives the same
numbers. On dense ones NumPy adds the terms of an expected value in another order, and the numbers are the same within
rounding. There, modified policy iteration may also evaluate another of two equally good actions on its way. Its result
then agrees with that of its algorithm within the tolerance only.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _fast
from .evaluation import ValueHistory, error_limit, evaluation_residual
from .models import FiniteMDP
from .solutions import Solution, greedy_actions

Floats = NDArray[np.float64]


def value_iteration(
    mdp: FiniteMDP,
    tolerance: float,
    *,
    start: Floats,
    max_iterations: int,
    record: bool,
) -> Solution:
    """Twin of ``dynamic_programming.value_iteration``: maximum and residual are found in the pass of the backup."""
    values, limit, history = start, mdp.residual_for(tolerance), ValueHistory(record)
    updated, policy = np.empty_like(values), np.empty(mdp.n_states, dtype=np.intp)
    history.append(values)
    for iteration in range(1, max_iterations + 1):
        least, most = _fast.optimal_sweep(*mdp.arrays, values, updated, policy)
        values, updated = updated, values
        history.append(values)
        residual = max(-least, most)
        if residual <= limit:
            break
    policy = greedy_actions(mdp, values, tolerance)
    converged = residual <= limit
    return Solution(values, policy, iteration, residual, converged, history.rows)


def modified_policy_iteration(
    mdp: FiniteMDP,
    tolerance: float,
    *,
    sweeps: int,
    start: Floats,
    max_iterations: int,
    record: bool,
) -> Solution:
    """Twin of ``dynamic_programming.modified_policy_iteration``: sweeps need no copy of the induced chain."""
    values, limit, history = (
        start,
        evaluation_residual(mdp, tolerance),
        ValueHistory(record),
    )
    updated, policy = np.empty_like(values), np.empty(mdp.n_states, dtype=np.intp)
    for iteration in range(1, max_iterations + 1):
        history.append(values)
        least, most = _fast.optimal_sweep(*mdp.arrays, values, updated, policy)
        values, updated = updated, values
        residual = most - least if mdp.discount < 1 else max(-least, most)
        if residual <= limit:
            break
        for _ in range(sweeps):
            _fast.policy_sweep(*mdp.arrays, values, updated, policy)
            values, updated = updated, values
    policy = greedy_actions(mdp, values, tolerance)
    converged = residual <= limit
    if converged and mdp.discount < 1:
        missing = mdp.discount / (1 - mdp.discount) * (least + most) / 2
        values = np.where(mdp.terminal, 0, values + missing)
    history.append(values)
    return Solution(values, policy, iteration, residual, converged, history.rows)


def in_place_value_iteration(
    mdp: FiniteMDP,
    tolerance: float,
    *,
    start: Floats,
    max_iterations: int,
    record: bool,
) -> Solution:
    """Twin of ``asynchronous.in_place_value_iteration``."""
    values, limit, history = start, mdp.residual_for(tolerance), ValueHistory(record)
    history.append(values)
    for iteration in range(1, max_iterations + 1):
        residual = _fast.in_place_sweep(*mdp.arrays, values)
        history.append(values)
        if residual <= limit:
            break
    policy = greedy_actions(mdp, values, tolerance)
    converged = residual <= limit
    return Solution(values, policy, iteration, residual, converged, history.rows)


def prioritized_sweeping(
    mdp: FiniteMDP, tolerance: float, *, start: Floats, max_backups: int
) -> Solution:
    """Twin of ``asynchronous.prioritized_sweeping``: the largest priority is on top of a heap."""
    values, limit = start, error_limit(mdp, tolerance)
    priority = abs(mdp.action_values(values).max(axis=1) - values)
    likeliest = mdp.likeliest_predecessors()
    backups, residual = _fast.prioritized_backups(
        *mdp.arrays,
        unsigned(likeliest.indptr),
        unsigned(likeliest.indices),
        likeliest.data,
        values,
        priority,
        np.argsort(-priority),
        limit,
        max_backups,
    )
    policy = greedy_actions(mdp, values, tolerance)
    return Solution(values, policy, backups, residual, residual <= limit)


def unsigned(positions: NDArray[Any]) -> NDArray[Any]:
    """Positions as ``_fast`` takes them."""
    return positions.view(f"u{positions.itemsize}")
