"""Planning with a known model: value iteration, policy iteration, and modified policy iteration (section 2.3).

A Markov decision process has states s, actions a, probabilities T(s, a, s') of the next state, rewards r(s, a) and a
discount gamma. The action values of values V are

    Q(s, a) = r(s, a) + gamma * sum over s' of T(s, a, s') V(s').                 (2.15)

The optimal values solve Bellman's optimality equation, and the values of a policy pi solve a linear one:

    V*(s)   = max over a of Q*(s, a)
    V_pi(s) = Q_pi(s, pi(s)),      in matrices  V_pi = r_pi + gamma T_pi V_pi.

- Value iteration (Algorithm 2) replaces V by the maximum of its action values, written B V, again and again. With
  gamma < 1 the backup B is a contraction: ||B V - V*|| <= gamma ||V - V*||, with ||.|| the largest absolute value of
  all states. All later sweeps together therefore change a value by at most gamma / (1 - gamma) times the last change.
- Policy iteration (Algorithm 1) solves the linear equation for its policy, and then takes the best action of every
  state. It repeats both until no action gains anything.
- Modified policy iteration only approaches the solution of the linear equation, by a few sweeps.

A model of one's own needs one matrix T[a][s, s'] for each action, and rewards r(s, a). Here an agent can stay where it
is or move to the other of two states, and staying in state 1 pays 1 a step. So V*(1) = 1 + 0.5 V*(1) = 2, and
V*(0) = 0.5 V*(1) = 1:

>>> from robonav.mdp import FiniteMDP, policy_iteration, value_iteration
>>> stay, move = [[1, 0], [0, 1]], [[0, 1], [1, 0]]
>>> mdp = FiniteMDP([stay, move], rewards=[[0, 0], [1, 0]], discount=0.5)

Policy iteration starts here with a poor policy: stay (0) in state 0, move (1) in state 1. Nothing is ever paid, so that
V = (0, 0). In state 1 staying gains 1 and is taken. Then V(1) = 2, and moving there gains 1 in state 0:

>>> solution = policy_iteration(mdp, start=[0, 1], record=True)
>>> for policy, values in zip(solution.policies, solution.history):
...     print(policy, values)
[0 1] [0. 0.]
[0 0] [0. 2.]
[1 0] [1. 2.]

Value iteration starts at V = (0, 0). From the first sweep on, each sweep halves the distance to V* = (1, 2):

>>> value_iteration(mdp, record=True).history[:4]
array([[0.  , 0.  ],
       [0.  , 1.  ],
       [0.5 , 1.5 ],
       [0.75, 1.75]])

In the code ``values`` are an array (S,), a ``policy`` is an array (S,) of actions, and ``q`` and the rewards are arrays
(S, A). The numbers in the comments are the steps of the thesis's algorithms. Each function is complete for a discount
below 1. The decorator :func:`robonav.mdp.planner.planner` checks the arguments and then runs a twin of the function,
which is faster, keeps the history if ``record`` is true, and also plans without discount (``undiscounted.py``).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from robonav.validation import ArrayArgument

from .evaluation import evaluation_residual, least_gain
from .models import FiniteMDP
from .planner import planner
from .solutions import (
    Solution,
    first_policy,
    first_values,
    first_values_below,
    greedy_actions,
    policy_to_start_from,
)

Floats = NDArray[np.float64]


@planner(start=first_values, limit=FiniteMDP.residual_for, twin="_fast_planners")
def value_iteration(
    mdp: FiniteMDP,
    tolerance: float = 1e-6,
    *,
    start: ArrayArgument | None = None,
    max_iterations: int = 100_000,
) -> Solution:
    """Value iteration, Algorithm 2, Eq. (2.26).

    Stops when a sweep changes no value by more than ``tolerance * (1 - discount) / (2 * discount)``. The values are
    then within half of ``tolerance`` of the optimal ones, and the greedy policy loses at most ``tolerance`` in every
    state (Puterman 2005, Theorem 6.3.1). Without discount there is no such bound, and ``tolerance`` itself is used.

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
    discount = mdp.discount
    values = np.zeros(mdp.n_states) if start is None else start  # 1 and 2
    for iteration in range(1, max_iterations + 1):  # 3: repeat
        previous = values
        # (S, A): the sum over s' of T(s, a, s') V(s'); one matrix (S, S) an action
        expected = np.stack([matrix @ previous for matrix in mdp.transitions], axis=1)
        q = mdp.rewards + discount * expected  # Eq. (2.15)
        values = q.max(axis=1)  # 4 and 5  Eq. (2.26)
        residual = abs(values - previous).max()
        # the most that the greedy policy can lose; without discount there is no bound
        loss = 2 * discount / (1 - discount) * residual if discount < 1 else residual
        if loss <= tolerance:  # 6
            break
    policy = greedy_actions(mdp, values, tolerance)  # 7: argmax of Q(s, a)  Eq. (2.25)
    return Solution(values, policy, iteration, residual, loss <= tolerance)


@planner(start=first_policy, limit=least_gain, twin="_recorded_planners")
def policy_iteration(
    mdp: FiniteMDP,
    tolerance: float = 1e-9,
    *,
    start: ArrayArgument | None = None,
    max_iterations: int = 1000,
) -> Solution:
    """Policy iteration, Algorithm 1, with each policy evaluated exactly.

    Actions are switched only if the gain exceeds ``tolerance * (1 - discount)`` and the floating-point error. Each
    switch is then a strict improvement, so the loop terminates even with ties. A gain of this size in each of 1 / (1 -
    discount) steps adds up to ``tolerance``. Without discount there is no bound on the loss, and only the
    floating-point error counts.

    The twin that runs does the same with three additions: it keeps sparse matrices sparse, it bounds the
    floating-point error from the residual of the equations (``rounding.py``), and it plans without discount.

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
        if rounding near discount 1 hides gains that may add up to more than the tolerance.

    Examples
    --------
    >>> from robonav.mdp import four_by_three, policy_iteration
    >>> solution = policy_iteration(four_by_three().mdp(discount=0.95))
    >>> solution.iterations, solution.policy
    (3, array([1, 1, 1, 0, 0, 0, 0, 0, 3, 0, 3]))
    """
    discount, states = mdp.discount, np.arange(mdp.n_states)
    transitions = np.stack([dense(matrix) for matrix in mdp.transitions])  # (A, S, S)
    policy = policy_to_start_from(mdp) if start is None else start  # 1 and 2
    for iteration in range(1, max_iterations + 1):  # 3 and 4: repeat
        # 5 to 8, evaluate: solve V = r_pi + gamma T_pi V  Eq. (2.5)
        of_policy = transitions[policy, states]  # T_pi (S, S): T(s, pi(s), .)
        rewards = mdp.rewards[states, policy]  # r_pi (S,): r(s, pi(s))
        values = np.linalg.solve(np.eye(len(states)) - discount * of_policy, rewards)

        # 9, improve: the best action of each state, where it gains something
        q = mdp.rewards + discount * (transitions @ values).T  # Q_pi  Eq. (2.15)
        gains = q - values[:, None]  # Q_pi(s, a) - V_pi(s)
        better = gains.max(axis=1) > gain_that_counts(mdp, values, tolerance)
        policy = np.where(better, q.argmax(axis=1), policy)  # 10  Eq. (2.25)
        converged = not better.any()
        if converged:  # 11: no action is better, so V_pi is optimal
            break
    return Solution(values, policy, iteration, gains.max(), converged)


def dense(matrix: Any) -> Floats:
    """Return a matrix of transitions, which may be sparse, as an array."""
    return matrix.toarray() if sp.issparse(matrix) else np.asarray(matrix)


def gain_that_counts(mdp: FiniteMDP, values: Floats, tolerance: float) -> float:
    """Return the least gain of an action that counts. Of two equal actions, rounding makes one look better by less."""
    rounding = 4 * np.spacing(abs(values).max()) / (1 - mdp.discount)
    return max(least_gain(mdp, tolerance), rounding)


@planner(start=first_values_below, limit=evaluation_residual, twin="_fast_planners")
def modified_policy_iteration(
    mdp: FiniteMDP,
    tolerance: float = 1e-6,
    *,
    sweeps: int = 8,
    start: ArrayArgument | None = None,
    max_iterations: int = 100_000,
) -> Solution:
    """Modified policy iteration: improve once, evaluate by a few sweeps, repeat.

    It lies between Algorithm 1 (policy iteration) and Algorithm 2 (value iteration).

    Each iteration improves the policy once and evaluates it by ``sweeps`` sweeps (0: value iteration; many: policy
    iteration). Stops when the changes of the improvement differ by at most ``tolerance * (1 - discount) / discount``
    between states. The greedy policy then loses at most ``tolerance`` (Puterman 2005, section 6.6). The optimal values
    lie between two bounds, with V after the improvement, of which the function returns the middle:

        V + gamma / (1 - gamma) * min change <= V* <= V + gamma / (1 - gamma) * max change.

    Without discount no value may change by more than ``tolerance``.

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
    discount = mdp.discount
    values = start
    if values is None:  # the least reward forever: no sweep lowers these values
        values = np.where(mdp.terminal, 0, min(mdp.rewards.min(), 0) / (1 - discount))
    for iteration in range(1, max_iterations + 1):
        q = mdp.rewards + discount * mdp.expected_next_values(values)
        change = q.max(axis=1) - values
        policy, values = q.argmax(axis=1), q.max(axis=1)  # improve  Eqs. (2.25), (2.26)
        spread = change.max() - change.min() if discount < 1 else abs(change).max()
        loss = discount / (1 - discount) * spread if discount < 1 else spread  # at most
        if loss <= tolerance:
            break
        transitions, rewards = mdp.induced_chain(policy)  # T_pi (S, S) and r_pi (S,)
        for _ in range(sweeps):  # evaluate  Eq. (2.24)
            values = rewards + discount * (transitions @ values)
    policy = greedy_actions(mdp, values, tolerance)
    converged = loss <= tolerance
    if converged and discount < 1:  # V* - V lies between two bounds: take their middle
        missing = discount / (1 - discount) * (change.min() + change.max()) / 2
        values = np.where(mdp.terminal, 0, values + missing)
    return Solution(values, policy, iteration, spread, converged)
