"""Planning with a known model: Algorithms 1 and 2 of the thesis, and what lies between them (section 2.3)."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.errors import ConvergenceWarning
from robonav.validation import check_instance, check_integer, check_positive

from . import policies
from .evaluation import solve_chain, solve_differences, starting_values, warn_unfinished
from .models import FiniteMDP
from .value_functions import or_rest


@dataclass(frozen=True)
class Solution:
    """What a planner found: the optimal values V*, the largest of any policy (Eq. (2.9)), and a policy that has them.

    Attributes
    ----------
    values : (S,), in units of reward.
    policy : (S,), action indices.
    iterations : sweeps over all states, or policies evaluated.
    residual : largest change of a value that one more improvement still promised.
    history : (steps, S), the values on the way, if recorded: see each planner.
    policies : (steps, S), the policy that goes with each row of ``history``.
    """

    values: NDArray[np.float64]
    policy: NDArray[np.intp]
    iterations: int
    residual: float
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
    start : values (S,) to start from; zeros if not given. Without discount what the greedy policy for them earns.
    max_iterations : sweeps after which to give up.
    record : keep ``history`` (iterations + 1, S) and the greedy policy of each of its rows.

    Warns
    -----
    ConvergenceWarning : if ``max_iterations`` sweeps did not suffice; says how far the values still moved.
    """
    from . import _fast

    check_instance("mdp", mdp, FiniteMDP)
    enough = mdp.residual_for(tolerance)
    values = first_values(mdp, start)
    updated, policy = np.empty_like(values), np.empty(mdp.n_states, dtype=np.intp)
    history, chosen = ([values.copy()], []) if record else ([], [])
    for iterations in range(
        1, check_integer("max_iterations", max_iterations, at_least=1) + 1
    ):
        least, most = _fast.optimal_sweep(*mdp.arrays, values, updated, policy)
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
    return Solution(
        values, policy, iterations, distance, *stacked(history, [*chosen, policy])
    )


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
    feign: every change then improves the policy truly, and where actions tie it ends all the same. Without discount
    there is no bound on the loss, and only rounding counts.

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
    ConvergenceWarning : if ``max_iterations`` policies did not suffice; says how much the last could be improved. Also
        if rounding hides gains that are worth more than the tolerance, near discount 1; says how much may be lost.
    """
    check_instance("mdp", mdp, FiniteMDP)
    worth = check_positive("tolerance", tolerance) * (1 - mdp.discount)
    check_integer("max_iterations", max_iterations, at_least=1)
    policy = (
        _first_policy(mdp)
        if start is None
        else policies.check_deterministic_policy(
            "start", start, mdp.n_states, mdp.n_actions
        )
    )
    values, name = np.zeros(mdp.n_states), "policy" if start is None else "start"
    history, chosen = [], []
    for iterations in range(1, max_iterations + 1):
        values = solve_chain(
            *mdp.induced_chain(policy), mdp.discount, values, name=name
        )
        name = "policy"
        gains, rounding = _gains(mdp, policy, values, worth)
        gain, enough = gains.max(axis=1), max(worth, rounding)
        if record:
            history.append(values)
            chosen.append(policy)
        if gain.max() <= enough:
            _warn_if_hidden(rounding, worth, mdp.discount)
            break
        if iterations == max_iterations:
            warn_unfinished("policy_iteration", iterations, gain.max(), enough)
            break
        policy = np.where(gain > enough, gains.argmax(axis=1), policy)
    return Solution(
        values, policy, iterations, float(gain.max()), *stacked(history, chosen)
    )


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
    start : values (S,) to start from; if not given, some that every policy improves on. Without discount what the
        greedy policy for them earns.
    max_iterations : improvements after which to give up.
    record : keep ``history`` (iterations + 1, S) and the greedy policy of each of its rows.

    Warns
    -----
    ConvergenceWarning : if ``max_iterations`` improvements did not suffice; says how far the values still moved.
    """
    from . import _fast

    check_instance("mdp", mdp, FiniteMDP)
    enough = mdp.residual_for(tolerance) * (1 if mdp.discount == 1 else 2)
    check_integer("sweeps", sweeps, at_least=0)
    values = _values_below(mdp) if start is None else first_values(mdp, start)
    updated, policy = np.empty_like(values), np.empty(mdp.n_states, dtype=np.intp)
    history, chosen = ([values.copy()], []) if record else ([], [])
    for iterations in range(
        1, check_integer("max_iterations", max_iterations, at_least=1) + 1
    ):
        least, most = _fast.optimal_sweep(*mdp.arrays, values, updated, policy)
        values, updated = updated, values
        distance = most - least if mdp.discount < 1 else max(-least, most)
        if record:
            chosen.append(policy.copy())
        if distance <= enough:
            values = _centred(mdp, values, least, most)
        else:
            for _ in range(sweeps):
                _fast.policy_sweep(*mdp.arrays, values, updated, policy)
                values, updated = updated, values
        if record:
            history.append(values.copy())
        if distance <= enough:
            break
        if iterations == max_iterations:
            warn_unfinished("modified_policy_iteration", iterations, distance, enough)
    policy = greedy_policy(mdp, values, tolerance)
    return Solution(
        values, policy, iterations, distance, *stacked(history, [*chosen, policy])
    )


def first_values(
    mdp: FiniteMDP, start: ArrayLike | None, *, name: str = "start"
) -> NDArray[np.float64]:
    """Values (S,) for sweeps to start from: those given under ``name``, or zeros.

    Without discount sweeps may come to rest on values that nobody earns, where waiting costs nothing and so keeps what
    it was told. From below they cannot. So they start from what a policy earns that is sure to end, greedy for
    those given where that leads to an end, or from the 0 of one who rests where that is more.
    """
    values = starting_values(name, mdp, start)
    if mdp.discount < 1:
        return values
    _, out = mdp.way_to(mdp.terminal)
    steps, onwards = mdp.way_to(
        mdp.terminal, policies.greedy_actions(mdp.action_values(values))
    )
    earned = solve_chain(
        *mdp.induced_chain(np.where(np.isfinite(steps), onwards, out)), 1, values
    )
    return np.where(mdp.rests.any(axis=1), np.maximum(earned, 0), earned)


def greedy_policy(
    mdp: FiniteMDP, values: NDArray[np.float64], tolerance: float
) -> NDArray[np.intp]:
    """The greedy policy (S,) for optimal values known to within ``tolerance``.

    Without discount an action that waits for ever can be as greedy as the one that goes (and is worth nothing): of the
    greedy actions take one that comes closer to an end, or, where 0 is the best, to a place to rest.
    """
    if mdp.discount < 1:
        return mdp.greedy(values)
    q = or_rest(mdp, mdp.action_values(values))
    best = policies.greedy_actions(q, tolerance=tolerance)
    steps, onwards = mdp.way_to(mdp.terminal, best)
    ends = np.isfinite(steps)
    rests = mdp.rests.any(axis=1) & (values <= tolerance) & ~ends
    steps, towards = mdp.way_to(ends | rests, best)
    return np.select(
        [ends, rests, np.isfinite(steps)],
        [onwards, mdp.rests.argmax(axis=1), towards],
        default=q.argmax(axis=1),
    )


def stacked(
    history: list[NDArray], chosen: list[NDArray]
) -> tuple[NDArray | None, NDArray | None]:
    """Recorded values and policies, each (steps, S); nothing where nothing was recorded."""
    return (np.stack(history), np.stack(chosen)) if history else (None, None)


def _first_policy(mdp: FiniteMDP) -> NDArray[np.intp]:
    """A policy to start from: the way to an end where there is one (a proper policy), else the best reward at once."""
    steps, out = mdp.way_to(mdp.terminal)
    return np.where(np.isfinite(steps), out, mdp.rewards.argmax(axis=1))


def _values_below(mdp: FiniteMDP) -> NDArray[np.float64]:
    """Values (S,) that no sweep lowers, so that modified policy iteration climbs from them steadily."""
    if mdp.discount == 1:
        return first_values(mdp, None)
    return np.where(mdp.terminal, 0, min(mdp.rewards.min(), 0) / (1 - mdp.discount))


def _centred(
    mdp: FiniteMDP, values: NDArray[np.float64], least: float, most: float
) -> NDArray[np.float64]:
    """The middle of the bounds on the optimal values that a sweep with changes from ``least`` to ``most`` leaves."""
    if mdp.discount == 1:
        return values
    return np.where(
        mdp.terminal, 0, values + mdp.discount / (1 - mdp.discount) * (least + most) / 2
    )


def _gains(
    mdp: FiniteMDP, policy: NDArray[np.intp], values: NDArray[np.float64], worth: float
) -> tuple[NDArray[np.float64], float]:
    """What each action (S, A) gains over the policy, whose ``values`` are given, and how much of it may be rounding.

    If rounding may hide gains larger than ``worth``, and no larger ones are to be seen, look closer: what all values
    share cancels in a gain, and near discount 1 that is nearly all of them.
    """
    state = np.arange(mdp.n_states)
    q = mdp.action_values(values)
    own = q[state, policy]
    gains, rounding = (
        or_rest(mdp, q) - own[:, None],
        rounding_of_gains(mdp, values, own),
    )
    if mdp.discount == 1 or rounding <= worth or gains.max() > rounding:
        return gains, rounding
    differences, step = solve_differences(
        *mdp.induced_chain(policy), mdp.discount, values
    )
    q, moved = mdp.action_values(differences), mdp.action_values(step) - mdp.rewards
    size = abs(differences).max() + abs(mdp.rewards).max()
    rounding = (
        2 * abs(moved - moved[state, policy][:, None]).max()
        + 4 * np.finfo(float).eps * size
    )
    return q - q[state, policy][:, None], rounding


def rounding_of_gains(
    mdp: FiniteMDP, values: NDArray[np.float64], own: NDArray[np.float64]
) -> float:
    """How much of a gain the error of a policy's ``values`` (S,) can explain at most, given their backup ``own``."""
    rounding = np.finfo(float).eps * abs(values).max()
    error = max(abs(own - values).max(), rounding) * (
        mdp.n_states if mdp.discount == 1 else 1 / (1 - mdp.discount)
    )
    return max(2 * mdp.discount * error, 2 * rounding)


def _warn_if_hidden(rounding: float, worth: float, discount: float) -> None:
    """ConvergenceWarning at the caller's caller if gains hide in rounding that are worth more than was accepted."""
    if discount < 1 and rounding > worth:
        warnings.warn(
            f"policy_iteration cannot tell gains below {rounding:.3g} from rounding: its policy may lose "
            f"{rounding / (1 - discount):.3g}, where {worth / (1 - discount):.3g} was asked for",
            ConvergenceWarning,
            stacklevel=3,
        )
