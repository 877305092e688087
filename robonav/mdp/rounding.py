"""The gain of each action over a policy, and the rounding error that it may hold."""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import NDArray

from robonav.errors import ConvergenceWarning

from .evaluation import least_gain
from .linear_solver import solve_differences
from .models import FiniteMDP
from .undiscounted import clamp_undiscounted

Floats = NDArray[np.float64]
Actions = NDArray[np.intp]


def gains_and_limit(
    mdp: FiniteMDP, policy: Actions, values: Floats, q: Floats, tolerance: float
) -> tuple[Floats, float]:
    """The gain Q(s, a) - V(s) of each action (S, A), and the limit above which a gain makes an action strictly better.

    Warns if no action is strictly better, but rounding may hide gains that add up to more than the tolerance.
    """
    matters = least_gain(mdp, tolerance)
    gains, rounding = gains_and_rounding(mdp, policy, values, q, matters)
    limit = max(matters, rounding)
    if gains.max() <= limit:
        warn_if_hidden(rounding, matters, mdp.discount)
    return gains, limit


def gains_and_rounding(
    mdp: FiniteMDP, policy: Actions, values: Floats, q: Floats, matters: float
) -> tuple[Floats, float]:
    """Gain Q(s, a) - V(s) of each action (S, A), and the largest rounding error that a gain may hold.

    Near discount 1 all values are large, and nearly all of a value is a part that all states share. It cancels in a
    gain, but its rounding error does not. So where rounding may hide a gain that matters, and no larger one is found,
    the gains are computed again from differences between values.
    """
    state = np.arange(mdp.n_states)
    own = q[state, policy]
    gains = clamp_undiscounted(mdp, q) - own[:, None]
    rounding = rounding_of_gains(mdp, values, own)
    if mdp.discount == 1 or rounding <= matters or gains.max() > rounding:
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


def rounding_of_gains(mdp: FiniteMDP, values: Floats, own: Floats) -> float:
    """Largest gain that the error of a policy's ``values`` (S,) can explain, given their backup ``own`` (S,)."""
    rounding = np.finfo(float).eps * abs(values).max()
    error = max(abs(own - values).max(), rounding) * (
        mdp.n_states if mdp.discount == 1 else 1 / (1 - mdp.discount)
    )
    return max(2 * mdp.discount * error, 2 * rounding)


def warn_if_hidden(rounding: float, matters: float, discount: float) -> None:
    """Warn if rounding may hide gains that add up to more than the accepted loss."""
    if discount < 1 and rounding > matters:
        warnings.warn(
            f"policy_iteration cannot tell gains below {rounding:.3g} from rounding: its policy may lose "
            f"{rounding / (1 - discount):.3g}, where {matters / (1 - discount):.3g} was asked for",
            ConvergenceWarning,
            stacklevel=7,
        )


def improve(
    mdp: FiniteMDP, policy: Actions, values: Floats, q: Floats, tolerance: float
) -> tuple[Actions, float]:
    """Greedy policy that changes an action only where another one is strictly better.

    With a plain ``q.argmax(axis=1)``, policy iteration may never end: where two actions tie, rounding may prefer one in
    one iteration and the other in the next. So the gain Q(s, a) - V(s) of a new action must exceed what rounding can
    explain, and also the least gain that matters, ``tolerance * (1 - discount)``.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    policy : (S,) array of ints
    values : (S,) array
        The values of the policy.
    q : (S, A) array
        The action values of the policy, computed from ``values``.
    tolerance : float
        Largest loss of value accepted, in units of reward.

    Returns
    -------
    improved : (S,) array of ints
        The best action of each state where it is strictly better, the action of ``policy`` elsewhere.
    gain : float
        The largest gain of any action.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.mdp import FiniteMDP, policy_evaluation
    >>> from robonav.mdp.rounding import improve
    >>> mdp = FiniteMDP([[[1.0]], [[1.0]]], [[0.0, 1.0]], discount=0.5)
    >>> policy = np.array([0])  # action 1 has the larger reward
    >>> values = policy_evaluation(mdp, policy)
    >>> improve(mdp, policy, values, mdp.action_values(values), tolerance=1e-9)
    (array([1]), 1.0)
    """
    gains, limit = gains_and_limit(mdp, policy, values, q, tolerance)  # Q(s, a) - V(s)
    best = gains.max(axis=1)
    improved = np.where(best > limit, gains.argmax(axis=1), policy)
    return improved, float(best.max())
