"""Known mistakes in 4.3; a function's docstring is its hint."""

import numpy as np


def _targets(outputs, actions, rewards, next_outputs, ended, bounds, discount, learning_rate, *, scale=True,
             horizon=True, end=True, clip=True, whole=False, zero=True, every=False, mean=False):  # fmt: skip
    least, greatest = (
        (bound / (1 - discount if horizon else 1) for bound in bounds)
        if scale
        else (0.0, 1.0)
    )
    taken = np.arange(len(actions)), actions
    q = least + (greatest - least) * outputs
    nothing = 0.0 if zero else least
    after = least + (greatest - least) * next_outputs.max(axis=1)
    following = np.where(ended, nothing, after) if end else after
    if mean:
        after = least + (greatest - least) * next_outputs.mean(axis=1)
        following = np.where(ended, nothing, after)
    if every:
        q += learning_rate * ((rewards + discount * following)[:, None] - q)
        return ((q - least) / (greatest - least)).clip(0.0, 1.0)
    q[taken] += (1.0 if whole else learning_rate) * (
        rewards + discount * following - q[taken]
    )
    targets = (q - least) / (greatest - least)
    return targets.clip(0.0, 1.0) if clip else targets


def as_they_are(*arguments):
    """An output is not a Q-value: 0 stands for the smallest possible Q-value, and 1 for the largest."""
    return _targets(*arguments, scale=False)


def one_reward(*arguments):
    """Divide the bounds of the rewards by 1 - discount to get the bounds of the Q-values, which are sums of rewards."""
    return _targets(*arguments, horizon=False)


def on_from_the_end(*arguments):
    """The last step of an episode has no next state: use 0 for its value."""
    return _targets(*arguments, end=False)


def worst_at_the_end(*arguments):
    """After the end the Q-value is 0. This is not the 0 of the network's scale."""
    return _targets(*arguments, zero=False)


def all_the_way(*arguments):
    """The value moves towards its target by the learning rate, not all the way."""
    return _targets(*arguments, whole=True)


def not_clipped(*arguments):
    """Clip the targets to the range from 0 to 1: a reward may be out of its bounds."""
    return _targets(*arguments, clip=False)


def every_action(*arguments):
    """Only the action that was taken gets a new target: all other targets are the network's own outputs."""
    return _targets(*arguments, every=True)


def mean_of_the_next(*arguments):
    """Q-learning uses the largest value of the next state."""
    return _targets(*arguments, mean=True)


def other_targets_zero(outputs, actions, *arguments):
    """The actions that were not taken keep the network's outputs as targets, so that they do not change."""
    targets = _targets(outputs, actions, *arguments)
    return np.where(np.arange(outputs.shape[1]) == actions[:, None], targets, 0.0)


def _on_raw_outputs(outputs, actions, rewards, next_outputs, ended, discount, rate):
    taken = np.arange(len(actions)), actions
    moved = outputs.copy()
    following = np.where(ended, 0.0, next_outputs.max(axis=1))
    moved[taken] += rate * (rewards + discount * following - moved[taken])
    return moved, taken


def scaled_at_the_end(outputs, actions, rewards, next_outputs, ended, bounds, discount, rate):  # fmt: skip
    """First bring the outputs onto the scale of the Q-values. Then move the value, and then bring it back."""
    least, greatest = (bound / (1 - discount) for bound in bounds)
    moved, taken = _on_raw_outputs(
        outputs, actions, rewards, next_outputs, ended, discount, rate
    )
    moved[taken] = (moved[taken] - least) / (greatest - least)
    return moved.clip(0.0, 1.0)


def all_scaled_at_the_end(outputs, actions, rewards, next_outputs, ended, bounds, discount, rate):  # fmt: skip
    """First bring the outputs onto the scale of the Q-values. Then move the value, and then bring it back."""
    least, greatest = (bound / (1 - discount) for bound in bounds)
    moved, _ = _on_raw_outputs(
        outputs, actions, rewards, next_outputs, ended, discount, rate
    )
    return ((moved - least) / (greatest - least)).clip(0.0, 1.0)


def not_back_on_the_scale(outputs, actions, rewards, next_outputs, ended, bounds, discount, rate):  # fmt: skip
    """Return the targets on the network's scale, from 0 to 1, not as Q-values."""
    least, greatest = (bound / (1 - discount) for bound in bounds)
    arguments = outputs, actions, rewards, next_outputs, ended, bounds, discount, rate
    return least + (greatest - least) * _targets(*arguments, clip=False)
