r"""Q-learning, SARSA and expected SARSA differ only in the value that they use for the
next state. Compute the three targets $r + \gamma \cdot (\text{value of } s')$ for a
batch of recorded steps. After the last step of an episode this value is 0. Expected
SARSA uses the mean over the $\varepsilon$-greedy policy. With probability
$\varepsilon$ this policy takes any of the $A$ actions, each with the same probability.
Otherwise it takes a best action. There may be several best actions: does it matter
which of them it takes?
"""

import numpy as np
from numpy.typing import NDArray


def targets(
    q: NDArray[np.float64],
    rewards: NDArray[np.float64],
    next_states: NDArray[np.int64],
    next_actions: NDArray[np.int64],
    terminated: NDArray[np.bool_],
    discount: float,
    epsilon: float,
) -> NDArray[np.float64]:
    """Targets of Q-learning, SARSA and expected SARSA.

    Parameters
    ----------
    q : (S, A), current action values.
    rewards : (N,), reward of each step.
    next_states, next_actions : (N,), the next state of each step, and the action taken
        there.
    terminated : (N,), whether the episode ended with the step.
    discount, epsilon : discount factor and exploration, both in [0, 1].

    Returns
    -------
    (3, N), the targets of Q-learning in the first row, of SARSA in the second, of
    expected SARSA in the third.
    """
    ### BEGIN SOLUTION
    following = q[next_states]
    best = following.max(axis=1)
    taken = q[next_states, next_actions]
    mean = epsilon * following.mean(axis=1) + (1 - epsilon) * best
    return rewards + discount * np.where(terminated, 0.0, np.stack([best, taken, mean]))
    ### END SOLUTION
