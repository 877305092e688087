"""Apprenticeship learning via inverse reinforcement learning (Abbeel and Ng 2004).

The reward is linear in features f of state and action (the paper has features phi of the state), with unknown weights
theta. Then the value of a policy is linear in its *feature expectations* mu:

    R(s, a) = theta . f(s, a),      ||theta|| <= 1
    mu(pi)  = E[ sum over t of gamma^t f(s_t, a_t) ]
    V(pi)   = E[ sum over t of gamma^t R(s_t, a_t) ] = theta . mu(pi).

So a policy whose mu lies within epsilon of the expert's mu_E has nearly the expert's value, whatever theta is:

    |V(pi_E) - V(pi)| = |theta . (mu_E - mu(pi))| <= ||theta|| ||mu_E - mu(pi)|| <= epsilon.

The algorithm looks for such a policy, and it alternates between a reward and a policy. It guesses a reward under which
the expert does better than all policies found so far, finds the best policy for this reward, and adds it to the list.
What comes near the expert is a mixture of the policies: one of them, drawn at the start of each episode. The paper has
two ways to guess the reward from mu_E and the mu_j of the policies found so far:

    max-margin    max over theta, t of t    subject to  theta . (mu_E - mu_j) >= t for all j,  ||theta|| <= 1
    projection    theta = mu_E - mean,      where the mean of a mixture moves with each new policy, mean +=
                  lambda (mu_j - mean), to the point nearest to mu_E on the segment from the mean to mu_j.

:func:`apprenticeship_learning` is the algorithm, :func:`max_margin_guess` and :func:`projection_guess` are the two
ways. ``robot_apprenticeship.py`` is the same for the robot, where there is no model.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from robonav.validation import ArrayArgument

from ._arguments import checked
from .max_margin import maximum_margin

Floats = NDArray[np.float64]

Solver = Callable[[Floats], tuple[Any, Floats]]
"""``solve(weights) -> (policy, mu)``: the best policy for the reward theta . f, and its feature expectations (K,)."""

RewardGuess = Callable[[Floats, Sequence[Floats]], tuple[Floats, float]]
"""``guess(expert, found) -> (weights, distance)``: a reward under which the expert does better than the policies found
so far, and the distance of the expert's feature expectations from those of a mixture of these policies."""


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
        The length of the weights: the distance of the expert from this mixture. The nearest of all mixtures may be
        nearer.

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
        The margin, see :func:`maximum_margin`. It is the distance of the expert from the nearest of all mixtures.

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
    expert: ArrayArgument,
    solve: Solver,
    first: tuple[Any, ArrayArgument],
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
        epsilon: the algorithm ends when the expert is no farther than this from the guess's mixture of the policies.
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
    policies, found, guesses = [first[0]], [first[1]], []  # 1
    for iteration in range(iterations + 1):
        guesses.append(guess(expert, found))  # 2: from mu_E and all mu_j
        theta, distance = guesses[-1]
        if distance <= tolerance or iteration == iterations:  # 3
            break
        policy, mu = solve(theta)  # 4: the best policy for theta . f, and 5: its mu
        policies.append(policy)
        found.append(mu)  # 6
    return apprenticeship_of(expert, policies, found, guesses)


def apprenticeship_of(
    expert: Floats,
    policies: Sequence[Any],
    found: Sequence[Floats],
    guesses: Sequence[tuple[Floats, float]],
) -> Apprenticeship:
    """The result of n + 1 policies, their feature expectations, and the guess after each of them."""
    rewards = [weights for weights, _ in guesses[: len(policies) - 1]]
    return Apprenticeship(
        policies=tuple(policies),
        expectations=np.stack(found),
        weights=np.array(rewards).reshape(len(rewards), len(expert)),
        distances=np.array([distance for _, distance in guesses]),
        expert=expert,
    )


@checked
def nearest_mixture(expert: ArrayArgument, found: ArrayArgument) -> Floats:
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
    gaps = found - expert
    scale = max(abs(gaps).max(), np.finfo(float).tiny)
    large = 1e5
    matrix = np.vstack([gaps.T / scale, np.full(len(gaps), large)])
    target = np.zeros(len(matrix))
    target[-1] = large
    shares, _ = nnls(matrix, target, maxiter=30 * len(gaps) + 100)
    return shares / shares.sum()


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
        Distance of the expert's feature expectations from those of a mixture of the first 1, 2, ... policies: with
        :func:`max_margin_guess` the nearest mixture, with :func:`projection_guess` the one that it keeps, which is at
        least as far.
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
