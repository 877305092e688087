"""Known mistakes in 4.5; a function's docstring is its hint."""

import numpy as np


def _weights(features, actions, costs, next_features, outcomes, number, discount, ridge, iterations, *, least=True,
             goal=True, fail=True, adds=False, future=False, mean=False, own=False, once=False, discounted=True,
             penalty_on=True, at_once=False):  # fmt: skip
    weights = np.zeros((number, features.shape[1]))
    for _ in range(1 if once else iterations):
        q = next_features @ weights.T
        following = q.min(axis=1) if least else q.max(axis=1)
        if own:
            following = q[np.arange(len(q)), actions]
        targets = costs + (discount if discounted else 1.0) * following
        if goal:
            targets = np.where(outcomes == 1, costs, targets)
        if fail:
            targets = np.where(outcomes == -1, costs + 1.0 if adds else 1.0, targets)
        if future:
            targets = np.where(outcomes == -1, 1.0 + discount * following, targets)
        if at_once:
            weights = _one_after_another(
                features,
                actions,
                costs,
                next_features,
                outcomes,
                weights,
                discount,
                ridge,
            )
            continue
        new = np.zeros_like(weights)
        for action in range(number):
            x, y = features[actions == action], targets[actions == action]
            penalty = ridge * (max(len(x), 1) if mean else 1)
            if penalty_on:
                new[action] = np.linalg.solve(
                    x.T @ x + penalty * np.eye(x.shape[1]), x.T @ y
                )
            elif len(x):
                new[action] = np.linalg.lstsq(x, y, rcond=None)[0]
        weights = new
    return weights


def takes_the_most(*arguments):
    """These are costs: the best action is the one with the least value."""
    return _weights(*arguments, least=False)


def on_from_the_goal(*arguments):
    """When the goal is reached, the target is only the cost of the step."""
    return _weights(*arguments, goal=False)


def forgives_failure(*arguments):
    """A step on which the robot failed has the target 1."""
    return _weights(*arguments, fail=False)


def failure_on_top(*arguments):
    """The target of a failure is exactly 1: do not add the cost of the step."""
    return _weights(*arguments, adds=True)


def failure_with_a_future(*arguments):
    """Nothing follows a failure: its target is exactly 1, without the value of a next state."""
    return _weights(*arguments, future=True)


def penalty_for_each(*arguments):
    """Add the penalty once, not once for each step: the squared errors are summed, not averaged."""
    return _weights(*arguments, mean=True)


def same_action_again(*arguments):
    """Use the best action of the next state, not the action that was taken in the current one."""
    return _weights(*arguments, own=True)


def only_once(*arguments):
    """Compute the targets again in each iteration, with the weights of the previous one."""
    return _weights(*arguments, once=True)


def one_too_few(*arguments):
    """There is one iteration too few: the first already fits the costs, with weights that were zero."""
    *others, iterations = arguments
    return _weights(*others, max(iterations - 1, 0))


def _one_after_another(
    features, actions, costs, next_features, outcomes, weights, discount, ridge
):
    weights = weights.copy()
    for action in range(len(weights)):
        following = (next_features @ weights.T).min(axis=1)
        targets = np.select(
            [outcomes == 1, outcomes == -1], [costs, 1.0], costs + discount * following
        )
        x, y = features[actions == action], targets[actions == action]
        weights[action] = np.linalg.solve(x.T @ x + ridge * np.eye(x.shape[1]), x.T @ y)
    return weights


def no_discount(*arguments):
    """Multiply the smallest value of the next state by the discount factor."""
    return _weights(*arguments, discounted=False)


def no_penalty(*arguments):
    """Add the penalty: it keeps the weights small where an action was taken in few steps."""
    return _weights(*arguments, penalty_on=False)


def one_after_another(*arguments):
    """Compute all targets with the weights of the last iteration, before any action's weights change."""
    return _weights(*arguments, at_once=True)
