"""Policy evaluation: the values of a policy, from Bellman's linear equations at once or sweep by sweep."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import wraps
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from robonav.documentation import with_signature
from robonav.validation import ArrayArgument

from . import undiscounted
from ._arguments import checked
from .convergence import warns_not_converged
from .linear_solver import solve
from .models import FiniteMDP

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class EvaluationResult:
    """Values of a policy, found sweep by sweep.

    Attributes
    ----------
    values : (S,) array
    iterations : int
        Number of sweeps.
    residual : float
        Largest change of a value in the last sweep.
    converged : bool
        Whether it was as small as the tolerance asks for.
    history : (iterations + 1, S) array or None
        The values before the first sweep and after each, if recorded.

    Examples
    --------
    >>> from robonav.mdp import FiniteMDP, iterative_policy_evaluation
    >>> mdp = FiniteMDP([[[1.0]]], [[1.0]], discount=0.5)  # a reward of 1 in every step
    >>> result = iterative_policy_evaluation(mdp, [0], tolerance=0.1)
    >>> result.iterations, result.residual, result.values
    (5, 0.0625, array([1.9375]))
    """

    values: Floats
    iterations: int
    residual: float
    converged: bool
    history: Floats | None = None


@checked
def policy_evaluation(
    mdp: FiniteMDP, policy: ArrayLike, *, guess: ArrayArgument | None = None
) -> Floats:
    """Values of a policy, the solution of Bellman's equation, Eq. (2.5).

    Exact to rounding. Bellman's equation takes the first step out of the expected return, Eq. (2.4), which leaves one
    linear equation a state: V = r_pi + gamma T_pi V.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    policy : (S,) array of ints or (S, A) array of probabilities
    guess : (S,) array, optional
        Values near the solution, from which a large system is solved faster; zeros by default.

    Returns
    -------
    (S,) array

    Raises
    ------
    ValueError
        If, without discount, the policy collects rewards forever, so that its value is not finite.

    Examples
    --------
    >>> from robonav.mdp import four_by_three, policy_evaluation
    >>> mdp = four_by_three().mdp(discount=0.95)
    >>> always_up = [0] * mdp.n_states
    >>> policy_evaluation(mdp, always_up).round(2)[:4]
    array([-0.47, -0.3 ,  0.13, -0.  ])
    """
    transitions, rewards = mdp.induced_chain(policy)
    near = np.zeros(mdp.n_states) if guess is None else guess
    if mdp.discount == 1:
        return undiscounted.policy_values(transitions, rewards, guess=near)
    identity = sp.eye_array(mdp.n_states, format="csr")
    return solve(identity - mdp.discount * transitions, rewards, near)  # Eq. (2.5)


def evaluation_residual(mdp: FiniteMDP, tolerance: float) -> float:
    """The largest change of a sweep after which all values are within ``tolerance`` of their limit.

    Examples
    --------
    >>> from robonav.mdp import four_by_three
    >>> evaluation_residual(four_by_three().mdp(0.9), tolerance=0.01)
    0.001111111111111111
    """
    return (1 if mdp.discount == 1 else 2) * mdp.residual_for(tolerance)


def least_gain(mdp: FiniteMDP, tolerance: float) -> float:
    """The gain of an action that adds up to ``tolerance`` if it is taken forever; without discount 0.

    Examples
    --------
    >>> from robonav.mdp import four_by_three
    >>> least_gain(four_by_three().mdp(0.5), tolerance=0.01)
    0.005
    """
    return tolerance * (1 - mdp.discount)


def error_limit(mdp: FiniteMDP, tolerance: float) -> float:
    """The largest Bellman error for which the greedy policy loses at most ``tolerance``; that itself without discount.

    Examples
    --------
    >>> from robonav.mdp import four_by_three
    >>> error_limit(four_by_three().mdp(0.5), tolerance=0.01)
    0.0025
    """
    return tolerance * (1 if mdp.discount == 1 else (1 - mdp.discount) / 2)


def keeps_history(
    evaluate: Callable[..., EvaluationResult],
) -> Callable[..., EvaluationResult]:
    """Give an evaluation by sweeps the argument ``record``, which asks for the values of every sweep.

    The sweeps are done again for the record, with the same numbers, so that the evaluation itself keeps nothing.
    """
    signature = inspect.signature(evaluate)

    @wraps(evaluate)
    def run(*args: Any, record: bool = False, **kwargs: Any) -> EvaluationResult:
        """Evaluate the policy, and add the history if it is asked for."""
        result = evaluate(*args, **kwargs)
        if not record:
            return result
        call = signature.bind(*args, **kwargs)
        call.apply_defaults()
        mdp, policy, start = (
            call.arguments[name] for name in ("mdp", "policy", "start")
        )
        history = swept_values(mdp, policy, start, result.iterations)
        return replace(result, history=history)

    return with_signature(run, with_record(signature))


def swept_values(
    mdp: FiniteMDP, policy: ArrayLike, start: Floats | None, sweeps: int
) -> Floats:
    """The values before the first sweep and after each, (sweeps + 1, S).

    Examples
    --------
    >>> from robonav.mdp import FiniteMDP
    >>> mdp = FiniteMDP([[[1.0]]], [[1.0]], discount=0.5)
    >>> swept_values(mdp, [0], None, sweeps=2).ravel()
    array([0. , 1. , 1.5])
    """
    transitions, rewards = mdp.induced_chain(policy)
    rows = np.zeros((sweeps + 1, mdp.n_states))
    if start is not None:
        rows[0] = start
    for sweep in range(sweeps):
        rows[sweep + 1] = rewards + mdp.discount * (transitions @ rows[sweep])
    return rows


def with_record(signature: inspect.Signature) -> inspect.Signature:
    """The signature with one more argument by name, ``record=False``.

    Examples
    --------
    >>> import inspect
    >>> print(with_record(inspect.signature(lambda mdp, *, sweeps: None)))
    (mdp, *, sweeps, record: 'bool' = False)
    """
    record = inspect.Parameter(
        "record", inspect.Parameter.KEYWORD_ONLY, default=False, annotation="bool"
    )
    return signature.replace(parameters=[*signature.parameters.values(), record])


@checked
@warns_not_converged(evaluation_residual)
@keeps_history
def iterative_policy_evaluation(
    mdp: FiniteMDP,
    policy: ArrayLike,
    *,
    tolerance: float = 1e-6,
    start: ArrayArgument | None = None,
    max_iterations: int = 100_000,
) -> EvaluationResult:
    """Values of a policy by repeated sweeps, Eq. (2.24).

    These are steps 5 to 8 of Algorithm 1. They stop when a sweep changes no value by more than
    ``tolerance * (1 - discount) / discount``. Every value is then within ``tolerance`` of the policy's. Without
    discount there is no such bound, and ``tolerance`` itself is used.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    policy : (S,) array of ints or (S, A) array of probabilities
    tolerance : float
        Largest error of a value accepted, in units of reward.
    start : (S,) array, optional
        Values to start from; zeros by default.
    max_iterations : int
        Number of sweeps after which to give up.
    record : bool
        Whether to keep the values of every sweep.

    Returns
    -------
    EvaluationResult

    Warns
    -----
    ConvergenceWarning
        If ``max_iterations`` sweeps were not enough; the message says how far the values still moved.

    Examples
    --------
    >>> from robonav.mdp import four_by_three, iterative_policy_evaluation
    >>> mdp = four_by_three().mdp(discount=0.95)
    >>> iterative_policy_evaluation(mdp, [0] * 11).values.round(2)[:4]
    array([-0.47, -0.3 ,  0.13,  0.  ])
    """
    transitions, rewards = mdp.induced_chain(policy)  # T_pi (S, S) and r_pi (S,)
    values = np.zeros(mdp.n_states) if start is None else start
    epsilon = evaluation_residual(mdp, tolerance)
    for iteration in range(1, max_iterations + 1):  # 5: repeat
        previous = values
        values = rewards + mdp.discount * (transitions @ previous)  # 6, 7  Eq. (2.24)
        residual = abs(values - previous).max()
        if residual <= epsilon:  # 8
            break
    converged = bool(residual <= epsilon)
    return EvaluationResult(values, iteration, float(residual), converged)


@checked
def expected_return(mdp: FiniteMDP, policy: ArrayLike, start: ArrayArgument) -> float:
    """Expected discounted return of a policy from random start states, Eq. (2.28).

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions.
    policy : (S,) array of ints or (S, A) array of probabilities
    start : (S,) array
        Probability of starting in each state.

    Returns
    -------
    float

    Examples
    --------
    >>> from robonav.mdp import expected_return, four_by_three, value_iteration
    >>> grid = four_by_three()
    >>> mdp = grid.mdp(discount=0.95)
    >>> round(expected_return(mdp, value_iteration(mdp).policy, grid.start), 3)
    0.501
    """
    return float(start @ policy_evaluation(mdp, policy))  # Eq. (2.28)


class ValueHistory:
    """Keeps the values of each iteration, if asked to.

    Examples
    --------
    >>> history = ValueHistory(record=True)
    >>> history.append(np.zeros(2))
    >>> history.append(np.ones(2))
    >>> history.rows
    array([[0., 0.],
           [1., 1.]])
    """

    def __init__(self, record: bool) -> None:
        self._rows: list[NDArray[Any]] | None = [] if record else None

    def append(self, values: NDArray[Any]) -> None:
        """Keep a copy of the values (S,) of one more iteration."""
        if self._rows is not None:
            self._rows.append(values.copy())

    @property
    def rows(self) -> NDArray[Any] | None:
        """All of them, (rows, S), or None if nothing is kept."""
        return None if self._rows is None else np.stack(self._rows)
