"""Apprenticeship learning via inverse reinforcement learning (Abbeel and Ng 2004).

Each iteration guesses a reward under which the expert does better than the policies found so far, finds a good policy
for it, and adds this policy to them. The expert's feature expectations come ever closer to a mixture of theirs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import nnls

from robonav.progress import Progress

from ._arguments import checked
from .feature_expectations import discounted_feature_sums, empirical_expectations
from .features import state_action_features
from .max_margin import maximum_margin
from .model_selection import Score, balanced_accuracy
from .policy_improvement import ReplaySGD
from .tasks import Task
from .trainer import IRLResult, Trainer
from .transitions import Transitions

Floats = NDArray[np.float64]

Solver = Callable[[Floats], tuple[Any, ArrayLike]]
"""``solve(weights) -> (policy, mu)``: the best policy for the reward theta . f, and its feature expectations (K,)."""

RewardGuess = Callable[[Floats, Sequence[Floats]], tuple[Floats, float]]
"""``guess(expert, found) -> (weights, distance)``: a reward under which the expert beats the policies found so far, and
how far the expert is from what they reach."""

PolicyExpectations = Callable[[Transitions, int, float], Floats]
"""``expectations(transitions, n_actions, discount) -> (A (k + 1),)``: feature expectations of whoever decided."""


@dataclass(frozen=True, eq=False)
class Apprenticeship:
    """The policies found in n iterations, and the first one.

    Attributes
    ----------
    policies : tuple
        n + 1 of them; the first is the one started from.
    expectations : (n + 1, K) array
        Their feature expectations.
    weights : (n, K) array
        The reward that each policy after the first is best for.
    distances : (n + 1,) array
        Distance of the expert, in feature expectations, from what the first 1, 2, ... policies reach.
    expert : (K,) array
        The expert's feature expectations.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import projection_method
    >>> corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    >>> solve = lambda weights: ((k := int((corners @ weights).argmax())), corners[k])
    >>> found = projection_method([0.5, 0.5], solve, (0, corners[0]), iterations=3)
    >>> found.mixture.round(2)[:3]
    array([0. , 0.5, 0.5])
    """

    policies: tuple[Any, ...]
    expectations: Floats
    weights: Floats
    distances: Floats
    expert: Floats

    @property
    def closest(self) -> int:
        """The policy whose feature expectations are nearest to the expert's."""
        return int(np.linalg.norm(self.expectations - self.expert, axis=1).argmin())

    @property
    def mixture(self) -> Floats:
        """(n + 1,) probabilities of the policies with which their mixture comes nearest to the expert."""
        return nearest_mixture(self.expert, self.expectations)


def project(mean: Floats, found: Floats, expert: Floats) -> Floats:
    """The point nearest to the expert on the segment from ``mean`` to ``found`` (Abbeel and Ng 2004, section 3.1).

    The segment ends at ``found``, so that the point remains a mixture of policies. If ``found`` belongs to the best
    policy for the reward ``expert - mean``, the nearest point of the whole line lies on it anyway; a learned policy may
    be worse.

    Parameters
    ----------
    mean, found, expert : (K,) array
        Feature expectations.

    Returns
    -------
    (K,) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import project
    >>> project(np.array([0.0, 0.0]), np.array([2.0, 0.0]), np.array([1.0, 1.0]))
    array([1., 0.])
    """
    along = found - mean
    length2 = along @ along
    share = 0.0 if length2 == 0 else along @ (expert - mean) / length2
    return mean + float(np.clip(share, 0, 1)) * along


def projection_guess(expert: Floats, found: Sequence[Floats]) -> tuple[Floats, float]:
    """The reward of the projection method: the vector to the expert from its projection onto the policies found.

    Parameters
    ----------
    expert : (K,) array
        Feature expectations of the expert.
    found : sequence of (K,) arrays
        Those of the policies found so far, in order.

    Returns
    -------
    weights : (K,) array
    distance : float
        The length of the weights.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import projection_guess
    >>> projection_guess(np.array([1.0, 1.0]), [np.array([0.0, 0.0]), np.array([2.0, 0.0])])
    (array([0., 1.]), 1.0)
    """
    mean = found[0]
    for mu in found[1:]:
        mean = project(mean, mu, expert)
    weights = expert - mean
    return weights, float(np.linalg.norm(weights))


def max_margin_guess(expert: Floats, found: Sequence[Floats]) -> tuple[Floats, float]:
    """The reward of the max-margin method, by :func:`maximum_margin`, and the margin.

    Parameters
    ----------
    expert : (K,) array
        Feature expectations of the expert.
    found : sequence of (K,) arrays
        Those of the policies found so far.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import max_margin_guess
    >>> max_margin_guess(np.array([3.0, 4.0]), [np.zeros(2)])
    (array([0.6, 0.8]), 5.0)
    """
    widest = maximum_margin(expert, np.stack(found))
    return widest.weights, widest.margin


@checked
def nearest_mixture(expert: ArrayLike, found: ArrayLike) -> Floats:
    """The mixture of policies whose feature expectations are nearest to the expert's.

    It is a non-negative least-squares problem; one heavily weighted equation makes the probabilities sum to 1.

    Parameters
    ----------
    expert : (K,) array
        mu_E.
    found : (n, K) array
        mu of n policies.

    Returns
    -------
    (n,) array
        Probabilities.

    Examples
    --------
    >>> from robonav.nirl import nearest_mixture
    >>> nearest_mixture([0.25], [[0.0], [1.0]]).round(2)
    array([0.75, 0.25])
    """
    gaps = np.asarray(found) - np.asarray(expert)
    scale = max(abs(gaps).max(), np.finfo(float).tiny)
    heavy = 1e5
    matrix = np.vstack([gaps.T / scale, np.full(len(gaps), heavy)])
    target = np.zeros(len(matrix))
    target[-1] = heavy
    shares, _ = nnls(matrix, target, maxiter=30 * len(gaps) + 100)
    return shares / shares.sum()


@checked
def projection_method(
    expert: ArrayLike,
    solve: Solver,
    first: tuple[Any, ArrayLike],
    *,
    tolerance: float = 1e-3,
    iterations: int = 50,
    progress: Progress | None = None,
) -> Apprenticeship:
    """Apprenticeship learning by the projection method (Abbeel and Ng 2004, section 3.1): no quadratic program.

    Parameters
    ----------
    expert : (K,) array
        Feature expectations mu_E.
    solve : callable
        ``solve(weights)`` returns the best policy for the reward theta . f, and its feature expectations (K,).
    first : tuple
        A policy to start from, and its feature expectations (K,).
    tolerance : float
        epsilon: ends when the expert is no farther than this from the projection.
    iterations : int
        Policies to find at most.
    progress : callable, optional
        Called as ``progress(done, iterations)``.

    Returns
    -------
    Apprenticeship

    Examples
    --------
    >>> from robonav.mdp import policy_iteration
    >>> from robonav.nirl import TRUE_WEIGHTS, initial_expectations, projection_method, terrain
    >>> grid, mdp = terrain()
    >>> def solve(weights):
    ...     policy = policy_iteration(mdp.with_reward(weights)).policy
    ...     return policy, initial_expectations(mdp, policy)
    >>> expert = solve(TRUE_WEIGHTS)[1]
    >>> found = projection_method(expert, solve, solve(-TRUE_WEIGHTS))
    >>> found.distances[-1] < 0.1 * found.distances[0]
    np.True_
    """
    return _apprentice(expert, solve, first, projection_guess, tolerance, iterations, progress)  # fmt: skip


@checked
def max_margin_method(
    expert: ArrayLike,
    solve: Solver,
    first: tuple[Any, ArrayLike],
    *,
    tolerance: float = 1e-3,
    iterations: int = 50,
    progress: Progress | None = None,
) -> Apprenticeship:
    """Apprenticeship learning by the max-margin method (Abbeel and Ng 2004, section 3).

    Parameters
    ----------
    expert, solve, first, tolerance, iterations, progress
        As in :func:`projection_method`.

    Returns
    -------
    Apprenticeship

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import max_margin_method
    >>> corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    >>> solve = lambda weights: ((k := int((corners @ weights).argmax())), corners[k])
    >>> max_margin_method([0.5, 0.5], solve, (0, corners[0])).policies
    (0, 1, 2)
    """
    return _apprentice(expert, solve, first, max_margin_guess, tolerance, iterations, progress)  # fmt: skip


def _apprentice(
    expert: Any,
    solve: Solver,
    first: tuple[Any, ArrayLike],
    guess: RewardGuess,
    tolerance: float,
    iterations: int,
    progress: Progress | None,
) -> Apprenticeship:
    """Guess a reward, find the best policy for it, and repeat until the expert is near a mixture of the policies."""
    policies, found = [first[0]], [np.asarray(first[1], dtype=float)]
    weights: list[Floats] = []
    distances: list[float] = []
    while True:
        theta, distance = guess(expert, found)
        distances.append(distance)
        if distance <= tolerance or len(weights) == iterations:
            break
        policy, mu = solve(theta)
        weights.append(theta)
        policies.append(policy)
        found.append(np.asarray(mu, dtype=float))
        if progress is not None:
            progress(len(weights), iterations)
    rewards = np.array(weights).reshape(len(weights), len(expert))
    return Apprenticeship(
        tuple(policies), np.stack(found), rewards, np.array(distances), expert
    )


def from_initial_state(
    transitions: Transitions, n_actions: int, discount: float
) -> Floats:
    """Feature expectations discounted from the first decision of each episode on.

    This is Eq. (5.13). With the thesis's discount, what happens a dozen decisions later hardly counts.

    Parameters
    ----------
    transitions : Transitions
        M decisions; if there is none, the expectations are zero.
    n_actions : int
        A.
    discount : float
        gamma.

    Returns
    -------
    (A (k + 1),) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, from_initial_state, terrain
    >>> task = TabularTask(terrain()[1], max_steps=2)
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> from_initial_state(expert, 4, 0.5).sum()  # a feature and the constant, at two steps
    np.float64(3.0)
    """
    taken = state_action_features(transitions.features, transitions.actions, n_actions)
    if not len(taken):
        return np.zeros(taken.shape[1])
    return empirical_expectations(taken, transitions.trajectory, discount)


def from_all_states(
    transitions: Transitions, n_actions: int, discount: float
) -> Floats:
    """Feature expectations discounted from every decision, and averaged over all of them.

    Every part of an episode then has the same weight.

    Parameters
    ----------
    transitions : Transitions
        M decisions; if there is none, the expectations are zero.
    n_actions : int
        A.
    discount : float
        gamma.

    Returns
    -------
    (A (k + 1),) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, from_all_states, terrain
    >>> task = TabularTask(terrain()[1], max_steps=2)
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> from_all_states(expert, 4, 0.5).sum()  # the mean of 3 and 2
    np.float64(2.5)
    """
    taken = state_action_features(transitions.features, transitions.actions, n_actions)
    sums = discounted_feature_sums(taken, transitions.trajectory, discount)
    return sums.mean(axis=0) if len(sums) else np.zeros(sums.shape[1])


@checked
def apprenticeship(
    demonstrations: Transitions,
    task: Task,
    *,
    guess: RewardGuess = projection_guess,
    expectations: PolicyExpectations = from_all_states,
    n_rewards: int = 14,
    iterations: int = 140,
    hidden: int = 10,
    inverse_temperature: float = 25.0,
    improver: ReplaySGD = ReplaySGD(),  # noqa: B008 - frozen
    score: Score = balanced_accuracy,
    seed: int | np.random.Generator = 0,
    progress: Progress | None = None,
) -> IRLResult:
    """Apprenticeship learning (Abbeel and Ng 2004) with a neural policy: a policy is learned for each reward.

    Parameters
    ----------
    demonstrations : Transitions
        The expert's decisions.
    task : Task
        Where the learner practises.
    guess : callable
        :func:`projection_guess` or :func:`max_margin_guess`.
    expectations : callable
        :func:`from_all_states`, or :func:`from_initial_state`, which takes the equation literally.
    n_rewards : int
        Rewards tried. They share the ``iterations``; the network goes on learning from one reward to the next.
    iterations, hidden, inverse_temperature, score, seed, progress
        As in :func:`nirl`.
    improver : ReplaySGD
        Improves the network; its discount is that of the feature expectations.

    Returns
    -------
    IRLResult

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, apprenticeship, terrain
    >>> task = TabularTask(terrain()[1])
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> len(apprenticeship(expert, task, n_rewards=2, iterations=4).history.costs)
    4
    """
    rng = np.random.default_rng(seed)
    trainer = Trainer(demonstrations, task, hidden, inverse_temperature, improver, rng)
    iterations_per_reward = max(iterations // n_rewards, 1)
    total, done = n_rewards * iterations_per_reward, 0
    expert = expectations(demonstrations, task.n_actions, improver.discount)
    trainer.rollout()
    found: list[Floats] = []
    for _ in range(n_rewards):
        latest = trainer.episodes[-1]
        mu = expectations(latest, task.n_actions, improver.discount)
        found.append(mu)
        weights, distance = guess(expert, found)
        if distance <= 0:
            break  # the expert is a mixture of the policies found
        theta = weights.reshape(task.n_actions, -1)
        for _ in range(iterations_per_reward):
            trainer.improve(theta, fraction=min(done / max(total - 1, 1), 1.0))
            trainer.rollout()
            done += 1
            if progress is not None:
                progress(done, total)
    return trainer.result(score)
