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
