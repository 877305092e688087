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
    ### BEGIN SOLUTION
    rounds = [[(p, p)] for p in range(3)]
    rounds += [[(p, q), (q, p)] for p, q in ((0, 1), (0, 2), (1, 2))]
    rounds += [[(0, 1), (1, 2), (2, 0)], [(0, 2), (2, 1), (1, 0)]]

    def gain(table, steps):
        return sum(table[step] for step in steps)

    entries = [(p, q) for p in range(3) for q in range(3)]
    subsets = [[e] for e in entries]
    subsets += [[e, f] for n, e in enumerate(entries) for f in entries[:n]]
    best = None
    for chosen in subsets:
        cured = rewards.copy()
        for entry in chosen:
            through = [steps for steps in rounds if entry in steps]
            most = max(gain(cured, steps) for steps in through)
            cured[entry] -= max(most, 0.0)
        if max(gain(cured, steps) for steps in rounds) <= 1e-9:
            change = (len(chosen), np.abs(cured - rewards).sum())
            if best is None or change < best[0]:
                best = change, cured
    return rewards if best is None else best[1]
    ### END SOLUTION
