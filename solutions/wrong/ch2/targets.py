"""Known mistakes in 2.5; a function's docstring is its hint."""

import numpy as np


def on_from_the_end(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    """After the last step of an episode nothing is to come: the target is the reward alone."""
    following = q[next_states]
    mean = epsilon * following.mean(axis=1) + (1 - epsilon) * following.max(axis=1)
    return rewards + discount * np.stack([following.max(axis=1), q[next_states, next_actions], mean])


def rows_swapped(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    """Q-learning's targets come first, SARSA's second: Q-learning takes the best action, whatever was done."""
    following = q[next_states]
    mean = epsilon * following.mean(axis=1) + (1 - epsilon) * following.max(axis=1)
    worth = np.stack([q[next_states, next_actions], following.max(axis=1), mean])
    return rewards + discount * np.where(terminated, 0.0, worth)


def explores_the_others(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    """When it explores, the policy draws from all actions, the best one among them."""
    following = q[next_states]
    best = following.max(axis=1)
    others = (following.sum(axis=1) - best) / (q.shape[1] - 1)
    worth = np.stack([best, q[next_states, next_actions], epsilon * others + (1 - epsilon) * best])
    return rewards + discount * np.where(terminated, 0.0, worth)


def discounts_the_reward(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    """The reward comes at once and counts in full; only what follows is discounted."""
    following = q[next_states]
    best = following.max(axis=1)
    mean = epsilon * following.mean(axis=1) + (1 - epsilon) * best
    worth = np.stack([best, q[next_states, next_actions], mean])
    return discount * (rewards + np.where(terminated, 0.0, worth))


def no_reward_at_the_end(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    """The last step earns its reward like any other."""
    following = q[next_states]
    best = following.max(axis=1)
    mean = epsilon * following.mean(axis=1) + (1 - epsilon) * best
    worth = np.stack([best, q[next_states, next_actions], mean])
    return np.where(terminated, 0.0, rewards + discount * worth)
