"""Relative-entropy inverse reinforcement learning (Boularias et al. 2011): no model, only sampled trajectories.

Of all distributions over trajectories with about the expert's features take the one closest to a baseline policy's.
It weighs a trajectory by exp(theta . f); the samples came from yet another policy, so they carry importance weights.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize
from scipy.special import logsumexp, softmax

from robonav.validation import check_array, check_integer, check_positive, check_real

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class RelativeEntropy:
    """A reward's ``weights`` (K,), and how the samples bore it.

    Attributes
    ----------
    dual : value of the concave function that was maximised.
    gap : (K,) features of the expert minus those of the weighted samples; within the slack, entry by entry.
    effective_samples : how many equally weighted samples the weighted ones are worth (Kish): few, and the estimate
        hangs on a handful of trajectories.
    """

    weights: Floats
    dual: float
    gap: Floats
    effective_samples: float


def importance(weights: ArrayLike, samples: ArrayLike, log_ratios: ArrayLike) -> Floats:
    """How much each sampled trajectory counts under theta, (N,), with sum 1.

    Proportional to U(tau) / pi(tau) * exp(theta . f(tau)), where U is the baseline policy's probability of the
    trajectory's actions and pi the sampling policy's; what the world adds is the same in both and cancels.

    Parameters
    ----------
    weights : theta, (K,).
    samples : f(tau), discounted features of N trajectories, (N, K).
    log_ratios : log U(tau) - log pi(tau), (N,); zeros where the samples were drawn from the baseline itself.
    """
    theta, features, ratios = _checked(weights, samples, log_ratios)
    return np.asarray(softmax(features @ theta + ratios))


def dual(
    weights: ArrayLike,
    expert: ArrayLike,
    samples: ArrayLike,
    log_ratios: ArrayLike,
    slack: ArrayLike,
) -> float:
    """What is maximised: theta . mu_E - log Z(theta) - sum_i eps_i |theta_i|, Z estimated from the samples."""
    theta, features, ratios = _checked(weights, samples, log_ratios)
    mu, eps = _aims(expert, slack, len(theta))
    log_z = logsumexp(features @ theta + ratios) - logsumexp(ratios)
    return float(theta @ mu - log_z - eps @ abs(theta))


def dual_gradient(
    weights: ArrayLike,
    expert: ArrayLike,
    samples: ArrayLike,
    log_ratios: ArrayLike,
    slack: ArrayLike,
) -> Floats:
    """The (sub)gradient of :func:`dual`, (K,): mu_E - sum_tau importance(tau) f(tau) - eps sign(theta).

    It depends on theta through the importance weights. A known fault in published code divides the same factor out of
    numerator and denominator, which leaves a gradient that is the same for every theta.
    """
    mu, eps = _aims(expert, slack, np.size(weights))
    weighted = importance(weights, samples, log_ratios) @ np.asarray(
        samples, dtype=float
    )
    return mu - weighted - eps * np.sign(np.asarray(weights, dtype=float))


def hoeffding_slack(
    samples: ArrayLike, demonstrations: int, *, confidence: float = 0.95
) -> Floats:
    """How far a mean over so many demonstrations may be off by chance, (K,): the paper's choice of eps.

    Hoeffding's bound, with the range of each trajectory feature among the samples (N, K) for its range.
    """
    features = check_array("samples", samples, shape=("N", "K"))
    n = check_integer("demonstrations", demonstrations, at_least=1)
    doubt = 1 - check_real("confidence", confidence, at_least=0, below=1)
    return np.asarray(np.sqrt(-np.log(doubt / 2) / (2 * n)) * np.ptp(features, axis=0))


def relative_entropy(
    expert: ArrayLike,
    samples: ArrayLike,
    log_ratios: ArrayLike,
    *,
    slack: ArrayLike = 0.0,
    bound: float = 1e3,
    iterations: int = 1000,
) -> RelativeEntropy:
    """The weights that maximise :func:`dual`.

    The paper climbs by subgradients; here theta is split into its positive and negative part, which makes the function
    smooth, and L-BFGS with bounds climbs it.

    Parameters
    ----------
    expert : mu_E, mean discounted features of the demonstrations, (K,).
    samples, log_ratios : see :func:`importance`.
    slack : eps, (K,) or one number for all; 0 matches the expert exactly.
    bound : largest weight allowed: without slack, an expert outside the samples' range would drive theta to infinity.
    iterations : of L-BFGS at most.

    Raises
    ------
    ValueError : if there is no sample, or shapes do not fit.
    """
    features = check_array("samples", samples, shape=("N", "K"))
    k = features.shape[1]
    mu, eps = _aims(expert, np.broadcast_to(np.asarray(slack, dtype=float), (k,)), k)
    most = check_positive("bound", bound)
    scale = np.maximum(
        abs(features - mu).max(axis=0, initial=0), np.finfo(float).tiny
    )  # features of like size

    def negative(parts: Floats) -> tuple[float, Floats]:
        up, down = parts.reshape(2, k) / scale
        theta = up - down
        smooth = dual_gradient(theta, mu, features, log_ratios, np.zeros(k))
        value = dual(theta, mu, features, log_ratios, np.zeros(k)) - eps @ (up + down)
        return -value, -np.concatenate(
            [(smooth - eps) / scale, (-smooth - eps) / scale]
        )

    found = minimize(
        negative,
        np.zeros(2 * k),
        jac=True,
        method="L-BFGS-B",
        bounds=[(0.0, most)] * (2 * k),
        options={
            "maxiter": check_integer("iterations", iterations, at_least=1),
            "maxfun": 20 * iterations,
        },
    )
    up, down = found.x.reshape(2, k) / scale
    theta = up - down
    shares = importance(theta, features, log_ratios)
    return RelativeEntropy(
        theta,
        dual(theta, mu, features, log_ratios, eps),
        mu - shares @ features,
        float(1 / (shares**2).sum()),
    )


def _checked(
    weights: ArrayLike, samples: ArrayLike, log_ratios: ArrayLike
) -> tuple[Floats, Floats, Floats]:
    features = check_array("samples", samples, shape=("N", "K"))
    if len(features) == 0:
        raise ValueError("samples must hold at least one trajectory, got none")
    theta = check_array("weights", weights, shape=(features.shape[1],))
    return (
        theta,
        features,
        check_array("log_ratios", log_ratios, shape=(len(features),)),
    )


def _aims(expert: ArrayLike, slack: ArrayLike, k: int) -> tuple[Floats, Floats]:
    eps = check_array("slack", slack, shape=(k,))
    if (eps < 0).any():
        raise ValueError(f"slack must be at least 0, got {eps.min():g}")
    return check_array("expert", expert, shape=(k,)), eps
