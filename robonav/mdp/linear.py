"""Action values as a linear function of features, Eq. (4.3): SARSA (Algorithm 7) and Q-learning.

With features f_i(s, a) and weights w_i,

    Q(s, a) = sum over i of w_i f_i(s, a).                                                             (4.3)

The derivative of Q(s, a) by w_i is f_i(s, a). A step that changes Q(s, a) by the fraction alpha of its error delta
therefore changes each weight in proportion to its feature:

    delta = r + gamma * (value of s') - Q(s, a),        w_i += alpha * delta * f_i(s, a).

SARSA takes Q(s', a') of the next action for the value of s', and Q-learning the largest Q(s', a').

``f = features(state)`` is an array (A, n): ``f[a, i]`` is f_i(s, a), and ``f @ weights`` are the action values (A,).
``tolist`` makes a list of them, because Python reads single numbers faster from a list than from an array.
The functions change ``weights`` in place. ``learning_rate(episode)`` and ``epsilon(episode)`` are schedules. The
decorator ``linear_method`` makes them and the weights (step 1 of the algorithm), so users call
``linear_sarsa(env, episodes, features, epsilon=0.1)``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .episodes import Environment, UniformNumbers
from .exploration import Schedule, epsilon_greedy_action
from .features import Features
from .learner import linear_method

Weights = NDArray[np.float64]


@linear_method
def linear_sarsa(
    env: Environment,
    features: Features,
    weights: Weights,
    episodes: int,
    *,
    discount: float,
    learning_rate: Schedule,
    epsilon: Schedule,
    rng: UniformNumbers,
) -> None:
    """SARSA with linear function approximation, Algorithm 7.

    After each step every weight moves by ``alpha * delta * f_i(s, a)``, where ``delta`` is the error of Q(s, a),
    Eq. (4.3).

    Examples
    --------
    >>> from robonav.mdp import GridWorld, OneHot, linear_sarsa
    >>> env = GridWorld("S . . G", step_reward=-1).environment()
    >>> result = linear_sarsa(env, 50, OneHot(4, 4), learning_rate=0.5)
    >>> result.q([0, 1, 2]).argmax(axis=1)
    array([1, 1, 1])
    """
    for episode in range(episodes):  # 1: the weights are those given
        alpha, eps = learning_rate(episode), epsilon(episode)
        state, _ = env.reset()  # 2
        f = features(state)
        q = (f @ weights).tolist()
        action = epsilon_greedy_action(q, eps, rng)  # 3
        done = False
        while not done:  # 4
            state, reward, terminated, truncated, _ = env.step(action)  # 5 and 6
            next_f = features(state)
            next_q = (next_f @ weights).tolist()
            next_action = epsilon_greedy_action(next_q, eps, rng)  # 7
            next_value = 0.0 if terminated else next_q[next_action]
            delta = reward + discount * next_value - f[action] @ weights  # 8
            weights += alpha * delta * f[action]  # 9 to 11
            f, action = next_f, next_action  # 12
            done = terminated or truncated  # 13


@linear_method
def linear_q_learning(
    env: Environment,
    features: Features,
    weights: Weights,
    episodes: int,
    *,
    discount: float,
    learning_rate: Schedule,
    epsilon: Schedule,
    rng: UniformNumbers,
) -> None:
    """Q-learning with linear function approximation.

    It is Algorithm 7 with the largest next value in ``delta`` instead of that of the next action.

    Unlike for :func:`linear_sarsa`, nothing promises that the weights converge: learning about one policy from the
    steps of another, with shared features, can diverge (Baird 1995).

    Examples
    --------
    >>> from robonav.mdp import GridWorld, OneHot, linear_q_learning
    >>> env = GridWorld("S . . G", step_reward=-1).environment()
    >>> result = linear_q_learning(env, 50, OneHot(4, 4), learning_rate=0.5)
    >>> result.q([0, 1, 2]).argmax(axis=1)
    array([1, 1, 1])
    """
    for episode in range(episodes):
        alpha, eps = learning_rate(episode), epsilon(episode)
        state, _ = env.reset()
        f = features(state)
        done = False
        while not done:
            q = (f @ weights).tolist()
            action = epsilon_greedy_action(q, eps, rng)
            state, reward, terminated, truncated, _ = env.step(action)
            next_f = features(state)
            next_value = 0.0 if terminated else (next_f @ weights).max()
            delta = reward + discount * next_value - f[action] @ weights
            weights += alpha * delta * f[action]
            f, done = next_f, terminated or truncated
