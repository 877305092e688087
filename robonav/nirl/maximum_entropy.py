"""Maximum causal entropy inverse reinforcement learning (Ziebart et al. 2010; 2008 for deterministic worlds).

Of all policies with the expert's feature expectations, take the one with the largest causal entropy: it prefers nothing
that the demonstrations do not show. With the reward r(s, a) = theta . f(s, a) it is the Boltzmann policy

    pi(a | s) = exp((Q(s, a) - V(s)) / T),
    Q(s, a)   = r(s, a) + gamma * sum over s' of T(s, a, s') V(s'),
    V(s)      = T log sum over a of exp(Q(s, a) / T),

with a soft maximum in the last line, where Bellman's equation has the maximum of Q(s, a). The temperature T, not to
be confused with T(s, a, s'), is 1 in inverse reinforcement learning, where another one would only scale theta. As it
falls to 0, the soft maximum becomes the maximum.

How often this policy visits the states, each visit discounted by its step, follows from the initial distribution p_0:

    d(s')     = p_0(s') + gamma * sum over s and a of d(s) pi(a | s) T(s, a, s').

The expert's feature expectations mu_E come from its demonstrations: the sum over the steps of gamma^t f(s_t, a_t),
averaged over the trajectories (``empirical_expectations``). The weights theta make the demonstrations most likely where
the gradient is zero,

    mu_E - sum over s and a of d(s) pi(a | s) f(s, a) = 0:

the policy then has the expert's feature expectations. The file has these parts in order: the backward pass,
:func:`soft_value_iteration`; the forward pass, :func:`occupancy_measure`; the function that is maximised and its
gradient, :func:`causal_entropy_dual`; plain gradient ascent, :func:`causal_entropy_ascent`; and the fast way to the
same maximum, L-BFGS, :func:`maximum_causal_entropy`.
"""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from typing import ParamSpec

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult, minimize
from scipy.special import logsumexp, softmax

from robonav.counting import counted
from robonav.documentation import with_signature
from robonav.errors import ConvergenceWarning
from robonav.mdp.convergence import warns_not_converged
from robonav.mdp.evaluation import evaluation_residual
from robonav.mdp.models import FiniteMDP
from robonav.validation import ArrayArgument

from ._arguments import checked
from .reward_free_mdp import RewardFreeMDP

Floats = NDArray[np.float64]
P = ParamSpec("P")


@checked
def soft_maximum(q: ArrayArgument, temperature: float) -> Floats:
    """The soft maximum T log sum_a exp(q / T) over the last axis; it tends to the maximum as T falls to 0.

    Parameters
    ----------
    q : (..., A) array
        Action values.
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
    return temperature * logsumexp(q / temperature, axis=-1)


@checked
@warns_not_converged(evaluation_residual)
def soft_value_iteration(
    mdp: FiniteMDP,
    *,
    temperature: float = 1.0,
    tolerance: float = 1e-10,
    max_iterations: int = 100_000,
) -> SoftSolution:
    """The backward pass: repeat the soft backup V(s) = T log sum_a exp(Q(s, a) / T) until the values settle.

    The result maximises the discounted reward plus T times the discounted entropy. A terminal state is a state like all
    others here: its A actions have the same effect, so that the policy draws them with equal probability, and the state
    goes on collecting the entropy T log A in each step. Its value is T log(A) / (1 - gamma), not 0.

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions and a discount below 1.
    temperature : float
        T, positive; as it falls to 0 this becomes value iteration.
    tolerance : float
        Largest error of a value.
    max_iterations : int
        Number of sweeps after which to give up.

    Returns
    -------
    SoftSolution

    Warns
    -----
    ConvergenceWarning
        If ``max_iterations`` sweeps were not enough.

    Examples
    --------
    >>> from robonav.nirl import TRUE_WEIGHTS, soft_value_iteration, terrain
    >>> grid, mdp = terrain()
    >>> soft_value_iteration(mdp.with_reward(TRUE_WEIGHTS)).values.max().round(2)
    np.float64(15.39)
    """
    values = np.zeros(mdp.n_states)
    epsilon = evaluation_residual(mdp, tolerance)
    for iteration in range(1, max_iterations + 1):
        before = values
        expected = mdp.expected_next_values(before)  # sum over s' of T(s, a, s') V(s')
        q = mdp.rewards + mdp.discount * expected  # (S, A)
        values = soft_maximum(q, temperature)  # (S,)
        residual = float(abs(values - before).max())
        if residual <= epsilon:
            break
    q = mdp.action_values(values)
    policy = softmax(q / temperature, axis=1)
    return SoftSolution(values, q, policy, iteration, residual, residual <= epsilon)


@checked
def occupancy_measure(mdp: RewardFreeMDP, policy: ArrayArgument) -> Floats:
    """The forward pass: how often a policy takes each action in each state, each time discounted by its step.

    The discounted number of visits d solves d(s') = p_0(s') + gamma sum_s,a d(s) pi(a | s) T(s, a, s'): a visit is a
    start, or it follows a visit to another state. Ziebart repeats this equation; here a linear solver solves it.

    Parameters
    ----------
    mdp : RewardFreeMDP
        S states, A actions.
    policy : (S,) array of int or (S, A) array
        Actions or probabilities.

    Returns
    -------
    (S, A) array
        d(s) pi(a | s), with sum 1 / (1 - discount).

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import occupancy_measure, terrain
    >>> grid, mdp = terrain()  # with discount 0.9
    >>> occupancy_measure(mdp, np.zeros(42, dtype=int)).sum().round(6)
    np.float64(10.0)
    """
    chain = np.einsum("sa,ast->st", policy, mdp.transitions)  # from s to s' under pi
    arriving = chain.T  # row s': the probabilities of coming into s' from each s
    visits = np.linalg.solve(np.eye(mdp.n_states) - mdp.discount * arriving, mdp.starts)
    return visits[:, None] * policy


def causal_entropy_dual(
    weights: Floats, mdp: RewardFreeMDP, expert: Floats, regularisation: float = 0.0
) -> tuple[float, Floats]:
    """The penalised dual theta . mu_E - E[V_theta(s_0)] - lambda ||theta||^2 / 2, and its gradient.

    Without the penalty it is the expected log-likelihood of the expert's actions, where log pi(a_t | s_t) is discounted
    by gamma^t and summed over the steps. It is concave. Its gradient is the expert's feature expectations minus those
    of the soft policy, minus lambda theta.

    Parameters
    ----------
    weights : (K,) array
        theta.
    mdp : RewardFreeMDP
        S states, A actions, K features.
    expert : (K,) array
        Feature expectations mu_E of the expert from the initial state.
    regularisation : float
        lambda, at least 0.

    Returns
    -------
    value : float
    gradient : (K,) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import causal_entropy_dual, initial_expectations, terrain
    >>> grid, mdp = terrain()
    >>> uniform = np.full((42, 4), 0.25)  # the soft policy under the reward 0
    >>> value, gradient = causal_entropy_dual(np.zeros(4), mdp, initial_expectations(mdp, uniform))
    >>> abs(gradient).max() < 1e-9
    np.True_
    """
    soft = soft_value_iteration(mdp.with_reward(weights))  # backward pass
    occupancy = occupancy_measure(mdp, soft.policy)  # forward pass
    expected = np.einsum("sa,sak->k", occupancy, mdp.features)
    penalty = regularisation / 2 * weights @ weights
    value = weights @ expert - mdp.starts @ soft.values - penalty
    gradient = expert - expected - regularisation * weights
    return float(value), gradient


@checked
def causal_entropy_ascent(
    mdp: RewardFreeMDP,
    expert: ArrayArgument,
    *,
    regularisation: float = 1e-6,
    gradient_step: float = 0.1,
    iterations: int = 200,
) -> Floats:
    """Maximum causal entropy IRL by plain gradient ascent: raise the weight of what the expert has more of.

    Parameters
    ----------
    mdp : RewardFreeMDP
        S states, A actions, K features.
    expert : (K,) array
        Feature expectations mu_E of the expert from the initial state.
    regularisation : float
        lambda, at least 0.
    gradient_step : float
        Step along the gradient, positive. A step that is too large jumps to and fro over the maximum.
    iterations : int
        Number of steps.

    Returns
    -------
    (K,) array
        The weights theta. :func:`maximum_causal_entropy` finds them faster, and says whether they have converged.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import causal_entropy_ascent, initial_expectations, terrain
    >>> grid, mdp = terrain()
    >>> uniform = np.full((42, 4), 0.25)  # an expert without a preference
    >>> bool(abs(causal_entropy_ascent(mdp, initial_expectations(mdp, uniform), iterations=5)).max() < 1e-9)
    True
    """
    theta = np.zeros(len(expert))
    for _ in range(iterations):
        soft = soft_value_iteration(mdp.with_reward(theta))  # backward: r = theta . f
        occupancy = occupancy_measure(mdp, soft.policy)  # forward: d(s) pi(a | s)
        expected = np.einsum("sa,sak->k", occupancy, mdp.features)  # of the policy
        theta = theta + gradient_step * (expert - expected - regularisation * theta)
    return theta


def with_trace(
    maximise: Callable[P, OptimizeResult],
) -> Callable[P, MaximumCausalEntropy]:
    """Make a method of a search for the weights: it checks the arguments, and keeps the dual after each iteration.

    The search takes the arguments of :func:`maximum_causal_entropy`, and returns the result of ``scipy``'s minimiser.
    """
    signature = inspect.signature(maximise)

    @wraps(maximise)
    def learn(*args: P.args, **kwargs: P.kwargs) -> MaximumCausalEntropy:
        """Search for the weights, and keep those after each iteration."""
        bound = signature.bind(*args, **kwargs)
        bound.apply_defaults()
        arguments, path = bound.arguments, []
        mdp, expert = arguments["mdp"], arguments["expert"]
        tolerance, regularisation = arguments["tolerance"], arguments["regularisation"]
        tell = arguments["callback"]

        def keep(theta: Floats) -> None:
            path.append(theta)
            tell(theta)

        arguments["callback"] = keep
        found = maximise(*bound.args, **bound.kwargs)
        trace = [causal_entropy_dual(theta, mdp, expert) for theta in path]
        penalties = [regularisation / 2 * theta @ theta for theta in path]
        largest = float(abs(found.jac).max(initial=0.0))
        if largest > tolerance:
            warn_unconverged(found, largest, tolerance)
        return MaximumCausalEntropy(
            weights=found.x,
            policy=soft_value_iteration(mdp.with_reward(found.x)).policy,
            dual_values=np.array([value for value, _ in trace]) - penalties,
            gaps=np.array([np.linalg.norm(gap) for _, gap in trace]),
            converged=largest <= tolerance,
        )

    shown = signature.replace(return_annotation="MaximumCausalEntropy")
    return checked(with_signature(learn, shown))


def warn_unconverged(found: OptimizeResult, largest: float, tolerance: float) -> None:
    """Warn that the largest entry of the gradient exceeds the tolerance."""
    warnings.warn(
        f"maximum_causal_entropy ended after {counted(found.nit, 'iteration')} with a gradient of {largest:.3g}, "
        f"more than the tolerance {tolerance:g}: {found.message}",
        ConvergenceWarning,
        stacklevel=4,
    )


@with_trace
def maximum_causal_entropy(
    mdp: RewardFreeMDP,
    expert: ArrayArgument,
    *,
    regularisation: float = 1e-6,
    tolerance: float = 1e-6,
    iterations: int = 200,
    callback: Callable[[Floats], None] = lambda _weights: None,
) -> OptimizeResult:
    """Maximum causal entropy IRL (Ziebart et al. 2010): the reward under which the demonstrations are most likely.

    Maximises :func:`causal_entropy_dual` over the weights. L-BFGS makes the steps; since scipy minimises, it gets the
    dual and its gradient with the opposite sign.

    Parameters
    ----------
    mdp : RewardFreeMDP
        S states, A actions, K features.
    expert : (K,) array
        Feature expectations mu_E of the expert from the initial state.
    regularisation : float
        lambda, at least 0. It keeps the weights finite if the expert never errs.
    tolerance : float
        Largest entry of the gradient at which to stop, positive.
    iterations : int
        Iterations of L-BFGS at most.
    callback : callable, optional
        Called with the weights after each iteration.

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

    def negative_dual(theta: Floats) -> tuple[float, Floats]:
        value, gradient = causal_entropy_dual(theta, mdp, expert, regularisation)
        return -value, -gradient

    return minimize(
        negative_dual,
        np.zeros(len(expert)),
        jac=True,
        method="L-BFGS-B",
        callback=callback,
        options={"maxiter": iterations, "gtol": tolerance, "ftol": 0.0},
    )


@dataclass(frozen=True, eq=False)
class SoftSolution:
    """Soft-optimal values and policy, at one temperature.

    Attributes
    ----------
    values : (S,) array
        V, the soft maximum of each row of ``q``.
    q : (S, A) array
        Action values Q.
    policy : (S, A) array
        The Boltzmann policy over ``q``.
    iterations : int
        Number of sweeps.
    residual : float
        Largest change of a value in the last sweep.
    converged : bool
        Whether it was as small as the tolerance asks for.

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
    iterations: int
    residual: float
    converged: bool


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
        The penalised dual, which is maximised, after each iteration.
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
