"""What the planners share: directions relative to the heading, and how far a robot can go in a direction."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.robot import SENSOR_RANGE, Sensing
from robonav.robot._fast import SECTOR, SENSORS, TURNS

Floats = NDArray[np.float64]

CENTRES: Floats = np.array([SECTOR * ((k + 4) % SENSORS - 4) for k in range(SENSORS)])
"""Bearings (9,) of the middles of the sectors in radians from -pi to pi, counter-clockwise, 0 ahead."""

WAYS: Floats = np.append(TURNS[:5], math.pi)
"""Bearings (6,) in which the actions F, L30, L60, R30, R60 and B move the robot; B moves it backwards."""

POINTS = np.linspace(-1.0, 1.0, 5)
"""Where the five points that stand for a reading lie, in half widths from the middle of the sector."""


def turned(angles: ArrayLike) -> Floats:
    """Return angles in radians as the same directions between -pi and pi.

    Examples
    --------
    >>> import numpy as np
    >>> np.degrees(turned(np.radians([30.0, 200.0, -190.0]))).round()
    array([  30., -160.,  170.])
    """
    folded: Floats = np.remainder(np.asarray(angles) + np.pi, 2 * np.pi) - np.pi
    return folded


def target_bearing(sensing: Sensing) -> Floats:
    """Return the bearing of the middle of the target's sector, which is all that the robot senses of the target.

    Parameters
    ----------
    sensing : Sensing
        What N robots sense.

    Returns
    -------
    (N,) array
        Radians from -pi to pi, counter-clockwise, 0 ahead.

    Examples
    --------
    >>> from robonav.planners import target_bearing
    >>> from robonav.robot import make_world, sense
    >>> target_bearing(sense(make_world(target=(50, 90)), [(50, 50, 0)])).round(2)
    array([1.4])
    """
    return CENTRES[sensing.target_region - 1]


def action_towards(bearings: ArrayLike, *, back: bool) -> NDArray[np.int64]:
    """Return the actions that move robots most nearly in given directions.

    Parameters
    ----------
    bearings : (N,) array
        Radians, counter-clockwise, 0 ahead.
    back : bool
        Whether action B is among the actions to choose from.

    Returns
    -------
    (N,) int array
        Of two equally near actions the one that comes first in F, L30, L60, R30, R60, B.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.planners import action_towards
    >>> action_towards(np.radians([0.0, 40.0, -80.0, 170.0]), back=True)
    array([0, 1, 4, 5])
    >>> action_towards(np.radians([0.0, 40.0, -80.0, 170.0]), back=False)
    array([0, 1, 4, 2])
    """
    ways = WAYS if back else WAYS[:5]
    off = np.abs(turned(np.asarray(bearings)[:, None] - ways))
    nearest: NDArray[np.int64] = off.round(9).argmin(axis=1)
    return nearest


def free_way(
    ranges: ArrayLike, bearings: ArrayLike, *, clearance: float, half_width: float
) -> Floats:
    """Return how far robots can go in given directions until something that they sense is nearer than a clearance.

    A reading says how near the nearest thing in a sector is, but not where in the sector it is. Five points stand for
    it, at the distance that is read, within a half width of the middle of the sector.

    Parameters
    ----------
    ranges : (N, 9) array
        What the sectors read, in metres. A reading of 10 m means that no obstacle is in range.
    bearings : (N, D) or (D,) array
        D directions, in radians, 0 ahead.
    clearance : float
        Metres, at least 0.
    half_width : float
        Radians. 0 places the obstacle at the middle of the sector; 20 degrees lets it fill the sector.

    Returns
    -------
    (N, D) array
        Metres, at most 10.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.planners import free_way
    >>> ranges = np.full((1, 9), 10.0)
    >>> ranges[0, 0] = 5.0
    >>> free_way(ranges, np.radians([0.0, 60.0]), clearance=1.0, half_width=0.3).round(2)
    array([[ 4., 10.]])
    """
    distance = np.repeat(ranges, len(POINTS), axis=1)[:, None]
    points = (CENTRES[:, None] + half_width * POINTS).ravel()
    angle = points - np.atleast_2d(bearings)[..., None]  # of a point to a direction
    along, across = distance * np.cos(angle), distance * np.sin(angle)
    meets = (distance < SENSOR_RANGE) & (along > 0) & (np.abs(across) < clearance)
    chord = np.sqrt(np.maximum(clearance**2 - across**2, 0.0))
    way: Floats = np.where(meets, along - chord, SENSOR_RANGE).min(axis=2)
    return way.clip(0.0, SENSOR_RANGE)
