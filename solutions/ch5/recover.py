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
    ### BEGIN SOLUTION
    states = len(features)
    weight = discount ** np.arange(paths.shape[1])
    wanted = (weight[:, None] * features[paths]).sum(axis=1).mean(axis=0)
    first = np.bincount(paths[:, 0], minlength=states) / len(paths)
    theta = np.zeros(features.shape[1])
    for round_ in range(150):
        values = np.zeros(states)
        for _ in range(40):  # soft value iteration
            q = features @ theta + discount * transitions @ values
            top = q.max(axis=0)
            values = top + np.log(np.exp(q - top).sum(axis=0))
        policy = np.exp(q - values)
        flow = np.einsum("as,ast->st", policy / policy.sum(axis=0), transitions)
        visits, reached = first.copy(), first.copy()
        for _ in range(paths.shape[1] - 1):
            reached = discount * reached @ flow
            visits += reached
        theta += 0.3 / (1 + round_ / 50) * (wanted - visits @ features)
    return theta
    ### END SOLUTION
