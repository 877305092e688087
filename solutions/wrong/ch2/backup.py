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


def _backed_up(transitions, rewards, discount, values, terminal):
    following = np.where(terminal, 0.0, values)
    q = np.einsum("ast,ast->sa", transitions, rewards + discount * following)
    q[terminal] = 0.0
    return q


def best_action_alone(*case):
    """Return the value of each action, and not only that of the best one."""
    return _backed_up(*case).max(axis=1, keepdims=True)


def mean_of_the_actions(*case):
    """Return the value of each action, and not their mean in its place."""
    q = _backed_up(*case)
    return np.broadcast_to(q.mean(axis=1, keepdims=True), q.shape).copy()


def value_of_the_same_state(transitions, rewards, discount, values, terminal):
    """The value is that of the next state, not that of the state before the step."""
    q = np.einsum("ast,ast->sa", transitions, rewards)
    q = q + discount * np.where(terminal, 0.0, values)[:, None]
    q[terminal] = 0.0
    return q


def likeliest_next_state_alone(transitions, rewards, discount, values, terminal):
    """Sum over all next states with their probabilities; do not take the likeliest one alone."""
    likeliest = transitions == transitions.max(axis=2, keepdims=True)
    alone = likeliest / likeliest.sum(axis=2, keepdims=True)
    return _backed_up(alone, rewards, discount, values, terminal)
