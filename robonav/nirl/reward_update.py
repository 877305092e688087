"""From what the expert did to a reward: the step of Algorithm 10 that the thesis leaves open, in two readings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robonav.validation import check_real

from .feature_expectations import discounted_feature_sums
from .features import state_action_features
from .max_margin import project_to_unit_ball
from .transitions import Floats, Steps


def balance(actions: NDArray[np.int64], count: int, *, power: float = 1.0) -> Floats:
    """Weights (M,), with sum 1, of decisions: the frequency of each one's action to the power ``-power``.

    1 makes all actions that occur count alike, 0 all decisions.
    """
    frequency = np.bincount(actions, minlength=count) / max(len(actions), 1)
    weights = frequency[actions] ** -check_real("power", power, at_least=0)
    return weights / weights.sum()


def contrast(shown: Steps, chances: Floats, weights: Floats) -> Floats:
    """By how much the expert has more of each feature than a policy in the same states, (A, k + 1).

    sum_t w_t [f(s_t, a_t) - sum_a pi(a | s_t) f(s_t, a)] over the expert's states s_t. The two are compared where
    the expert was, one decision at a time; what a decision leads to is the business of the policy iteration.

    Parameters
    ----------
    shown : M decisions of the expert.
    chances : pi(a | s_t), (M, A).
    weights : w_t, (M,).
    """
    apart = np.eye(chances.shape[1])[shown.actions] - chances
    return (weights[:, None] * apart).T @ shown.features


@dataclass(frozen=True)
class SubgradientMaxMargin:
    """Max-margin by subgradient steps: theta gathers the contrasts to one policy after the other.

    The margin sum_t w_t [r(s_t, a_t) - sum_a pi(a | s_t) r(s_t, a)] is linear in theta, with :func:`contrast` as its
    gradient. Each new policy is the rival that the next step is taken against, the i-th step 1 / sqrt(i) long
    (Ratliff et al. 2006). How long theta is does not matter to what follows, so it is not shortened on the way.

    Attributes
    ----------
    power : how far rare actions are made up for, see :func:`balance`. More than half of what experts do is to go
        forward; unbalanced, that is what there is to learn.
    """

    power: float = 1.0

    def __call__(
        self,
        shown: Steps,
        chances: Floats,
        values: Floats,
        before: Floats,
        iteration: int,
    ) -> Floats:
        """Theta (A, k + 1) after ``iteration`` (from 1); arguments as in ``RewardRule``."""
        weights = balance(shown.actions, chances.shape[1], power=self.power)
        return before + contrast(shown, chances, weights) / np.sqrt(iteration)


@dataclass(frozen=True)
class LeastSquaresReward:
    """Eq. (5.14) to the letter: the theta in the unit ball that minimises it.

    J(theta) = mean_t (theta . mu_E(s_t, a_t) - Q(s_t, a_t))^2 + lambda ||theta||, with mu_E the discounted features of
    the rest of the expert's drive, and Q what the learner's network says, which does not depend on theta. So the reward
    is fitted to what the learner believes already. Projected gradient descent finds it.

    Attributes
    ----------
    discount, ridge : gamma and lambda.
    steps : of descent.
    """

    discount: float = 0.65
    ridge: float = 1e-3
    steps: int = 200

    def __call__(
        self,
        shown: Steps,
        chances: Floats,
        values: Floats,
        before: Floats,
        iteration: int,
    ) -> Floats:
        """Theta (A, k + 1); arguments as in ``RewardRule``."""
        actions = values.shape[1]
        mu = discounted_feature_sums(
            state_action_features(shown.features, shown.actions, actions),
            shown.trajectory,
            self.discount,
        )
        q = values[np.arange(len(shown)), shown.actions]
        theta = np.zeros(mu.shape[1])
        rate = 0.5 / max(float(np.linalg.norm(mu.T @ mu / len(mu), 2)), 1e-12)
        for _ in range(self.steps):
            slope = 2 * mu.T @ (mu @ theta - q) / len(mu)
            length = np.linalg.norm(theta)
            theta = project_to_unit_ball(
                theta
                - rate * (slope + (self.ridge / length * theta if length > 0 else 0.0))
            )
        return theta.reshape(actions, -1)
