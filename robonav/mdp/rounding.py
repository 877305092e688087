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
    """Gain Q(s, a) - V(s) of each action (S, A), and the gain above which an action is strictly better.

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
