"""Known mistakes in 4.3; a function's docstring is its hint."""

import numpy as np


def _targets(outputs, actions, rewards, next_outputs, ended, bounds, discount, learning_rate, *, scale=True,
             horizon=True, end=True, clip=True, whole=False, zero=True):  # fmt: skip
    least, greatest = (bound / (1 - discount if horizon else 1) for bound in bounds) if scale else (0.0, 1.0)
    taken = np.arange(len(actions)), actions
    q = least + (greatest - least) * outputs
    nothing = 0.0 if zero else least
    after = least + (greatest - least) * next_outputs.max(axis=1)
    following = np.where(ended, nothing, after) if end else after
    q[taken] += (1.0 if whole else learning_rate) * (rewards + discount * following - q[taken])
    targets = (q - least) / (greatest - least)
    return targets.clip(0.0, 1.0) if clip else targets


def as_they_are(*arguments):
    """An output is no Q-value yet: 0 stands for the least there can be, 1 for the greatest."""
    return _targets(*arguments, scale=False)


def one_reward(*arguments):
    """The bounds on the Q-values are those of the rewards divided by 1 - discount: rewards add up."""
    return _targets(*arguments, horizon=False)


def on_from_the_end(*arguments):
    """Nothing follows the last step of an episode."""
    return _targets(*arguments, end=False)


def worst_at_the_end(*arguments):
    """Nothing to come is worth 0 as a Q-value, which is not the 0 of the network's scale."""
    return _targets(*arguments, zero=False)


def all_the_way(*arguments):
    """The value moves towards its target by the learning rate, not all the way."""
    return _targets(*arguments, whole=True)


def not_clipped(*arguments):
    """Targets stay between 0 and 1, even when a reward was out of its bounds."""
    return _targets(*arguments, clip=False)
