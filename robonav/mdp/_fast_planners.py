"""Compiled twins of the planners in ``dynamic_programming``: each sweep is one pass over the model (``_fast``)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from . import _fast
from ._arguments import checked
from .evaluation import History, evaluation_residual, warn_not_converged
from .models import FiniteMDP
from .solutions import (
    Solution,
    first_values,
    greedy_policy,
    shifted_to_middle,
    solution_of,
    values_below,
)


@checked
def value_iteration(
    mdp: FiniteMDP,
    tolerance: float = 1e-6,
    *,
    start: ArrayLike | None = None,
    max_iterations: int = 100_000,
    record: bool = False,
) -> Solution:
    """Twin of ``dynamic_programming.value_iteration``: maximum and residual are found in the pass of the backup."""
    values = first_values(mdp, start)
    limit, history = mdp.residual_for(tolerance), History(record)
    updated, policy = np.empty_like(values), np.empty(mdp.n_states, dtype=np.intp)
    history.append(values)
    for iteration in range(1, max_iterations + 1):
        least, most = _fast.optimal_sweep(*mdp.arrays, values, updated, policy)
        values, updated = updated, values
        history.append(values)
        residual = max(-least, most)
        if residual <= limit:
            break
    else:
        warn_not_converged("value_iteration", iteration, residual, limit, stacklevel=5)
    policy = greedy_policy(mdp, values, tolerance)
    return solution_of(mdp, values, policy, iteration, residual, history, tolerance)


@checked
def modified_policy_iteration(
    mdp: FiniteMDP,
    tolerance: float = 1e-6,
    *,
    sweeps: int = 8,
    start: ArrayLike | None = None,
    max_iterations: int = 100_000,
    record: bool = False,
) -> Solution:
    """Twin of ``dynamic_programming.modified_policy_iteration``: sweeps need no copy of the induced chain."""
    values = values_below(mdp) if start is None else first_values(mdp, start)
    history = History(record)
    history.append(values)
    limit = evaluation_residual(mdp, tolerance)
    updated, policy = np.empty_like(values), np.empty(mdp.n_states, dtype=np.intp)
    for iteration in range(1, max_iterations + 1):
        least, most = _fast.optimal_sweep(*mdp.arrays, values, updated, policy)
        values, updated = updated, values
        residual = most - least if mdp.discount < 1 else max(-least, most)
        if residual <= limit:
            break
        for _ in range(sweeps):
            _fast.policy_sweep(*mdp.arrays, values, updated, policy)
            values, updated = updated, values
        history.append(values)
    else:
        warn_not_converged(
            "modified_policy_iteration", iteration, residual, limit, stacklevel=5
        )
    policy = greedy_policy(mdp, values, tolerance)
    if residual <= limit:
        values = shifted_to_middle(mdp, values, least, most)
        history.append(values)
    return solution_of(mdp, values, policy, iteration, residual, history, tolerance)
