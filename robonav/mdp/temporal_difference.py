"""Learning from each step: Q-learning (Algorithm 5), SARSA (Algorithm 6), expected SARSA, and TD(0).

After each step from s by action a to s' with reward r, an estimate moves by the fraction alpha towards a target:

    Q(s, a) += alpha * (target - Q(s, a)),      target = r + gamma * (value of s').

The methods differ in what they take for the value of s':

- Q-learning: the largest Q(s', a') over all actions a';
- SARSA: Q(s', a') of the action a' that comes next;
- expected SARSA: the mean of Q(s', a') over the actions a', with the probabilities of the policy;
- TD(0), which learns the values V of a given policy: V(s').

A terminal state s' has the value 0.

In each function ``q[state][action]`` is Q(s, a), or ``values[state]`` is V(s), and ``visits`` counts the updates of
each entry. All of them are changed in place. ``epsilon(episode)`` and ``learning_rate(n)`` are schedules: the
probability of a random action in an episode, and the learning rate alpha after n earlier updates.

The decorators of ``learner`` make these tables (step 1 of the algorithms) and schedules, so users call
``q_learning(env, episodes, epsilon=0.1)``.
"""

from __future__ import annotations

from collections.abc import Callable

from .episodes import Environment, UniformNumbers
from .exploration import Schedule, epsilon_greedy_action
from .learner import control_method, prediction_method

Table = list[list[float]]
Counts = list[list[int]]


@control_method
def q_learning(
    env: Environment,
    q: Table,
    visits: Counts,
    episodes: int,
    *,
    discount: float,
    learning_rate: Schedule,
    epsilon: Schedule,
    rng: UniformNumbers,
) -> None:
    """One-step Q-learning, Algorithm 5, Eqs. (2.29) and (4.1).

    Learns the values of the best policy while it follows another. The thesis gives the same update in both equations.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, q_learning
    >>> env = GridWorld("S . . G", step_reward=-1).environment()
    >>> q_learning(env, 50, learning_rate=0.5).policy[:3]
    array([1, 1, 1])
    """
    for episode in range(episodes):  # 2
        eps = epsilon(episode)
        state, _ = env.reset()  # 3
        done = False
        while not done:  # 4
            action = epsilon_greedy_action(q[state], eps, rng)  # 5
            next_state, reward, terminated, truncated, _ = env.step(action)  # 6
            next_value = 0.0 if terminated else max(q[next_state])
            td_error = reward + discount * next_value - q[state][action]
            alpha = learning_rate(visits[state][action])
            q[state][action] += alpha * td_error  # 7  Eqs. (2.29) and (4.1)
            visits[state][action] += 1
            state, done = next_state, terminated or truncated  # 8 and 9


@control_method
def sarsa(
    env: Environment,
    q: Table,
    visits: Counts,
    episodes: int,
    *,
    discount: float,
    learning_rate: Schedule,
    epsilon: Schedule,
    rng: UniformNumbers,
) -> None:
    """On-policy SARSA, Algorithm 6, Eqs. (2.30) and (4.2).

    Learns the values of the policy that it follows, exploration included. They tend to the optimal values only if
    ``epsilon`` falls to zero as well (Singh et al. 2000). The thesis gives the same update in both equations.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, sarsa
    >>> env = GridWorld("S . . G", step_reward=-1).environment()
    >>> sarsa(env, 50, learning_rate=0.5).policy[:3]
    array([1, 1, 1])
    """
    for episode in range(episodes):  # 2
        eps = epsilon(episode)
        state, _ = env.reset()  # 3
        action = epsilon_greedy_action(q[state], eps, rng)  # 4
        done = False
        while not done:  # 5
            next_state, reward, terminated, truncated, _ = env.step(action)  # 6
            next_action = epsilon_greedy_action(q[next_state], eps, rng)  # 7
            next_value = 0.0 if terminated else q[next_state][next_action]
            td_error = reward + discount * next_value - q[state][action]
            alpha = learning_rate(visits[state][action])
            q[state][action] += alpha * td_error  # 8  Eqs. (2.30) and (4.2)
            visits[state][action] += 1
            state, action = next_state, next_action  # 9
            done = terminated or truncated  # 10


@control_method
def expected_sarsa(
    env: Environment,
    q: Table,
    visits: Counts,
    episodes: int,
    *,
    discount: float,
    learning_rate: Schedule,
    epsilon: Schedule,
    rng: UniformNumbers,
) -> None:
    """Expected SARSA (van Seijen et al. 2009): SARSA with the mean over the next action instead of one draw of it.

    The target varies less than SARSA's, so a larger learning rate works. In a deterministic environment a rate of 1 is
    the best.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, expected_sarsa
    >>> env = GridWorld("S . . G", step_reward=-1).environment()
    >>> expected_sarsa(env, 50, learning_rate=0.5).policy[:3]
    array([1, 1, 1])
    """
    for episode in range(episodes):
        eps = epsilon(episode)
        state, _ = env.reset()
        done = False
        while not done:
            action = epsilon_greedy_action(q[state], eps, rng)
            next_state, reward, terminated, truncated, _ = env.step(action)
            # any action with probability epsilon, else a best one
            next_q = q[next_state]
            expected = eps * sum(next_q) / len(next_q) + (1 - eps) * max(next_q)
            next_value = 0.0 if terminated else expected
            td_error = reward + discount * next_value - q[state][action]
            alpha = learning_rate(visits[state][action])
            q[state][action] += alpha * td_error
            visits[state][action] += 1
            state, done = next_state, terminated or truncated


@prediction_method
def td_prediction(
    env: Environment,
    policy: Callable[[int], int],
    values: list[float],
    visits: list[int],
    episodes: int,
    *,
    discount: float,
    learning_rate: Schedule,
) -> None:
    """TD(0) prediction: the values of a policy, each estimate updated towards the next (section 2.4.3).

    Examples
    --------
    >>> from robonav.mdp import GridWorld, td_prediction
    >>> env = GridWorld("S . G").environment()
    >>> td_prediction(env, [1, 1, 1], 5, discount=0.5, learning_rate=1.0).values
    array([0.5, 1. , 0. ])
    """
    for _ in range(episodes):
        state, _ = env.reset()
        done = False
        while not done:
            next_state, reward, terminated, truncated, _ = env.step(policy(state))
            next_value = 0.0 if terminated else values[next_state]
            td_error = reward + discount * next_value - values[state]
            alpha = learning_rate(visits[state])
            values[state] += alpha * td_error
            visits[state] += 1
            state, done = next_state, terminated or truncated
