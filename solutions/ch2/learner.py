"""An open task: let a robot learn in a gridworld that neither you nor it has seen.
Cells and actions are numbers in no order, and where an action leads is not known. The
robot always starts in the same cell. It drives ten rounds of ten episodes, each of at
most 40 steps. Before each round your function is asked how to act in the round, and is
given all steps so far. After the last round it is asked once more, and then it must
say how to act for the largest discounted return. The largest reward of a step is 1.
Each world has a place to fall into. In some the robot slips, and some have a small
reward near the start and a large one far away. Any method is fine: Q-learning that
replays the recorded steps, SARSA, an estimated model as in exercise 2.8. What counts
besides the update is how the robot explores: without chance in its actions, all
episodes of a round may be the same. Each part computes the return of your last answers
in four new worlds, on a scale from 0 % for a robot that acts at random to 100 % for the
best policy. It asks for 80 % where no action slips (3 points), for 60 % where every
fifth one does (4 points), and for 60 % where a small reward is near (3 points). All
calls together may take 30 seconds.
"""

import numpy as np
from numpy.typing import NDArray


def learner(
    steps: NDArray[np.int64],
    rewards: NDArray[np.float64],
    terminated: NDArray[np.bool_],
    size: tuple[int, int],
    discount: float,
    rounds_left: int,
) -> NDArray[np.float64]:
    """How the robot acts in the next round.

    Parameters
    ----------
    steps : (M, 3), the cell, the action and the next cell of each step so far.
    rewards : (M,), reward of each step.
    terminated : (M,), whether the episode ended with this step.
    size : numbers of cells S and of actions A.
    discount : discount factor in [0, 1).
    rounds_left : rounds still to drive, from 10 to 1; 0 for the answer that counts.

    Returns
    -------
    (S, A), the probability of each action in each cell.
    """
    ### BEGIN SOLUTION
    # A pair that was never tried seems as good as can be, until the answer that counts.
    q = np.full(size, 1.0 if rounds_left else 0.0).tolist()
    tries = np.zeros(size).tolist()
    seen = list(zip(steps.tolist(), rewards.tolist(), terminated.tolist()))
    for _ in range(10):  # backwards, so that a reward reaches the start at once
        for (cell, action, after), reward, end in reversed(seen):
            tries[cell][action] += 1
            target = reward + (0.0 if end else discount * max(q[after]))
            rate = max(0.03, 1 / tries[cell][action])
            q[cell][action] += rate * (target - q[cell][action])
    table = np.array(q)
    best = table >= table.max(axis=1, keepdims=True) - 1e-9
    greedy = best / best.sum(axis=1, keepdims=True)
    epsilon = 0.1 if rounds_left else 0.0
    policy = (1 - epsilon) * greedy + epsilon / size[1]
    return policy
    ### END SOLUTION
