"""What a policy is worth: the linear equations (2.14), solved at once or sweep by sweep."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csgraph, linalg

from robonav.errors import ConvergenceWarning
from robonav.validation import (
    check_array,
    check_instance,
    check_integer,
    check_positive,
)

from .models import FiniteMDP, packed

DIRECT_SOLVE = (
    1000  # up to so many equations elimination is quick whatever their pattern
)


@dataclass(frozen=True)
class EvaluationResult:
    """Values of a policy, found sweep by sweep: ``history`` (iterations + 1, S) if recorded."""

    values: NDArray[np.float64]
    iterations: int
    residual: float
    history: NDArray[np.float64] | None = None


def policy_evaluation(mdp: FiniteMDP, policy: ArrayLike) -> NDArray[np.float64]:
    """The values (S,) of a policy, exact to rounding: the solution of V = r_pi + gamma T_pi V (Eqs. (2.6), (2.14)).

    These are its expected returns, Eq. (2.4); Eq. (2.5) takes the first step out of them, and leaves linear equations.

    Parameters
    ----------
    mdp : finite MDP with S states and A actions.
    policy : (S,) actions or (S, A) probabilities.

    Raises
    ------
    ValueError : if, without discount, the policy collects rewards for ever, so that its value is not finite.
    """
    check_instance("mdp", mdp, FiniteMDP)
    return solve_chain(*mdp.induced_chain(policy), mdp.discount, np.zeros(mdp.n_states))


def iterative_policy_evaluation(
    mdp: FiniteMDP,
    policy: ArrayLike,
    *,
    tolerance: float = 1e-6,
    start: ArrayLike | None = None,
    max_iterations: int = 100_000,
    record: bool = False,
) -> EvaluationResult:
    """The values of a policy by repeated sweeps (Eq. (2.24), steps 5 to 8 of Algorithm 1).

    Stops when a sweep changes no value by more than ``tolerance * (1 - discount) / discount``: every value is then
    within ``tolerance`` of the policy's. Without discount there is no such bound; ``tolerance`` itself is taken.

    Parameters
    ----------
    start : values (S,) to start from; zeros if not given.
    max_iterations : sweeps after which to give up.
    record : keep the values of every sweep.

    Warns
    -----
    ConvergenceWarning : if ``max_iterations`` sweeps did not suffice; says how far the values still moved.
    """
    check_instance("mdp", mdp, FiniteMDP)
    from . import _fast

    check_positive("tolerance", tolerance)
    enough = tolerance if mdp.discount == 1 else 2 * mdp.residual_for(tolerance)
    transitions, rewards = mdp.induced_chain(policy)
    chain = packed(
        transitions, rewards[:, None], mdp.discount
    )  # an MDP with one action
    values = starting_values("start", mdp, start)
    updated, only_action = np.empty_like(values), np.zeros(mdp.n_states, dtype=np.intp)
    history = [values.copy()] if record else []
    for iterations in range(
        1, check_integer("max_iterations", max_iterations, at_least=1) + 1
    ):
        distance = _fast.policy_sweep(*chain, values, updated, only_action)
        values, updated = updated, values
        if record:
            history.append(values.copy())
        if distance <= enough:
            break
        if iterations == max_iterations:
            warn_unfinished("iterative_policy_evaluation", iterations, distance, enough)
    return EvaluationResult(
        values, iterations, distance, np.stack(history) if record else None
    )


def starting_values(
    name: str, mdp: FiniteMDP, given: ArrayLike | None
) -> NDArray[np.float64]:
    """A fresh copy of the values to start from, zeros unless given."""
    return (
        np.zeros(mdp.n_states)
        if given is None
        else check_array(name, given, shape=(mdp.n_states,)).copy()
    )


def warn_unfinished(name: str, iterations: int, distance: float, enough: float) -> None:
    """ConvergenceWarning at the caller's caller."""
    warnings.warn(
        f"{name} gave up after {iterations} iterations: the last one still changed a value by {distance:.3g}, "
        f"where {enough:.3g} was asked for",
        ConvergenceWarning,
        stacklevel=3,
    )


def solve_chain(
    transitions: sp.csr_array,
    rewards: NDArray[np.float64],
    discount: float,
    guess: NDArray[np.float64],
    *,
    name: str = "policy",
) -> NDArray[np.float64]:
    """V = r + gamma T V for the Markov chain of the policy ``name``, improving on ``guess`` (S,)."""
    if discount < 1:
        return _solve(
            sp.eye_array(rewards.size, format="csr") - discount * transitions,
            rewards,
            guess,
        )
    moving = ~_resting(transitions, rewards, name)
    values = np.zeros(rewards.size)
    equations = (
        sp.eye_array(moving.sum(), format="csr") - transitions[moving][:, moving]
    )
    values[moving] = _solve(equations, rewards[moving], guess[moving])
    return values


def solve_differences(
    transitions: sp.csr_array,
    rewards: NDArray[np.float64],
    discount: float,
    values: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The solution of V = r + gamma T V but for a number that all states share, refined from ``values`` (S,).

    Near discount 1 values are large, because all states share the mean reward over 1 - gamma, and the differences
    that matter drown in the rounding of what is shared. Here it is left out. Rows of ``transitions`` are taken to sum
    to one exactly.

    Returns
    -------
    differences : (S,), V less a number.
    step : (S,), what the last refinement still changed: as much as rounding makes it.
    """
    equations = sp.eye_array(rewards.size, format="csr") - discount * transitions
    differences, step = _less_shared(values), values
    for _ in range(3):
        missing = _less_shared(rewards - equations @ differences)
        step = _less_shared(_solve(equations, missing, np.zeros_like(missing)))
        differences = differences + step
    return differences, step


def _less_shared(numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    """Numbers about 0: less the middle between the least and the largest."""
    return numbers - (numbers.min() + numbers.max()) / 2


def _resting(
    transitions: sp.csr_array, rewards: NDArray[np.float64], name: str
) -> NDArray[np.bool_]:
    """Which states (S,) the chain never leaves for others and where it collects nothing: their value is 0."""
    count, member = csgraph.connected_components(transitions, connection="strong")
    source, reached = transitions.nonzero()
    closed = np.ones(count, dtype=bool)
    closed[member[source[member[source] != member[reached]]]] = False
    rewarded = closed[member] & (rewards != 0)
    if rewarded.any():
        raise ValueError(
            f"{name} must not collect rewards for ever where discount is 1, "
            f"got one that does in state {int(rewarded.argmax())} and never ends"
        )
    return closed[member]


def _solve(
    equations: sp.csr_array, right: NDArray[np.float64], guess: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Solve a sparse system to rounding: elimination for few equations, else a Krylov method, refined.

    Elimination fills up where states lead anywhere; the Krylov method does not, and says how well it did. Where it
    fails elimination is the last resort.
    """
    if right.size <= DIRECT_SOLVE:
        return linalg.spsolve(equations.tocsc(), right) if right.size else right
    solution = guess
    for _ in range(6):
        missing = right - equations @ solution
        rounding = np.finfo(float).eps * max(abs(solution).max(), abs(right).max())
        if abs(missing).max() <= 16 * rounding:
            return solution
        step, _ = linalg.bicgstab(
            equations, missing, rtol=1e-10, atol=4 * rounding, maxiter=1000
        )
        if not np.isfinite(step).all():
            break
        solution = solution + step
    return linalg.spsolve(equations.tocsc(), right)
