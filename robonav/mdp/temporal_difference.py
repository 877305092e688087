"""Learning from each step: Q-learning (Algorithm 5), SARSA (Algorithm 6), expected SARSA, and TD(0).

After each step from s by action a to s' with reward r, an estimate moves by the fraction alpha towards a target:

    Q(s, a) += alpha * (target - Q(s, a)),      target = r + gamma * (value of s').

The methods differ in what they take for the value of s':

- Q-learning: the largest Q(s', a') over all actions a'. It is off-policy: it learns the values of the greedy policy,
  while it follows one that explores;
- SARSA: Q(s', a') of the action a' that comes next. It is on-policy: it learns the values of the policy that it
  follows, exploration included;
- expected SARSA: the mean of Q(s', a') over the actions a', with the probabilities of the policy;
- TD(0), which learns the values V of a given policy: V(s').

A terminal state s' has the value 0.

Along a cliff the first two disagree. Q-learning goes along the edge (1 is right), where the greedy policy is safe.
SARSA goes up (0), away from the edge, since its random actions fall down there:

>>> import gymnasium
>>> from robonav.mdp import q_learning, sarsa
>>> cliff, edge = gymnasium.make("CliffWalking-v1"), 28  # a cell beside the cliff
>>> [int(learn(cliff, 500, learning_rate=0.5).policy[edge]) for learn in (q_learning, sarsa)]
[1, 0]

Each function changes two tables in place, and their decorator makes both before it calls the function, as step 1 of
the algorithms says. That is why users call ``q_learning(env, episodes)`` without them::

    q = [[initial] * n_actions for _ in range(n_states)]  # q[state][action] is Q(s, a)
    visits = [[0] * n_actions for _ in range(n_states)]  # how often each entry was updated

(TD(0) has lists ``values`` and ``visits`` with one entry a state.) Users give ``learning_rate`` and ``epsilon`` as
numbers or as schedules. Here both are schedules: ``learning_rate(n)`` is alpha after n updates of an entry, and
``epsilon(episode)`` is the probability of a random action in an episode.
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
    >>> q_learning(env, 50, learning_rate=0.5).policy[:3]  # 1 is right, towards G
    array([1, 1, 1])
    """
    # 1: q holds the initial values, and visits only zeros
    for episode in range(episodes):  # 2
        eps = epsilon(episode)
        state, _ = env.reset()  # 3
        done = False
        while not done:  # 4
            action = epsilon_greedy_action(q[state], eps, rng)  # 5
            next_state, reward, terminated, truncated, _ = env.step(action)  # 6
            # off-policy: the best action in s', whichever comes next
            next_value = 0.0 if terminated else max(q[next_state])
            target = reward + discount * next_value
            td_error = target - q[state][action]
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
    >>> sarsa(env, 50, learning_rate=0.5).policy[:3]  # 1 is right, towards G
    array([1, 1, 1])
    """
    # 1: q holds the initial values, and visits only zeros
    for episode in range(episodes):  # 2
        eps = epsilon(episode)
        state, _ = env.reset()  # 3
        action = epsilon_greedy_action(q[state], eps, rng)  # 4
        done = False
        while not done:  # 5
            next_state, reward, terminated, truncated, _ = env.step(action)  # 6
            next_action = epsilon_greedy_action(q[next_state], eps, rng)  # 7
            # on-policy: the action that comes next in s'
            next_value = 0.0 if terminated else q[next_state][next_action]
            target = reward + discount * next_value
            td_error = target - q[state][action]
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
    >>> expected_sarsa(env, 50, learning_rate=0.5).policy[:3]  # 1 is right, towards G
    array([1, 1, 1])
    """
    for episode in range(episodes):
        eps = epsilon(episode)
        state, _ = env.reset()
        done = False
        while not done:
            action = epsilon_greedy_action(q[state], eps, rng)
            next_state, reward, terminated, truncated, _ = env.step(action)
            # on-policy on average: any action with probability epsilon, else a best one
            next_q = q[next_state]
            expected = eps * sum(next_q) / len(next_q) + (1 - eps) * max(next_q)
            next_value = 0.0 if terminated else expected
            target = reward + discount * next_value
            td_error = target - q[state][action]
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
            target = reward + discount * next_value
            td_error = target - values[state]
            alpha = learning_rate(visits[state])
            values[state] += alpha * td_error
            visits[state] += 1
            state, done = next_state, terminated or truncated
