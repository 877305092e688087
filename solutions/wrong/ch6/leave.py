"""Known mistakes in 6.3; a function's docstring is its hint."""

import numpy as np


def _side(path, start, target):
    along, out = target - start, path - start
    return np.sign(along[0] * out[:, 1] - along[1] * out[:, 0])


def _meets(path, start, target):
    side = _side(path, start, target)
    return (side[1:] == 0) | (side[1:] * side[:-1] < 0)


def _away(path, target):
    return ((target - path) ** 2).sum(axis=1)


def _near(path, target):
    away = _away(path, target)
    return away[1:] < away[0]


def _first(leaves):
    return int(leaves.argmax()) + 1 if leaves.any() else -1


def anywhere(path, free, start, target):
    """Bug2 leaves the obstacle only with a step that meets the line from the start to the target."""
    return _first(_near(path, target) & free[1:])


def however_far(path, free, start, target):
    """Bug2 leaves only nearer to the target than where it met the obstacle, or it may go round for ever."""
    return _first(_meets(path, start, target) & free[1:])


def nearer_than_before(path, free, start, target):
    """Compare the distance with that of the place where the robot met the obstacle, not with that of the last place."""
    away = _away(path, target)
    return _first(_meets(path, start, target) & (away[1:] < away[:-1]) & free[1:])


def way_not_free(path, free, start, target):
    """The robot leaves only where the way to the target is free."""
    return _first(_meets(path, start, target) & _near(path, target))


def free_before(path, free, start, target):
    """The way must be free at the place after the step; whether it was free before does not matter."""
    return _first(_meets(path, start, target) & _near(path, target) & free[:-1])


def only_on_the_line(path, free, start, target):
    """A step also meets the line if the places before and after it lie on different sides."""
    on = _side(path, start, target)[1:] == 0
    return _first(on & _near(path, target) & free[1:])


def never_on_the_line(path, free, start, target):
    """A step also meets the line if the robot stands on it after the step."""
    side = _side(path, start, target)
    return _first((side[1:] * side[:-1] < 0) & _near(path, target) & free[1:])


def begins_on_the_line(path, free, start, target):
    """A step that only begins on the line does not meet it; the first step begins there, too."""
    side = _side(path, start, target)
    return _first((side[1:] * side[:-1] <= 0) & _near(path, target) & free[1:])


def line_from_the_origin(path, free, start, target):
    """The line begins at the start, which need not be the origin."""
    return _first(_meets(path, 0 * start, target) & _near(path, target) & free[1:])


def one_too_few(path, free, start, target):
    """The steps are numbered from 1: the first step leads to the second row of the path."""
    leaves = _meets(path, start, target) & _near(path, target) & free[1:]
    return int(leaves.argmax()) if leaves.any() else -1


def last_time(path, free, start, target):
    """The robot leaves the first time that it may, not the last time."""
    leaves = _meets(path, start, target) & _near(path, target) & free[1:]
    return int(np.flatnonzero(leaves)[-1]) + 1 if leaves.any() else -1


def nearest_meeting(path, free, start, target):
    """Bug2 leaves the first time that it may. Bug1 goes all the way round, and then returns to the nearest place."""
    leaves = _meets(path, start, target) & _near(path, target) & free[1:]
    away = np.where(leaves, _away(path, target)[1:], np.inf)
    return int(away.argmin()) + 1 if leaves.any() else -1


def first_step_where_it_stays(path, free, start, target):
    """If the robot does not leave, the answer is -1; `argmax` of nothing but False is 0."""
    leaves = _meets(path, start, target) & _near(path, target) & free[1:]
    return int(leaves.argmax()) + 1


def _leaves(path, free, start, target, *, meets=None, near=None, is_free=None):
    """After which steps the robot leaves, with another rule for one of the three conditions."""
    meets = _meets(path, start, target) if meets is None else meets
    near = _near(path, target) if near is None else near
    return meets & near & (free[1:] if is_free is None else is_free)


def as_near_is_enough(*case):
    """The place must be nearer to the target than where it met the obstacle: as near is not enough."""
    away = _away(case[0], case[3])
    return _first(_leaves(*case, near=away[1:] <= away[0]))


def farther_away(*case):
    """The place must be nearer to the target than where it met the obstacle, not farther away."""
    away = _away(case[0], case[3])
    return _first(_leaves(*case, near=away[1:] > away[0]))


def nearer_before_the_step(*case):
    """The place after the step must be nearer to the target, not the place before it."""
    away = _away(case[0], case[3])
    return _first(_leaves(*case, near=away[:-1] < away[0]))


def nearer_at_one_end_of_the_step(*case):
    """The place after the step must be nearer to the target; it does not help that the place before it was."""
    away = _away(case[0], case[3])
    return _first(_leaves(*case, near=np.minimum(away[1:], away[:-1]) < away[0]))


def nearer_than_all_before(*case):
    """The place must be nearer than where it met the obstacle, but not nearer than all places since then."""
    away = _away(case[0], case[3])
    return _first(_leaves(*case, near=away[1:] < np.minimum.accumulate(away)[:-1]))


def nearer_along_both_axes_together(*case):
    """The distance is the length of the straight way, not the sum of the ways along x and y."""
    away = np.abs(case[3] - case[0]).sum(axis=1)
    return _first(_leaves(*case, near=away[1:] < away[0]))


def nearer_along_the_longer_axis(*case):
    """The distance is the length of the straight way, not the longer one of the ways along x and y."""
    away = np.abs(case[3] - case[0]).max(axis=1)
    return _first(_leaves(*case, near=away[1:] < away[0]))


def free_at_both_ends(*case):
    """The way must be free at the place after the step; whether it was free before does not matter."""
    return _first(_leaves(*case, is_free=case[1][1:] & case[1][:-1]))


def free_at_one_end(*case):
    """The way must be free at the place after the step; whether it was free before does not matter."""
    return _first(_leaves(*case, is_free=case[1][1:] | case[1][:-1]))


def where_the_way_is_blocked(*case):
    """The robot leaves where the way to the target is free, not where it is blocked."""
    return _first(_leaves(*case, is_free=~case[1][1:]))


def first_meeting_or_never(*case):
    """If the robot may not leave where it meets the line, it goes on to where it meets it again."""
    meets = _meets(case[0], *case[2:])
    return _first(_leaves(*case, meets=meets & (meets.cumsum() == 1)))


def first_nearer_meeting_or_never(*case):
    """If the way is not free where it meets the line nearer, the robot goes on to where it meets it again."""
    meets = _meets(case[0], *case[2:]) & _near(case[0], case[3])
    return _first(_leaves(*case, meets=meets & (meets.cumsum() == 1)))


def side_of_the_first_place(*case):
    """Compare the sides before and after each step, not always with the side on which the robot was at first."""
    side = _side(case[0], *case[2:])
    return _first(_leaves(*case, meets=(side[1:] == 0) | (side[1:] * side[1] < 0)))


def any_change_of_side(*case):
    """A step that only begins on the line does not meet it; the first step begins there, too."""
    side = _side(case[0], *case[2:])
    return _first(_leaves(*case, meets=side[1:] != side[:-1]))


def x_and_y_exchanged(path, free, start, target):
    """The side of the line is the sign of the cross product, in which x of the one is multiplied by y of the other."""
    along, out = target - start, path - start
    side = np.sign(along[0] * out[:, 0] - along[1] * out[:, 1])
    meets = (side[1:] == 0) | (side[1:] * side[:-1] < 0)
    return _first(_leaves(path, free, start, target, meets=meets))


def along_instead_of_beside(path, free, start, target):
    """The inner product says how far along the line a place is; its side is the sign of the cross product."""
    along = np.sign((path - start) @ (target - start))
    meets = (along[1:] == 0) | (along[1:] * along[:-1] < 0)
    return _first(_leaves(path, free, start, target, meets=meets))


def line_from_the_next_place(path, free, start, target):
    """The line goes from the start to the target, wherever the robot is after its first step."""
    meets = _meets(path, path[1], target)
    return _first(_leaves(path, free, start, target, meets=meets))


def one_too_many(*case):
    """The first step has the number 1: a step's number is the row of the place after it, counted from 0."""
    found = _first(_leaves(*case))
    return found + 1 if found > 0 else found


def last_step_where_it_stays(*case):
    """If the robot does not leave, the answer is -1, and not the last step."""
    found = _first(_leaves(*case))
    return len(case[0]) - 1 if found == _first(np.zeros(1, dtype=bool)) else found


def nothing_where_it_stays(*case):
    """If the robot does not leave, the answer is the number -1, not None."""
    found = _first(_leaves(*case))
    return None if found == _first(np.zeros(1, dtype=bool)) else found


def zero_where_it_stays(*case):
    """If the robot does not leave, the answer is -1, and not 0."""
    found = _first(_leaves(*case))
    return 0 if found == _first(np.zeros(1, dtype=bool)) else found
