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


def values_of_the_next_row_and_none_after_the_last(*case):
    """Take the value after a step from those given, in the last row too: the next row may begin another episode."""
    after = np.concatenate([case[1][1:], 0 * case[2][-1:]])
    return _backwards(*case[:2], after, *case[3:])


def returns_instead(*case):
    """This is the advantage plus the value of the state: the advantage is what goes beyond that value."""
    return _backwards(*case, baseline=False)


def standardised(*case):
    """Return the advantages as they are; PPO shifts and scales them afterwards."""
    found = _backwards(*case)
    return (found - found.mean()) / (found.std() + 1e-8)


def seconds_left_out_of_the_errors(*case):
    """The discount to the power of the seconds stands before the next value, too, and not only before the advantage."""
    seconds, discount, decay = case[3], case[6], case[7]
    flat = np.full(seconds.shape, discount)
    return _backwards(*case, powers=flat, keeps=discount**seconds * decay)


def seconds_left_out_of_the_advantages(*case):
    """The discount to the power of the seconds stands before the next advantage, too, and not only before the value."""
    return _backwards(*case, keeps=np.full(case[3].shape, case[6] * case[7]))


def discount_and_decay_exchanged(*case):
    """Discount and lambda are exchanged: the discount is raised to the power of the seconds, and lambda counts once."""
    return _backwards(*case[:6], case[7], case[6])


def decay_in_the_errors(*case):
    """The error has the discount and no lambda: lambda stands only before the next advantage."""
    powers = case[6] ** case[3]
    return _backwards(*case, powers=powers * case[7], keeps=powers * case[7])


def decay_for_the_discount_in_the_errors(*case):
    """In the error the next value is multiplied by the discount to the power of the seconds, not by that of lambda."""
    keeps = case[6] ** case[3] * case[7]
    return _backwards(*case, powers=case[7] ** case[3], keeps=keeps)


def exchanged_before_the_advantage(*case):
    """Before the next advantage, the discount is raised to the power of the seconds, and lambda is not."""
    return _backwards(*case, keeps=case[6] * case[7] ** case[3])


def both_by_the_second_everywhere(*case):
    """Lambda counts once for each step, and only before the next advantage; the error has the discount alone."""
    powers = (case[6] * case[7]) ** case[3]
    return _backwards(*case, powers=powers, keeps=powers)


def value_not_discounted(*case):
    """In the error the next value is multiplied by the discount to the power of the seconds."""
    keeps = case[6] ** case[3] * case[7]
    return _backwards(*case, powers=np.ones_like(case[3]), keeps=keeps)


def _following(table):
    return np.concatenate([table[1:], table[-1:]])


def seconds_of_the_next_step(*case):
    """What comes after a step is discounted by the seconds of this step, not by those of the next one."""
    powers = case[6] ** _following(case[3])
    return _backwards(*case, powers=powers, keeps=powers * case[7])


def seconds_of_the_next_step_before_the_advantage(*case):
    """The next advantage is discounted by the seconds of this step, not by those of the next one."""
    return _backwards(*case, keeps=case[6] ** _following(case[3]) * case[7])


def seconds_divide(*case):
    """Raise the discount factor to the power of the seconds; do not divide it by them."""
    return _backwards(*case, powers=case[6] / case[3])


def seconds_to_the_power_of_the_discount(*case):
    """Raise the discount factor to the power of the seconds, not the seconds to the power of the discount factor."""
    return _backwards(*case, powers=case[3] ** case[6])


def seconds_since_the_first_step(*case):
    """Only the seconds of the step itself count: the discounts of the later steps come with their advantages."""
    return _backwards(*case, powers=case[6] ** case[3].cumsum(axis=0))


def reward_by_the_second(*case):
    """The reward is that of the whole step: do not multiply it by the seconds."""
    return _backwards(case[0] * case[3], *case[1:])


def reward_discounted(*case):
    """The reward of the step itself is not discounted; only what comes after the step is."""
    return _backwards(case[0] * case[6] ** case[3], *case[1:])


def value_added(*case):
    """The value of the state before the step is taken off, not added: the error is what goes beyond it."""
    return _backwards(case[0], -case[1], *case[2:])


def value_not_taken_off(*case):
    """The value of the state before the step is missing in the error: take it off."""
    return _backwards(case[0], 0 * case[1], *case[2:])


def no_end_at_all(*case):
    """Where an episode has terminated nothing follows: neither the value of its last state nor the next advantage."""
    nothing = np.zeros_like(case[4])
    return _backwards(*case, no_value=nothing, ends=nothing)


def ends_exchanged(*case):
    """The two ends are exchanged: one that terminated has no value of its last state, one of the time limit has."""
    return _backwards(*case, no_value=case[5])


def across_the_terminated(*case):
    """An episode that terminated is over, too: the advantage of the next row must not flow back."""
    return _backwards(*case, ends=case[5])


def forwards(*case):
    """An advantage holds what comes later: go through the rows from the last step to the first one."""
    turned = _backwards(*(one[::-1] for one in case[:6]), *case[6:])
    return turned[::-1]


def ends_of_any_robot(*case):
    """Each robot has its own episodes: if one robot's ends, the advantages of the others flow on."""
    ends = (case[4] | case[5]).any(axis=1, keepdims=True)
    return _backwards(*case, ends=np.broadcast_to(ends, case[4].shape))


def cleared_after_the_step(*case):
    """The cut between two episodes is one row off: an end's own advantage flows back, that of the next row does not."""
    _, _, _, seconds, terminated, truncated, discount, decay = case
    ends, keeps = terminated | truncated, discount**seconds * decay
    found = _backwards(*case, keeps=0 * keeps)
    later = np.zeros(ends.shape[1])
    for t in reversed(range(len(ends))):
        found[t] += keeps[t] * later
        later = np.where(ends[t], 0.0, found[t])
    return found


def value_follows_the_last_row(*case):
    """Nothing follows the last row: its advantage is its error alone, in which the value after it counts already."""
    found, keeps = _backwards(*case), case[6] ** case[3] * case[7]
    later = case[2][-1]
    for t in reversed(range(len(found))):
        later = np.where(case[4][t] | case[5][t], 0.0, keeps[t] * later)
        found[t] += later
    return found


def last_row_left_out(*case):
    """The last row has an advantage, too: its error. Only what follows it counts as zero."""
    found = _backwards(*case)
    found[-1] = 0.0
    return found


def no_error_at_the_end(*case):
    """The last step of an episode has an error, too: only the next advantage does not count there."""
    ends, keeps = case[4] | case[5], case[6] ** case[3] * case[7]
    errors = _backwards(*case, keeps=0 * keeps)
    found, later = np.zeros_like(errors), np.zeros(errors.shape[1])
    for t in reversed(range(len(errors))):
        later = np.where(ends[t], 0.0, errors[t] + keeps[t] * later)
        found[t] = later
    return found


def value_not_taken_off_at_the_end(*case):
    """Where an episode terminates, the value before the step is taken off, too: the error is the reward minus it."""
    return _backwards(case[0], np.where(case[4], 0.0, case[1]), *case[2:])
