"""Neural-network Q-learning, its online form, and navigation with what they learned (sections 4.4.5, 4.5.3).

A network computes the Q-values of a state s, one output for each action. After a step by action a to s' with reward r,
the value of this action moves towards a target, as in Q-learning:

    Q(s, a) <- Q(s, a) + alpha * (r + gamma * max over a' of Q(s', a') - Q(s, a))                      (4.9)

The outputs are sigmoids, so these values are rescaled into [0, 1]. The network then learns to answer s with them, by
stochastic gradient descent on the cross-entropy, Eqs. (4.11) and (4.12). :func:`nnql` trains on all pairs of s and
rescaled values that the episode has gathered so far, and :func:`online` on the latest pair alone.
"""

from __future__ import annotations

from typing import Any

import gymnasium

from robonav.networks.multilayer_perceptron import Network
from robonav.networks.policy import sample_actions

from ._arguments import Schedule, checked
from .schedules import geometric_schedule, softmax_policy
from .task import EXPLORING, make_rng, reflex_acted
from .updates import RESCALE, q_targets, train_on_pairs


@checked
def nnql(
    env: gymnasium.Env,
    network: Network,
    *,
    episodes: int,
    learning_rate: Schedule = (0.8, 0.1),
    discount: float = 0.6,
    gradient_step: Schedule = (0.3, 0.05),
    temperature: Schedule = (0.9, 0.1),
    rescale: str = "shift",
    passes: int = 3,
    tolerance: float = 1e-3,
    seed: int,
) -> Network:
    """Neural-network Q-learning (NNQL), Algorithm 8.

    After each step the network trains on all pairs of state and target that the episode has gathered so far. The
    robot's reflex acts in safe states, where nothing is learned; other environments have no reflex.

    The numbers in the comments are the lines of Algorithm 8. The caller draws the first weights, line 1, and line 7
    starts a counter of the steps, which the code does not need.

    Parameters
    ----------
    passes : int
        Gradient descent goes through the pairs at most this many times.
    tolerance : float
        It stops earlier when the mean cost changes by less than this from one pass to the next.

    Notes
    -----
    A schedule is a number, or a pair: the quantity then goes from the first number to the second, by the same factor
    each episode. Gymnasium's ``RecordEpisodeStatistics`` records returns and lengths.

    Examples
    --------
    >>> from robonav.nnql import NavigationTask, nnql, q_network
    >>> env = NavigationTask().environment()
    >>> nnql(env, q_network(env, seed=0), episodes=1, seed=0).sizes
    (16, 8, 5)
    """
    for episode in range(episodes):  # 2
        fraction = episode / max(episodes - 1, 1)
        alpha = geometric_schedule(learning_rate, fraction)
        sigma = geometric_schedule(gradient_step, fraction)
        t = geometric_schedule(temperature, fraction)
        rng = make_rng(seed, EXPLORING, episode)
        state, _ = env.reset(seed=None if episode else seed)  # 3 to 5
        inputs, targets, done = [], [], False  # 6
        while not done:  # 8
            q = network.forward(state)  # 9
            action = sample_actions(softmax_policy(q, t), rng.random())  # 10  Eq. (4.7)
            next_state, reward, terminated, truncated, info = env.step(action)  # 11, 12
            if not reflex_acted(info):
                next_value = 0.0 if terminated else network.forward(next_state).max()
                q = q_targets(
                    q, action, float(reward), next_value, alpha, discount
                )  # 13  Eq. (4.9)
                targets.append(RESCALE[rescale](q))  # 14, 15
                inputs.append(state)  # 15
                network = train_on_pairs(
                    network, inputs, targets, sigma, passes, tolerance
                )  # 16  Eqs. (4.11) and (4.12)
            state, done = next_state, terminated or truncated  # 17 to 20
    return network


@checked
def online(
    env: gymnasium.Env,
    network: Network,
    *,
    episodes: int,
    learning_rate: Schedule = 0.8,
    discount: float = 0.7,
    gradient_step: Schedule = 0.3,
    temperature: Schedule = (0.9, 0.1),
    rescale: str = "clip",
    passes: int = 1,
    tolerance: float = 1e-3,
    seed: int,
) -> Network:
    """One-step online neural Q-learning: train on the pair of each step and forget it.

    Parameters
    ----------
    passes : int
        Gradient descent repeats the pair at most this many times.
    tolerance : float
        It stops earlier when the cost changes by less than this from one step to the next.

    Examples
    --------
    >>> from robonav.nnql import NavigationTask, online, q_network
    >>> env = NavigationTask().environment()
    >>> online(env, q_network(env, seed=0), episodes=1, seed=0).sizes
    (16, 8, 5)
    """
    for episode in range(episodes):
        fraction = episode / max(episodes - 1, 1)
        alpha = geometric_schedule(learning_rate, fraction)
        sigma = geometric_schedule(gradient_step, fraction)
        t = geometric_schedule(temperature, fraction)
        rng = make_rng(seed, EXPLORING, episode)
        state, _ = env.reset(seed=None if episode else seed)
        done = False
        while not done:
            q = network.forward(state)
            action = sample_actions(softmax_policy(q, t), rng.random())
            next_state, reward, terminated, truncated, info = env.step(action)
            if not reflex_acted(info):
                next_value = 0.0 if terminated else network.forward(next_state).max()
                q = q_targets(q, action, float(reward), next_value, alpha, discount)
                # the latest pair alone
                network = train_on_pairs(
                    network, [state], [RESCALE[rescale](q)], sigma, passes, tolerance
                )
            state, done = next_state, terminated or truncated
    return network


@checked
def navigate_greedily(
    env: gymnasium.Env, network: Network, *, seed: int
) -> tuple[float, dict[str, Any]]:
    """Navigation with a trained network, Algorithm 9: one episode of its greedy policy.

    Step 1 of the algorithm is to load the weights: here they are the argument ``network``. Steps 4 and 12 count the
    steps, and nothing reads the count. Gymnasium makes steps 6 to 9 at the end of each action: it returns the state,
    and says whether the episode has ended. The loop asks for this in its condition. Step 11 is Eq. (4.8); it compares
    the outputs before the sigmoid, because two large Q-values both round to 1.

    Parameters
    ----------
    env : gymnasium.Env
        An environment with discrete actions. Its observations, as :func:`network_environment` makes them, are the
        network's inputs.
    network : Network
        A trained network.
    seed : int
        Seed of the environment.

    Returns
    -------
    return : float
        Sum of the rewards.
    info : dict
        What the environment says of the last step; ``info["outcome"]`` in the robot's, a
        :class:`~robonav.robot.Outcome`.

    Examples
    --------
    >>> from robonav.nnql import NavigationTask, navigate_greedily, q_network
    >>> from robonav.robot import Outcome
    >>> env = NavigationTask().environment()
    >>> total, info = navigate_greedily(env, q_network(env, seed=0), seed=2)
    >>> Outcome(info["outcome"]).name
    'COLLIDED'
    """
    state, info = env.reset(seed=seed)  # 2, 3
    total, done = 0.0, False
    while not done:  # 5 to 9
        q = network.logits(state)  # 10
        state, reward, terminated, truncated, info = env.step(q.argmax())  # 11
        total, done = total + float(reward), terminated or truncated
    return total, info
