"""An open task: write the function that drives the robot. It is asked once a second of
simulated time, for all robots at once, with what they perceive, and answers with their
actions. The robot has no reflexes here: if nothing is near, it must turn to its target
itself. The check drives 200 of your robots through random worlds in which nothing
moves. In empty worlds 170 must arrive nearly straight (2 points), with 5 and with 10
obstacles 150 (1 point each), and with 15 obstacles 140 (4 points). Many functions can
do this. Look where a robot goes wrong: `robonav.robot.navigate` and
`robonav.plots.robot` draw its path, and the playground shows it.
"""

import numpy as np
from numpy.typing import NDArray


def steer(
    ranges: NDArray[np.float64],
    region: NDArray[np.int64],
    seen: NDArray[np.bool_],
) -> NDArray[np.int64]:
    """Actions of N robots in their worlds.

    Parameters
    ----------
    ranges : (N, 9), the nearest thing in each sector of 40 degrees in metres, 10 where
        nothing is in range; sector 1 is straight ahead, the others follow
        counter-clockwise.
    region : (N,), the sector that the target is in, from 1 to 9.
    seen : (N,), whether the target is in range.

    Returns
    -------
    (N,), 0 for forward, 1 and 2 for 30 and 60 degrees to the left, 3 and 4 for 30 and
    60 degrees to the right; after a turn the robot goes forward, too. A step is 2 m.
    """
    ### BEGIN SOLUTION
    to_target = np.array([0, 1, 2, 2, 2, 4, 4, 4, 3])[region - 1]
    left, right = ranges[:, 1:3].min(axis=1), ranges[:, 7:9].min(axis=1)
    away = np.where(left > right, 2, 4)
    near = ranges[:, 0] < 6
    # Where the way to the target leads into something near, go on along it.
    ahead = np.array([0, 1, 1, 2, 2, 7, 7, 8, 8])[region - 1]
    towards = ranges[np.arange(len(ranges)), ahead]
    blocked = (towards < 5) | ((to_target > 0) & (ranges.min(axis=1) < 2.5))
    action = np.where(near, away, np.where(blocked, 0, to_target))
    return action
    ### END SOLUTION
