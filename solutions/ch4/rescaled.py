r"""A network with sigmoid outputs has values between 0 and 1, and Q-values can be
larger or smaller. The chapter clips them, or shifts and divides each row. There is a
third method. If rewards lie between $r_{min} \le 0$ and $r_{max} \ge 0$, every Q-value
lies in $[r_{min}, r_{max}] / (1 - \gamma)$. Interpret the network's outputs as values
on this scale, from 0 for the smallest to 1 for the largest. Make the Q-learning step of
Eq. (4.9) on the scale of the Q-values, for the action taken alone, and return the
targets on the network's scale. Clip targets that lie outside because a reward was out
of its bounds.
"""

import numpy as np
from numpy.typing import NDArray


def rescaled(
    outputs: NDArray[np.float64],
    actions: NDArray[np.int64],
    rewards: NDArray[np.float64],
    next_outputs: NDArray[np.float64],
    ended: NDArray[np.bool_],
    bounds: tuple[float, float],
    discount: float,
    learning_rate: float,
) -> NDArray[np.float64]:
    """Targets for the network.

    Parameters
    ----------
    outputs, next_outputs : (N, A), the network's answers in [0, 1] before and after
        each step.
    actions, rewards : (N,), action and reward of each step.
    ended : (N,), whether the episode ended with it: the Q-value of the next state is
        then exactly 0.
    bounds : the least and the greatest reward.
    discount : discount factor in [0, 1).
    learning_rate : learning rate of Q-learning in [0, 1].

    Returns
    -------
    (N, A) in [0, 1]: the outputs, moved where an action was taken.
    """
    ### BEGIN SOLUTION
    least, greatest = (bound / (1 - discount) for bound in bounds)
    taken = np.arange(len(actions)), actions
    q = least + (greatest - least) * outputs
    following = np.where(
        ended, 0.0, least + (greatest - least) * next_outputs.max(axis=1)
    )
    q[taken] += learning_rate * (rewards + discount * following - q[taken])
    return ((q - least) / (greatest - least)).clip(0.0, 1.0)
    ### END SOLUTION
