"""Known mistakes in 2.1; a function's docstring is its hint."""

import numpy as np


def no_discount(transitions, rewards, discount, values, terminal):
    """Multiply the value of the next state by the discount factor."""
    q = np.einsum("ast,ast->sa", transitions, rewards + np.where(terminal, 0.0, values))
    q[terminal] = 0.0
    return q


def on_from_the_end(transitions, rewards, discount, values, terminal):
    """The episode ends in a terminal state: ignore its entry in the value table."""
    q = np.einsum("ast,ast->sa", transitions, rewards + discount * values)
    q[terminal] = 0.0
    return q


def acts_at_the_end(transitions, rewards, discount, values, terminal):
    """In a terminal state every action has the value 0."""
    return np.einsum(
        "ast,ast->sa", transitions, rewards + discount * np.where(terminal, 0.0, values)
    )


def actions_first(transitions, rewards, discount, values, terminal):
    """The answer has a row for each state and a column for each action."""
    q = np.einsum(
        "ast,ast->as", transitions, rewards + discount * np.where(terminal, 0.0, values)
    )
    q[:, terminal] = 0.0
    return q


def unweighted_rewards(transitions, rewards, discount, values, terminal):
    """Multiply the reward of each transition by the probability of the transition."""
    q = rewards.mean(axis=2).T + discount * np.einsum(
        "ast,t->sa", transitions, np.where(terminal, 0.0, values)
    )
    q[terminal] = 0.0
    return q
