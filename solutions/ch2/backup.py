r"""In the chapter a reward belongs to a state and an action, and a terminal state is
one that returns to itself. Here the reward belongs to the transition, $r(s, a, s')$,
and terminal states are marked. The episode ends in a terminal state, so its entry in
the value table must be ignored, though the reward of the step into it counts. Write the
Bellman backup for this case,

$$Q(s, a) = \sum_{s'} P(s' \mid s, a) \left(r(s, a, s') + \gamma V(s')\right),$$

with $V(s') = 0$ where $s'$ is terminal, and $Q(s, \cdot) = 0$ where $s$ itself is
terminal.
"""

import numpy as np
from numpy.typing import NDArray


def backup(
    transitions: NDArray[np.float64],
    rewards: NDArray[np.float64],
    discount: float,
    values: NDArray[np.float64],
    terminal: NDArray[np.bool_],
) -> NDArray[np.float64]:
    """Action values after one Bellman backup.

    Parameters
    ----------
    transitions : (A, S, S), probability of each next state after an action in a state.
    rewards : (A, S, S), reward of each transition.
    discount : discount factor in [0, 1].
    values : (S,), values of the states; ignore those of terminal states.
    terminal : (S,), whether a state is terminal.

    Returns
    -------
    (S, A), the value of each action in each state.
    """
    ### BEGIN SOLUTION
    following = np.where(terminal, 0.0, values)
    q = np.einsum("ast,ast->sa", transitions, rewards + discount * following)
    q[terminal] = 0.0
    return q
    ### END SOLUTION
