# Exercise 4.8: Cure a robot that circles.
# 8 points, open task, about 60 minutes.
# Your marks come from new random cases, which are drawn again whenever your submission
# changes. Two right answers were tried on 30 draws of the cases: they passed all parts
# every time. A call may take 5 s and all calls 30 s; theirs took at most 0.1 s and 0.1
# s.
# Check it with: robonav check 4.8
"""An open task: cure a robot that circles. As in the chapter, the reward of a step
depends on how dangerous the place before it was and how dangerous the place after it
is. No way back to the same place earned anything, until somebody raised one or two
rewards of the table by 0.2 to 0.4. A robot that learns perfectly now goes round and
round instead of arriving. Lower as few rewards as possible, until no round earns
anything but no further, or a collision may cost less than the way. Leave the rewards
for arrivals and collisions alone.

The check plans with your table and the discount 0.95 in random grids of nine by nine
cells. A step leads one cell right, down, left or up; against the edge the robot stays
where it is. The eight cells around an obstacle are dangerous, the next ring is cozy,
and all others are safe. From every cell the robot has to arrive about as often as
with the table as it was. Think first: which ways back to the same place are there, and
what does one round of each earn?
"""

import numpy as np
from numpy.typing import NDArray


def cure(rewards: NDArray[np.float64]) -> NDArray[np.float64]:
    """A table of rewards for which the robot arrives.

    Parameters
    ----------
    rewards : (3, 5), reward of a step from a safe, cozy or dangerous place (row) to a
        safe, cozy or dangerous place, to the target, or into a collision (column).

    Returns
    -------
    (3, 5), the table with as few rewards changed as possible.
    """
    raise NotImplementedError("cure is yours to write")
