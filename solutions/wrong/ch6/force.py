"""Known mistakes in 6.1; a function's docstring is its hint."""

import numpy as np


def _pull(place, target, attraction, fading, *, strength=None):
    to_target = target - place
    d = np.hypot(*to_target)
    strength = min(d, fading) if strength is None else strength
    return attraction * strength * (to_target / d if d > 0 else to_target)


def _push(place, circles, repulsion, influence, *, edge=1.0, least=0.1, law=None):
    away = place - circles[:, :2]
    middle = np.hypot(away[:, 0], away[:, 1])
    rho = np.clip(middle - edge * circles[:, 2], least, influence)
    strength = repulsion * (1 / rho - 1 / influence) / rho**2
    strength = strength if law is None else law(rho)
    return (strength / middle)[:, None] * away


def _both(
    place, target, circles, attraction, fading, repulsion, influence, *,
    strength=None, edge=1.0, least=0.1, law=None,
):  # fmt: skip
    pull = _pull(place, target, attraction, fading, strength=strength)
    each = _push(place, circles, repulsion, influence, edge=edge, least=least, law=law)
    return np.array([pull, each.sum(axis=0)])


def grows_for_ever(*case):
    """Beyond the distance d* the pull stays the same: its strength is zeta times the smaller one of d and d*."""
    return _both(*case, strength=np.hypot(*(case[1] - case[0])))


def never_fades(*case):
    """Nearer than d* the pull is weaker: its strength is zeta times the distance."""
    return _both(*case, strength=case[4])


def pushed_by_the_target(*case):
    """The target pulls: the attraction points from the robot to its target."""
    return _both(*case) * np.array([[-1.0], [1.0]])


def pulled_by_obstacles(*case):
    """An obstacle pushes: the repulsion points from the middle of the circle to the robot."""
    return _both(*case) * np.array([[1.0], [-1.0]])


def nothing_by_nothing(place, target, circles, attraction, fading, *others):
    """At the target the division by the distance is 0 by 0. There is no force there."""
    found = _both(place, target, circles, attraction, fading, *others)
    d = np.hypot(*(target - place))
    with np.errstate(all="ignore"):
        found[0] = attraction * (target - place) * np.minimum(d, fading) / d
    return found


def from_the_middle(*case):
    """Measure the distance of an obstacle from its edge: take its radius off."""
    return _both(*case, edge=0.0)


def potential_for_force(*case):
    """This is the potential. The force is its negative derivative with respect to rho."""
    return _both(*case, law=lambda rho: case[5] / 2 * (1 / rho - 1 / case[6]) ** 2)


def inner_derivative_left_out(*case):
    """Differentiate 1 / rho, too: the strength has the factor 1 / rho squared."""
    return _both(*case, law=lambda rho: case[5] * (1 / rho - 1 / case[6]))


def pulls_from_afar(place, target, circles, attraction, fading, repulsion, influence):
    """An obstacle that is farther than the distance of influence has no force; here it pulls."""
    away = place - circles[:, :2]
    middle = np.hypot(away[:, 0], away[:, 1])
    rho = np.maximum(middle - circles[:, 2], 0.1)
    strength = repulsion * (1 / rho - 1 / influence) / rho**2
    pull = _pull(place, target, attraction, fading)
    return np.array([pull, (strength / middle) @ away])


def longer_from_afar(place, target, circles, attraction, fading, *others):
    """Divide the way from the middle of the circle by its length, so that it is a direction only."""
    each = _push(place, circles, *others)
    middle = np.hypot(*(place - circles[:, :2]).T)
    pull = _pull(place, target, attraction, fading)
    return np.array([pull, middle @ each])


def too_near(*case):
    """Where the robot is nearer to an edge than 0.1 m, or inside a circle, rho is 0.1 m."""
    return _both(*case, least=-np.inf)


def nearest_alone(place, target, circles, attraction, fading, *others):
    """All circles in reach push the robot, not only the nearest one: add their forces."""
    away = np.hypot(*(place - circles[:, :2]).T) - circles[:, 2]
    each = _push(place, circles, *others)
    pull = _pull(place, target, attraction, fading)
    return np.array([pull, each[away.argmin()]])


def mean_of_all(place, target, circles, attraction, fading, *others):
    """Add the forces of the circles; do not take their mean."""
    each = _push(place, circles, *others)
    pull = _pull(place, target, attraction, fading)
    return np.array([pull, each.mean(axis=0)])


def repulsion_first(*case):
    """The attraction comes first."""
    return _both(*case)[::-1]


def _in_reach(strength, case):
    """The law of a force that stops at the distance of influence."""
    return lambda rho: np.where(rho < case[6], strength(rho), 0.0)


def one_power_too_few(*case):
    """The derivative of 1 / rho is minus 1 / rho squared: the strength has this factor, and not 1 / rho."""
    return _both(*case, law=lambda rho: case[5] * (1 / rho - 1 / case[6]) / rho)


def one_power_too_many(*case):
    """The derivative of 1 / rho is minus 1 / rho squared: here there is one power of rho too many."""
    return _both(*case, law=lambda rho: case[5] * (1 / rho - 1 / case[6]) / rho**3)


def half_of_the_push(*case):
    """The derivative of a square has a factor 2, which cancels the half of the potential."""
    return _both(*case, law=lambda rho: case[5] / 2 * (1 / rho - 1 / case[6]) / rho**2)


def twice_the_push(*case):
    """The potential has a half, which cancels the factor 2 of the square's derivative."""
    return _both(*case, law=lambda rho: 2 * case[5] * (1 / rho - 1 / case[6]) / rho**2)


def bracket_still_squared(*case):
    """The derivative of a square has the bracket once: here it is still squared."""
    return _both(*case, law=lambda rho: case[5] * (1 / rho - 1 / case[6]) ** 2 / rho**2)


def influence_left_out(*case):
    """The bracket takes 1 / rho_0 off, so that the force begins with 0 at the distance of influence."""
    return _both(*case, law=_in_reach(lambda rho: case[5] / rho**3, case))


def only_the_inner_derivative(*case):
    """This is the inner derivative alone: the derivative of the square also leaves the bracket as a factor."""
    return _both(*case, law=_in_reach(lambda rho: case[5] / rho**2, case))


def larger_of_the_two(*case):
    """The pull has the smaller one of d and d* as a factor, not the larger one."""
    return _both(*case, strength=max(np.hypot(*(case[1] - case[0])), case[4]))


def potential_of_the_target(*case):
    """For the target this is the potential. The pull is its derivative with respect to d."""
    d, fading = np.hypot(*(case[1] - case[0])), case[4]
    far = fading * d - fading**2 / 2
    return _both(*case, strength=d**2 / 2 if d <= fading else far)


def share_of_the_fading(*case):
    """The strength is zeta times a distance: do not divide it by d*."""
    d = np.hypot(*(case[1] - case[0]))
    return _both(*case, strength=min(d / case[4], 1.0))


def half_of_the_pull(*case):
    """The derivative of the square of d has a factor 2, which cancels the half: the pull is twice as strong."""
    d = np.hypot(*(case[1] - case[0]))
    return _both(*case, strength=min(d, case[4]) / 2)


def distance_squared(*case):
    """The strength grows with the distance itself, not with its square."""
    d = np.hypot(*(case[1] - case[0]))
    return _both(*case, strength=min(d, case[4]) ** 2)


def everywhere_the_same(*case):
    """This pull has the same strength zeta everywhere, as on the page; here the smaller one of d and d* counts, too."""
    return _both(*case, strength=1.0)


def longer_pull_from_afar(*case):
    """Divide the way to the target by its length, so that it is a direction only."""
    d = np.hypot(*(case[1] - case[0]))
    return _both(*case, strength=min(d, case[4]) * d)


def each_coordinate_limited(place, target, circles, attraction, fading, *others):
    """The length of the way is limited to d*, not each of its two coordinates."""
    found = _both(place, target, circles, attraction, fading, *others)
    found[0] = attraction * np.clip(target - place, -fading, fading)
    return found


def always_a_little_farther(place, target, circles, *others):
    """The 0.1 m are the least that rho may be: they are not added to it."""
    away = place - circles[:, :2]
    farther = np.hypot(away[:, 0], away[:, 1]) - circles[:, 2] > 0
    widened = circles - np.array([0.0, 0.0, 0.1]) * farther[:, None]
    return _both(place, target, widened, *others)


def no_force_at_the_edge(place, target, circles, *others):
    """A robot that is nearer to an edge than 0.1 m, or inside a circle, is pushed, too: there rho is 0.1 m."""
    away = np.hypot(*(place - circles[:, :2]).T) - circles[:, 2]
    shrunk = np.where(away[:, None] < 0.1, np.array([1.0, 1.0, -np.inf]), 1.0)
    with np.errstate(all="ignore"):
        return _both(place, target, circles * shrunk, *others)


def no_force_inside(place, target, circles, *others):
    """Inside a circle the robot is pushed, too, away from the middle: there rho is 0.1 m."""
    away = np.hypot(*(place - circles[:, :2]).T) - circles[:, 2]
    shrunk = np.where(away[:, None] < 0, np.array([1.0, 1.0, -np.inf]), 1.0)
    with np.errstate(all="ignore"):
        return _both(place, target, circles * shrunk, *others)


def pushed_at_an_edge_not_inside(place, target, circles, *others):
    """Inside a circle rho is 0.1 m, too, and not the negative distance."""
    away = np.hypot(*(place - circles[:, :2]).T) - circles[:, 2]
    least = np.where(away > 0, 0.1, -np.inf)
    return _both(place, target, circles, *others, least=least)


def diameter(*case):
    """The third number of a circle is its radius, not its diameter."""
    return _both(*case, edge=0.5)


def direction_from_the_edge(place, target, circles, *others):
    """Divide the way from the middle of the circle by its own length, and not by the distance from the edge."""
    away = place - circles[:, :2]
    middle = np.hypot(away[:, 0], away[:, 1])
    rho = np.clip(middle - circles[:, 2], 0.1, others[3])
    found = _both(place, target, circles, *others)
    each = _push(place, circles, *others[2:]) * (middle / rho)[:, None]
    return np.array([found[0], each.sum(axis=0)])


def both_in_one(*case):
    """Return both forces, the attraction above the repulsion; do not add them."""
    return _both(*case).sum(axis=0)


def sum_below_the_attraction(*case):
    """The second row is the repulsion alone; the attraction must not be added to it."""
    return _both(*case).cumsum(axis=0)


def columns_for_rows(*case):
    """Each force is a row of the answer, with x and y; here each is a column."""
    return _both(*case).T


def strengths_alone(*case):
    """A force has a direction: return its x and its y, not only its strength."""
    return np.hypot(*_both(*case).T)
