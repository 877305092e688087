# Exercise 4.8: Cure a robot that circles.
# 8 points, open task, about 60 minutes.
# Your marks come from new random cases, which are drawn again whenever your submission
# changes. Two right answers were tried on 30 draws of the cases: they passed all parts
# every time. A call may take 5 s and all calls 30 s; theirs took at most 0.1 s and 0.1
# s.
# Check it with: robonav check 4.8
"""An open task: cure a robot that circles. As in the chapter, the reward of a step
depends on how dangerous the place before it was and how dangerous the place after it
is. Somebody has raised one or two rewards of the table a little, and a robot that
learns perfectly now goes round and round instead of arriving. Lower as few rewards as
possible, by as much as is needed, and leave those for arrivals and collisions alone.
The check plans with your table and the discount 0.95 in random grids of nine by nine
cells, lets the robot drive from every cell, and counts arrivals. Think first: which
ways back to the same place are there, and what does one round of each earn?
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
