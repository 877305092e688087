"""Table 3.1 is for a sensor with a range of 30 cm, and has borders at 3, 7, 11, 15, 20,
25 and 30 cm. Write the state of Eq. (3.17) for sensors of any range (``reach``): nine
degrees of danger, with the borders of the table scaled in proportion; the target's
region; and whether the target is within range. The target is given by its distance and
by its bearing from straight ahead, counter-clockwise in radians. Region 1 covers the 40
degrees around straight ahead, and the regions are numbered counter-clockwise from 1 to
9. A reading that lies on a border of the table has the lesser danger.
"""

import numpy as np
from numpy.typing import NDArray


def encode(
    ranges: NDArray[np.float64],
    bearing: NDArray[np.float64],
    distance: NDArray[np.float64],
    reach: float,
) -> NDArray[np.int64]:
    """Return the states of Eq. (3.17).

    Parameters
    ----------
    ranges : (N, 9), the readings of the sensors in metres; ``reach`` where nothing is
        in range.
    bearing : (N,), direction of the target relative to the robot's heading, any angle
        in radians.
    distance : (N,), distance to the target in metres.
    reach : range of the sensors in metres.

    Returns
    -------
    (N, 11), whole numbers: nine degrees of danger from 0 to 7, the region from 1 to 9,
    and 1 if the distance to the target is at most ``reach``, else 0.
    """
    ### BEGIN SOLUTION
    borders = np.array([3, 7, 11, 15, 20, 25, 30]) * (reach / 30)
    danger = (ranges[:, :, None] < borders).sum(axis=2)
    region = np.floor(bearing / np.radians(40) + 0.5).astype(int) % 9 + 1
    return np.column_stack([danger, region, distance <= reach]).astype(int)
    ### END SOLUTION
