"""Relative-entropy inverse reinforcement learning (Boularias et al. 2011), from sampled trajectories, without a model.

Of all distributions over trajectories whose expected features are close to the expert's, the method takes the one with
the least relative entropy to the distribution of a baseline policy. This distribution gives a trajectory tau the
baseline's probability times a number proportional to exp(theta . f(tau)). If the samples come from a policy other than
the baseline, importance weights correct for it.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from typing import Any, ParamSpec

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.special import logsumexp, softmax

from robonav.counting import counted
from robonav.errors import ConvergenceWarning
from robonav.validation import ArrayArgument

from ._arguments import checked
from .decisions import Decisions
from .feature_expectations import decision_feature_sums
from .policy_improvement import ReplaySGD
from .tasks import Task
from .training import IRLResult, train_under_reward

Floats = NDArray[np.float64]
P = ParamSpec("P")

PRECISION = 1e-2
"""By so much of a feature's scale the gap may exceed the slack; L-BFGS usually comes closer."""


@dataclass(frozen=True, eq=False)
class RelativeEntropy:
    """A reward's weights, and how well the samples support them.

    Attributes
    ----------
    weights : (K,) array
        theta.
    dual : float
        The maximum of :func:`dual`.
    gap : (K,) array
        Features of the expert minus the weighted mean of the samples' features. At the maximum each entry is within the
        slack, unless its weight has reached the bound.
    effective_samples : float
        Kish's effective sample size: the number of equally weighted samples with the same variance. If it is small, the
        estimate depends on a few trajectories.
    excess : float
        By how much an entry of the gap exceeds the slack, in units of the feature's scale, where the weight has not
        reached the bound. The scale of a feature is the largest distance of a sample's from the expert's.
    iterations : int
        Iterations of L-BFGS.

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
    excess: float
    iterations: int

    @property
    def converged(self) -> bool:
        """Whether the gap is within the slack, to a hundredth of the feature's scale."""
        return self.excess <= PRECISION


@checked
def importance_weights(
    weights: ArrayArgument, samples: ArrayArgument, log_ratios: ArrayArgument
) -> Floats:
    """Weights of the sampled trajectories under theta, which sum to 1.

    The weight of tau is proportional to U(tau) / pi(tau) * exp(theta . f(tau)), where U(tau) is the probability of the
    trajectory's actions under the baseline policy, and pi(tau) that under the sampling policy. The probabilities of the
    transitions are the same under both policies and cancel.

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
    return softmax(samples @ weights + log_ratios)


@checked
def dual(
    weights: ArrayArgument,
    expert: ArrayArgument,
    samples: ArrayArgument,
    log_ratios: ArrayArgument,
    slack: ArrayArgument,
) -> float:
    """The dual function, which is concave: theta . mu_E - log Z(theta) - sum_i eps_i |theta_i|.

    Z(theta), the normalising constant of the weights, is estimated from the samples.

    Parameters
    ----------
    weights : (K,) array
        theta.
    expert : (K,) array
        mu_E, mean discounted features of the demonstrations.
    samples : (N, K) array
        f(tau), discounted features of N trajectories.
    log_ratios : (N,) array
        log U(tau) - log pi(tau), as in :func:`importance_weights`.
    slack : (K,) array
        eps, at least 0.

    Returns
    -------
    float

    Examples
    --------
    >>> from robonav.nirl import dual
    >>> dual([0.0], [0.5], [[0.0], [1.0]], [0.0, 0.0], [0.0])
    0.0
    """
    log_z = logsumexp(samples @ weights + log_ratios) - logsumexp(log_ratios)
    return float(weights @ expert - log_z - slack @ abs(weights))


@checked
def dual_gradient(
    weights: ArrayArgument,
    expert: ArrayArgument,
    samples: ArrayArgument,
    log_ratios: ArrayArgument,
    slack: ArrayArgument,
) -> Floats:
    """The subgradient of :func:`dual`: mu_E - sum_tau w(tau) f(tau) - eps sign(theta).

    The importance weights w depend on theta. Published code exists in which a factor of the weights is multiplied and
    divided again, so that its gradient is the same for every theta.

    Parameters
    ----------
    weights : (K,) array
        theta.
    expert : (K,) array
        mu_E, mean discounted features of the demonstrations.
    samples : (N, K) array
        f(tau), discounted features of N trajectories.
    log_ratios : (N,) array
        log U(tau) - log pi(tau), as in :func:`importance_weights`.
    slack : (K,) array
        eps, at least 0.

    Returns
    -------
    (K,) array

    Examples
    --------
    >>> from robonav.nirl import dual_gradient
    >>> dual_gradient([0.0], [0.75], [[0.0], [1.0]], [0.0, 0.0], [0.0])
    array([0.25])
    """
    w = importance_weights(weights, samples, log_ratios)
    return expert - w @ samples - slack * np.sign(weights)


@checked
def hoeffding_slack(
    samples: ArrayArgument, n_demonstrations: int, *, confidence: float = 0.95
) -> Floats:
    """The slack eps of the paper: a bound on the error of the mean features of the demonstrations.

    By Hoeffding's inequality each mean is within this bound of its expectation, with the given probability. The range
    of a feature is estimated from the samples.

    Parameters
    ----------
    samples : (N, K) array
        Features of trajectories.
    n_demonstrations : int
        Number of demonstrated trajectories.
    confidence : float
        Probability with which the bound holds for a feature.

    Returns
    -------
    (K,) array

    Examples
    --------
    >>> from robonav.nirl import hoeffding_slack
    >>> hoeffding_slack([[0.0], [1.0]], 50).round(3)
    array([0.192])
    """
    ranges = np.ptp(samples, axis=0)
    failure = 1 - confidence
    return np.sqrt(-np.log(failure / 2) / (2 * n_demonstrations)) * ranges


def warns_beyond_slack(
    method: Callable[P, RelativeEntropy],
) -> Callable[P, RelativeEntropy]:
    """Decorate a method, so that it warns where the gap of its result exceeds the slack."""

    @wraps(method)
    def run(*args: P.args, **kwargs: P.kwargs) -> RelativeEntropy:
        """Call the method, and warn if it has not converged."""
        found = method(*args, **kwargs)
        if not found.converged:
            warnings.warn(
                f"{method.__name__} ended after {counted(found.iterations, 'iteration')}, and the gap exceeds the "
                f"slack by {found.excess:.3g} of a feature's scale, more than {PRECISION:g}",
                ConvergenceWarning,
                stacklevel=3,
            )
        return found

    return run


@checked
@warns_beyond_slack
def relative_entropy_weights(
    expert: ArrayArgument,
    samples: ArrayArgument,
    log_ratios: ArrayArgument,
    *,
    slack: ArrayArgument = 0.0,
    bound: float = 1e3,
    iterations: int = 1000,
) -> RelativeEntropy:
    """The weights that maximise :func:`dual`.

    The paper uses subgradient ascent, because |theta_i| has no derivative at 0. Here theta is the difference of two
    vectors with entries of at least 0, and |theta_i| becomes the sum of these entries. The function is then smooth, and
    L-BFGS with bounds maximises it.

    Parameters
    ----------
    expert : (K,) array
        mu_E, mean discounted features of the demonstrations.
    samples : (N, K) array
        f(tau), discounted features of N trajectories.
    log_ratios : (N,) array
        log U(tau) - log pi(tau), as in :func:`importance_weights`.
    slack : (K,) array or float
        eps, at least 0. With 0 the weighted samples have exactly the expert's features.
    bound : float
        Largest absolute value of a weight, in units of the feature's scale. Without slack, theta grows without limit if
        the expert's features lie outside the range of the samples'.
    iterations : int
        Iterations of L-BFGS at most.

    Returns
    -------
    RelativeEntropy

    Raises
    ------
    ValueError
        If there is no sample, or shapes do not fit.

    Warns
    -----
    ConvergenceWarning
        If L-BFGS ended before the gap was within the slack.

    Examples
    --------
    >>> from robonav.nirl import relative_entropy_weights
    >>> relative_entropy_weights([0.731], [[0.0], [1.0]], [0.0, 0.0]).weights.round(2)
    array([1.])
    """
    n_features = len(expert)
    eps, smooth = np.broadcast_to(slack, (n_features,)), np.zeros(n_features)
    scale = np.maximum(abs(samples - expert).max(axis=0), np.finfo(float).tiny)

    def negative_dual(parts: Floats) -> tuple[float, Floats]:
        up, down = parts.reshape(2, n_features) / scale
        theta = up - down
        slope = dual_gradient(theta, expert, samples, log_ratios, smooth)
        value = dual(theta, expert, samples, log_ratios, smooth) - eps @ (up + down)
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
    w = importance_weights(theta, samples, log_ratios)
    value = dual(theta, expert, samples, log_ratios, eps)
    gap, effective_samples = expert - w @ samples, float(1 / (w**2).sum())
    free = abs(theta) * scale < bound
    excess = float(((abs(gap) - eps) / scale)[free].max(initial=0.0))
    return RelativeEntropy(theta, value, gap, effective_samples, excess, found.nit)


def segment_features(
    decisions: Decisions, n_actions: int, discount: float, horizon: int
) -> Floats:
    """Discounted features of segments: of each decision and the ones after it, ``horizon`` of them at most.

    A segment ends with its episode. Its sum is the sum to the end of the episode, minus the part that begins
    ``horizon`` decisions later.

    Parameters
    ----------
    decisions : Decisions
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
    all_sums = decision_feature_sums(decisions, n_actions, discount)
    sums = all_sums.copy()
    after = np.arange(len(decisions)) + horizon  # the first decision left out
    same = after < len(decisions)  # whether it belongs to the same episode
    same[same] = decisions.trajectory[after[same]] == decisions.trajectory[same]
    sums[same] -= discount**horizon * all_sums[after[same]]
    return sums


def random_segments(
    demonstrations: Decisions,
    task: Task,
    n_samples: int,
    horizon: int,
    rng: np.random.Generator,
) -> Decisions:
    """Segments of uniformly random actions, each begun in a state in which the expert made a decision.

    Parameters
    ----------
    demonstrations : Decisions
        The expert's decisions.
    task : Task
        The task in which the actions are taken.
    n_samples : int
        Number of segments.
    horizon : int
        Decisions of a segment at most.
    rng : Generator
        Source of all random numbers.

    Returns
    -------
    Decisions

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
    demonstrations: Decisions,
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

    An episode of random actions hardly ever resembles the expert's. The method therefore compares segments of
    ``horizon`` decisions: those of the expert, and random ones that begin in the expert's states.

    Parameters
    ----------
    demonstrations : Decisions
        The expert's decisions, with the states where segments can begin.
    task : Task
        The task on which the network trains. Obstacles must stand still, because segments begin in the
        middle of an episode.
    n_samples : int
        Number of random segments.
    horizon : int
        Decisions of a segment at most.
    slack : float
        eps, as a multiple of each feature's standard deviation among the samples.
    improver : ReplaySGD
        Improves the network. Its discount is also that of the features.
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
    >>> from robonav.nirl import TabularTask, relative_entropy, terrain
    >>> task = TabularTask(terrain()[1])
    >>> expert = task.demonstrate(np.full((42, 4), 0.25), 20, seed=0)
    >>> relative_entropy(expert, task, n_samples=500, iterations=2).policy.shape
    (42,)
    """
    rng = np.random.default_rng(seed)
    n_actions, discount = task.n_actions, improver.discount
    expert = segment_features(demonstrations, n_actions, discount, horizon)
    random = random_segments(demonstrations, task, n_samples, horizon, rng)
    sums = decision_feature_sums(random, n_actions, discount)
    samples = sums[np.diff(random.trajectory, prepend=-1) > 0]  # of whole segments
    log_ratios = np.zeros(len(samples))  # the sampling policy is the baseline
    eps = slack * samples.std(axis=0)
    found = relative_entropy_weights(
        expert.mean(axis=0), samples, log_ratios, slack=eps
    )
    theta = found.weights.reshape(n_actions, -1)
    return train_under_reward(
        demonstrations, task, theta, improver=improver, seed=rng, **training
    )
