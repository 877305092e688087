"""SCIRL: structured classification for inverse reinforcement learning (Klein et al. 2012).

Let a linear classifier score action a in state s by theta . mu_E(s, a), where mu_E are the expert's feature
expectations. The score is then the value of this action for the expert under the reward theta . f. If the classifier
gives the expert's actions the largest scores, the expert is optimal for this reward. The method therefore finds a
reward without finding any policy.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.validation import ArrayArgument

from ._arguments import checked
from .decisions import Decisions
from .feature_expectations import decision_feature_sums
from .features import all_action_features, state_action_features
from .policy_improvement import ReplaySGD
from .reward_update import inverse_frequency_weights
from .tasks import Task
from .training import IRLResult, train_under_reward

Floats = NDArray[np.float64]

Estimate = Callable[[Decisions, int, float], Floats]
"""``estimate(demonstrations, n_actions, discount) -> (M, A, A (k + 1))``: mu_E(s_t, a) of every action in each of the
expert's states."""


@dataclass(frozen=True, eq=False)
class Classification:
    """The weights of a classifier, and the costs of its training.

    Attributes
    ----------
    weights : (K,) array
        theta.
    costs : (iterations,) array

    Examples
    --------
    >>> from robonav.nirl import structured_classification
    >>> structured_classification([[[1.0], [0.0]]], [0], iterations=10).costs.shape
    (10,)
    """

    weights: Floats
    costs: Floats


@checked
def lstd_mu(
    basis: ArrayArgument,
    next_basis: ArrayArgument,
    features: ArrayArgument,
    discount: float,
    *,
    regularisation: float = 1e-6,
) -> Floats:
    """LSTD-mu: coefficients omega such that psi(s, a) . omega estimates mu_E(s, a), from steps of the expert.

    This is the method of least-squares temporal differences (Bradtke and Barto 1996) with each feature in turn as the
    reward. It solves sum_t psi_t (psi_t - gamma psi_t+1)' omega = sum_t psi_t f_t'.

    Parameters
    ----------
    basis : (M, n) array
        psi(s_t, a_t) of M steps.
    next_basis : (M, n) array
        psi(s_t+1, a_t+1) of the step after each; zeros where an episode ended in a terminal state.
    features : (M, K) array
        f(s_t, a_t).
    discount : float
        gamma, from 0 to 1.
    regularisation : float
        Positive; added to the diagonal for every step. Coefficients that the steps do not determine then stay at 0.

    Returns
    -------
    (n, K) array

    Raises
    ------
    ValueError
        If there is no step or shapes do not fit.

    Examples
    --------
    >>> from robonav.nirl import lstd_mu
    >>> lstd_mu([[1.0]], [[1.0]], [[1.0]], 0.5).round(3)  # 1 + 0.5 + 0.25 + ...
    array([[2.]])
    """
    psi, next_psi, f = basis, next_basis, features
    decay = regularisation * len(psi) * np.eye(psi.shape[1])
    matrix = psi.T @ (psi - discount * next_psi) + decay
    return np.linalg.solve(matrix, psi.T @ f)


@checked
def heuristic_mu(
    expectations: ArrayArgument, actions: ArrayArgument, n_actions: int, discount: float
) -> Floats:
    """mu_E(s, a) of every action, if only that of the expert's action is known (Klein et al. 2012, section 5).

    The heuristic assumes that any other action leaves the state as it is and has no features, and that the expert then
    takes its own action: mu_E(s, a) = gamma mu_E(s, a_E).

    Parameters
    ----------
    expectations : (M, K) array
        mu(s_t, a_t) of the expert's steps, for instance by :func:`discounted_feature_sums`.
    actions : (M,) array of int
        The expert's actions a_t.
    n_actions : int
        A.
    discount : float
        gamma.

    Returns
    -------
    (M, A, K) array

    Examples
    --------
    >>> from robonav.nirl import heuristic_mu
    >>> heuristic_mu([[2.0]], [1], 2, 0.5).ravel()
    array([1., 2.])
    """
    every = np.repeat((discount * expectations)[:, None], n_actions, axis=1)
    every[np.arange(len(expectations)), actions] = expectations
    return every


def large_margin_cost(
    theta: Floats,
    expectations: Floats,
    actions: NDArray[np.int64],
    step_weights: Floats,
    *,
    regularisation: float = 0.0,
) -> tuple[float, Floats]:
    """The large-margin cost of a classifier with the scores theta . mu(s, a), and its subgradient.

    The cost is sum_t w_t {max_a [theta . mu(s_t, a) + 1(a != a_t)] - theta . mu(s_t, a_t)} + lambda ||theta||^2 / 2
    (Taskar et al. 2005; Klein et al. 2012). A step costs nothing if the expert's action a_t leads every other action by
    1. If a* is the action of the maximum, the step contributes w_t [mu(s_t, a*) - mu(s_t, a_t)] to the subgradient.

    Parameters
    ----------
    theta : (K,) array
    expectations : (M, A, K) array
        mu_E(s_t, a).
    actions : (M,) array of int
        The expert's.
    step_weights : (M,) array
        w_t.
    regularisation : float
        lambda.

    Returns
    -------
    cost : float
    gradient : (K,) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import large_margin_cost
    >>> large_margin_cost(np.zeros(1), np.array([[[1.0], [0.0]]]), np.array([0]), np.ones(1))
    (1.0, array([-1.]))
    """
    n_steps, n_actions, _ = expectations.shape
    t = np.arange(n_steps)
    other = np.arange(n_actions) != actions[:, None]  # 1(a != a_t)
    scores = expectations @ theta + other
    best = scores.argmax(axis=1)  # a*
    cost = step_weights @ (scores[t, best] - scores[t, actions])
    gradient = step_weights @ (expectations[t, best] - expectations[t, actions])
    return (
        float(cost + regularisation / 2 * theta @ theta),
        gradient + regularisation * theta,
    )


@checked
def structured_classification(
    expectations: ArrayArgument,
    actions: ArrayArgument,
    *,
    step_weights: ArrayArgument | None = None,
    regularisation: float = 1e-6,
    gradient_step: float = 1.0,
    iterations: int = 1000,
) -> Classification:
    """Weights under which the scores theta . mu_E(s, a) of the expert's actions are the largest, by a margin.

    The cost is :func:`large_margin_cost`. Adagrad (Duchi et al. 2011) minimises it: subgradient descent in which each
    weight has a step of its own, ``gradient_step`` divided by the root of the sum of its squared subgradients. With a
    common step, weights of features that differ little between actions would hardly change. The result is the mean of
    the weights over the second half of the iterations.

    Parameters
    ----------
    expectations : (M, A, K) array
        mu_E(s_t, a) of every action in every demonstrated state.
    actions : (M,) array of int
        The expert's.
    step_weights : (M,) array, optional
        Weight of each step, with sum 1; by default all are equal.
    regularisation : float
        lambda, for expectations scaled so that their largest difference between actions has length 1.
    gradient_step : float
        Step of Adagrad.
    iterations : int
        Its number of iterations.

    Returns
    -------
    Classification

    Raises
    ------
    ValueError
        If there is no step, shapes do not fit or an action does not exist.

    Examples
    --------
    >>> from robonav.nirl import structured_classification
    >>> bool(structured_classification([[[1.0], [0.0]]], [0]).weights[0] > 0)
    True
    """
    mu, n = expectations, len(expectations)
    shares = np.full(n, 1 / n) if step_weights is None else step_weights
    differences = np.linalg.norm(mu - mu[np.arange(n), actions][:, None], axis=2)
    scale = max(differences.max(), np.finfo(float).tiny)
    mu = mu / scale  # the same classifier, with weights in units of 1 / scale
    theta, total = np.zeros(mu.shape[2]), np.zeros(mu.shape[2])
    squares, costs = np.full(mu.shape[2], 1e-12), np.empty(iterations)
    for k in range(iterations):
        costs[k], gradient = large_margin_cost(
            theta, mu, actions, shares, regularisation=regularisation
        )
        squares += gradient**2
        theta = theta - gradient_step * gradient / np.sqrt(squares)
        if k >= iterations // 2:
            total += theta
    mean = total / (iterations - iterations // 2)
    return Classification(mean / scale, costs)


def lstd_estimate(demonstrations: Decisions, n_actions: int, discount: float) -> Floats:
    """mu_E of every action by :func:`lstd_mu`, with the state-action features as its basis.

    For an action that was not demonstrated in a state, the estimate comes from similar states.

    Parameters
    ----------
    demonstrations : Decisions
        M decisions.
    n_actions : int
        A.
    discount : float
        gamma.

    Returns
    -------
    (M, A, A (k + 1)) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, lstd_estimate, terrain
    >>> task = TabularTask(terrain()[1], max_steps=3)
    >>> lstd_estimate(task.demonstrate(np.zeros(42, dtype=int), 1, seed=0), 4, 0.5).shape
    (3, 4, 172)
    """
    features, following = demonstrations.features, demonstrations.next_index
    own = state_action_features(features, demonstrations.actions, n_actions)
    next_own = np.where(following[:, None] >= 0, own[following], 0.0)
    coefficients = lstd_mu(own, next_own, own, discount, regularisation=1e-3)
    return all_action_features(features, n_actions) @ coefficients


def heuristic_estimate(
    demonstrations: Decisions, n_actions: int, discount: float
) -> Floats:
    """mu_E of every action: a Monte Carlo estimate for the expert's own, :func:`heuristic_mu` for all others.

    Parameters
    ----------
    demonstrations : Decisions
        M decisions.
    n_actions : int
        A.
    discount : float
        gamma.

    Returns
    -------
    (M, A, A (k + 1)) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, heuristic_estimate, terrain
    >>> task = TabularTask(terrain()[1], max_steps=3)
    >>> heuristic_estimate(task.demonstrate(np.zeros(42, dtype=int), 1, seed=0), 4, 0.5).shape
    (3, 4, 172)
    """
    sums = decision_feature_sums(demonstrations, n_actions, discount)
    return heuristic_mu(sums, demonstrations.actions, n_actions, discount)


@checked
def scirl(
    demonstrations: Decisions,
    task: Task,
    *,
    estimate: Estimate = lstd_estimate,
    regularisation: float = 1e-6,
    power: float = 1.0,
    improver: ReplaySGD = ReplaySGD(),  # noqa: B008 - frozen
    seed: int | np.random.Generator = 0,
    **training: Any,
) -> IRLResult:
    """SCIRL (Klein et al. 2012): a reward by classification, then neural policy iteration under it.

    Parameters
    ----------
    demonstrations : Decisions
        The expert's decisions.
    task : Task
        The task on which the network trains with the reward.
    estimate : callable
        Estimates mu_E: :func:`lstd_estimate` or :func:`heuristic_estimate`.
    regularisation : float
        lambda of the classifier.
    power : float
        How much more rare actions count, see :func:`inverse_frequency_weights`. 0 gives the paper's cost.
    improver : ReplaySGD
        Improves the network. Its discount is also that of mu_E.
    seed : int or Generator
        Seed of all random numbers.
    **training
        Other arguments of :func:`train_under_reward`.

    Returns
    -------
    IRLResult

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, scirl, terrain
    >>> task = TabularTask(terrain()[1])
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> scirl(expert, task, iterations=2).policy.shape
    (42,)
    """
    actions, n_actions = demonstrations.actions, task.n_actions
    mu = estimate(demonstrations, n_actions, improver.discount)
    shares = inverse_frequency_weights(actions, n_actions, power=power)
    classifier = structured_classification(
        mu, actions, step_weights=shares, regularisation=regularisation
    )
    theta = classifier.weights.reshape(n_actions, -1)
    return train_under_reward(
        demonstrations, task, theta, improver=improver, seed=seed, **training
    )
