"""Neural inverse reinforcement learning, Algorithm 10, and the descent with which it improves its policy.

A network gives the action values Q(s, a), and a Boltzmann policy follows them. Each iteration

1. rolls out this policy, pi(a | s) proportional to exp(eta Q(s, a)), Eq. (5.10);
2. chooses weights theta of a reward r(s, a) = theta . f(s, a) under which the expert's decisions are better than the
   policy's, Eq. (5.14);
3. improves the policy for this reward: it moves Q(s, a) towards r(s, a) + gamma * Q(s', a'), where s' and a' are the
   state and the action that came next, Eq. (5.16).

:func:`nirl` is this loop, and :func:`sarsa_descent` its step 3 for one transition after the other.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from robonav.networks.multilayer_perceptron import Network, sigmoid

from .decisions import Decisions, Floats, Ints, concatenate_decisions
from .max_margin import project_to_unit_ball
from .policy import exploring_policy, neural_action_values
from .policy_improvement import (
    Improved,
    Improver,
    ReplaySGD,
    decision_rewards,
    sarsa_targets,
)
from .reward_update import RewardUpdate, SubgradientMaxMargin, expert_margin
from .tasks import Task
from .training import Iteration, training_method


@training_method
def nirl(
    demonstrations: Decisions,
    task: Task,
    network: Network,
    *,
    iterations: int = 140,
    tolerance: float = -math.inf,
    inverse_temperature: float = 25.0,
    reward_update: RewardUpdate = SubgradientMaxMargin(),  # noqa: B008 - frozen
    improver: Improver = ReplaySGD(),  # noqa: B008 - frozen
    rng: np.random.Generator,
) -> Iterator[Iteration]:
    """Neural inverse reinforcement learning, Algorithm 10.

    Each iteration guesses a reward under which the expert does better than the latest policy, and improves the policy
    for this reward. The result is the policy, of all iterations, that predicts the demonstrations best. The numbers in
    the code are the lines of Algorithm 10 in the thesis.

    Parameters
    ----------
    tolerance : float
        epsilon: the algorithm ends when the margin is no larger. By default it makes all iterations.
    reward_update : RewardUpdate
        Line 5: :class:`SubgradientMaxMargin`, or :class:`LeastSquaresReward` for the objective that the thesis prints.
    improver : Improver
        Lines 9 and 10: :class:`ReplaySGD`, or :class:`FullBatchDescent`. The thesis leaves the number of steps open.

    Raises
    ------
    ValueError
        If there is no demonstrated decision, a demonstrated action does not exist, or an argument is out of bounds.

    Examples
    --------
    >>> from robonav.mdp import policy_iteration
    >>> from robonav.nirl import TRUE_WEIGHTS, TabularTask, nirl, terrain
    >>> grid, mdp = terrain()
    >>> task = TabularTask(mdp)
    >>> expert = policy_iteration(mdp.with_reward(TRUE_WEIGHTS)).policy
    >>> result = nirl(task.demonstrate(expert, 20, seed=0), task, iterations=5)
    >>> result.reward_weights.shape, result.history.margins[0] > result.history.margins[-1]
    ((4, 43), np.True_)
    """
    # 1: the network has random weights
    theta, episodes = np.zeros((task.n_actions, task.n_inputs + 1)), []
    for i in range(1, iterations + 1):  # 2, 3, 11
        policy = exploring_policy(network, inverse_temperature)
        episodes.append(task.rollout(policy, rng))  # 4
        q = neural_action_values(network, demonstrations.inputs)
        pi = policy(demonstrations.inputs)  # what it would do in the expert's states
        theta = reward_update(demonstrations, pi, q, theta, i)  # 5
        reward = project_to_unit_ball(theta)
        if expert_margin(demonstrations, pi, reward) <= tolerance:  # 6
            break  # 7, 8
        pairs = concatenate_decisions(episodes[-improver.replay :])
        rewards = decision_rewards(reward, pairs)  # 9: theta . f(s, a)
        fraction = (i - 1) / max(iterations - 1, 1)
        # 9, 10: targets, Eq. (5.16), and descent to them, as in sarsa_descent below
        network, cost = improver.improve(network, pairs, rewards, fraction, rng)
        yield Iteration(episodes[-1], reward, network, cost)


def sarsa_descent(
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
    """Stochastic gradient descent on the cost, one transition at a time, with SARSA targets.

    Each step computes the target of one transition with the current weights, by Eq. (5.16), and clips it into [0, 1].
    It then changes the weights against the gradient of the cross-entropy of the output of the action taken.

    Parameters
    ----------
    network : Network
        One hidden layer.
    decisions : Decisions
        M decisions.
    rewards : (M,) array
        In units of the network's output.
    terminal_values : (M,) array
        Future value after a decision that is the last one of its episode.
    order : array of int
        Indices of the decisions to train on, one step for each.
    learning_rate, discount, gradient_step : float
        alpha, gamma and sigma.

    Returns
    -------
    Improved
        The network, and the mean cost, of each step before its change of the weights.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import random_network
    >>> from robonav.nirl import Decisions, sarsa_descent
    >>> nothing = np.zeros(1, dtype=int)
    >>> one = Decisions(np.ones((1, 2)), nothing, nothing, nothing, nothing, nothing)
    >>> start = random_network((2, 3, 1), seed=0)
    >>> order = np.zeros(500, dtype=int)
    >>> rates = {"learning_rate": 0.8, "discount": 0.5, "gradient_step": 1.0}
    >>> network, cost = sarsa_descent(start, one, np.array([0.5]), np.array([0.8]), order, **rates)
    >>> network.forward(one.inputs).round(2)  # 0.5 + 0.5 * 0.8
    array([[0.9]])
    """
    w1, w2 = (weight.copy() for weight in network.weights)
    b1, b2 = (bias.copy() for bias in network.biases)
    inputs, actions = decisions.inputs, decisions.actions
    following = decisions.next_index
    rates = {"learning_rate": learning_rate, "discount": discount}
    cost = 0.0
    for i in order:
        next_q, k = terminal_values[i], following[i]
        if k >= 0:  # the episode went on: Q(s', a') of the next decision
            x, a = inputs[k], actions[k]
            next_q = sigmoid(w2[a] @ sigmoid(w1 @ x + b1) + b2[a])
        x, a = inputs[i], actions[i]
        hidden = sigmoid(w1 @ x + b1)
        z = w2[a] @ hidden + b2[a]
        q = sigmoid(z)
        target = sarsa_targets(q, rewards[i], next_q, **rates).clip(0, 1)  # Eq. (5.16)
        cost += np.logaddexp(0, z) - target * z  # cross-entropy, as in Eq. (5.15)
        delta = gradient_step * (q - target)  # its derivative by z, times sigma
        back = delta * w2[a] * hidden * (1 - hidden)
        w2[a] -= delta * hidden
        b2[a] -= delta
        w1 -= np.outer(back, x)
        b1 -= back
    return Improved(Network((w1, w2), (b1, b2)), cost / max(len(order), 1))
