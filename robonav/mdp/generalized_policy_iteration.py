"""Generalized policy iteration, step by step (Fig. 2.4): evaluation and improvement take turns."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.counting import counted
from robonav.errors import ConvergenceWarning
from robonav.validation import check_array

from ._arguments import checked
from .evaluation import policy_evaluation
from .models import FiniteMDP
from .policies import as_deterministic_policy
from .rounding import rounding_of_gains
from .solutions import first_values
from .undiscounted import clamp_undiscounted

Floats = NDArray[np.float64]
Actions = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class GPIHistory:
    """Every half step of generalized policy iteration, n of them, from the start (row 0).

    Attributes
    ----------
    values : (n + 1, S) array
    policies : (n + 1, S) array of ints
    improves : (n,) array of bools
        Whether half step i, from row i to row i + 1, improved the policy; otherwise it evaluated.
    evaluation_gap : (n + 1,) array
        Largest change that one evaluation sweep would make to the values: 0 on the line V = V^pi of Fig. 2.4(b).
    greedy_gap : (n + 1,) array
        Largest gain that another action than the policy's promises: 0 on the line pi = greedy(V).

    Examples
    --------
    >>> from robonav.mdp import four_by_three, generalized_policy_iteration
    >>> history = generalized_policy_iteration(four_by_three().mdp(discount=0.9), sweeps=5)
    >>> len(history.values) - len(history.improves)
    1
    """

    values: Floats
    policies: Actions
    improves: NDArray[np.bool_]
    evaluation_gap: Floats
    greedy_gap: Floats


@checked
def generalized_policy_iteration(
    mdp: FiniteMDP,
    *,
    sweeps: float = 1,
    tolerance: float = 1e-6,
    start_values: ArrayLike | None = None,
    start_policy: ArrayLike | None = None,
    max_rounds: int = 10_000,
) -> GPIHistory:
    """Generalized policy iteration with a record: evaluate by some sweeps, improve, and repeat until both agree.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    sweeps : int or math.inf
        Evaluation sweeps in each round: 1 is value iteration, ``math.inf`` (exact evaluation) policy iteration.
    tolerance : float
        Largest loss of value accepted, in units of reward. Losses that rounding can explain are accepted too.
    start_values : (S,) array, optional
        Values to start from; zeros by default, without discount as in :func:`~robonav.mdp.value_iteration`.
    start_policy : (S,) array of ints, optional
        Policy to start from; action 0 everywhere by default.
    max_rounds : int
        Number of evaluations after which to give up.

    Returns
    -------
    GPIHistory

    Warns
    -----
    ConvergenceWarning
        If ``max_rounds`` were not enough; the message says how far the values and how many actions still moved.

    Examples
    --------
    >>> import math
    >>> from robonav.mdp import four_by_three, generalized_policy_iteration
    >>> mdp = four_by_three().mdp(discount=0.9)
    >>> history = generalized_policy_iteration(mdp, sweeps=math.inf)
    >>> history.policies[-1]
    array([1, 1, 1, 0, 0, 0, 0, 0, 1, 0, 3])
    """
    values = first_values(mdp, start_values, name="start_values")
    policy = first_or_given(mdp, start_policy)
    epsilon, state = mdp.residual_for(tolerance), np.arange(mdp.n_states)
    rows = [(values, policy, False)]
    for rounds in range(1, max_rounds + 1):
        if sweeps == math.inf:  # evaluate the policy exactly
            values = policy_evaluation(mdp, policy)
        else:  # or move the values towards those of the policy, Eq. (2.24)
            for _ in range(int(sweeps)):
                values = one_step_action_values(mdp, values)[state, policy]
        rows.append((values, policy, False))
        q = one_step_action_values(mdp, values)
        rounding = largest_rounding(mdp, policy, values, exact=sweeps == math.inf)
        greedy = keep_ties(mdp, policy, values, q, rounding)  # improve, Eq. (2.25)
        rows.append((values, greedy, True))
        residual = abs(q.max(axis=1) - values).max()
        changed = int((greedy != policy).sum())
        policy = greedy
        if residual <= max(epsilon, rounding) and changed == 0:
            break
    else:
        _warn_not_converged(rounds, residual, epsilon, changed)
    return history_of(mdp, rows)


def one_step_action_values(mdp: FiniteMDP, values: Floats) -> Floats:
    """Action values (S, A) one step ahead; without discount at least 0 for staying in zero-reward states.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.mdp import FiniteMDP
    >>> from robonav.mdp.generalized_policy_iteration import one_step_action_values
    >>> mdp = FiniteMDP([[[1.0]], [[1.0]]], [[0.0, 1.0]], discount=0.5)
    >>> one_step_action_values(mdp, np.array([2.0]))
    array([[1., 2.]])
    """
    q = mdp.rewards + mdp.discount * mdp.expected_next_values(values)
    return clamp_undiscounted(mdp, q)


def largest_rounding(
    mdp: FiniteMDP, policy: Actions, values: Floats, *, exact: bool
) -> float:
    """Largest gain of an action that rounding can explain: more for exact values, since the equations amplify it."""
    if not exact:
        return 4 * np.finfo(float).eps * float(abs(values).max())
    own = mdp.action_values(values)[np.arange(mdp.n_states), policy]
    return rounding_of_gains(mdp, values, own)


def keep_ties(
    mdp: FiniteMDP, policy: Actions, values: Floats, q: Floats, rounding: float
) -> Actions:
    """The greedy policy that keeps an action as good as the best; otherwise ties could alternate forever."""
    own = mdp.action_values(values)[np.arange(mdp.n_states), policy]
    gain = q.max(axis=1) - own
    return np.where(gain <= rounding, policy, q.argmax(axis=1))


def first_or_given(mdp: FiniteMDP, policy: ArrayLike | None) -> Actions:
    """The policy (S,) to start from: action 0 everywhere unless given."""
    chosen = np.zeros(mdp.n_states, dtype=np.intp) if policy is None else policy
    return as_deterministic_policy("start_policy", chosen, mdp.n_states, mdp.n_actions)


def _warn_not_converged(
    rounds: int, residual: float, limit: float, changed: int
) -> None:
    """ConvergenceWarning at the line that called."""
    warnings.warn(
        f"generalized_policy_iteration gave up after {counted(rounds, 'round')}: the last one left a value to move by "
        f"{residual:.3g}, where {limit:.3g} was asked for, and changed {counted(changed, 'action')}",
        ConvergenceWarning,
        stacklevel=4,
    )


def history_of(mdp: FiniteMDP, rows: list[tuple[Floats, Actions, bool]]) -> GPIHistory:
    """The rows (values, policy, whether improved) as arrays, with their distances from the two lines of Fig. 2.4."""
    state = np.arange(mdp.n_states)
    gaps = []
    for values, policy, _ in rows:
        q = mdp.action_values(values)
        backed_up = q[state, policy]
        gaps.append((abs(backed_up - values).max(), (q.max(axis=1) - backed_up).max()))
    values, policies, improves = (
        np.stack(column) for column in zip(*rows, strict=True)
    )
    evaluation_gap, greedy_gap = np.array(gaps).T
    return GPIHistory(values, policies, improves[1:], evaluation_gap, greedy_gap)


@checked
def suboptimality(
    mdp: FiniteMDP, history: ArrayLike, policies: ArrayLike, *, best: ArrayLike
) -> tuple[Floats, Floats]:
    """Distance of each row of a history from the optimum.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    history : (n, S) array
        Values, such as a recorded ``Solution.history``.
    policies : (n, S) array of ints
        The policies that go with them.
    best : (S,) array
        The optimal values.

    Returns
    -------
    errors : (n,) array
        Largest error of a value.
    losses : (n,) array
        Largest loss of value under the policy, in any state.

    Examples
    --------
    >>> from robonav.mdp import FiniteMDP
    >>> from robonav.mdp.generalized_policy_iteration import suboptimality
    >>> mdp = FiniteMDP([[[1.0]], [[1.0]]], [[0.0, 1.0]], discount=0.5)
    >>> suboptimality(mdp, [[0.0], [2.0]], [[0], [1]], best=[2.0])
    (array([2., 0.]), array([2., 0.]))
    """
    optimum = check_array("best", best, shape=(mdp.n_states,))
    values = check_array("history", history, shape=("n", mdp.n_states))
    chosen = check_array("policies", policies, shape=values.shape, dtype=np.intp)
    losses = [(optimum - policy_evaluation(mdp, policy)).max() for policy in chosen]
    return abs(values - optimum).max(axis=1), np.array(losses)
