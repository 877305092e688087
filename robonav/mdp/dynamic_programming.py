"""Planning with a known model: value iteration, policy iteration, and modified policy iteration (section 2.3).

A Markov decision process has states s, actions a, probabilities T(s, a, s') of the next state, rewards r(s, a) and a
discount gamma. The action values of values V are

    Q(s, a) = r(s, a) + gamma * sum over s' of T(s, a, s') V(s').                 (2.15)

The optimal values solve Bellman's optimality equation, and the values of a policy pi solve a linear one:

    V*(s)   = max over a of Q*(s, a)
    V_pi(s) = Q_pi(s, pi(s)),      in matrices  V_pi = r_pi + gamma T_pi V_pi.

- Value iteration (Algorithm 2) replaces V by the maximum of its action values, again and again. With
  gamma < 1 each sweep brings V closer to V*, by the factor gamma or more. The change in the last sweep therefore bounds
  the distance to V*.
- Policy iteration (Algorithm 1) solves the linear equation for its policy, and then takes the best action of every
  state. It repeats both until no action changes.
- Modified policy iteration only approaches the solution of the linear equation, by a few sweeps.

In the code ``values`` are an array (S,), a ``policy`` is an array (S,) of actions, and ``q`` and the rewards are arrays
(S, A). ``mdp.expected_next_values(values)`` are the sums over s'. The numbers in the comments are the steps of the
thesis's algorithms. What stands around an algorithm, such as the checks of its arguments and its compiled twin, is the
work of the decorator :func:`robonav.mdp.planner.planner`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .evaluation import evaluation_residual, least_gain, policy_evaluation
from .models import FiniteMDP
from .planner import planner
from .rounding import improve
from .solutions import (
    Solution,
    first_policy,
    first_values,
    first_values_below,
    greedy_policy,
)

Floats = NDArray[np.float64]
Actions = NDArray[np.intp]


@planner(start=first_values, limit=FiniteMDP.residual_for, twin="_fast_planners")
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
    epsilon = mdp.residual_for(tolerance)
    values = np.asarray(start)  # 1 and 2
    for iteration in range(1, max_iterations + 1):  # 3: repeat
        previous = values
        q = mdp.rewards + mdp.discount * mdp.expected_next_values(previous)
        values = q.max(axis=1)  # 4 and 5  Eq. (2.26)
        residual = abs(values - previous).max()
        if residual <= epsilon:  # 6
            break
    policy = greedy_policy(mdp, values, tolerance)  # 7  Eq. (2.25)
    return Solution(values, policy, iteration, residual, residual <= epsilon)


@planner(start=first_policy, limit=least_gain, twin="_recorded_planners")
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
        if rounding near discount 1 hides gains that may add up to more than the tolerance.

    Examples
    --------
    >>> from robonav.mdp import four_by_three, policy_iteration
    >>> solution = policy_iteration(four_by_three().mdp(discount=0.95))
    >>> solution.iterations, solution.policy
    (3, array([1, 1, 1, 0, 0, 0, 0, 0, 3, 0, 3]))
    """
    policy = np.asarray(start)  # 1 and 2
    values = np.zeros(mdp.n_states)  # 3
    for iteration in range(1, max_iterations + 1):  # 4: repeat
        # 5 to 8: the values of the policy, the solution of V = r_pi + discount * T_pi V
        values = policy_evaluation(mdp, policy, guess=values)
        # 9: its greedy policy, Eq. (2.25): the argmax of q where that gains something
        q = mdp.rewards + mdp.discount * mdp.expected_next_values(values)
        improved, gain = improve(mdp, policy, values, q, tolerance)
        previous, policy = policy, improved  # 10
        converged = np.array_equal(policy, previous)
        if converged:  # 11
            break
    return Solution(values, policy, iteration, gain, converged)


@planner(start=first_values_below, limit=evaluation_residual, twin="_fast_planners")
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
    epsilon = evaluation_residual(mdp, tolerance)
    values = np.asarray(start)
    for iteration in range(1, max_iterations + 1):
        q = mdp.rewards + mdp.discount * mdp.expected_next_values(values)
        change = q.max(axis=1) - values
        policy, values = q.argmax(axis=1), q.max(axis=1)  # improve  Eqs. (2.25), (2.26)
        spread = change.max() - change.min() if mdp.discount < 1 else abs(change).max()
        if spread <= epsilon:
            break
        transitions, rewards = mdp.induced_chain(policy)  # T_pi (S, S) and r_pi (S,)
        for _ in range(sweeps):  # evaluate  Eq. (2.24)
            values = rewards + mdp.discount * (transitions @ values)
    policy = greedy_policy(mdp, values, tolerance)
    converged = spread <= epsilon
    if converged and mdp.discount < 1:  # the middle of the bounds on the optimal values
        missing = mdp.discount / (1 - mdp.discount) * (change.min() + change.max()) / 2
        values = np.where(mdp.terminal, 0, values + missing)
    return Solution(values, policy, iteration, spread, converged)
