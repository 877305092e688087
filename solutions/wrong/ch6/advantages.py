"""Known mistakes in 6.4; a function's docstring is its hint."""

import numpy as np


def _backwards(
    rewards,
    values,
    next_values,
    seconds,
    terminated,
    truncated,
    discount,
    decay,
    *,
    powers=None,
    keeps=None,
    no_value=None,
    ends=None,
    baseline=True,
):
    powers = discount**seconds if powers is None else powers
    keeps = powers * decay if keeps is None else keeps
    no_value = terminated if no_value is None else no_value
    ends = terminated | truncated if ends is None else ends
    errors = rewards + powers * np.where(no_value, 0.0, next_values) - values
    found, later = np.zeros_like(errors), np.zeros(errors.shape[1])
    for t in reversed(range(len(errors))):
        later = errors[t] + np.where(ends[t], 0.0, keeps[t]) * later
        found[t] = later
    return found if baseline else found + values


def one_step(*case):
    """This is the error of the single step: add what the later errors of the episode say, discounted."""
    return _backwards(*case, keeps=np.zeros_like(case[3]))


def seconds_left_out(*case):
    """A step of several seconds is discounted by the discount factor to the power of its seconds."""
    return _backwards(*case, powers=np.full(case[3].shape, case[6]))


def seconds_multiplied(*case):
    """Raise the discount factor to the power of the seconds; do not multiply it by them."""
    return _backwards(*case, powers=case[6] * case[3])


def decay_by_the_second(*case):
    """Lambda counts once for each step, however long the step lasts; only the discount counts by the second."""
    return _backwards(*case, keeps=(case[6] * case[7]) ** case[3])


def decay_alone(*case):
    """The next advantage lies a step ahead: multiply it by the discount of the step, and not by lambda alone."""
    return _backwards(*case, keeps=np.full(case[3].shape, case[7]))


def discount_alone(*case):
    """Multiply the next advantage by lambda, too."""
    return _backwards(*case, keeps=case[6] ** case[3])


def value_after_the_end(*case):
    """After an episode has terminated nothing follows: the value of its last state counts as 0."""
    return _backwards(*case, no_value=np.zeros_like(case[4]))


def no_value_at_the_limit(*case):
    """Where the time limit ends an episode, the value of the last state counts: the robot would have gone on."""
    return _backwards(*case, no_value=case[4] | case[5])


def across_all_ends(*case):
    """The row after the end of an episode belongs to another one: its advantage must not flow back."""
    return _backwards(*case, ends=np.zeros_like(case[4]))


def across_the_limit(*case):
    """An episode that the time limit ends is over, too: the advantage of the next row must not flow back."""
    return _backwards(*case, ends=case[4])


def values_of_the_next_row(*case):
    """The next row may begin another episode: take the value after a step from the values that are given for it."""
    after = np.concatenate([case[1][1:], case[2][-1:]])
    return _backwards(*case[:2], after, *case[3:])


def returns_instead(*case):
    """This is the advantage plus the value of the state: the advantage is what goes beyond that value."""
    return _backwards(*case, baseline=False)


def standardised(*case):
    """Return the advantages as they are; PPO shifts and scales them afterwards."""
    found = _backwards(*case)
    return (found - found.mean()) / (found.std() + 1e-8)
