r"""The page leaves out two parts of VFH+ that need a memory (Ulrich and Borenstein,
1998). With one threshold, a bin whose magnitude is near it is blocked now and free a
moment later, and the robot swerves. So the paper has two: a bin is blocked if its
magnitude is at least the high threshold, and free if it is at most the low one; a bin
between them stays as it was. And the cost of a direction has a third term. It is the
sum of three angles, each with its weight: to the target, to the heading, and to the
direction that was chosen last.

Every free bin is a candidate here. The angle between two bins is how many bins they
are apart, the shorter way round the circle; the heading is bin 0. The candidate of the
least cost is chosen, and of several with the same cost the one with the lowest number.
"""

import numpy as np
from numpy.typing import NDArray


def direction(
    histogram: NDArray[np.float64],
    blocked: NDArray[np.bool_],
    low: float,
    high: float,
    target: int,
    last: int,
    weights: NDArray[np.float64],
) -> tuple[NDArray[np.bool_], NDArray[np.float64], int]:
    """One step of a vector field histogram with a memory.

    Parameters
    ----------
    histogram : (B,), how much obstacle lies in each bin; the bins go round the circle.
    blocked : (B,), which bins were blocked before.
    low, high : the two thresholds; low is the smaller one.
    target : the bin in which the target lies.
    last : the bin that was chosen last.
    weights : (3,), weights of the angles to the target, to the heading and to the bin
        chosen last.

    Returns
    -------
    (B,) which bins are blocked now; (B,) the cost of each bin, whether free or not; and
    the bin that is chosen, -1 if none is free.
    """
    ### BEGIN SOLUTION
    blocked = (histogram >= high) | (blocked & (histogram > low))
    bins = np.arange(len(histogram))
    apart = np.abs(bins - np.array([target, 0, last])[:, None])
    angles = np.minimum(apart, len(bins) - apart)
    cost = weights @ angles
    best = int(np.where(blocked, np.inf, cost).argmin())
    return blocked, cost, -1 if blocked.all() else best
    ### END SOLUTION
