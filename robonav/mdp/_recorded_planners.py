"""Policy iteration for every model, with the record that its readable function leaves out.

Systems of many equations are solved by a Krylov method from the values of the policy before, models without discount
are allowed, and the rounding error of a gain is bounded from the residual of the equations. The values of both
functions agree within rounding, because they solve the equations by different methods.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .evaluation import ValueHistory, policy_evaluation
from .models import FiniteMDP
from .rounding import improve
from .solutions import Solution


def policy_iteration(
    mdp: FiniteMDP,
    tolerance: float,
    *,
    start: NDArray[np.intp],
    max_iterations: int,
    record: bool,
) -> Solution:
    """Twin of ``dynamic_programming.policy_iteration`` that keeps each policy and its values."""
    policy, values = start, np.zeros(mdp.n_states)
    history, policies = ValueHistory(record), ValueHistory(record)
    for iteration in range(1, max_iterations + 1):
        values = policy_evaluation(mdp, policy, guess=values)
        history.append(values)
        policies.append(policy)
        q = mdp.rewards + mdp.discount * mdp.expected_next_values(values)
        improved, gain = improve(mdp, policy, values, q, tolerance)
        previous, policy = policy, improved
        converged = np.array_equal(policy, previous)
        if converged:
            break
    rows = history.rows, policies.rows
    return Solution(values, policy, iteration, gain, converged, *rows)
