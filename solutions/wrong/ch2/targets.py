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


def _rows(q, rewards, next_states, next_actions, terminated, discount, mean):
    following = q[next_states]
    values = np.stack(
        [following.max(axis=1), q[next_states, next_actions], mean(following)]
    )
    return rewards + discount * np.where(terminated, 0.0, values)


def each_best_as_probable(
    q, rewards, next_states, next_actions, terminated, discount, epsilon
):
    """The best actions together have the probability 1 - epsilon: several of them share it."""

    def mean(rows):
        best = rows == rows.max(axis=1, keepdims=True)
        return (rows * (epsilon / rows.shape[1] + (1 - epsilon) * best)).sum(axis=1)

    return _rows(q, rewards, next_states, next_actions, terminated, discount, mean)


def plain_mean(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    """The policy is not uniform: with probability 1 - epsilon it takes a best action."""
    return _rows(
        q,
        rewards,
        next_states,
        next_actions,
        terminated,
        discount,
        lambda rows: rows.mean(axis=1),
    )


def sum_for_mean(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    """Each of the A actions has the probability epsilon / A: take the mean of the values, not their sum."""
    return _rows(
        q,
        rewards,
        next_states,
        next_actions,
        terminated,
        discount,
        lambda rows: epsilon * rows.sum(axis=1) + (1 - epsilon) * rows.max(axis=1),
    )


def epsilon_turned(
    q, rewards, next_states, next_actions, terminated, discount, epsilon
):
    """Epsilon is the probability of a random action, not of a best one."""
    return _rows(
        q,
        rewards,
        next_states,
        next_actions,
        terminated,
        discount,
        lambda rows: (1 - epsilon) * rows.mean(axis=1) + epsilon * rows.max(axis=1),
    )


def only_the_best(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    """Expected SARSA also counts the random actions: each has the probability epsilon / A."""
    return _rows(
        q,
        rewards,
        next_states,
        next_actions,
        terminated,
        discount,
        lambda rows: (1 - epsilon) * rows.max(axis=1),
    )


def no_discount(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    """Multiply the value of the next state by the discount factor."""
    return _rows(
        q,
        rewards,
        next_states,
        next_actions,
        terminated,
        1.0,
        lambda rows: epsilon * rows.mean(axis=1) + (1 - epsilon) * rows.max(axis=1),
    )
