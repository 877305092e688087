"""Planning with a known model: Algorithms 1 and 2 of the thesis, and what lies between them (section 2.3)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav import expect

from . import policies
from .evaluation import solve_chain, starting_values, warn_unfinished
from .models import FiniteMDP


@dataclass(frozen=True)
class Solution:
    """What a planner found.

    Attributes
    ----------
    values : (S,), in units of reward.
    policy : (S,), action indices.
    iterations : sweeps over all states, or policies evaluated.
    distance : largest change of a value that one more improvement still promised.
    history : (steps, S), the values on the way, if recorded: see each planner.
    policies : (steps, S), the policy that goes with each row of ``history``.
    """

    values: NDArray[np.float64]
    policy: NDArray[np.intp]
    iterations: int
    distance: float
    history: NDArray[np.float64] | None = None
    policies: NDArray[np.intp] | None = None


def value_iteration(
    mdp: FiniteMDP,
    tolerance: float = 1e-6,
    *,
    start: ArrayLike | None = None,
    max_iterations: int = 100_000,
    record: bool = False,
) -> Solution:
    """Optimal values and a greedy policy by value iteration (Algorithm 2, Eq. (2.26)).

    Stops when a sweep changes no value by more than ``tolerance * (1 - discount) / (2 * discount)``: the policy is
    then within ``tolerance`` of optimal in every state, the values within half of that (Puterman 2005, Theorem 6.3.1).
    Without discount there is no such bound; ``tolerance`` itself is taken.

    Parameters
    ----------
    tolerance : largest loss of value accepted, in units of reward; positive.
    start : values (S,) to start from; zeros if not given.
    max_iterations : sweeps after which to give up.
    record : keep ``history`` (iterations + 1, S) and the greedy policy of each of its rows.

    Warns
    -----
    ConvergenceWarning : if ``max_iterations`` sweeps did not suffice; says how far the values still moved.
    """
    from . import kernels

    enough = mdp.stopping_distance(expect.positive("tolerance", tolerance))
    values = starting_values("start", mdp, start)
    updated, policy = np.empty_like(values), np.empty(mdp.states, dtype=np.intp)
    history, chosen = ([values.copy()], []) if record else ([], [])
    for iterations in range(1, expect.integer("max_iterations", max_iterations, at_least=1) + 1):
        least, most = kernels.optimal_sweep(*mdp.arrays, values, updated, policy)
        values, updated = updated, values
        distance = max(-least, most)
        if record:
            history.append(values.copy())
            chosen.append(policy.copy())
        if distance <= enough:
            break
        if iterations == max_iterations:
            warn_unfinished("value_iteration", iterations, distance, enough)
    policy = greedy_policy(mdp, values, tolerance)
    return Solution(values, policy, iterations, distance, *stacked(history, [*chosen, policy]))


def policy_iteration(
    mdp: FiniteMDP,
    tolerance: float = 1e-9,
    *,
    start: ArrayLike | None = None,
    max_iterations: int = 1000,
    record: bool = False,
) -> Solution:
    """An optimal policy and its values by policy iteration (Algorithm 1), each policy evaluated exactly.

    An action changes only where that gains more than ``tolerance * (1 - discount)``, and more than rounding could
    feign: every change then improves the policy truly, and where actions tie it ends all the same.

    Parameters
    ----------
    tolerance : largest loss of value accepted, in units of reward; positive.
    start : policy (S,) to start from; if not given, the shortest way to a terminal state where there is one, else the
        action with the best immediate reward. Without discount it must be sure to end.
    max_iterations : policies after which to give up.
    record : keep ``history`` (iterations, S), the values of each policy, and ``policies`` (iterations, S).

    Raises
    ------
    ValueError : if, without discount, rewards can be collected for ever.

    Warns
    -----
    ConvergenceWarning : if ``max_iterations`` policies did not suffice; says how much the last could be improved.
    """
    expect.positive("tolerance", tolerance)
    expect.integer("max_iterations", max_iterations, at_least=1)
    policy = _first_policy(mdp) if start is None else policies.deterministic("start", start, mdp.states, mdp.actions)
    state, values = np.arange(mdp.states), np.zeros(mdp.states)
    history, chosen = [], []
    for iterations in range(1, max_iterations + 1):
        values = solve_chain(*mdp.under(policy), mdp.discount, values)
        q = mdp.backup(values)
        gain = q.max(axis=1) - q[state, policy]
        enough = _true_gain(mdp, tolerance, values, q[state, policy])
        if record:
            history.append(values)
            chosen.append(policy)
        if gain.max() <= enough:
            break
        if iterations == max_iterations:
            warn_unfinished("policy_iteration", iterations, gain.max(), enough)
            break
        policy = np.where(gain > enough, q.argmax(axis=1), policy)
    return Solution(values, policy, iterations, float(gain.max()), *stacked(history, chosen))


def modified_policy_iteration(
    mdp: FiniteMDP,
    tolerance: float = 1e-6,
    *,
    sweeps: int = 8,
    start: ArrayLike | None = None,
    max_iterations: int = 100_000,
    record: bool = False,
) -> Solution:
    """Optimal values and a greedy policy by modified policy iteration: between Algorithms 1 and 2.

    Each iteration improves the policy once and evaluates it by ``sweeps`` sweeps (0: value iteration; many: policy
    iteration). Stops when the changes of the improvement differ by no more than ``tolerance * (1 - discount) /
    discount`` from state to state: the policy is then within ``tolerance`` of optimal, and the values, moved by what
    all states still have to gain alike, within half of that (Puterman 2005, section 6.6). Without discount no change
    may exceed ``tolerance``.

    Parameters
    ----------
    tolerance : largest loss of value accepted, in units of reward; positive.
    sweeps : evaluation sweeps after each improvement.
    start : values (S,) to start from; if not given, some that every policy improves on.
    max_iterations : improvements after which to give up.
    record : keep ``history`` (iterations + 1, S) and the greedy policy of each of its rows.

    Warns
    -----
    ConvergenceWarning : if ``max_iterations`` improvements did not suffice; says how far the values still moved.
    """
    from . import kernels

    expect.positive("tolerance", tolerance)
    enough = tolerance if mdp.discount == 1 else 2 * mdp.stopping_distance(tolerance)
    expect.integer("sweeps", sweeps, at_least=0)
    values = _values_below(mdp) if start is None else starting_values("start", mdp, start)
    updated, policy = np.empty_like(values), np.empty(mdp.states, dtype=np.intp)
    history, chosen = ([values.copy()], []) if record else ([], [])
    for iterations in range(1, expect.integer("max_iterations", max_iterations, at_least=1) + 1):
        least, most = kernels.optimal_sweep(*mdp.arrays, values, updated, policy)
        values, updated = updated, values
        distance = most - least if mdp.discount < 1 else max(-least, most)
        if record:
            chosen.append(policy.copy())
        if distance <= enough:
            values = _centred(mdp, values, least, most)
        else:
            for _ in range(sweeps):
                kernels.policy_sweep(*mdp.arrays, values, updated, policy)
                values, updated = updated, values
        if record:
            history.append(values.copy())
        if distance <= enough:
            break
        if iterations == max_iterations:
            warn_unfinished("modified_policy_iteration", iterations, distance, enough)
    policy = greedy_policy(mdp, values, tolerance)
    return Solution(values, policy, iterations, distance, *stacked(history, [*chosen, policy]))


def greedy_policy(mdp: FiniteMDP, values: NDArray[np.float64], tolerance: float) -> NDArray[np.intp]:
    """The greedy policy (S,) for optimal values known to within ``tolerance``.

    Without discount an action that waits for ever can be as greedy as the one that goes (and is worth nothing):
    of the greedy actions take one that comes closer to an end.
    """
    if mdp.discount < 1:
        return mdp.greedy(values)
    q = mdp.backup(values)
    steps, onwards = mdp.way_out(policies.greedy_actions(q, tolerance=tolerance))
    return np.where(np.isfinite(steps), onwards, q.argmax(axis=1))


def stacked(history: list[NDArray], chosen: list[NDArray]) -> tuple[NDArray | None, NDArray | None]:
    """Recorded values and policies, each (steps, S); nothing where nothing was recorded."""
    return (np.stack(history), np.stack(chosen)) if history else (None, None)


def _first_policy(mdp: FiniteMDP) -> NDArray[np.intp]:
    """A policy to start from: the way to an end where there is one (a proper policy), else the best reward at once."""
    steps, out = mdp.way_out()
    return np.where(np.isfinite(steps), out, mdp.rewards.argmax(axis=1))


def _values_below(mdp: FiniteMDP) -> NDArray[np.float64]:
    """Values (S,) that no sweep lowers, so that modified policy iteration climbs from them steadily."""
    if mdp.discount == 1:
        return solve_chain(*mdp.under(_first_policy(mdp)), 1, np.zeros(mdp.states))
    return np.where(mdp.terminal, 0, min(mdp.rewards.min(), 0) / (1 - mdp.discount))


def _centred(mdp: FiniteMDP, values: NDArray[np.float64], least: float, most: float) -> NDArray[np.float64]:
    """The middle of the bounds on the optimal values that a sweep with changes from ``least`` to ``most`` leaves."""
    if mdp.discount == 1:
        return values
    return np.where(mdp.terminal, 0, values + mdp.discount / (1 - mdp.discount) * (least + most) / 2)


def _true_gain(mdp: FiniteMDP, tolerance: float, values: NDArray[np.float64], backed_up: NDArray[np.float64]) -> float:
    """The least gain that counts as one: worth the tolerance, and more than the error of ``values`` can explain."""
    rounding = np.finfo(float).eps * abs(values).max()
    error = max(abs(backed_up - values).max(), rounding) * (mdp.states if mdp.discount == 1 else 1 / (1 - mdp.discount))
    return max(tolerance * (1 - mdp.discount), 2 * mdp.discount * error, 2 * rounding)
