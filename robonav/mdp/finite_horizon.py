"""Finite horizon: so many steps to go, planned backward from the last (Eq. (2.27))."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_instance, check_integer

from .evaluation import starting_values
from .models import FiniteMDP


@dataclass(frozen=True)
class FiniteHorizonSolution:
    """The best that can be done in the next H steps.

    Attributes
    ----------
    values : (H + 1, S); ``values[t]`` with t steps done and H - t to go, ``values[H]`` the final ones.
    policy : (H, S); ``policy[t]`` is the best action with t steps done.
    """

    values: NDArray[np.float64]
    policy: NDArray[np.intp]


def backward_induction(
    mdp: FiniteMDP, horizon: int, *, final_values: ArrayLike | None = None
) -> FiniteHorizonSolution:
    """Optimal values and policy for each of the next ``horizon`` steps: the return J of Eq. (2.27), discounted.

    Parameters
    ----------
    horizon : number of steps H, at least 0.
    final_values : (S,), what it is worth to stand in each state at the end; zeros if not given.
    """
    check_instance("mdp", mdp, FiniteMDP)
    steps = check_integer("horizon", horizon, at_least=0)
    values = np.empty((steps + 1, mdp.n_states))
    policy = np.empty((steps, mdp.n_states), dtype=np.intp)
    values[steps] = starting_values("final_values", mdp, final_values)
    for t in reversed(range(steps)):
        q = mdp.action_values(values[t + 1])
        values[t], policy[t] = q.max(axis=1), q.argmax(axis=1)
    return FiniteHorizonSolution(values, policy)


def finite_horizon_evaluation(
    mdp: FiniteMDP,
    policy: ArrayLike,
    horizon: int,
    *,
    final_values: ArrayLike | None = None,
) -> NDArray[np.float64]:
    """Expected return (S,) of the next ``horizon`` steps under one policy, (S,) actions or (S, A) probabilities."""
    check_instance("mdp", mdp, FiniteMDP)
    transitions, rewards = mdp.induced_chain(policy)
    values = starting_values("final_values", mdp, final_values)
    for _ in range(check_integer("horizon", horizon, at_least=0)):
        values = rewards + mdp.discount * (transitions @ values)
    return values
