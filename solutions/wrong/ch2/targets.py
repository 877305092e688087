"""Known mistakes in 2.5; a function's docstring is its hint."""

import numpy as np


def on_from_the_end(
    q, rewards, next_states, next_actions, terminated, discount, epsilon
):
    """After the last step of an episode the target is only the reward."""
    following = q[next_states]
    mean = epsilon * following.mean(axis=1) + (1 - epsilon) * following.max(axis=1)
    return rewards + discount * np.stack(
        [following.max(axis=1), q[next_states, next_actions], mean]
    )


def rows_swapped(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    """Return Q-learning's targets first. They use the best action; SARSA's use the action that was taken."""
    following = q[next_states]
    mean = epsilon * following.mean(axis=1) + (1 - epsilon) * following.max(axis=1)
    values = np.stack([q[next_states, next_actions], following.max(axis=1), mean])
    return rewards + discount * np.where(terminated, 0.0, values)


def explores_the_others(
    q, rewards, next_states, next_actions, terminated, discount, epsilon
):
    """When the policy explores, it draws from all actions, including the best one."""
    following = q[next_states]
    best = following.max(axis=1)
    others = (following.sum(axis=1) - best) / (q.shape[1] - 1)
    values = np.stack(
        [best, q[next_states, next_actions], epsilon * others + (1 - epsilon) * best]
    )
    return rewards + discount * np.where(terminated, 0.0, values)


def discounts_the_reward(
    q, rewards, next_states, next_actions, terminated, discount, epsilon
):
    """Do not discount the reward of the step. Discount only the value of the next state."""
    following = q[next_states]
    best = following.max(axis=1)
    mean = epsilon * following.mean(axis=1) + (1 - epsilon) * best
    values = np.stack([best, q[next_states, next_actions], mean])
    return discount * (rewards + np.where(terminated, 0.0, values))


def no_reward_at_the_end(
    q, rewards, next_states, next_actions, terminated, discount, epsilon
):
    """The last step has a reward like any other step: include it."""
    following = q[next_states]
    best = following.max(axis=1)
    mean = epsilon * following.mean(axis=1) + (1 - epsilon) * best
    values = np.stack([best, q[next_states, next_actions], mean])
    return np.where(terminated, 0.0, rewards + discount * values)
