# Exercise 5.7: Recover a reward.
# 10 points, open task, about 90 minutes.
# Your marks come from new random cases, which are drawn again whenever your submission
# changes. Two right answers were tried on 30 draws of the cases: they passed all parts
# 30 and 29 times. A call may take 5 s and all calls 30 s; theirs took at most 0.1 s and
# 1.1 s.
# Check it with: robonav check 5.7
r"""An open task: recover a reward. An expert drove a robot through a grid of cells and
acted optimally for a reward $r(s) = \theta \cdot f(s)$ that you do not know. You are
given the cells that it visited, but not its actions. Each step that the robot spends in
a cell counts, the first included, and no cell ends an episode. Find weights $\theta$
for which an optimal robot drives like the expert; several are as good. The check plans
with your weights, drives the robot in this grid and in another one with the same kinds
of terrain, and compares the true reward of both trajectories. Any method of the chapter
is fine: projection, the widest margin, or maximum entropy.
"""

import numpy as np
from numpy.typing import NDArray


def recover(
    transitions: NDArray[np.float64],
    features: NDArray[np.float64],
    paths: NDArray[np.int64],
    discount: float,
) -> NDArray[np.float64]:
    """Weights of a reward that explains the expert.

    Parameters
    ----------
    transitions : (A, S, S), probability of each next cell after an action in a cell.
    features : (S, k), features of each cell: 1 for its kind of terrain, else 0.
    paths : (N, T), the cells that the expert visited in N episodes, in order.
    discount : discount factor in [0, 1).

    Returns
    -------
    (k,), weights of the features.
    """
    raise NotImplementedError("recover is yours to write")
