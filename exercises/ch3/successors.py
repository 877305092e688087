# Exercise 3.4: Expanding a node where turning costs.
# 6 points, exercise, about 40 minutes.
# Check it with: robonav check 3.4
"""Expand one node of modified A*: find out which of the five actions are possible from
a pose, where each leads, and what it costs. In the chapter the cost of a step is its
length. Here turning costs something, too. The robot first turns, then goes straight on
for one second. An action is possible if the *whole step* keeps at least the margin to
all round obstacles and to the borders of the square map. A step that keeps exactly the
margin is possible.
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
    """Return the possible actions from a pose.

    Parameters
    ----------
    pose : (3,), x and y in metres, heading in radians counter-clockwise from the x
        axis.
    speed : speed of the robot in m/s; a step lasts one second.
    turn_cost : cost of turning by one radian to the left or right, in metres.
    centres : (K, 2), centres of the obstacles in metres.
    radii : (K,), radii of the obstacles in metres.
    size : side of the map in metres; its corners are (0, 0) and (size, size).
    margin : the least distance to obstacles and borders in metres.

    Returns
    -------
    (n, 5), a row for each possible action, in the order F, L30, L60, R30, R60: its
    index from 0 to 4, the new x, y and heading (between -pi and pi), and the cost in
    metres.
    """
    raise NotImplementedError("successors is yours to write")
