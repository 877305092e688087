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
    """The way must be free at the place after the step, not at the one before it."""
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
