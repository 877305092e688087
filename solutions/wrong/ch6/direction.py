"""Known mistakes in 6.2; a function's docstring is its hint."""

import numpy as np


def _angles(target, last, n, *, around=True):
    apart = np.abs(np.arange(n) - np.array([target, 0, last])[:, None])
    return np.minimum(apart, n - apart) if around else apart


def _blocked(histogram, blocked, low, high):
    return (histogram >= high) | (blocked & (histogram > low))


def _least(blocked, cost):
    cost = np.where(blocked, np.inf, cost)
    return -1 if blocked.all() else int(cost.argmin())


def _step(
    histogram, blocked, low, high, target, last, weights, *,
    now=None, candidates=None, around=True, part=(1, 1, 1), least=_least,
):  # fmt: skip
    now = _blocked(histogram, blocked, low, high) if now is None else now
    angles = _angles(target, last, len(histogram), around=around)
    cost = (np.asarray(part) * weights) @ angles
    return now, cost, least(now if candidates is None else candidates, cost)


def high_threshold_alone(*case):
    """A bin between the two thresholds stays as it was: one that was blocked does not become free there."""
    return _step(*case, now=case[0] >= case[3])


def low_threshold_alone(*case):
    """A bin between the two thresholds stays as it was: one that was free is not blocked there."""
    return _step(*case, now=case[0] > case[2])


def once_blocked_always_blocked(*case):
    """A bin that was blocked becomes free when its magnitude is at most the low threshold."""
    return _step(*case, now=case[1] | (case[0] >= case[3]))


def changes_between(*case):
    """Between the thresholds a bin stays as it was; here it changes."""
    return _step(*case, now=_blocked(case[0], ~case[1], case[2], case[3]))


def free_at_the_high_threshold(*case):
    """A bin whose magnitude is exactly the high threshold is blocked."""
    now = (case[0] > case[3]) | (case[1] & (case[0] > case[2]))
    return _step(*case, now=now)


def stays_at_the_low_threshold(*case):
    """A bin whose magnitude is exactly the low threshold is free."""
    now = (case[0] >= case[3]) | (case[1] & (case[0] >= case[2]))
    return _step(*case, now=now)


def chosen_among_those_before(*case):
    """Choose among the bins that are free now, not among those that were free before."""
    return _step(*case, candidates=case[1])


def not_round_the_circle(*case):
    """The bins go round the circle: from bin 0 to the last bin it is one step."""
    return _step(*case, around=False)


def without_the_target(*case):
    """The angle to the target counts, too, with the first weight."""
    return _step(*case, part=(0, 1, 1))


def without_the_heading(*case):
    """The angle to the heading, bin 0, counts, too, with the second weight."""
    return _step(*case, part=(1, 0, 1))


def without_the_last(*case):
    """The angle to the bin that was chosen last counts, too, with the third weight."""
    return _step(*case, part=(1, 1, 0))


def weights_in_another_order(*case):
    """The weights belong to the target, the heading and the bin chosen last, in this order."""
    return _step(*case[:6], case[6][::-1])


def without_weights(*case):
    """Multiply each angle by its weight before you add them."""
    return _step(*case[:6], np.ones(3))


def last_of_equal_costs(*case):
    """Of several bins with the least cost, the one with the lowest number is chosen."""

    def least(blocked, cost):
        cost = np.where(blocked, np.inf, cost)
        reversed_place = int(cost[::-1].argmin())
        return -1 if blocked.all() else len(cost) - 1 - reversed_place

    return _step(*case, least=least)


def some_bin_where_none_is_free(*case):
    """Where no bin is free the answer is -1; the smallest of nothing but infinities is at place 0."""

    def least(blocked, cost):
        return int(np.where(blocked, np.inf, cost).argmin())

    return _step(*case, least=least)
