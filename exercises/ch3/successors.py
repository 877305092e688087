# Exercise 3.4: Expanding a node where turning costs. 6 points, exercise, about 40 minutes.
# Check it with: robonav check 3.4
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
    raise NotImplementedError("successors is yours to write")
