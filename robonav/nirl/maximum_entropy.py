"""Maximum causal entropy inverse reinforcement learning (Ziebart et al. 2010; 2008 for deterministic worlds).

Of all behaviours with the expert's feature expectations, take the one whose actions, each given the past, have the
largest entropy. It is a Boltzmann policy over action values whose backup has a soft maximum in place of Bellman's.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize
from scipy.special import logsumexp, softmax

from robonav.errors import ConvergenceWarning
from robonav.mdp.models import FiniteMDP

from ._arguments import checked
from .feature_expectations import initial_expectations
from .reward_free_mdp import RewardFreeMDP

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SoftSolution:
    """Soft-optimal values and policy, at one temperature.

    Attributes
    ----------
    values : (S,) array
    q : (S, A) array
    policy : (S, A) array
        The Boltzmann policy over ``q``.

    Examples
    --------
    >>> from robonav.nirl import TRUE_WEIGHTS, soft_value_iteration, terrain
    >>> grid, mdp = terrain()
    >>> soft_value_iteration(mdp.with_reward(TRUE_WEIGHTS)).policy.shape
    (42, 4)
    """

    values: Floats
    q: Floats
    policy: Floats


@dataclass(frozen=True, eq=False)
class MaximumCausalEntropy:
    """A reward, its soft policy, and the trace of the optimisation.

    Attributes
    ----------
    weights : (K,) array
        theta.
    policy : (S, A) array
        Soft-optimal for this reward.
    dual_values : (iterations,) array
        The penalised dual, which is maximised. Without its penalty it is the log-likelihood of the demonstrations, up
        to a constant.
    gaps : (iterations,) array
        Distance between the expert's feature expectations and the policy's.
    converged : bool
        Whether the gradient became as small as asked for.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import initial_expectations, maximum_causal_entropy, terrain
    >>> grid, mdp = terrain()
    >>> expert = initial_expectations(mdp, np.zeros(42, dtype=int))
    >>> maximum_causal_entropy(mdp, expert, regularisation=0.1).converged
    True
    """

    weights: Floats
    policy: Floats
    dual_values: Floats
    gaps: Floats
    converged: bool


@checked
def soft_maximum(q: ArrayLike, temperature: float) -> Floats:
    """The soft maximum T log sum_a exp(q / T) over the last axis; it tends to the maximum as T falls.

    Parameters
    ----------
    q : (..., A) array
    temperature : float
        T, positive.

    Returns
    -------
    (...) array

    Examples
    --------
    >>> from robonav.nirl import soft_maximum
    >>> soft_maximum([0.0, 1.0], 0.1).round(4)
    np.float64(1.0)
    """
    return np.asarray(
        temperature * logsumexp(np.asarray(q, dtype=float) / temperature, axis=-1)
    )


@checked
def soft_value_iteration(
    mdp: FiniteMDP,
    *,
    temperature: float = 1.0,
    tolerance: float = 1e-10,
    start: ArrayLike | None = None,
    max_iterations: int = 100_000,
) -> SoftSolution:
    """Soft value iteration: the backup V(s) = T log sum_a exp(Q(s, a) / T), repeated to its fixed point.

    The result maximises discounted reward plus T times discounted entropy. A terminal state goes on collecting entropy,
    since its A actions all do the same.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions and a discount below 1.
    temperature : float
        T, positive; as it falls to 0 this becomes value iteration.
    tolerance : float
        Largest error of a value.
    start : (S,) array, optional
        Values to start from; by default zeros.
    max_iterations : int
        Sweeps at most.

    Returns
    -------
    SoftSolution

    Warns
    -----
    ConvergenceWarning
        If ``max_iterations`` sweeps did not suffice.

    Examples
    --------
    >>> from robonav.nirl import TRUE_WEIGHTS, soft_value_iteration, terrain
    >>> grid, mdp = terrain()
    >>> soft_value_iteration(mdp.with_reward(TRUE_WEIGHTS)).values.max().round(2)
    np.float64(15.39)
    """
    values = np.zeros(mdp.n_states) if start is None else np.asarray(start, dtype=float)
    for _ in range(max_iterations):
        old = values
        values = soft_maximum(mdp.action_values(old), temperature)
        change = abs(values - old).max()
        if mdp.discount * change <= tolerance * (1 - mdp.discount):
            break
    else:
        warnings.warn(
            f"soft_value_iteration gave up after {max_iterations} sweeps: the last one still changed a value by "
            f"{change:.3g}",
            ConvergenceWarning,
            stacklevel=3,
        )
    q = mdp.action_values(values)
    return SoftSolution(values, q, softmax(q / temperature, axis=1))


@checked
def maximum_causal_entropy(
    mdp: RewardFreeMDP,
    expert: ArrayLike,
    *,
    regularisation: float = 1e-6,
    tolerance: float = 1e-6,
    iterations: int = 200,
) -> MaximumCausalEntropy:
    """Maximum causal entropy IRL (Ziebart et al. 2010): the reward under which the demonstrations are likeliest.

    Maximises the penalised dual theta . mu_E - E[V_theta(s_0)] - lambda ||theta||^2 / 2, which is concave. Its gradient
    is the expert's feature expectations minus those of the soft policy, minus lambda theta. L-BFGS makes the steps.

    Parameters
    ----------
    mdp : RewardFreeMDP
        S states, A actions, K features.
    expert : (K,) array
        Feature expectations mu_E of the expert from the initial state.
    regularisation : float
        lambda, at least 0: keeps the weights finite where the expert never errs.
    tolerance : float
        Largest entry of the gradient at which to stop, positive.
    iterations : int
        Of L-BFGS at most.

    Returns
    -------
    MaximumCausalEntropy

    Warns
    -----
    ConvergenceWarning
        If the gradient is still larger than ``tolerance`` at the end.

    Examples
    --------
    >>> from robonav.mdp import policy_iteration
    >>> from robonav.nirl import TRUE_WEIGHTS, initial_expectations, maximum_causal_entropy, terrain
    >>> grid, mdp = terrain()
    >>> expert = policy_iteration(mdp.with_reward(TRUE_WEIGHTS)).policy
    >>> found = maximum_causal_entropy(mdp, initial_expectations(mdp, expert), regularisation=1e-3)
    >>> int(found.weights.argmax())  # the target
    3
    """
    mu = np.asarray(expert)
    values, latest = np.zeros(mdp.n_states), (0.0, 0.0)
    trace: list[tuple[float, float]] = []

    def negative_dual(theta: Floats) -> tuple[float, Floats]:
        nonlocal values, latest
        soft = soft_value_iteration(mdp.with_reward(theta), start=values)
        values = soft.values  # where the next iteration starts
        gap = mu - initial_expectations(mdp, soft.policy)
        penalty = regularisation / 2 * theta @ theta
        dual = float(theta @ mu - mdp.starts @ soft.values - penalty)
        latest = (dual, float(np.linalg.norm(gap)))
        return -dual, regularisation * theta - gap

    found: Any = minimize(
        negative_dual,
        np.zeros(len(mu)),
        jac=True,
        method="L-BFGS-B",
        callback=lambda _: trace.append(latest),
        options={"maxiter": iterations, "gtol": tolerance, "ftol": 0.0},
    )
    converged = _has_converged(found, tolerance)
    policy = soft_value_iteration(mdp.with_reward(found.x), start=values).policy
    dual_values, gaps = np.array(trace, dtype=float).reshape(-1, 2).T
    return MaximumCausalEntropy(found.x, policy, dual_values, gaps, converged)


def _has_converged(found: Any, tolerance: float) -> bool:
    """Whether the gradient is as small as asked for; a warning if it is not."""
    largest = float(abs(found.jac).max(initial=0.0))
    if largest > tolerance:
        warnings.warn(
            f"maximum_causal_entropy ended after {found.nit} iterations with a gradient of {largest:.3g}, "
            f"more than the tolerance {tolerance:g}: {found.message}",
            ConvergenceWarning,
            stacklevel=4,
        )
    return largest <= tolerance
