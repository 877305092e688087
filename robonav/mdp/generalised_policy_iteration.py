"""Generalized policy iteration, step by step (Fig. 2.4): evaluation and improvement chase each other."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.errors import ConvergenceWarning
from robonav.validation import check_array, check_instance, check_integer

from . import policies
from .dynamic_programming import first_values, rounding_of_gains
from .evaluation import policy_evaluation
from .models import FiniteMDP
from .value_functions import or_rest


@dataclass(frozen=True)
class GPIHistory:
    """Every half step of generalized policy iteration, n of them, from the start (row 0).

    Attributes
    ----------
    values : (n + 1, S).
    policies : (n + 1, S), actions.
    improves : (n,), whether half step i, from row i to row i + 1, improved the policy (else it evaluated).
    evaluation_gap : (n + 1,), largest difference of the values to what one evaluation sweep makes of them: 0 on the
        line V = V^pi of Fig. 2.4(b).
    greedy_gap : (n + 1,), most that another action than the policy's promises under the values: 0 on the line
        pi = greedy(V).
    """

    values: NDArray[np.float64]
    policies: NDArray[np.intp]
    improves: NDArray[np.bool_]
    evaluation_gap: NDArray[np.float64]
    greedy_gap: NDArray[np.float64]


def generalized_policy_iteration(
    mdp: FiniteMDP,
    *,
    sweeps: float = 1,
    tolerance: float = 1e-6,
    start_values: ArrayLike | None = None,
    start_policy: ArrayLike | None = None,
    max_rounds: int = 10_000,
) -> GPIHistory:
    """Evaluate by some sweeps, improve, and so on until both agree; all recorded, for pages to step through.

    Parameters
    ----------
    sweeps : evaluation sweeps in each round: 1 is value iteration, ``math.inf`` (exact evaluation) policy iteration.
    tolerance : largest loss of value accepted, in units of reward; positive. What rounding can feign is accepted too.
    start_values, start_policy : (S,); zeros if not given, without discount as in ``value_iteration``.
    max_rounds : evaluations after which to give up.

    Warns
    -----
    ConvergenceWarning : if ``max_rounds`` did not suffice; says how far the values and how many actions still moved.
    """
    check_instance("mdp", mdp, FiniteMDP)
    if sweeps != math.inf:
        check_integer("sweeps", sweeps, at_least=1)
    enough = mdp.residual_for(tolerance)
    values = first_values(mdp, start_values, name="start_values")
    chosen = (
        np.zeros(mdp.n_states, dtype=np.intp) if start_policy is None else start_policy
    )
    policy = policies.check_deterministic_policy(
        "start_policy", chosen, mdp.n_states, mdp.n_actions
    )
    rows = [(values, policy, False)]
    for rounds in range(1, check_integer("max_rounds", max_rounds, at_least=1) + 1):
        evaluated, rounding = _evaluated(mdp, policy, values, sweeps)
        improved = _improved(mdp, policy, evaluated, rounding)
        rows += [(evaluated, policy, False), (evaluated, improved, True)]
        moved = abs(
            or_rest(mdp, mdp.action_values(evaluated)).max(axis=1) - evaluated
        ).max()
        changed = int((improved != policy).sum())
        if moved <= max(enough, rounding) and not changed:
            break
        if rounds == max_rounds:
            _warn_unfinished(rounds, moved, enough, changed)
        values, policy = evaluated, improved
    return _traced(mdp, rows)


def _evaluated(
    mdp: FiniteMDP, policy: NDArray[np.intp], values: NDArray[np.float64], sweeps: float
) -> tuple[NDArray[np.float64], float]:
    """The values moved towards the policy's by some sweeps, all the way by infinitely many; and what a gain may feign.

    That is more for exact values: the equations pass rounding on.
    """
    state = np.arange(mdp.n_states)
    if sweeps == math.inf:
        exact = policy_evaluation(mdp, policy)
        return exact, rounding_of_gains(
            mdp, exact, mdp.action_values(exact)[state, policy]
        )
    for _ in range(int(sweeps)):
        values = or_rest(mdp, mdp.action_values(values))[state, policy]
    return values, 4 * np.finfo(float).eps * float(abs(values).max())


def _improved(
    mdp: FiniteMDP,
    policy: NDArray[np.intp],
    values: NDArray[np.float64],
    rounding: float,
) -> NDArray[np.intp]:
    """The greedy policy, but an action that is as good as the best stays (else ties would go round for ever)."""
    q = mdp.action_values(values)
    promised = or_rest(mdp, q)
    stays = promised.max(axis=1) - q[np.arange(mdp.n_states), policy] <= rounding
    return np.where(stays, policy, promised.argmax(axis=1))


def _warn_unfinished(rounds: int, moved: float, enough: float, changed: int) -> None:
    """ConvergenceWarning at the caller's caller."""
    warnings.warn(
        f"generalized_policy_iteration gave up after {rounds} rounds: the last one left a value to move by "
        f"{moved:.3g}, where {enough:.3g} was asked for, and changed {changed} actions",
        ConvergenceWarning,
        stacklevel=3,
    )


def _traced(
    mdp: FiniteMDP, rows: list[tuple[NDArray[np.float64], NDArray[np.intp], bool]]
) -> GPIHistory:
    """The rows (values, policy, whether improved) as arrays, with their distances from the two lines."""
    state = np.arange(mdp.n_states)
    gaps = []
    for values, policy, _ in rows:
        q = mdp.action_values(values)
        backed_up = q[state, policy]
        gaps.append((abs(backed_up - values).max(), (q.max(axis=1) - backed_up).max()))
    values, chosen, improves = (np.stack(column) for column in zip(*rows, strict=True))
    evaluation_gap, greedy_gap = np.array(gaps).T
    return GPIHistory(values, chosen, improves[1:], evaluation_gap, greedy_gap)


def suboptimality(
    mdp: FiniteMDP, values: ArrayLike, chosen: ArrayLike, *, best: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How far each step of a history is from the best: (n,) for its values, (n,) for its policy.

    Parameters
    ----------
    values : (n, S), such as a recorded ``Solution.history``.
    chosen : (n, S), the policies that go with them.
    best : (S,), the optimal values.

    Returns
    -------
    largest difference of the values of each step from the best, and the most that its policy loses in any state.
    """
    check_instance("mdp", mdp, FiniteMDP)
    optimum = check_array("best", best, shape=(mdp.n_states,))
    held = check_array("values", values, shape=("n", mdp.n_states))
    kept = check_array("chosen", chosen, shape=held.shape, dtype=np.intp)
    loss = [(optimum - policy_evaluation(mdp, policy)).max() for policy in kept]
    return abs(held - optimum).max(axis=1), np.array(loss)
