"""Planning with a known model: Algorithms 1 and 2 of the thesis, and modified policy iteration (section 2.3).

Value iteration and modified policy iteration run as their compiled twins in ``_fast_planners``, which do the same sums
in one pass over the model; a test holds both equal bit for bit.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec

import numpy as np
from numpy.typing import ArrayLike

from ._arguments import checked
from .evaluation import History, evaluation_residual, warn_not_converged
from .models import FiniteMDP
from .rounding import gains_and_rounding, warn_if_hidden
from .solutions import (
    Solution,
    evaluated,
    first_policy,
    first_values,
    greedy_policy,
    shifted_to_middle,
    solution_of,
    spread,
    values_below,
)

P = ParamSpec("P")


def runs_compiled(planner: Callable[P, Solution]) -> Callable[P, Solution]:
    """Run the compiled twin of the same name instead; ``planner.__wrapped__`` is the function as written."""

    @wraps(planner)
    def twin(*args: P.args, **kwargs: P.kwargs) -> Solution:
        from . import _fast_planners

        compiled: Callable[P, Solution] = getattr(_fast_planners, planner.__name__)
        return compiled(*args, **kwargs)

    return twin


@runs_compiled
@checked
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
    (29, array([0.69, 0.8 , 0.9 , 0.  ]))
    """
    values = first_values(mdp, start)  # 1 and 2
    limit, history = mdp.residual_for(tolerance), History(record)
    history.append(values)
    for iteration in range(1, max_iterations + 1):  # 3
        before = values
        q = mdp.action_values(before)  # r(s, a) + discount * sum over s' of T V(s')
        values = q.max(axis=1)  # 4  Eq. (2.26)
        history.append(values)  # 5
        residual = abs(values - before).max()
        if residual <= limit:  # 6
            break
    else:
        warn_not_converged("value_iteration", iteration, residual, limit)
    policy = greedy_policy(mdp, values, tolerance)  # 7  Eq. (2.25)
    return solution_of(mdp, values, policy, iteration, residual, history, tolerance)


@checked
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
    (3, array([1, 1, 1, 0, 0, 0, 0, 0, 3, 0, 3]))
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


@runs_compiled
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
    """Modified policy iteration: improve once, evaluate by a few sweeps, repeat.

    It lies between Algorithm 1 (policy iteration) and Algorithm 2 (value iteration).

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
    array([0.69, 0.8 , 0.9 , 0.  ])
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
        values = shifted_to_middle(mdp, values, change.min(), change.max())
        history.append(values)
    return solution_of(mdp, values, policy, iteration, residual, history, tolerance)
