# Exercise 3.2: A state for sensors of any reach. 5 points, exercise, about 25 minutes.
# Check it with: robonav check 3.2
"""Table 3.1 is made for a sensor that reaches 30 cm. Encode what a robot senses for a sensor of any reach: nine
degrees of danger, with the table's borders stretched in proportion; the target's region; and whether the target is
within reach. Here the target is given by its bearing from straight ahead, counter-clockwise in radians, and its
distance. Region 1 is the 40 degrees around straight ahead, and the regions are numbered counter-clockwise to 9.
"""

import numpy as np
from numpy.typing import NDArray


def encode(
    ranges: NDArray[np.float64], bearing: NDArray[np.float64], distance: NDArray[np.float64], reach: float
) -> NDArray[np.int64]:
    """States of Eq. (3.17).

    Parameters
    ----------
    ranges : (N, 9), what the sensors read, in metres; ``reach`` where they see nothing.
    bearing : (N,), direction of the target from the robot's heading, any angle in radians.
    distance : (N,), to the target in metres.
    reach : of the sensors, in metres.

    Returns
    -------
    (N, 11) whole numbers: nine degrees of danger 0 to 7, the region 1 to 9, and 1 if the target is no farther than
    ``reach``, else 0.
    """
    raise NotImplementedError("encode is yours to write")
