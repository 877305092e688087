r"""The bug of the page leaves an obstacle where it sees a place nearer to the target.
*Bug2* (Lumelsky and Stepanov, 1987) remembers a line instead, the one from its start
to its target. It goes along this line until it meets an obstacle, follows the obstacle
all the time on the same side, and leaves it where it meets the line again, nearer to
the target than where it met the obstacle, if the way to the target is free there. Here
the line goes on behind the target, and a robot may meet it there, too.

A robot moves in steps, so it seldom stands on the line exactly. It meets the line with
a step if it stands on the line after the step, or if the place before and the place
after the step lie on different sides of it. A step that only begins on the line does
not meet it. The place after the step is the one that must be nearer, and have a free
way.
"""

import numpy as np
from numpy.typing import NDArray


def leave(
    path: NDArray[np.int64],
    free: NDArray[np.bool_],
    start: NDArray[np.int64],
    target: NDArray[np.int64],
) -> int:
    """After which step a robot that follows an obstacle leaves it.

    Parameters
    ----------
    path : (T + 1, 2), x and y of the robot: where it met the obstacle, on the line, and
        after each of the T steps since then.
    free : (T + 1,), whether the way to the target is free at each of these places.
    start, target : (2,), x and y of two places on the line.

    Returns
    -------
    The number of the first step, from 1 to T, after which it leaves; -1 if it does not.
    """
    ### BEGIN SOLUTION
    along, out = target - start, path - start
    side = np.sign(along[0] * out[:, 1] - along[1] * out[:, 0])
    meets = (side[1:] == 0) | (side[1:] * side[:-1] < 0)
    away = ((target - path) ** 2).sum(axis=1)
    leaves = meets & (away[1:] < away[0]) & free[1:]
    return int(leaves.argmax()) + 1 if leaves.any() else -1
    ### END SOLUTION
