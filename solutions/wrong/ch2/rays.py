"""Known mistakes in 2.11; a function's docstring is its hint."""

import numpy as np


def _met(pose, centres, radii, size, *, first=0.0, unit=1.0):
    """How far each ray goes to each circle and to each border; infinity where it never arrives."""
    angles = pose[2] * unit + np.radians(40) * np.arange(9) + first
    u = np.column_stack([np.cos(angles), np.sin(angles)])
    to_centres = centres - pose[:2]
    foot = u @ to_centres.T
    half_chord = radii**2 - ((to_centres**2).sum(axis=1) - foot**2)
    enters = (foot > 0) & (half_chord > 0)
    circles = np.where(enters, foot - np.sqrt(np.maximum(half_chord, 0)), np.inf)
    borders = np.where(u > 0, size - pose[:2], -pose[:2])
    walls = np.where(u == 0, np.inf, borders / np.where(u == 0, 1, u))
    return circles, walls


def _read(circles, walls, reach):
    nearest = np.column_stack([circles, walls]).min(axis=1)
    return np.where(nearest > reach, reach, nearest)


def _feet(pose, centres):
    angles = pose[2] + np.radians(40) * np.arange(9)
    u = np.column_stack([np.cos(angles), np.sin(angles)])
    return u @ (centres - pose[:2]).T


def clockwise(pose, centres, radii, size, reach):
    """The rays follow counter-clockwise: the second one points 40 degrees to the left of the first."""
    return _read(*_met(pose, centres, radii, size), reach)[[0, 8, 7, 6, 5, 4, 3, 2, 1]]


def on_the_map(pose, centres, radii, size, reach):
    """The first ray points where the robot faces: add the heading to the angles of the rays."""
    return _read(*_met(pose, centres, radii, size, unit=0.0), reach)


def heading_in_degrees(pose, centres, radii, size, reach):
    """The heading is in radians already."""
    return _read(*_met(pose, centres, radii, size, unit=np.pi / 180), reach)


def half_a_sector_aside(pose, centres, radii, size, reach):
    """The rays point 0, 40, 80 ... degrees from the heading, not to the borders of the sectors."""
    return _read(*_met(pose, centres, radii, size, first=np.radians(20)), reach)


def out_of_the_circle(pose, centres, radii, size, reach):
    """The ray ends where it enters a circle: subtract half the chord from the distance of the foot."""
    circles, walls = _met(pose, centres, radii, size)
    left = np.where(np.isinf(circles), np.inf, 2 * _feet(pose, centres) - circles)
    return _read(left, walls, reach)


def to_the_foot(pose, centres, radii, size, reach):
    """The foot of the perpendicular lies inside the circle: the ray enters half a chord before it."""
    circles, walls = _met(pose, centres, radii, size)
    feet = np.where(np.isinf(circles), np.inf, _feet(pose, centres))
    return _read(feet, walls, reach)


def to_the_nearest_point(pose, centres, radii, size, reach):
    """A ray that does not pass through the centre meets the circle farther away than its nearest point."""
    circles, walls = _met(pose, centres, radii, size)
    away = np.hypot(*(centres - pose[:2]).T) - radii
    return _read(np.where(np.isinf(circles), np.inf, away), walls, reach)


def foot_less_radius(pose, centres, radii, size, reach):
    """Half the chord is shorter than the radius, unless the ray passes through the centre: use Pythagoras."""
    circles, walls = _met(pose, centres, radii, size)
    before = _feet(pose, centres) - radii
    return _read(np.where(np.isinf(circles), np.inf, before), walls, reach)


def behind_as_well(pose, centres, radii, size, reach):
    """A ray goes one way only: a circle whose foot lies behind the robot is not on its way."""
    circles, walls = _met(pose, centres, radii, size)
    back = -_feet(pose, centres)
    squared = radii**2 - (((centres - pose[:2]) ** 2).sum(axis=1) - back**2)
    hit = (back > 0) & (squared > 0)
    entered = np.where(hit, back - np.sqrt(np.maximum(squared, 0)), np.inf)
    return _read(np.minimum(circles, entered), walls, reach)


def without_circles(pose, centres, radii, size, reach):
    """The rays also end at circles, not only at the border of the map."""
    _, walls = _met(pose, centres, radii, size)
    return _read(np.full((9, 0), np.inf), walls, reach)


def without_borders(pose, centres, radii, size, reach):
    """The rays also end at the border of the map."""
    circles, walls = _met(pose, centres, radii, size)
    return _read(circles, np.full_like(walls, np.inf), reach)


def straight_to_the_border(pose, centres, radii, size, reach):
    """A ray meets the border where it crosses it, which is farther away than the nearest point of the border."""
    circles, _ = _met(pose, centres, radii, size)
    least = np.minimum(pose[:2], size - pose[:2]).min()
    return _read(circles, np.full((9, 1), least), reach)


def two_borders_only(pose, centres, radii, size, reach):
    """A ray that points to the left or downwards meets the borders x = 0 and y = 0."""
    circles, walls = _met(pose, centres, radii, size)
    angles = pose[2] + np.radians(40) * np.arange(9)
    u = np.column_stack([np.cos(angles), np.sin(angles)])
    return _read(circles, np.where(u > 0, walls, np.inf), reach)


def without_end(pose, centres, radii, size, reach):
    """What is farther away than the range of the rays is not seen: the ray gives ``reach``."""
    return _read(*_met(pose, centres, radii, size), np.inf)


def the_last_in_the_list(pose, centres, radii, size, reach):
    """A ray ends at the nearest circle on its way, not at the first or the last one of the list."""
    circles, walls = _met(pose, centres, radii, size)
    if circles.shape[1] == 0:
        return _read(circles, walls, reach)
    found = np.isfinite(circles)
    last = circles.shape[1] - 1 - np.argmax(found[:, ::-1], axis=1)
    chosen = np.where(found.any(axis=1), circles[np.arange(9), last], np.inf)
    return _read(chosen[:, None], walls, reach)


def over_the_sector(pose, centres, radii, size, reach):
    """A ray sees what is on its line, not all of its sector of 40 degrees, as the sensors of the book's robot do."""
    circles, walls = _met(pose, centres, radii, size)
    for degrees in range(-20, 21):
        beside, border = _met(pose, centres, radii, size, first=np.radians(degrees))
        circles, walls = np.minimum(circles, beside), np.minimum(walls, border)
    return _read(circles, walls, reach)
