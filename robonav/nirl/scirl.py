"""Structured classification for inverse reinforcement learning (Klein et al. 2012).

A linear classifier that scores action a in state s by theta . mu_E(s, a), where mu_E are the expert's feature
expectations, is a set of action values: those of the expert under the reward theta . f. If it puts the
expert's actions first, the expert is optimal for that reward. No policy has to be found on the way.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array, check_integer, check_positive, check_real

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Classification:
    """``weights`` (K,), and the ``costs`` (iterations,) on the way to them."""

    weights: Floats
    costs: Floats


def lstd_mu(
    basis: ArrayLike,
    next_basis: ArrayLike,
    features: ArrayLike,
    discount: float,
    *,
    ridge: float = 1e-6,
) -> Floats:
    """LSTD-mu: coefficients (n, K) with mu(s, a) close to psi(s, a) . coefficients, from single steps of the expert.

    Least-squares temporal differences (Bradtke and Barto 1996) with every feature in place of the reward:
    solve sum_t psi_t (psi_t - gamma psi_t+1)^T omega = sum_t psi_t f_t^T.

    Parameters
    ----------
    basis : psi(s_t, a_t) of M steps, (M, n).
    next_basis : psi(s_t+1, a_t+1) of the step after each, zeros where the trajectory ends in a terminal state, (M, n).
    features : f(s_t, a_t), (M, K).
    discount : gamma in [0, 1].
    ridge : added to the diagonal, per step; keeps what the steps do not determine at zero. Positive.

    Raises
    ------
    ValueError : if there is no step or shapes do not fit.
    """
    psi = check_array("basis", basis, shape=("M", "n"))
    if len(psi) == 0:
        raise ValueError("basis must hold at least one step, got none")
    after = check_array("next_basis", next_basis, shape=psi.shape)
    f = check_array("features", features, shape=(len(psi), "K"))
    gamma = check_real("discount", discount, at_least=0, at_most=1)
    equations = psi.T @ (psi - gamma * after) + check_positive("ridge", ridge) * len(
        psi
    ) * np.eye(psi.shape[1])
    return np.linalg.solve(equations, psi.T @ f)


def heuristic_mu(
    expectations: ArrayLike, shown: ArrayLike, actions: int, discount: float
) -> Floats:
    """mu_E(s, a) of every action, (M, A, K), where only the expert's own is known (Klein et al. 2012, section 5).

    The paper's heuristic: with another action the expert loses a step and then goes on as before, so that
    mu(s, a) = gamma mu(s, a_E).

    Parameters
    ----------
    expectations : mu(s_t, a_t) of the expert's steps, (M, K), for instance by
        :func:`~robonav.nirl.discounted_feature_sums`.
    shown : the expert's actions a_t, (M,).
    """
    mu = check_array("expectations", expectations, shape=("M", "K"))
    own = _actions(shown, len(mu), actions)
    every = np.repeat((discount * mu)[:, None], actions, axis=1)
    every[np.arange(len(mu)), own] = mu
    return every


def cost(
    theta: ArrayLike,
    expectations: ArrayLike,
    shown: ArrayLike,
    *,
    ridge: float = 0.0,
    step_weights: ArrayLike | None = None,
) -> tuple[float, Floats]:
    """The large-margin cost of a classifier that scores theta . mu(s, a), and a subgradient of it (K,).

    The mean over steps of max_a [theta . mu(s, a) + 1(a != a_E)] - theta . mu(s, a_E), plus ridge ||theta||^2 / 2
    (Taskar et al. 2005; Klein et al. 2012). With a* the action that comes out on top, mu(s, a*) - mu(s, a_E) is a
    step's share of the subgradient. Arguments as in :func:`structured_classification`.
    """
    score = check_array("theta", theta, shape=("K",))
    mu = check_array("expectations", expectations, shape=("M", "A", len(score)))
    own = _actions(shown, len(mu), mu.shape[1])
    share = (
        np.full(len(mu), 1 / len(mu))
        if step_weights is None
        else np.asarray(step_weights, dtype=float)
    )
    row = np.arange(len(mu))
    scores = mu @ score + (np.arange(mu.shape[1]) != own[:, None])
    top = scores.argmax(axis=1)
    value = share @ (scores[row, top] - scores[row, own]) + ridge / 2 * score @ score
    return float(value), share @ (mu[row, top] - mu[row, own]) + ridge * score


def structured_classification(
    expectations: ArrayLike,
    shown: ArrayLike,
    *,
    step_weights: ArrayLike | None = None,
    ridge: float = 1e-6,
    rate: float = 1.0,
    iterations: int = 1000,
) -> Classification:
    """The weights whose scores theta . mu_E(s, a) put the expert's actions first by a margin.

    Subgradient descent, each weight with a step of its own: rate over the root of its squared subgradients so far
    (Duchi et al. 2011). Features whose expectations hardly differ between actions would else hardly move. The weights
    are averaged over the second half.

    Parameters
    ----------
    expectations : mu_E(s_t, a) of every action in every state shown, (M, A, K).
    shown : the expert's actions, (M,).
    step_weights : how much each step counts, (M,) with sum 1; alike if not given.
    ridge : lambda, at least 0, for expectations whose largest contrast has length 1.
    rate, iterations : of the descent.

    Raises
    ------
    ValueError : if there is no step, shapes do not fit or an action does not exist.
    """
    mu = check_array("expectations", expectations, shape=("M", "A", "K"))
    if len(mu) == 0:
        raise ValueError("expectations must hold at least one step, got none")
    own = _actions(shown, len(mu), mu.shape[1])
    decay, first = check_real("ridge", ridge, at_least=0), check_positive("rate", rate)
    apart = np.linalg.norm(mu - mu[np.arange(len(mu)), own][:, None], axis=2)
    scale = max(apart.max(), np.finfo(float).tiny)
    mu = mu / scale  # the same classifier with weights in units of 1 / scale
    theta, squares, total = (
        np.zeros(mu.shape[2]),
        np.full(mu.shape[2], 1e-12),
        np.zeros(mu.shape[2]),
    )
    costs = np.empty(check_integer("iterations", iterations, at_least=2))
    for k in range(iterations):
        costs[k], slope = cost(theta, mu, own, ridge=decay, step_weights=step_weights)
        squares += slope**2
        theta = theta - first * slope / np.sqrt(squares)
        if k >= iterations // 2:
            total += theta
    return Classification(total / (iterations - iterations // 2) / scale, costs)


def _actions(shown: ArrayLike, steps: int, actions: int) -> NDArray[np.int64]:
    own = check_array("shown", shown, shape=(steps,), dtype=np.int64)
    if steps and not 0 <= own.min() <= own.max() < actions:
        raise ValueError(
            f"shown must hold actions from 0 to {actions - 1}, got {own.min()} to {own.max()}"
        )
    return own
