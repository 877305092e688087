"""Value functions and Bellman operators: one equation of section 2.2.1 each."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array, check_instance, check_real

from .evaluation import policy_evaluation
from .models import FiniteMDP


def bellman_policy_operator(
    mdp: FiniteMDP, policy: ArrayLike, values: ArrayLike
) -> NDArray[np.float64]:
    """One evaluation sweep: r_pi + gamma T_pi V, (S,), the right-hand side of Eq. (2.6) and (2.14)."""
    check_instance("mdp", mdp, FiniteMDP)
    transitions, rewards = mdp.induced_chain(policy)
    return rewards + mdp.discount * (
        transitions @ check_array("values", values, shape=(mdp.n_states,))
    )


def bellman_optimality_operator(
    mdp: FiniteMDP, values: ArrayLike
) -> NDArray[np.float64]:
    """One sweep of value iteration: max_a of the backup of ``values``, (S,).

    This is Eq. (2.26). Eq. (2.13), which misses gamma and the expectation over s', means its fixed point.
    """
    check_instance("mdp", mdp, FiniteMDP)
    return mdp.action_values(values).max(axis=1)


def bellman_action_value_operator(
    mdp: FiniteMDP, action_values: ArrayLike
) -> NDArray[np.float64]:
    """One sweep of value iteration on action values: r(s, a) + gamma sum_s' T(s, a, s') max_b Q(s', b), (S, A).

    This is the right-hand side of Eq. (2.12), whose fixed point is Q*. Q-learning takes one sample of it at a time.
    """
    check_instance("mdp", mdp, FiniteMDP)
    q = check_array("action_values", action_values, shape=(mdp.n_states, mdp.n_actions))
    return mdp.action_values(q.max(axis=1))


def policy_action_values(mdp: FiniteMDP, policy: ArrayLike) -> NDArray[np.float64]:
    """Q of a policy, (S, A): take a, then follow the policy, Eq. (2.7) and (2.15)."""
    check_instance("mdp", mdp, FiniteMDP)
    return mdp.action_values(policy_evaluation(mdp, policy))


def advantage(mdp: FiniteMDP, policy: ArrayLike) -> NDArray[np.float64]:
    """How much better than the policy it is to take a once, then follow it: Q - V, (S, A), Eq. (2.8)."""
    check_instance("mdp", mdp, FiniteMDP)
    values = policy_evaluation(mdp, policy)
    return mdp.action_values(values) - values[:, None]


def is_optimal(mdp: FiniteMDP, policy: ArrayLike, *, tolerance: float = 1e-9) -> bool:
    """Whether no action has an advantage over the policy of more than ``tolerance`` (Theorem 2.2, Eq. (2.16)).

    Without discount also that no state is worth less than to rest there for ever, where one can: see ``or_rest``.
    """
    check_instance("mdp", mdp, FiniteMDP)
    check_real("tolerance", tolerance, at_least=0)
    values = policy_evaluation(mdp, policy)
    return bool(
        (or_rest(mdp, mdp.action_values(values)).max(axis=1) - values).max()
        <= tolerance
    )


def or_rest(mdp: FiniteMDP, q: NDArray[np.float64]) -> NDArray[np.float64]:
    """Action values (S, A), but without discount at least 0 where an action lets one rest for ever (``mdp.rests``).

    With discount the backup knows as much by itself. Without, it takes a state of value -1 in which waiting is free
    for settled: waiting keeps the -1 that comes, and never is the 0 of one who waits for ever.
    """
    return q if mdp.discount < 1 else np.where(mdp.rests, np.maximum(q, 0), q)
