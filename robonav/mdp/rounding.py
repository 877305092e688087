"""Gains of an action that floating-point numbers can tell from rounding errors."""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import NDArray

from robonav.errors import ConvergenceWarning

from .linear_solver import solve_differences
from .models import FiniteMDP
from .undiscounted import clamp_undiscounted

Floats = NDArray[np.float64]


def gains_and_rounding(
    mdp: FiniteMDP, policy: NDArray[np.intp], values: Floats, smallest: float
) -> tuple[Floats, float]:
    """Advantages (S, A) of all actions over a policy with these ``values``, and the rounding error they may hold.

    If rounding may hide advantages above ``smallest`` and no larger ones are in sight, they are computed again from
    differences of values: the part that all states share cancels in an advantage, and near discount 1 that is nearly
    everything.
    """
    state = np.arange(mdp.n_states)
    q = mdp.action_values(values)
    own = q[state, policy]
    gains = clamp_undiscounted(mdp, q) - own[:, None]
    rounding = rounding_of_gains(mdp, values, own)
    if mdp.discount == 1 or rounding <= smallest or gains.max() > rounding:
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


def warn_if_hidden(rounding: float, smallest: float, discount: float) -> None:
    """Warn if rounding may hide gains that are worth more than the accepted loss."""
    if discount < 1 and rounding > smallest:
        warnings.warn(
            f"policy_iteration cannot tell gains below {rounding:.3g} from rounding: its policy may lose "
            f"{rounding / (1 - discount):.3g}, where {smallest / (1 - discount):.3g} was asked for",
            ConvergenceWarning,
            stacklevel=4,
        )
