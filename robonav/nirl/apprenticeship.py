"""Apprenticeship learning via inverse reinforcement learning (Abbeel and Ng 2004).

The algorithm alternates between a reward and a policy. It guesses a reward under which the expert does better than all
policies found so far, finds the best policy for this reward, and adds this policy to the list. The feature expectations
of the expert come ever closer to those of a mixture of the policies.

:func:`apprenticeship_learning` is the algorithm. It has two ways to guess a reward: :func:`max_margin_guess` solves a
quadratic program, and :func:`projection_guess` needs none. :func:`apprenticeship` runs it for the robot, where there is
no model and a neural network learns each policy.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import nnls

from robonav.networks import random_network
from robonav.progress import Progress

from ._arguments import checked
from .decisions import Decisions, concatenate
from .feature_expectations import discounted_feature_sums, empirical_expectations
from .features import state_action_features
from .max_margin import maximum_margin, project_to_unit_ball
from .model_selection import Score, balanced_accuracy
from .policy import exploring_policy
from .policy_improvement import ReplaySGD, decision_rewards
from .tasks import Task
from .training import IRLRecorder, IRLResult

Floats = NDArray[np.float64]

Solver = Callable[[Floats], tuple[Any, ArrayLike]]
"""``solve(weights) -> (policy, mu)``: the best policy for the reward theta . f, and its feature expectations (K,)."""

RewardGuess = Callable[[Floats, Sequence[Floats]], tuple[Floats, float]]
"""``guess(expert, found) -> (weights, distance)``: a reward under which the expert does better than the policies found
so far, and the distance of the expert's feature expectations from those of the nearest mixture of these policies."""

PolicyExpectations = Callable[[Decisions, int, float], Floats]
"""``expectations(decisions, n_actions, discount) -> (A (k + 1),)``: estimated feature expectations."""


def project(mean: Floats, found: Floats, expert: Floats) -> Floats:
    """The point nearest to the expert on the segment from ``mean`` to ``found`` (Abbeel and Ng 2004, section 3.1).

    The paper projects onto the whole line through the two points. If ``found`` belongs to the best policy for the
    reward ``expert - mean``, this projection lies on the segment. A learned policy may be worse. The limits of the
    segment then keep the point a mixture of policies.

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
    step = found - mean
    length2 = step @ step
    # 0 at the mean, 1 at the policy found
    share = 0.0 if length2 == 0 else step @ (expert - mean) / length2
    return mean + float(np.clip(share, 0, 1)) * step


def projection_guess(expert: Floats, found: Sequence[Floats]) -> tuple[Floats, float]:
    """The reward of the projection method: the vector from a mixture of the policies found to the expert.

    The mixture begins with the first policy. For each further policy it moves to the point nearest to the expert on the
    segment to this policy.

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
    """The reward of the max-margin method: the one by which the expert leads the policies found by the largest margin.

    Parameters
    ----------
    expert : (K,) array
        Feature expectations of the expert.
    found : sequence of (K,) arrays
        Those of the policies found so far.

    Returns
    -------
    weights : (K,) array
    distance : float
        The margin, see :func:`maximum_margin`.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import max_margin_guess
    >>> max_margin_guess(np.array([3.0, 4.0]), [np.zeros(2)])
    (array([0.6, 0.8]), 5.0)
    """
    solution = maximum_margin(expert, np.stack(found))
    return solution.weights, solution.margin


@checked
def apprenticeship_learning(
    expert: ArrayLike,
    solve: Solver,
    first: tuple[Any, ArrayLike],
    *,
    guess: RewardGuess = projection_guess,
    tolerance: float = 1e-3,
    iterations: int = 50,
) -> Apprenticeship:
    """Apprenticeship learning (Abbeel and Ng 2004, section 3); the numbers are the steps of the paper.

    If the distance falls to ``tolerance``, some mixture of the policies has nearly the expert's feature expectations.
    Under every linear reward with weights of length 1 at most, its value then differs from the expert's by at most
    ``tolerance``.

    Parameters
    ----------
    expert : (K,) array
        Feature expectations mu_E of the expert.
    solve : callable
        ``solve(weights)`` returns the best policy for the reward theta . f, and its feature expectations (K,).
    first : tuple
        A policy to start from, and its feature expectations (K,).
    guess : callable
        :func:`projection_guess`, the projection method, or :func:`max_margin_guess`, the max-margin method.
    tolerance : float
        epsilon: the algorithm ends when the expert is no farther than this from a mixture of the policies found.
    iterations : int
        Policies to find at most.

    Returns
    -------
    Apprenticeship

    Examples
    --------
    >>> from robonav.mdp import policy_iteration
    >>> from robonav.nirl import TRUE_WEIGHTS, apprenticeship_learning, initial_expectations, terrain
    >>> grid, mdp = terrain()
    >>> def solve(weights):
    ...     policy = policy_iteration(mdp.with_reward(weights)).policy
    ...     return policy, initial_expectations(mdp, policy)
    >>> expert = solve(TRUE_WEIGHTS)[1]
    >>> found = apprenticeship_learning(expert, solve, solve(-TRUE_WEIGHTS))
    >>> found.distances[-1] < 0.1 * found.distances[0]
    np.True_
    """
    mu_expert = np.asarray(expert)
    policies, found = [first[0]], [np.asarray(first[1], dtype=float)]  # 1
    rewards: list[Floats] = []
    distances: list[float] = []
    for iteration in range(iterations + 1):
        theta, distance = guess(mu_expert, found)  # 2
        distances.append(distance)
        if distance <= tolerance or iteration == iterations:  # 3
            break
        policy, mu = solve(theta)  # 4 and 5
        rewards.append(theta)
        policies.append(policy)
        found.append(np.asarray(mu, dtype=float))  # 6
    return Apprenticeship(
        policies=tuple(policies),
        expectations=np.stack(found),
        weights=np.array(rewards).reshape(len(rewards), len(mu_expert)),
        distances=np.array(distances),
        expert=mu_expert,
    )


@checked
def nearest_mixture(expert: ArrayLike, found: ArrayLike) -> Floats:
    """The mixture of policies whose feature expectations are nearest to the expert's.

    The probabilities solve a least-squares problem with non-negative unknowns. That they sum to 1 is one more equation
    of this problem, with a weight so large that it holds almost exactly.

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
    large = 1e5
    matrix = np.vstack([gaps.T / scale, np.full(len(gaps), large)])
    target = np.zeros(len(matrix))
    target[-1] = large
    shares, _ = nnls(matrix, target, maxiter=30 * len(gaps) + 100)
    return shares / shares.sum()


def from_initial_state(decisions: Decisions, n_actions: int, discount: float) -> Floats:
    """Feature expectations discounted from the first decision of each episode.

    Uses Eq. (5.13). With the thesis's discount of 0.65, decisions after the first dozen hardly count.

    Parameters
    ----------
    decisions : Decisions
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
    taken = state_action_features(decisions.features, decisions.actions, n_actions)
    if not len(taken):
        return np.zeros(taken.shape[1])
    return empirical_expectations(taken, decisions.trajectory, discount)


def from_all_states(decisions: Decisions, n_actions: int, discount: float) -> Floats:
    """Feature expectations discounted from every decision, and averaged over all decisions.

    All parts of an episode then have equal weight.

    Parameters
    ----------
    decisions : Decisions
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
    taken = state_action_features(decisions.features, decisions.actions, n_actions)
    sums = discounted_feature_sums(taken, decisions.trajectory, discount)
    return sums.mean(axis=0) if len(sums) else np.zeros(sums.shape[1])


@checked
def apprenticeship(
    demonstrations: Decisions,
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
    """Apprenticeship learning (Abbeel and Ng 2004) without a model: a neural network learns the policy of each reward.

    The numbers in the code are the steps of the paper, as in :func:`apprenticeship_learning`. Feature expectations are
    estimated from episodes. The policies differ by one network, which goes on from one reward to the next.

    Parameters
    ----------
    demonstrations : Decisions
        The expert's decisions.
    task : Task
        The task on which the network trains.
    guess : callable
        :func:`projection_guess` or :func:`max_margin_guess`.
    expectations : callable
        :func:`from_all_states`, or :func:`from_initial_state`, which takes the equation literally.
    n_rewards : int
        Rewards to guess at most. The ``iterations`` are divided equally among them, and the network keeps its weights
        from one reward to the next.
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
    rng, eta = np.random.default_rng(seed), inverse_temperature
    n_actions, discount = task.n_actions, improver.discount
    network = random_network((task.n_inputs, hidden, n_actions), seed=rng)
    per_reward = max(iterations // n_rewards, 1)
    total = n_rewards * per_reward
    record = IRLRecorder(demonstrations, task, network, eta, total, progress)
    mu_expert = expectations(demonstrations, n_actions, discount)
    episodes = [task.rollout(exploring_policy(network, eta), rng)]
    found = [expectations(episodes[0], n_actions, discount)]  # 1
    for _ in range(n_rewards):
        weights, distance = guess(mu_expert, found)  # 2
        if distance <= 0:  # 3
            break
        theta = project_to_unit_ball(weights.reshape(n_actions, -1))
        for _ in range(per_reward):  # 4
            pairs = concatenate(episodes[-improver.replay :])
            rewards = decision_rewards(theta, pairs)  # theta . f(s, a)
            fraction = (len(episodes) - 1) / max(total - 1, 1)
            network, cost = improver.descend(network, pairs, rewards, fraction, rng)
            record.add(episodes[-1], theta, network, cost)
            episodes.append(task.rollout(exploring_policy(network, eta), rng))
        found.append(expectations(episodes[-1], n_actions, discount))  # 5, 6
    return record.result(score)


@dataclass(frozen=True, eq=False)
class Apprenticeship:
    """The result of :func:`apprenticeship_learning` after n iterations.

    Attributes
    ----------
    policies : tuple
        n + 1 policies, the initial one first.
    expectations : (n + 1, K) array
        Their feature expectations.
    weights : (n, K) array
        The reward for which each policy after the first is the best one.
    distances : (n + 1,) array
        Distance of the expert's feature expectations from those of the nearest mixture of the first 1, 2, ... policies.
    expert : (K,) array
        The expert's feature expectations.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import apprenticeship_learning
    >>> corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])  # feature expectations of three policies
    >>> solve = lambda weights: ((k := int((corners @ weights).argmax())), corners[k])
    >>> found = apprenticeship_learning([0.5, 0.5], solve, (0, corners[0]), iterations=3)
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
        """Probabilities (n + 1,) of the policies in the mixture nearest to the expert, see :func:`nearest_mixture`."""
        return nearest_mixture(self.expert, self.expectations)
