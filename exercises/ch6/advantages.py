# Exercise 6.4: Advantages of steps that last.
# 5 points, exercise, about 30 minutes.
# Check it with: robonav check 6.4
r"""PPO asks how much better things went after an action than the value function had
expected. The chapter computes this *advantage* backwards, for steps that all take the
same time. Here a step of a robot lasts $\tau_t$ seconds, since turning takes longer
than going on, and all that comes after it is discounted by $\gamma^{\tau_t}$. The error
of the value function in a step is then $\delta_t = r_t + \gamma^{\tau_t} V(s_{t+1}) -
V(s_t)$, and the advantage is $A_t = \delta_t + \gamma^{\tau_t} \lambda A_{t+1}$.
Nothing is known of what follows the last row: take 0 for the advantage there. Several
robots drive at once, each in a column of its own.

An episode ends in one of two ways. If it terminated, with an arrival or a collision,
its last state has no value. If the time limit ended it, the robot would have gone on,
so the value of its last state counts. If both flags of a step are set, the episode
terminated. Either way the next row belongs to another episode, whose advantage must not
flow back into this one.
"""

import numpy as np
from numpy.typing import NDArray


def advantages(
    rewards: NDArray[np.float64],
    values: NDArray[np.float64],
    next_values: NDArray[np.float64],
    seconds: NDArray[np.float64],
    terminated: NDArray[np.bool_],
    truncated: NDArray[np.bool_],
    discount: float,
    decay: float,
) -> NDArray[np.float64]:
    """Generalised advantage estimation for steps of different lengths.

    Parameters
    ----------
    rewards : (T, N), reward of each step of N robots.
    values : (T, N), value of the state before each step.
    next_values : (T, N), value of the state after it, before a new episode begins.
    seconds : (T, N), how long each step lasts, positive.
    terminated : (T, N), whether the episode terminated with the step.
    truncated : (T, N), whether the time limit ended the episode after the step.
    discount : discount factor of one second, in [0, 1].
    decay : lambda, in [0, 1].

    Returns
    -------
    (T, N), the advantage of each step.
    """
    raise NotImplementedError("advantages is yours to write")
