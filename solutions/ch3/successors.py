"""Expand one node of the modified A*: which of the five actions can be taken from a pose, where they lead, and what
they cost. The chapter's search counts metres; here turning costs, too. A robot turns first, then goes one second
straight ahead. An action is possible if the *whole step* keeps at least a margin to every round obstacle and to the
borders of the square map, the margin itself being enough.
"""

import numpy as np
from numpy.typing import NDArray


def successors(
    pose: NDArray[np.float64],
    speed: float,
    turn_cost: float,
    centres: NDArray[np.float64],
    radii: NDArray[np.float64],
    size: float,
    margin: float,
) -> NDArray[np.float64]:
    """The possible actions from a pose.

    Parameters
    ----------
    pose : (3,), x and y in metres, heading in radians counter-clockwise from the x axis.
    speed : in metres a second; a step lasts one second.
    turn_cost : metres that a radian of turning counts for, left or right.
    centres : (K, 2), centres of the obstacles in metres.
    radii : (K,), their radii.
    size : side of the map, whose corners are (0, 0) and (size, size).
    margin : to keep, in metres.

    Returns
    -------
    (n, 5), a row for each possible action, in the order F, L30, L60, R30, R60: its index 0 to 4, the new x, y and
    heading (within pi of zero), and the cost in metres.
    """
    ### BEGIN SOLUTION
    rows = []
    start = pose[:2]
    for action, degrees in enumerate((0, 30, 60, -30, -60)):
        heading = pose[2] + np.radians(degrees)
        way = speed * np.array([np.cos(heading), np.sin(heading)])
        end = start + way
        along = np.clip((centres - start) @ way / speed**2, 0, 1)
        nearest = start + along[:, None] * way
        clear = np.all(np.hypot(*(centres - nearest).T) - radii >= margin)
        inside = min(*start, *end) >= margin and max(*start, *end) <= size - margin
        if clear and inside:
            heading = (heading + np.pi) % (2 * np.pi) - np.pi
            rows.append([action, *end, heading, speed + turn_cost * abs(np.radians(degrees))])
    return np.array(rows).reshape(-1, 5)
    ### END SOLUTION
