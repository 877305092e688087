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
    ### BEGIN SOLUTION
    side, least = memory[:, 0].copy(), memory[:, 1].copy()
    sectors = np.radians(40) * np.array([0, 1, 2, 3, 4, -4, -3, -2, -1])

    def room(ways):  # how far each way is free, with an obstacle 10 degrees wide
        edges = sectors[:, None] + np.radians([-10, 0, 10])
        off = (
            np.cos(ways[..., None, None] - edges),
            np.sin(ways[..., None, None] - edges),
        )
        reach = ranges[:, None, :, None] * off[0]
        beside = np.abs(ranges[:, None, :, None] * off[1])
        hit = (reach > 0) & (beside < 1.5) & (ranges[:, None, :, None] < 10)
        gap = reach - np.sqrt(np.maximum(1.5**2 - beside**2, 0.0))
        return np.where(hit, gap, 10.0).min(axis=(2, 3))

    turns = np.radians([60, 30, 0, -30, -60])  # from left to right
    ahead = room(bearing[:, None])[:, 0]
    clear = ahead >= np.minimum(5.0, distance)
    # A robot beside a wall leaves it where it sees a place nearer than all before.
    least = np.where(side == 0, distance, np.minimum(least, distance))
    done = clear & (distance - ahead < least - 2.0)
    wall_left, wall_right = (
        ranges[:, :5].min(axis=1),
        ranges[:, [0, 5, 6, 7, 8]].min(axis=1),
    )
    done |= np.where(side > 0, wall_left, wall_right) >= 10
    side = np.where(done, 0.0, side)
    fan = np.radians(np.arange(20, 180, 20))
    to_left, to_right = (
        np.where(room(bearing[:, None] + sign * fan) >= 5, fan, 9.0).min(axis=1)
        for sign in (1, -1)
    )
    side = np.where(
        (side == 0) & ~clear, np.where(to_right <= to_left, 1.0, -1.0), side
    )
    free = room(np.broadcast_to(turns, (len(ranges), 5))) >= 4
    off = np.abs((bearing[:, None] - turns + np.pi) % (2 * np.pi) - np.pi)
    straight = np.where(free, off, off + 9).argmin(axis=1)
    nearest_left = sectors[:5][ranges[:, :5].argmin(axis=1)]
    nearest_right = sectors[[0, 8, 7, 6, 5]][ranges[:, [0, 8, 7, 6, 5]].argmin(axis=1)]
    left = free & (turns <= nearest_left[:, None] + 1e-9)
    right = (free & (turns >= nearest_right[:, None] - 1e-9))[:, ::-1]
    left[:, -1] = right[:, -1] = True
    along = np.where(side > 0, left.argmax(axis=1), 4 - right.argmax(axis=1))
    chosen = np.where(side == 0, straight, along)
    actions = np.array([2, 1, 0, 3, 4])[chosen]
    return actions, np.column_stack([side, least, memory[:, 2:]])
    ### END SOLUTION
