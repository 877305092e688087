"""Neural policy iteration: a network learns the values of its own actions under a reward (section 5.5.3)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from robonav.networks.multilayer_perceptron import (
    Network,
    cross_entropy_gradient,
    gradient_descent_step,
)
from robonav.validation import ArrayArgument, check_integer, check_positive, check_real

from ._arguments import checked
from .decisions import Decisions, Floats, Ints
from .policy import neural_action_values

SURVIVAL_BONUS = (0.0, 1.0)
"""Terminal value 0 after a collision and 1 after any other end. It rewards survival, whatever the reward is."""
ZERO_TERMINAL_VALUES = (0.0, 0.0)
"""Terminal value 0 after every end. If no reward is negative, it also rewards survival: a longer episode earns more."""
NEUTRAL_TERMINAL_VALUES = (0.5, 0.5)
"""Terminal value 1/2 after every end: what the reward 1/2, the middle of [0, 1], would earn forever. It rewards no
end of an episode more than another."""


class Improved(NamedTuple):
    """The network after an improvement, and the mean cost during it."""

    network: Network
    cost: float


class Improver(Protocol):
    """Lines 9 and 10 of NIRL: SARSA targets for the rewards of decisions, and gradient steps towards them."""

    @property
    def replay(self) -> int:
        """How many of the latest iterations the network trains with."""

    def improve(
        self,
        network: Network,
        decisions: Decisions,
        rewards: Floats,
        fraction: float,
        rng: np.random.Generator,
    ) -> Improved:
        """The network after its gradient steps.

        Parameters
        ----------
        network : Network
            The latest.
        decisions : Decisions
            M decisions of the last ``replay`` iterations.
        rewards : (M,) array
            Their rewards.
        fraction : float
            How much of the training is over, from 0 to 1.
        rng : Generator
            Of all random numbers.
        """


def decision_rewards(weights: ArrayLike, decisions: Decisions) -> Floats:
    """Rewards r(s_t, a_t) = theta . f(s_t, a_t) of decisions.

    Uses Eq. (5.2). By Eq. (5.5) only the block of the action taken is not zero, so the reward is theta_a . phi(s).

    Parameters
    ----------
    weights : (A, k + 1) array
        theta, one row for each action.
    decisions : Decisions
        M decisions.

    Returns
    -------
    (M,) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import Decisions, decision_rewards
    >>> nothing = np.zeros(1, dtype=int)
    >>> one = Decisions(np.array([[2.0]]), nothing, nothing, nothing, nothing, nothing)
    >>> decision_rewards([[3.0, 1.0]], one)
    array([7.])
    """
    theta = np.take(weights, decisions.actions, axis=0)  # (M, k + 1)
    return np.einsum("mk,mk->m", decisions.features, theta)


def scale_to_unit_interval(rewards: ArrayLike, *, percentile: float = 95.0) -> Floats:
    """Map rewards into [0, 1]: divide by a percentile of their absolute values, clip to [-1, 1], then map 0 to 1/2.

    Apart from the clipping this map is affine and increasing. With neutral terminal values it therefore leaves the
    order of the policies as it is. If all rewards are zero, all become 1/2.

    Parameters
    ----------
    rewards : (M,) array
    percentile : float
        A reward whose absolute value is this percentile becomes 0 or 1.

    Returns
    -------
    (M,) array

    Examples
    --------
    >>> from robonav.nirl import scale_to_unit_interval
    >>> scale_to_unit_interval([-2.0, 0.0, 1.0], percentile=100)
    array([0.  , 0.5 , 0.75])
    """
    scale = np.percentile(np.abs(rewards), percentile) if np.size(rewards) else 0.0
    if scale == 0:
        return np.full(np.shape(rewards), 0.5)
    return (np.clip(np.divide(rewards, scale), -1, 1) + 1) / 2


@checked
def sarsa_targets(
    q: ArrayArgument,
    rewards: ArrayArgument,
    next_q: ArrayArgument,
    *,
    learning_rate: float,
    discount: float,
) -> Floats:
    """Targets of the network's outputs by SARSA, Eq. (5.16).

    Parameters
    ----------
    q : (M,) array
        Q(s_t, a_t), values of the actions taken.
    rewards : (M,) array
        r_theta(s_t, a_t).
    next_q : (M,) array
        Q(s_t+1, a_t+1), or the terminal value where an episode ended.
    learning_rate : float
        alpha.
    discount : float
        gamma.

    Returns
    -------
    (M,) array

    Raises
    ------
    ValueError, TypeError
        If the arrays differ in shape, or the learning rate or the discount is not between 0 and 1.

    Examples
    --------
    >>> from robonav.nirl import sarsa_targets
    >>> sarsa_targets([0.5], [1.0], [0.4], learning_rate=0.8, discount=0.65).round(3)
    array([1.108])
    """
    return q + learning_rate * (rewards + discount * next_q - q)  # Eq. (5.16)


def policy_cost(
    network: Network,
    inputs: Floats,
    targets: Floats,
    *,
    regularisation: float = 0.0,
) -> float:
    """Cost of the neural policy: cross-entropy of its outputs, plus weight decay, Eq. (5.15).

    With z the weighted sum whose sigmoid is Q, -t log Q - (1 - t) log(1 - Q) is log(1 + exp(z)) - t z. This form never
    takes the logarithm of zero.

    Parameters
    ----------
    network : Network
    inputs : (N, k) array
    targets : (N, A) array
        Between 0 and 1.
    regularisation : float
        lambda.

    Returns
    -------
    float

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import random_network
    >>> from robonav.nirl import policy_cost
    >>> round(policy_cost(random_network((2, 3, 1), seed=0, spread=1e-9), np.zeros((1, 2)), np.ones((1, 1))), 3)
    0.693
    """
    z = network.logits(inputs)
    error = (np.logaddexp(0, z) - targets * z).sum()
    decay = sum(float((weight**2).sum()) for weight in network.weights)
    return float((error + regularisation / 2 * decay) / len(inputs))  # Eq. (5.15)


@dataclass(frozen=True)
class ReplaySGD:
    """Many gradient steps in each iteration, each on one decision drawn from the episodes of the last iterations.

    The network's output stands for y = (1 - gamma) Q. If the rewards lie in [0, 1], so does y, and no target has to be
    clipped. The target of Eq. (5.16) becomes y + alpha [(1 - gamma) r + gamma y' - y].

    Attributes
    ----------
    discount : float
        gamma, at least 0 and below 1.
    learning_rate : float
        alpha, above 0 and at most 1.
    gradient_step : tuple of float
        sigma in the first and in the last iteration; it changes by the same factor in each.
    n_samples : int
        Decisions drawn in an iteration.
    replay : int
        Number of latest iterations from whose episodes they are drawn.
    terminal_values : tuple of float
        Future value y after a collision and after any other end, in [0, 1]: ``SURVIVAL_BONUS``,
        ``ZERO_TERMINAL_VALUES`` or ``NEUTRAL_TERMINAL_VALUES``.

    Examples
    --------
    >>> from robonav.nirl import ReplaySGD
    >>> ReplaySGD(discount=0.9, n_samples=300).replay
    20
    """

    discount: float = 0.65
    learning_rate: float = 0.8
    gradient_step: tuple[float, float] = (0.4, 0.1)
    n_samples: int = 9600
    replay: int = 20
    terminal_values: tuple[float, float] = SURVIVAL_BONUS

    def __post_init__(self) -> None:
        check_real("discount", self.discount, at_least=0, below=1)
        check_real("learning_rate", self.learning_rate, above=0, at_most=1)
        for step in self.gradient_step:
            check_positive("gradient_step", step)
        check_integer("n_samples", self.n_samples, at_least=1)
        check_integer("replay", self.replay, at_least=1)
        for value in self.terminal_values:
            check_real("terminal_values", value, at_least=0, at_most=1)

    def improve(
        self,
        network: Network,
        decisions: Decisions,
        rewards: Floats,
        fraction: float,
        rng: np.random.Generator,
    ) -> Improved:
        """The network after ``n_samples`` steps of :func:`sarsa_descent`, by its compiled twin.

        Parameters
        ----------
        network : Network
            The network that is trained.
        decisions : Decisions
            The decisions of the replay memory.
        rewards : (M,) array
            The reward of each of the M decisions.
        fraction : float
            How much of the training is over, from 0 to 1; the step size falls with it.
        rng : numpy.random.Generator
            Of the random numbers.

        Returns
        -------
        Improved
            The network, and the mean cost of the samples.

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.networks import random_network
        >>> from robonav.nirl import ReplaySGD, TabularTask, terrain
        >>> task, rng = TabularTask(terrain()[1]), np.random.default_rng(0)
        >>> decisions = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
        >>> network = random_network((task.n_inputs, 5, 4), seed=0)
        >>> rewards = np.zeros(len(decisions))
        >>> ReplaySGD().improve(network, decisions, rewards, 0.0, rng).network.sizes
        (42, 5, 4)
        """
        if len(decisions) == 0:
            return Improved(network, np.nan)
        collided = decisions.collided[decisions.trajectory]
        order = rng.integers(len(decisions), size=self.n_samples)
        first, last = self.gradient_step
        return compiled_sarsa_descent(
            network,
            decisions,
            (1 - self.discount) * scale_to_unit_interval(rewards),
            np.where(collided, *self.terminal_values),
            order,
            learning_rate=self.learning_rate,
            discount=self.discount,
            gradient_step=first * (last / first) ** fraction,
        )


def compiled_sarsa_descent(
    network: Network,
    decisions: Decisions,
    rewards: Floats,
    terminal_values: Floats,
    order: Ints,
    *,
    learning_rate: float,
    discount: float,
    gradient_step: float,
) -> Improved:
    """The compiled twin of :func:`sarsa_descent`: the same steps, some hundred times as fast."""
    from . import _fast

    w1, w2 = (weight.T.copy(order="C") for weight in network.weights)
    b1, b2 = (bias.copy() for bias in network.biases)
    cost = _fast.sarsa_descent(
        w1, b1, w2, b2, decisions.inputs, decisions.actions, rewards,
        decisions.next_index, terminal_values, order, learning_rate, discount, gradient_step,
    )  # fmt: skip
    return Improved(Network((w1.T, w2.T), (b1, b2)), cost)


@dataclass(frozen=True)
class FullBatchDescent:
    """Gradient steps on the cost of all decisions of an iteration at once, for targets that stay.

    Line 9 of Algorithm 10 computes the targets of Eq. (5.16) once in an iteration; here they are clipped into [0, 1].
    Line 10 minimises the cost of Eq. (5.15) for these targets. The thesis does not say with how many gradient steps, so
    their number is a choice. After the last decision of an episode the future value is 0.

    Attributes
    ----------
    n_steps : int
        Gradient steps an iteration.
    discount, learning_rate, gradient_step : float
        gamma, alpha and sigma.
    regularisation : float
        lambda of Eq. (5.15).

    Examples
    --------
    >>> from robonav.nirl import FullBatchDescent
    >>> FullBatchDescent(n_steps=300).gradient_step
    0.4
    """

    n_steps: int = 1
    discount: float = 0.65
    learning_rate: float = 0.8
    gradient_step: float = 0.4
    regularisation: float = 0.0
    replay: ClassVar[int] = 1

    def __post_init__(self) -> None:
        check_integer("n_steps", self.n_steps, at_least=1)
        check_real("discount", self.discount, at_least=0, at_most=1)
        check_real("learning_rate", self.learning_rate, above=0, at_most=1)
        check_positive("gradient_step", self.gradient_step)
        check_real("regularisation", self.regularisation, at_least=0)

    def improve(
        self,
        network: Network,
        decisions: Decisions,
        rewards: Floats,
        fraction: float,
        rng: np.random.Generator,
    ) -> Improved:
        """The network after ``n_steps`` steps against the gradient, and its cost before them.

        Parameters
        ----------
        network : Network
            The network that is trained.
        decisions : Decisions
            The decisions of the last iteration.
        rewards : (M,) array
            The reward of each of the M decisions.
        fraction : float
            How much of the training is over. Not used.
        rng : numpy.random.Generator
            Of random numbers. Not used.

        Returns
        -------
        Improved
            The network, and its cost before the steps.

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.networks import random_network
        >>> from robonav.nirl import FullBatchDescent, TabularTask, terrain
        >>> task, rng = TabularTask(terrain()[1]), np.random.default_rng(0)
        >>> decisions = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
        >>> network = random_network((task.n_inputs, 5, 4), seed=0)
        >>> rewards = np.zeros(len(decisions))
        >>> FullBatchDescent().improve(network, decisions, rewards, 0.0, rng).network.sizes
        (42, 5, 4)
        """
        if len(decisions) == 0:
            return Improved(network, np.nan)
        inputs, actions = decisions.inputs, decisions.actions
        rows, following = np.arange(len(decisions)), decisions.next_index
        targets = neural_action_values(network, inputs)
        q = targets[rows, actions]
        targets[rows, actions] = sarsa_targets(
            q,
            rewards,
            next_q=np.where(following >= 0, q[following], 0.0),
            learning_rate=self.learning_rate,
            discount=self.discount,
        ).clip(0, 1)
        decay = {"regularisation": self.regularisation}
        cost = policy_cost(network, inputs, targets, **decay)
        for _ in range(self.n_steps):
            gradient = cross_entropy_gradient(network, inputs, targets, **decay)
            network = gradient_descent_step(network, gradient, self.gradient_step)
        return Improved(network, cost)
