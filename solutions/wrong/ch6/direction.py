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


def chosen_below_the_high_threshold(*case):
    """A bin below the high threshold may still be blocked from before: it is no candidate, since it is not free."""
    return _step(*case, candidates=case[0] >= case[3])


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


def _priced(case, price):
    """The right answer with another cost for the bins that are blocked."""
    now, cost, chosen = _step(*case)
    return now, np.where(now, price, cost), chosen


def blocked_bins_cost_infinity(*case):
    """The cost is asked for each bin, whether free or not: a blocked bin has its cost as well, and not infinity."""
    return _priced(case, np.inf)


def blocked_bins_have_no_number(*case):
    """The cost is asked for each bin, whether free or not: a blocked bin has its cost as well, and not nan."""
    return _priced(case, np.nan)


def blocked_bins_cost_nothing(*case):
    """The cost is asked for each bin, whether free or not: a blocked bin has its cost as well, and not 0."""
    return _priced(case, 0.0)


def blocked_bins_cost_minus_one(*case):
    """The cost is asked for each bin, whether free or not: a blocked bin has its cost as well, and not -1."""
    return _priced(case, -1.0)


def cost_of_free_bins_alone(*case):
    """The cost is asked for each bin, whether free or not, so there are as many costs as bins."""
    now, cost, chosen = _step(*case)
    return now, cost[~now], chosen


def number_among_the_free(*case):
    """Bins keep their numbers: return the number among all bins, not the place among those that are free."""

    def least(blocked, cost):
        return -1 if blocked.all() else int(cost[~blocked].argmin())

    return _step(*case, least=least)


def chosen_among_all(*case):
    """Only a free bin is a candidate; here the least cost of all bins is chosen, even of a blocked one."""
    return _step(*case, least=lambda blocked, cost: int(cost.argmin()))


def chosen_among_the_blocked(*case):
    """The candidates are the bins that are free, not those that are blocked."""
    now = _blocked(*case[:4])
    return _step(*case, candidates=~now)


def lowest_free_bin(*case):
    """Among the free bins the one of the least cost is chosen; the number decides only between equal costs."""

    def least(blocked, cost):
        return -1 if blocked.all() else int(blocked.argmin())

    return _step(*case, least=least)


def nearest_to_the_target(*case):
    """The cost decides, with all three angles, and not the angle to the target alone."""
    now, cost, _ = _step(*case)
    return now, cost, _step(*case, part=(1, 0, 0))[2]


def largest_cost(*case):
    """The candidate of the least cost is chosen, not that of the largest."""
    now, cost, _ = _step(*case)
    free = np.where(now, -np.inf, cost)
    return now, cost, -1 if now.all() else int(free.argmax())


def none_where_none_is_free(*case):
    """Where no bin is free the answer is the number -1, not None."""
    now, cost, chosen = _step(*case)
    return now, cost, None if chosen < 0 else chosen


def the_last_where_none_is_free(*case):
    """Where no bin is free the answer is -1, and not the bin that was chosen last."""
    now, cost, chosen = _step(*case)
    return now, cost, case[5] if chosen < 0 else chosen


def target_and_heading_exchanged(*case):
    """The weights of the angles to the target and to the heading are exchanged."""
    return _step(*case[:6], case[6][[1, 0, 2]])


def heading_and_last_exchanged(*case):
    """The weights of the angles to the heading and to the bin chosen last are exchanged."""
    return _step(*case[:6], case[6][[0, 2, 1]])


def weights_one_place_on(*case):
    """Each weight stands with another angle than its own: look up their order in the text."""
    return _step(*case[:6], case[6][[1, 2, 0]])


def weights_one_place_back(*case):
    """Each weight stands with another angle than its own: look up their order in the text."""
    return _step(*case[:6], case[6][[2, 0, 1]])


def weights_sum_to_one(*case):
    """The cost is the sum of the weighted angles, and not their mean: do not divide it by the sum of the weights."""
    now, cost, chosen = _step(*case)
    return now, cost / case[6].sum(), chosen


def costs_sum_to_one(*case):
    """The cost is the sum of the weighted angles: do not divide the costs by their sum."""
    now, cost, chosen = _step(*case)
    return now, cost / cost.sum(), chosen


def both_thresholds_strict(*case):
    """Exactly at the high threshold a bin is blocked, and exactly at the low one it is free."""
    now = (case[0] > case[3]) | (case[1] & (case[0] >= case[2]))
    return _step(*case, now=now)


def blocked_where_little_is(*case):
    """A bin is blocked where much obstacle lies, at the high threshold or above, and not where little does."""
    now = np.where(
        case[0] <= case[2], True, np.where(case[0] >= case[3], False, case[1])
    )
    return _step(*case, now=now)


def blocked_from_the_low_threshold(*case):
    """Between the thresholds a bin stays as it was, and exactly at the low one it is free: here both are blocked."""
    return _step(*case, now=case[0] >= case[2])


def one_threshold_in_the_middle(*case):
    """There are two thresholds, and between them a bin stays as it was: their mean has no meaning."""
    return _step(*case, now=case[0] >= (case[2] + case[3]) / 2)


def only_what_was_blocked(*case):
    """A bin whose magnitude is at least the high threshold is blocked, even if it was free before."""
    return _step(*case, now=case[1] & (case[0] >= case[3]))


def stays_for_ever(*case):
    """The flags are those from before: above the high threshold and below the low one they must change."""
    return _step(*case, now=case[1])


def free_flags(*case):
    """The flags say which bins are blocked; here they say which are free."""
    now, cost, chosen = _step(*case)
    return ~now, cost, chosen


def _measured(case, angle):
    """The answer for another angle between two bins, of their numbers and of how many there are."""
    now, n = _blocked(*case[:4]), len(case[0])
    to = np.array([case[4], 0, case[5]])[:, None]
    cost = case[6] @ angle(np.arange(n) - to, n)
    return now, cost, _least(now, cost)


def one_way_round(*case):
    """An angle is the shorter way round the circle: here it is always counted in the same sense, up to a full turn."""
    return _measured(case, lambda off, n: off % n)


def the_other_way_round(*case):
    """An angle is the shorter way round the circle: here it is always counted in the same sense, up to a full turn."""
    return _measured(case, lambda off, n: -off % n)


def angles_with_a_sign(*case):
    """An angle is a number of bins, and never negative: take it without its sign, or both sides cancel."""
    return _measured(case, lambda off, n: (off + n // 2) % n - n // 2)


def one_bin_too_few(*case):
    """Round the circle there are as many steps as bins: here one is missing the other way round."""
    return _measured(case, lambda off, n: np.minimum(abs(off), n - 1 - abs(off)))


def in_degrees(*case):
    """The angle is how many bins two bins are apart, and not so many degrees."""
    return _measured(case, lambda off, n: np.minimum(abs(off), n - abs(off)) * 360 / n)


def in_radians(*case):
    """The angle is how many bins two bins are apart, and not so many radians."""
    turn = 2 * np.pi
    return _measured(case, lambda off, n: np.minimum(abs(off), n - abs(off)) * turn / n)


def angles_squared(*case):
    """The cost is a sum of angles, not of their squares."""
    return _measured(case, lambda off, n: np.minimum(abs(off), n - abs(off)) ** 2)


def heading_is_the_last(*case):
    """The heading is bin 0, and not the bin that was chosen last."""
    to_target, to_heading, to_last = case[6]
    return _step(*case[:6], np.array([to_target, 0.0, to_heading + to_last]))
