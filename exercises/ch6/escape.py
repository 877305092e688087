# Exercise 6.6: Out of the pocket.
# 10 points, open task, about 90 minutes.
# Your marks come from new random cases, which are drawn again whenever your submission
# changes. Two right answers were tried on 30 draws of the cases: they passed all parts
# every time. A call may take 5 s and all calls 30 s; theirs took at most 0.1 s and 0.9
# s.
# Check it with: robonav check 6.6
"""An open task: write a planner that remembers. Across the way to the target lies a
pocket, three walls that open towards the robot. A robot that does in the same place
always the same goes to and fro in it. Yours has an odometer, which tells it the
direction and the distance of its target, and four numbers for each robot that it may
use as it likes. They are 0 at the start, and what your function returns it gets back in
the next second. The robot has no reflexes here, and it must not touch a wall. The check
drives your robots through pockets of random size, which lie in random directions, and
through worlds of ten obstacles without a pocket, and counts those that arrive within
250 s. Any method is fine: a bug that follows a wall, as on the page, a planner that
turns away from places where it has been, a network that you have trained at home.

Of 100 robots, 85 must arrive where the pocket is 5 to 9 m deep, 75 where it is 10 to
16 m deep, and 85 among ten obstacles. Inside, all pockets are 12 to 20 m wide. A robot
collides when anything comes nearer than 1 m to its middle, from which the readings are
measured, too.
"""

import numpy as np
from numpy.typing import NDArray


def escape(
    ranges: NDArray[np.float64],
    bearing: NDArray[np.float64],
    distance: NDArray[np.float64],
    memory: NDArray[np.float64],
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Actions of N robots, and what they remember.

    Parameters
    ----------
    ranges : (N, 9), the nearest thing in each sector of 40 degrees in metres, 10 where
        nothing is in range; sector 1 is straight ahead, the others follow
        counter-clockwise.
    bearing : (N,), direction of the target from -pi to pi; 0 is ahead, pi / 2 left.
    distance : (N,), distance of the target in metres.
    memory : (N, 4), what each robot remembers from the second before.

    Returns
    -------
    (N,) actions, 0 for forward, 1 and 2 for 30 and 60 degrees to the left, 3 and 4 for
    30 and 60 degrees to the right; after a turn the robot goes forward, too, and a step
    is 2 m. And (N, 4), what it remembers.
    """
    raise NotImplementedError("escape is yours to write")
