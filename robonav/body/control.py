"""What the robot's computer does twenty times a second: odometry, and following the robot of section 2.5.

A pose is (x, y, heading) in metres and radians, and a velocity has the same three numbers for each second.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

RATE = 20  # Hz of the control
WHEEL_ANGLES = np.radians(
    [60.0, 180.0, 300.0]
)  # where the wheels are, seen from the middle
WHEEL_RADIUS = 0.2  # m
ARM = 0.7  # m from the middle of the base to a wheel
WHEELS = (
    np.column_stack(
        [-np.sin(WHEEL_ANGLES), np.cos(WHEEL_ANGLES), np.full(3, ARM)],
    )
    / WHEEL_RADIUS
)
"""(3, 3) array: times the velocity of the base in its own frame, this is how fast the wheels turn, in rad/s."""

BASE = np.linalg.inv(WHEELS)
GAIN = 4.0  # 1/s: an error of 1 m asks for 4 m/s more
TURN_TIME = 0.8  # s in which the reference turns
SPEED_RATIO = 1.5  # greatest speed of the base over that of the robot of section 2.5
GREATEST_LEAD = 0.6  # m from the base to the reference as a second begins


def wheel_speeds(velocity: Floats) -> Floats:
    """How fast the three wheels turn when none of them slips.

    Parameters
    ----------
    velocity : (3,) array
        Of the base in its own frame: forward and left in m/s, and the turn in rad/s.

    Returns
    -------
    (3,) array
        In rad/s.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.body import wheel_speeds
    >>> wheel_speeds(np.array([2.0, 0.0, 0.0])).round(2) + 0.0  # forward: the wheel behind stands still
    array([-8.66,  0.  ,  8.66])
    >>> wheel_speeds(np.array([0.0, 0.0, 1.0])).round(2)  # turning on the spot
    array([3.5, 3.5, 3.5])
    """
    return WHEELS @ velocity


def odometry(estimate: Floats, turned: Floats) -> Floats:
    """Where the robot thinks it is after its wheels have turned.

    Parameters
    ----------
    estimate : (3,) array
        Where it thought it was.
    turned : (3,) array
        How far each wheel has turned since, in radians. A wheel that slips turns farther than it drives.

    Returns
    -------
    (3,) array
        The new estimate.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.body import odometry, wheel_speeds
    >>> odometry(np.zeros(3), wheel_speeds(np.array([1.0, 0.0, 0.0]))).round(6) + 0.0
    array([1., 0., 0.])
    """
    forward, left, turn = BASE @ turned
    heading = estimate[2] + turn / 2  # in the middle of the motion
    c, s = math.cos(heading), math.sin(heading)
    return estimate + [c * forward - s * left, s * forward + c * left, turn]


def reference(
    start: Floats, turn: float, length: float, t: float
) -> tuple[Floats, Floats]:
    """Pose and velocity of the robot of section 2.5 within a second, which the base follows.

    It goes straight in its new direction from the first moment on, as the simulator's does: a base with three such
    wheels can go where it does not look. Its heading follows smoothly within 0.8 s, since no motor turns at once.

    Parameters
    ----------
    start : (3,) array
        Its pose as the second begins.
    turn : float
        By which angle the action turns it, in radians.
    length : float
        How far it goes in the second, in metres; less than 0 is backward.
    t : float
        How much of the second has passed.

    Returns
    -------
    pose : (3,) array
        Where the reference is.
    velocity : (3,) array
        How it moves.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.body import reference
    >>> pose, velocity = reference(np.zeros(3), np.pi / 2, 2.0, 0.5)
    >>> pose.round(2), velocity.round(2)
    (array([0.  , 1.  , 1.07]), array([0.  , 2.  , 2.76]))
    """
    direction = start[2] + turn
    vx, vy = length * math.cos(direction), length * math.sin(direction)
    u = min(t / TURN_TIME, 1.0)
    turned, turning = turn * u * u * (3 - 2 * u), turn * 6 * u * (1 - u) / TURN_TIME
    return start + [vx * t, vy * t, turned], np.array([vx, vy, turning])


def follow(estimate: Floats, pose: Floats, velocity: Floats, most: float) -> Floats:
    """Return the velocity of the base, in its own frame, that brings it to the reference.

    It is the reference's own velocity, and more the farther the base is behind.

    Parameters
    ----------
    estimate : (3,) array
        Where the base thinks it is.
    pose, velocity : (3,) arrays
        Of the reference.
    most : float
        The greatest speed, in m/s.

    Returns
    -------
    (3,) array
        Forward, left and turn.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.body import follow
    >>> follow(np.zeros(3), np.array([0.1, 0.0, 0.0]), np.array([2.0, 0.0, 0.0]), most=3.0)
    array([2.4, 0. , 0. ])
    """
    error = pose - estimate
    error[2] = math.remainder(error[2], 2 * math.pi)
    vx, vy, turn = velocity + GAIN * error
    slower = min(1.0, most / max(math.hypot(vx, vy), 1e-9))
    c, s = slower * math.cos(estimate[2]), slower * math.sin(estimate[2])
    return np.array([c * vx + s * vy, c * vy - s * vx, turn])


def limited_reference(pose: Floats, base: Floats) -> Floats:
    """Return a pose that is at most 0.6 m from the base, and looks where the base looks.

    Parameters
    ----------
    pose : (3,) array
        Of the reference at the end of a second.
    base : (3,) array
        Where the base thinks it is then.

    Returns
    -------
    (3,) array
        Where the reference begins the next second.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.body import limited_reference
    >>> limited_reference(np.array([2.0, 0.0, 0.1]), np.zeros(3))
    array([0.6, 0. , 0. ])
    """
    ahead = pose[:2] - base[:2]
    kept = min(1.0, GREATEST_LEAD / max(math.hypot(*ahead), 1e-9))
    return np.array([*(base[:2] + kept * ahead), base[2]])
