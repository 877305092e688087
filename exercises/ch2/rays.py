# Exercise 2.11: What a laser reads.
# 5 points, exercise, about 40 minutes.
# Check it with: robonav check 2.11
r"""A laser range finder measures along a ray, not over a sector. Take a robot with nine
rays. The first one points straight ahead, and the others follow counter-clockwise, 40
degrees apart. Each gives the distance from the centre of the robot to the first thing
on its way: a circle or the border of the map. What is farther away than ``reach`` is
not seen, and the ray gives ``reach``. The map is a square from (0, 0) to (size, size).
The robot is on the map and outside all circles.

Where does a ray meet a circle? Its foot of the perpendicular from the centre of the
circle lies $d = u \cdot (c - p)$ metres along the ray, where $p$ is the place of the
robot, $u$ the direction of the ray and $c$ the centre. If the foot lies ahead and is
nearer to the centre than the radius, the ray enters the circle before the foot, as
Pythagoras says.
"""

import numpy as np
from numpy.typing import NDArray


def rays(
    pose: NDArray[np.float64],
    centres: NDArray[np.float64],
    radii: NDArray[np.float64],
    size: float,
    reach: float,
) -> NDArray[np.float64]:
    """Return what the nine rays read.

    Parameters
    ----------
    pose : (3,), x and y in metres, and the heading in radians, counter-clockwise from
        the x-axis.
    centres : (K, 2), the centres of the circles in metres.
    radii : (K,), their radii in metres.
    size : side of the map in metres.
    reach : range of the rays in metres.

    Returns
    -------
    (9,), the distances in metres.
    """
    raise NotImplementedError("rays is yours to write")
