"""Value functions and Bellman operators of section 2.2.1: one function an equation."""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arguments import checked
from .evaluation import policy_evaluation
from .models import FiniteMDP
from .policies import optimal_values_of
from .undiscounted import clamp_undiscounted

Floats = NDArray[np.float64]


@checked
def bellman_policy_operator(
    mdp: FiniteMDP, policy: ArrayLike, values: ArrayLike
) -> Floats:
    """Right-hand side of Bellman's equation for a policy, Eq. (2.14); the policy's values are its fixed point.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    policy : (S,) array of ints or (S, A) array of probabilities
    values : (S,) array

    Returns
    -------
    (S,) array

    Examples
    --------
    >>> from robonav.mdp import bellman_policy_operator, four_by_three, policy_evaluation
    >>> mdp = four_by_three().mdp(discount=0.95)
    >>> values = policy_evaluation(mdp, [0] * 11)
    >>> bool(np.allclose(bellman_policy_operator(mdp, [0] * 11, values), values))
    True
    """
    transitions, rewards = mdp.induced_chain(policy)
    return rewards + mdp.discount * (transitions @ values)  # Eq. (2.14)


@checked
def bellman_optimality_operator(mdp: FiniteMDP, values: ArrayLike) -> Floats:
    """Right-hand side of Bellman's optimality equation, Eq. (2.13); the optimal values are its fixed point.

    The thesis prints Eq. (2.13) without the discount and without the mean over s'; this is what it means.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    values : (S,) array

    Returns
    -------
    (S,) array

    Examples
    --------
    >>> from robonav.mdp import bellman_optimality_operator, four_by_three
    >>> bellman_optimality_operator(four_by_three().mdp(discount=0.95), np.zeros(11)).round(2)
    array([-0.04, -0.04,  0.76,  0.  , -0.04, -0.04,  0.  , -0.04, -0.04,
           -0.04, -0.04])
    """
    return mdp.action_values(values).max(axis=1)  # Eq. (2.13)


@checked
def bellman_action_value_operator(mdp: FiniteMDP, action_values: ArrayLike) -> Floats:
    """Right-hand side of Bellman's optimality equation for action values, Eq. (2.12).

    Its fixed point is Q*. Q-learning applies it to one sampled transition at a time.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    action_values : (S, A) array

    Returns
    -------
    (S, A) array

    Examples
    --------
    >>> from robonav.mdp import FiniteMDP, bellman_action_value_operator
    >>> mdp = FiniteMDP([[[1.0]], [[1.0]]], [[1.0, 0.0]], discount=0.5)
    >>> bellman_action_value_operator(mdp, [[2.0, 1.0]])
    array([[2., 1.]])
    """
    best_next = np.max(action_values, axis=1)  # max over b of Q(s', b)
    return mdp.action_values(best_next)  # Eq. (2.12)


@checked
def policy_action_values(mdp: FiniteMDP, policy: ArrayLike) -> Floats:
    """Action values of a policy, Eq. (2.7): the return of taking ``a`` once and then following the policy.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    policy : (S,) array of ints or (S, A) array of probabilities

    Returns
    -------
    (S, A) array

    Examples
    --------
    >>> from robonav.mdp import FiniteMDP, policy_action_values
    >>> mdp = FiniteMDP([[[1.0]], [[1.0]]], [[1.0, 0.0]], discount=0.5)
    >>> policy_action_values(mdp, [0])
    array([[2., 1.]])
    """
    return mdp.action_values(policy_evaluation(mdp, policy))  # Eq. (2.7)


@checked
def advantage(mdp: FiniteMDP, policy: ArrayLike) -> Floats:
    """Advantage of each action over a policy, Eq. (2.8): A = Q - V.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    policy : (S,) array of ints or (S, A) array of probabilities

    Returns
    -------
    (S, A) array

    Examples
    --------
    >>> from robonav.mdp import FiniteMDP, advantage
    >>> mdp = FiniteMDP([[[1.0]], [[1.0]]], [[1.0, 0.0]], discount=0.5)
    >>> advantage(mdp, [1])
    array([[1., 0.]])
    """
    values = policy_evaluation(mdp, policy)
    return mdp.action_values(values) - values[:, None]  # Eq. (2.8)


@checked
def best_values_of_any_policy(mdp: FiniteMDP) -> Floats:
    """Largest value of each state under any deterministic policy, Eq. (2.9), by trying all A^S of them.

    Only for models of a few states: it defines V*, which planners find without looking at every policy.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions; every policy must have finite values.

    Returns
    -------
    (S,) array

    Examples
    --------
    >>> from robonav.mdp import FiniteMDP, best_values_of_any_policy
    >>> stay_or_leave = [[[0.5, 0.5], [0, 1]], [[0, 1], [0, 1]]]
    >>> mdp = FiniteMDP(stay_or_leave, [[5, 10], [-1, -1]], discount=0.95)
    >>> best_values_of_any_policy(mdp).round(2)
    array([ -8.57, -20.  ])
    """
    policies = product(range(mdp.n_actions), repeat=mdp.n_states)
    values = [policy_evaluation(mdp, list(policy)) for policy in policies]
    return np.max(values, axis=0)  # Eq. (2.9)


@checked
def is_optimal(mdp: FiniteMDP, policy: ArrayLike, *, tolerance: float = 1e-9) -> bool:
    """Whether a policy takes a best action under its own action values in every state, Eq. (2.16).

    By Theorem 2.2 it is then optimal. Without discount, no state may have a value below 0 where the agent can stay
    forever in zero-reward states.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    policy : (S,) array of ints or (S, A) array of probabilities
    tolerance : float
        Largest advantage that still counts as none; not negative.

    Returns
    -------
    bool

    Examples
    --------
    >>> from robonav.mdp import four_by_three, is_optimal, value_iteration
    >>> mdp = four_by_three().mdp(discount=0.95)
    >>> is_optimal(mdp, value_iteration(mdp).policy), is_optimal(mdp, [0] * 11)
    (True, False)
    """
    values = policy_evaluation(mdp, policy)
    q = clamp_undiscounted(mdp, mdp.action_values(values))
    loss = optimal_values_of(q) - values
    return bool(loss.max() <= tolerance)  # Eq. (2.16)
