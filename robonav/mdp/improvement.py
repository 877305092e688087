"""Generalized policy iteration, step by step (Fig. 2.4): evaluation and improvement chase each other."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav import expect

from . import policies
from .evaluation import policy_evaluation, starting_values, warn_unfinished
from .models import FiniteMDP


@dataclass(frozen=True)
class Trace:
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
) -> Trace:
    """Evaluate by some sweeps, improve, and so on until both agree; all recorded, for pages to step through.

    Parameters
    ----------
    sweeps : evaluation sweeps in each round: 1 is value iteration, ``math.inf`` (exact evaluation) policy iteration.
    tolerance : largest loss of value accepted, in units of reward; positive.
    start_values, start_policy : (S,); zeros if not given.
    max_rounds : evaluations after which to give up.

    Warns
    -----
    ConvergenceWarning : if ``max_rounds`` did not suffice.
    """
    if sweeps != math.inf:
        expect.integer("sweeps", sweeps, at_least=1)
    enough = mdp.stopping_distance(expect.positive("tolerance", tolerance))
    values = starting_values("start_values", mdp, start_values)
    chosen = np.zeros(mdp.states, dtype=np.intp) if start_policy is None else start_policy
    policy = policies.deterministic("start_policy", chosen, mdp.states, mdp.actions)
    rows = [(values, policy, False)]
    for rounds in range(1, expect.integer("max_rounds", max_rounds, at_least=1) + 1):
        evaluated = _evaluated(mdp, policy, values, sweeps)
        improved = _improved(mdp, policy, evaluated, enough)
        rows += [(evaluated, policy, False), (evaluated, improved, True)]
        moved = abs(mdp.backup(evaluated).max(axis=1) - evaluated).max()
        if moved <= enough and (improved == policy).all():
            break
        if rounds == max_rounds:
            warn_unfinished("generalized_policy_iteration", rounds, moved, enough)
        values, policy = evaluated, improved
    return _traced(mdp, rows)


def _evaluated(
    mdp: FiniteMDP, policy: NDArray[np.intp], values: NDArray[np.float64], sweeps: float
) -> NDArray[np.float64]:
    """The values moved towards the policy's by some sweeps, all the way by infinitely many."""
    if sweeps == math.inf:
        return policy_evaluation(mdp, policy)
    transitions, rewards = mdp.under(policy)
    for _ in range(int(sweeps)):
        values = rewards + mdp.discount * (transitions @ values)
    return values


def _improved(mdp: FiniteMDP, policy: NDArray[np.intp], values: NDArray[np.float64], enough: float) -> NDArray[np.intp]:
    """The greedy policy, but an action that is as good as the best stays (else ties would go round for ever)."""
    q = mdp.backup(values)
    stays = policies.greedy_actions(q, tolerance=min(enough, 1e-9))[np.arange(mdp.states), policy]
    return np.where(stays, policy, q.argmax(axis=1))


def _traced(mdp: FiniteMDP, rows: list[tuple[NDArray[np.float64], NDArray[np.intp], bool]]) -> Trace:
    """The rows (values, policy, whether improved) as arrays, with their distances from the two lines."""
    state = np.arange(mdp.states)
    gaps = []
    for values, policy, _ in rows:
        q = mdp.backup(values)
        backed_up = q[state, policy]
        gaps.append((abs(backed_up - values).max(), (q.max(axis=1) - backed_up).max()))
    values, chosen, improves = (np.stack(column) for column in zip(*rows, strict=True))
    evaluation_gap, greedy_gap = np.array(gaps).T
    return Trace(values, chosen, improves[1:], evaluation_gap, greedy_gap)


def shortfalls(
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
    optimum = expect.array("best", best, shape=(mdp.states,))
    held = expect.array("values", values, shape=("n", mdp.states))
    kept = expect.array("chosen", chosen, shape=held.shape, dtype=np.intp)
    loss = [(optimum - policy_evaluation(mdp, policy)).max() for policy in kept]
    return abs(held - optimum).max(axis=1), np.array(loss)
