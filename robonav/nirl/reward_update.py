"""Line 5 of Algorithm 10: a reward from the expert's decisions and the latest policy, by two methods.

:class:`LeastSquaresReward` is what the thesis prints. :class:`SubgradientMaxMargin` is what :func:`nirl` uses.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robonav.validation import check_integer, check_real

from .decisions import Decisions, Floats
from .feature_expectations import decision_feature_sums
from .max_margin import project_to_unit_ball


class RewardUpdate(Protocol):
    """Line 5 of NIRL: a reward from the expert's decisions and the latest policy."""

    def __call__(
        self,
        demonstrations: Decisions,
        action_probabilities: Floats,
        action_values: Floats,
        weights: Floats,
        iteration: int,
    ) -> Floats:
        """theta (A, k + 1) of any length.

        Parameters
        ----------
        demonstrations : Decisions
            M decisions of the expert.
        action_probabilities : (M, A) array
            pi(a | s_t) of the latest policy in the expert's states.
        action_values : (M, A) array
            Outputs of its network there.
        weights : (A, k + 1) array
            theta of the last iteration.
        iteration : int
            Number of this iteration, from 1.
        """


def inverse_frequency_weights(
    actions: NDArray[np.int64], n_actions: int, *, power: float = 1.0
) -> Floats:
    """Weights of decisions, with sum 1: the frequency of each decision's action to the power ``-power``.

    With power 1 all actions that occur have the same total weight. With power 0 all decisions have the same weight.

    Parameters
    ----------
    actions : (M,) array of int
    n_actions : int
        A.
    power : float
        At least 0.

    Returns
    -------
    (M,) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import inverse_frequency_weights
    >>> inverse_frequency_weights(np.array([0, 0, 0, 1]), 2).round(3)
    array([0.167, 0.167, 0.167, 0.5  ])
    """
    frequency = np.bincount(actions, minlength=n_actions) / max(len(actions), 1)
    weights = frequency[actions] ** -power
    return weights / weights.sum()


def feature_gap(
    demonstrations: Decisions, action_probabilities: Floats, step_weights: Floats
) -> Floats:
    """The expert's features minus a policy's in the same states: sum_t w_t [f(s_t, a_t) - sum_a pi(a | s_t) f(s_t, a)].

    The function compares single decisions, in the expert's states. The consequences of a decision enter later, when the
    policy is improved for the reward.

    Parameters
    ----------
    demonstrations : Decisions
        M decisions of the expert.
    action_probabilities : (M, A) array
        pi(a | s_t).
    step_weights : (M,) array
        w_t.

    Returns
    -------
    (A, k + 1) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import Decisions, feature_gap
    >>> nothing = np.zeros(1, dtype=int)
    >>> left = Decisions(np.array([[2.0]]), nothing, nothing, nothing, nothing, nothing)
    >>> feature_gap(left, np.array([[0.5, 0.5]]), np.ones(1))
    array([[ 1. ,  0.5],
           [-1. , -0.5]])
    """
    taken = np.eye(action_probabilities.shape[1])[demonstrations.actions]
    difference = taken - action_probabilities
    return (step_weights[:, None] * difference).T @ demonstrations.features


def expert_margin(
    demonstrations: Decisions, action_probabilities: Floats, theta: Floats
) -> float:
    """By how much a reward prefers the expert's decisions to a policy's: theta . gap, see :func:`feature_gap`.

    All actions that the expert took have the same total weight.

    Parameters
    ----------
    demonstrations : Decisions
        M decisions of the expert.
    action_probabilities : (M, A) array
        pi(a | s_t) of the policy.
    theta : (A, k + 1) array
        Weights of the reward.

    Returns
    -------
    float

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import Decisions, expert_margin
    >>> nothing = np.zeros(1, dtype=int)
    >>> left = Decisions(np.array([[2.0]]), nothing, nothing, nothing, nothing, nothing)
    >>> expert_margin(left, np.array([[0.5, 0.5]]), np.array([[1.0, 0.0], [0.0, 0.0]]))
    1.0
    """
    step_weights = inverse_frequency_weights(
        demonstrations.actions, action_probabilities.shape[1]
    )
    gap = feature_gap(demonstrations, action_probabilities, step_weights)
    return float((theta * gap).sum())


@dataclass(frozen=True)
class SubgradientMaxMargin:
    """Maximum margin by subgradient steps, one for each new policy (Ratliff et al. 2006).

    The margin sum_t w_t [r(s_t, a_t) - sum_a pi(a | s_t) r(s_t, a)] between the expert and a policy is linear in theta,
    and :func:`feature_gap` is its gradient. Iteration i adds 1 / sqrt(i) times the gradient for the latest policy.
    Later steps use theta scaled to length 1 at most, so its length is not limited here.

    Attributes
    ----------
    power : float
        How much more rare actions count, see :func:`inverse_frequency_weights`. With 0 all decisions count equally, and
        the reward mainly says to go forward, since most decisions are that.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import SubgradientMaxMargin, Decisions
    >>> nothing = np.zeros(1, dtype=int)
    >>> left = Decisions(np.array([[2.0]]), nothing, nothing, nothing, nothing, nothing)
    >>> half = np.array([[0.5, 0.5]])
    >>> SubgradientMaxMargin()(left, half, half, np.zeros((2, 2)), 1)
    array([[ 1. ,  0.5],
           [-1. , -0.5]])
    """

    power: float = 1.0

    def __post_init__(self) -> None:
        check_real("power", self.power, at_least=0)

    def __call__(
        self,
        demonstrations: Decisions,
        action_probabilities: Floats,
        action_values: Floats,
        weights: Floats,
        iteration: int,
    ) -> Floats:
        """theta (A, k + 1) after this iteration; parameters as in ``RewardUpdate``."""
        step_weights = inverse_frequency_weights(
            demonstrations.actions, action_probabilities.shape[1], power=self.power
        )
        gap = feature_gap(demonstrations, action_probabilities, step_weights)
        return weights + gap / np.sqrt(iteration)


def least_squares_objective(
    theta: Floats, mu: Floats, q: Floats, regularisation: float
) -> tuple[float, Floats]:
    """The thesis's objective J(theta), with a mean in place of its sum, and its gradient, Eq. (5.14).

    Parameters
    ----------
    theta : (K,) array
        Weights of the reward.
    mu : (M, K) array
        mu_E(s_t, a_t): the discounted features of the expert from each of its M decisions on.
    q : (M,) array
        Q(s_t, a_t): the values that the learner's network gives these decisions.
    regularisation : float
        lambda.

    Returns
    -------
    J : float
    gradient : (K,) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl.reward_update import least_squares_objective
    >>> least_squares_objective(np.array([1.0]), np.array([[3.0], [2.0]]), np.ones(2), regularisation=0.5)
    (3.0, array([8.5]))
    """
    difference = mu @ theta - q  # (M,): the expert's value minus the learner's
    length = float(np.linalg.norm(theta))
    J = (difference**2).mean() + regularisation * length  # Eq. (5.14)
    gradient = 2 * mu.T @ difference / len(mu)
    if length > 0:
        gradient = gradient + regularisation / length * theta
    return float(J), gradient


@dataclass(frozen=True)
class LeastSquaresReward:
    """The thesis's objective taken literally: least squares between the expert's values and the network's.

    J(theta) = mean_t (theta . mu_E(s_t, a_t) - Q(s_t, a_t))^2 + lambda ||theta|| is minimised over the unit ball by
    projected gradient descent. mu_E(s_t, a_t) are the discounted features from step t to the end of the expert's
    episode. Q is the output of the learner's network, which does not depend on theta. The reward is therefore fitted to
    the values that the learner already has.

    Attributes
    ----------
    discount, regularisation : float
        gamma and lambda.
    iterations : int
        Iterations of the descent.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import LeastSquaresReward, Decisions
    >>> nothing = np.zeros(1, dtype=int)
    >>> left = Decisions(np.array([[0.0]]), nothing, nothing, nothing, nothing, nothing)
    >>> half = np.array([[0.5, 0.5]])
    >>> LeastSquaresReward(regularisation=0.0)(left, half, half, np.zeros((2, 2)), 1)
    array([[0. , 0.5],
           [0. , 0. ]])
    """

    discount: float = 0.65
    regularisation: float = 1e-3
    iterations: int = 200

    def __post_init__(self) -> None:
        check_real("discount", self.discount, at_least=0, at_most=1)
        check_real("regularisation", self.regularisation, at_least=0)
        check_integer("iterations", self.iterations, at_least=1)

    def __call__(
        self,
        demonstrations: Decisions,
        action_probabilities: Floats,
        action_values: Floats,
        weights: Floats,
        iteration: int,
    ) -> Floats:
        """theta (A, k + 1) that minimises ``least_squares_objective`` in the unit ball."""
        actions, n_actions = demonstrations.actions, action_values.shape[1]
        mu = decision_feature_sums(demonstrations, n_actions, self.discount)
        q = action_values[np.arange(len(actions)), actions]
        theta = np.zeros(mu.shape[1])
        curvature = float(np.linalg.norm(mu.T @ mu / len(mu), 2))
        step = 0.5 / max(curvature, 1e-12)  # no larger, or the descent diverges
        for _ in range(self.iterations):
            _, gradient = least_squares_objective(theta, mu, q, self.regularisation)
            theta = project_to_unit_ball(theta - step * gradient)
        return theta.reshape(n_actions, -1)
