"""Learning from whole episodes: Monte Carlo prediction and control (section 2.4.2).

The return from step t on is the sum of the discounted rewards that follow,

    G_t = r_t + gamma * r_(t+1) + gamma^2 * r_(t+2) + ... = r_t + gamma * G_(t+1),                     (2.3)

and the value of a state is the expected return. Monte Carlo estimates it by the mean of the returns. It needs no model
and no other estimates, but it can learn only when an episode has ended. Each function makes an episode, computes its
returns from the last step back to the first, and adds them to the means. If a state occurs several times in an
episode, the first-visit method counts only the return after the first time, and the every-visit method counts all.

The functions change ``values`` or ``q``, and ``visits``, in place, as those of ``temporal_difference`` do.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from .episodes import Environment, UniformNumbers
from .exploration import Schedule, epsilon_greedy_action, harmonic_decay
from .learner import control_method, prediction_method

Visit = Literal["first", "every"]

SAMPLE_AVERAGE = harmonic_decay()  # learning rates 1, 1/2, 1/3, ...


@prediction_method
def monte_carlo_prediction(
    env: Environment,
    policy: Callable[[int], int],
    values: list[float],
    visits: list[int],
    episodes: int,
    *,
    discount: float,
    visit: Visit = "first",
) -> None:
    """Monte Carlo prediction: the value of a state is the mean of the returns that followed it.

    The values of states that were never visited are NaN. An episode that is cut off counts as if no more rewards had
    come.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, monte_carlo_prediction
    >>> env = GridWorld("S . G").environment()
    >>> monte_carlo_prediction(env, [1, 1, 1], 5, discount=0.5).values
    array([0.5, 1. , nan])
    """
    for _ in range(episodes):
        states, rewards = [], []
        state, _ = env.reset()
        done = False
        while not done:  # one whole episode
            next_state, reward, terminated, truncated, _ = env.step(policy(state))
            states.append(state)
            rewards.append(reward)
            state, done = next_state, terminated or truncated
        returns = [0.0] * len(rewards)
        G = 0.0
        for t in reversed(range(len(rewards))):
            G = rewards[t] + discount * G  # the return from step t on, Eq. (2.3)
            returns[t] = G
        seen = set()
        for state, G in zip(states, returns, strict=True):
            if visit == "first" and state in seen:
                continue
            seen.add(state)
            visits[state] += 1
            values[state] += (G - values[state]) / visits[state]  # mean of the returns


@control_method
def monte_carlo_control(
    env: Environment,
    q: list[list[float]],
    visits: list[list[int]],
    episodes: int,
    *,
    discount: float,
    epsilon: Schedule,
    rng: UniformNumbers,
    learning_rate: Schedule = SAMPLE_AVERAGE,
    visit: Visit = "first",
) -> None:
    """Monte Carlo control: average the returns after each action, and act epsilon-greedily on the averages.

    The learning rate is by default 1, 1/2, 1/3, ..., which gives the plain average of the returns. A constant rate
    forgets the returns of policies abandoned long ago. An episode that is cut off counts as if no more rewards had
    come.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, monte_carlo_control
    >>> env = GridWorld("S . . G", step_reward=-1).environment()
    >>> monte_carlo_control(env, 50, max_steps=50).policy[:3]
    array([1, 1, 1])
    """
    for episode in range(episodes):
        eps = epsilon(episode)
        pairs, rewards = [], []
        state, _ = env.reset()
        done = False
        while not done:  # one whole episode
            action = epsilon_greedy_action(q[state], eps, rng)
            next_state, reward, terminated, truncated, _ = env.step(action)
            pairs.append((state, action))
            rewards.append(reward)
            state, done = next_state, terminated or truncated
        returns = [0.0] * len(rewards)
        G = 0.0
        for t in reversed(range(len(rewards))):
            G = rewards[t] + discount * G  # the return from step t on, Eq. (2.3)
            returns[t] = G
        seen = set()
        for (state, action), G in zip(pairs, returns, strict=True):
            if visit == "first" and (state, action) in seen:
                continue
            seen.add((state, action))
            alpha = learning_rate(visits[state][action])
            q[state][action] += alpha * (G - q[state][action])
            visits[state][action] += 1
