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


def forgets_the_end(transitions, rewards, discount, values, terminal):
    """A terminal state needs two rules: V(s') = 0 as a next state, and Q = 0 for all actions in the state itself."""
    return np.einsum("ast,ast->sa", transitions, rewards + discount * values)


def no_reward_into_the_end(transitions, rewards, discount, values, terminal):
    """A step into a terminal state has its reward: only the value of the terminal state is 0, not r(s, a, s')."""
    target = np.where(terminal, 0.0, rewards + discount * values)
    q = np.einsum("ast,ast->sa", transitions, target)
    q[terminal] = 0.0
    return q


def discounts_the_reward(transitions, rewards, discount, values, terminal):
    """Do not discount the reward of this step: the discount belongs to the value of the next state."""
    following = np.where(terminal, 0.0, values)
    q = discount * np.einsum("ast,ast->sa", transitions, rewards + following)
    q[terminal] = 0.0
    return q


def probabilities_turned(transitions, rewards, discount, values, terminal):
    """The second index of the transitions is the state, the third the next state: sum over the third."""
    target = rewards + discount * np.where(terminal, 0.0, values)
    q = np.einsum("ats,ast->sa", transitions, target)
    q[terminal] = 0.0
    return q
