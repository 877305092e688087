"""Relative-entropy inverse reinforcement learning (Boularias et al. 2011): no model, only sampled trajectories.

Of all distributions over trajectories with about the expert's features, take the one closest to that of a baseline
policy. It gives a trajectory a weight proportional to exp(theta . f). The samples may come from yet another policy, and
then carry importance weights as well.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize
from scipy.special import logsumexp, softmax

from ._arguments import checked
from .feature_expectations import discounted_feature_sums
from .features import state_action_features
from .policy_improvement import ReplaySGD
from .tasks import Task
from .trainer import IRLResult, train_under_reward
from .transitions import Transitions

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RelativeEntropy:
    """A reward's weights, and how well the samples support them.

    Attributes
    ----------
    weights : (K,) array
        theta.
    dual : float
        Value of the concave function that was maximised.
    gap : (K,) array
        Features of the expert minus those of the weighted samples; each entry is within the slack.
    effective_samples : float
        Number of equally weighted samples that the weighted ones are equivalent to (Kish). If it is small, the estimate
        depends on a few trajectories.

    Examples
    --------
    >>> from robonav.nirl import relative_entropy_weights
    >>> found = relative_entropy_weights([0.5], [[0.0], [1.0]], [0.0, 0.0])
    >>> round(found.effective_samples, 3)
    2.0
    """

    weights: Floats
    dual: float
    gap: Floats
    effective_samples: float


@checked
def importance_weights(
    weights: ArrayLike, samples: ArrayLike, log_ratios: ArrayLike
) -> Floats:
    """Weight of each sampled trajectory under theta, with sum 1.

    It is proportional to U(tau) / pi(tau) * exp(theta . f(tau)), where U is the baseline policy's probability of the
    trajectory's actions and pi the sampling policy's. The probabilities of the transitions are the same in both and
    cancel.

    Parameters
    ----------
    weights : (K,) array
        theta.
    samples : (N, K) array
        f(tau), discounted features of N trajectories.
    log_ratios : (N,) array
        log U(tau) - log pi(tau); zeros if the samples were drawn from the baseline itself.

    Returns
    -------
    (N,) array

    Examples
    --------
    >>> from robonav.nirl import importance_weights
    >>> importance_weights([1.0], [[0.0], [1.0]], [0.0, 0.0]).round(3)
    array([0.269, 0.731])
    """
    return np.asarray(softmax(np.asarray(samples) @ weights + np.asarray(log_ratios)))


@checked
def dual(
    weights: ArrayLike,
    expert: ArrayLike,
    samples: ArrayLike,
    log_ratios: ArrayLike,
    slack: ArrayLike,
) -> float:
    """The concave function to maximise: theta . mu_E - log Z(theta) - sum_i eps_i |theta_i|.

    Z is estimated from the samples.

    Parameters
    ----------
    weights, samples, log_ratios
        As in :func:`importance_weights`.
    expert : (K,) array
        mu_E.
    slack : (K,) array
        eps, at least 0.

    Examples
    --------
    >>> from robonav.nirl import dual
    >>> dual([0.0], [0.5], [[0.0], [1.0]], [0.0, 0.0], [0.0])
    0.0
    """
    theta, ratios = np.asarray(weights), np.asarray(log_ratios)
    log_z = logsumexp(np.asarray(samples) @ theta + ratios) - logsumexp(ratios)
    return float(theta @ np.asarray(expert) - log_z - np.asarray(slack) @ abs(theta))


@checked
def dual_gradient(
    weights: ArrayLike,
    expert: ArrayLike,
    samples: ArrayLike,
    log_ratios: ArrayLike,
    slack: ArrayLike,
) -> Floats:
    """The (sub)gradient of :func:`dual`: mu_E - sum_tau w(tau) f(tau) - eps sign(theta).

    It depends on theta through the importance weights w. A known fault in published code multiplies and divides by the
    same factor, which leaves a gradient that is the same for every theta.

    Parameters
    ----------
    weights, expert, samples, log_ratios, slack
        As in :func:`dual`.

    Returns
    -------
    (K,) array

    Examples
    --------
    >>> from robonav.nirl import dual_gradient
    >>> dual_gradient([0.0], [0.75], [[0.0], [1.0]], [0.0, 0.0], [0.0])
    array([0.25])
    """
    shares = importance_weights(weights, samples, log_ratios)
    gap = np.asarray(expert) - shares @ np.asarray(samples)
    return gap - np.asarray(slack) * np.sign(np.asarray(weights))


@checked
def hoeffding_slack(
    samples: ArrayLike, n_demonstrations: int, *, confidence: float = 0.95
) -> Floats:
    """The paper's choice of eps: how far a mean over so many demonstrations may be off by chance.

    Hoeffding's bound, with the range of each feature among the samples.

    Parameters
    ----------
    samples : (N, K) array
        Features of trajectories.
    n_demonstrations : int
        Number of demonstrated trajectories.
    confidence : float
        Probability that the bound holds.

    Returns
    -------
    (K,) array

    Examples
    --------
    >>> from robonav.nirl import hoeffding_slack
    >>> hoeffding_slack([[0.0], [1.0]], 50).round(3)
    array([0.192])
    """
    width = np.ptp(np.asarray(samples), axis=0)
    doubt = 1 - confidence
    return np.asarray(np.sqrt(-np.log(doubt / 2) / (2 * n_demonstrations)) * width)


@checked
def relative_entropy_weights(
    expert: ArrayLike,
    samples: ArrayLike,
    log_ratios: ArrayLike,
    *,
    slack: ArrayLike = 0.0,
    bound: float = 1e3,
    iterations: int = 1000,
) -> RelativeEntropy:
    """The weights that maximise :func:`dual`.

    The paper ascends by subgradients. Here theta is split into its positive and its negative part, which makes the
    function smooth, and L-BFGS with bounds maximises it.

    Parameters
    ----------
    expert : (K,) array
        mu_E, mean discounted features of the demonstrations.
    samples, log_ratios
        As in :func:`importance_weights`.
    slack : (K,) array or float
        eps; 0 matches the expert exactly.
    bound : float
        Largest weight. Without slack, an expert outside the samples' range would drive theta to infinity.
    iterations : int
        Of L-BFGS at most.

    Returns
    -------
    RelativeEntropy

    Raises
    ------
    ValueError
        If there is no sample, or shapes do not fit.

    Examples
    --------
    >>> from robonav.nirl import relative_entropy_weights
    >>> relative_entropy_weights([0.731], [[0.0], [1.0]], [0.0, 0.0]).weights.round(2)
    array([1.])
    """
    mu, features = np.asarray(expert), np.asarray(samples)
    n_features = len(mu)
    eps, smooth = np.broadcast_to(slack, (n_features,)), np.zeros(n_features)
    scale = np.maximum(abs(features - mu).max(axis=0), np.finfo(float).tiny)

    def negative_dual(parts: Floats) -> tuple[float, Floats]:
        up, down = parts.reshape(2, n_features) / scale
        theta = up - down
        slope = dual_gradient(theta, mu, features, log_ratios, smooth)
        value = dual(theta, mu, features, log_ratios, smooth) - eps @ (up + down)
        gradient = np.concatenate([(slope - eps) / scale, (-slope - eps) / scale])
        return -value, -gradient

    found: Any = minimize(
        negative_dual,
        np.zeros(2 * n_features),
        jac=True,
        method="L-BFGS-B",
        bounds=[(0.0, bound)] * (2 * n_features),
        options={"maxiter": iterations, "maxfun": 20 * iterations},
    )
    up, down = found.x.reshape(2, n_features) / scale
    theta = up - down
    shares = importance_weights(theta, features, log_ratios)
    value = dual(theta, mu, features, log_ratios, eps)
    gap, effective = mu - shares @ features, float(1 / (shares**2).sum())
    return RelativeEntropy(theta, value, gap, effective)


def segment_features(
    transitions: Transitions, n_actions: int, discount: float, horizon: int
) -> Floats:
    """Discounted features of the ``horizon`` decisions from each one on; fewer at the end of an episode.

    Parameters
    ----------
    transitions : Transitions
        M decisions.
    n_actions : int
        A.
    discount : float
        gamma.
    horizon : int
        Decisions of a segment.

    Returns
    -------
    (M, A (k + 1)) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, segment_features, terrain
    >>> task = TabularTask(terrain()[1], max_steps=3)
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> segment_features(expert, 4, 0.5, 2).sum(axis=1)
    array([3., 3., 2.])
    """
    taken = state_action_features(transitions.features, transitions.actions, n_actions)
    all_sums = discounted_feature_sums(taken, transitions.trajectory, discount)
    sums = all_sums.copy()
    after = np.arange(len(transitions)) + horizon  # the first decision left out
    same = after < len(transitions)
    same[same] = transitions.trajectory[after[same]] == transitions.trajectory[same]
    sums[same] -= discount**horizon * all_sums[after[same]]
    return sums


def random_segments(
    demonstrations: Transitions,
    task: Task,
    n_samples: int,
    horizon: int,
    rng: np.random.Generator,
) -> Transitions:
    """Segments of uniformly random actions, begun where the expert had to decide.

    Parameters
    ----------
    demonstrations : Transitions
        The expert's decisions.
    task : Task
        Where to act.
    n_samples : int
        Segments.
    horizon : int
        Decisions of each at most.
    rng : Generator
        Of all random numbers.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, random_segments, terrain
    >>> task = TabularTask(terrain()[1])
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> np.bincount(random_segments(expert, task, 3, 2, np.random.default_rng(0)).trajectory)
    array([2, 2, 2])
    """
    begin = rng.integers(len(demonstrations), size=n_samples)

    def uniform(inputs: Floats) -> Floats:
        return np.full((len(inputs), task.n_actions), 1 / task.n_actions)

    return task.rollout_from(demonstrations, begin, uniform, horizon, rng)


@checked
def relative_entropy(
    demonstrations: Transitions,
    task: Task,
    *,
    n_samples: int = 6000,
    horizon: int = 5,
    slack: float = 0.05,
    improver: ReplaySGD = ReplaySGD(),  # noqa: B008 - frozen
    seed: int | np.random.Generator = 0,
    **training: Any,
) -> IRLResult:
    """Relative-entropy IRL (Boularias et al. 2011): a reward from random segments, then neural policy iteration.

    A whole random episode never resembles the expert's. The trajectories compared are therefore segments of ``horizon``
    decisions: the expert's own, and random ones that begin where one of the expert's decisions was made.

    Parameters
    ----------
    demonstrations : Transitions
        The expert's decisions, with the states where segments can begin.
    task : Task
        Where the learner practises. Obstacles must stand still, since segments begin in the middle of an episode.
    n_samples : int
        Random segments.
    horizon : int
        Decisions of a segment.
    slack : float
        eps, as a multiple of each feature's standard deviation among the samples.
    improver : ReplaySGD
        Improves the network; its discount is that of the features.
    seed : int or Generator
        Of all random numbers.
    **training
        Other arguments of :func:`train_under_reward`.

    Returns
    -------
    IRLResult

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, relative_entropy, terrain
    >>> task = TabularTask(terrain()[1])
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> relative_entropy(expert, task, n_samples=50, iterations=2).policy.shape
    (42,)
    """
    rng = np.random.default_rng(seed)
    n_actions, discount = task.n_actions, improver.discount
    expert = segment_features(demonstrations, n_actions, discount, horizon)
    random = random_segments(demonstrations, task, n_samples, horizon, rng)
    taken = state_action_features(random.features, random.actions, n_actions)
    sums = discounted_feature_sums(taken, random.trajectory, discount)
    samples = sums[np.flatnonzero(np.diff(random.trajectory, prepend=-1))]
    uniform = np.zeros(len(samples))  # the baseline is the sampling policy itself
    eps = slack * samples.std(axis=0)
    found = relative_entropy_weights(expert.mean(axis=0), samples, uniform, slack=eps)
    theta = found.weights.reshape(n_actions, -1)
    return train_under_reward(
        demonstrations, task, theta, improver=improver, seed=rng, **training
    )
