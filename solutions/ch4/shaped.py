r"""A reward like the chapter's can be exploited: if every step away from an obstacle is
rewarded, a robot may go to and fro in front of it. Ng, Harada and Russell (1999) found
the additional rewards that leave the optimal policy unchanged. Give every state a
potential $\Phi(s)$, and add $\gamma \Phi(s') - \Phi(s)$ to the reward of each step.
The potential after a step that ends the episode counts as zero. In the discounted
return of a whole episode the additions cancel except for the potential of the first
state, so the optimal policy remains optimal. Shape the rewards of an episode.
"""

import numpy as np
from numpy.typing import NDArray


def shaped(
    rewards: NDArray[np.float64],
    potentials: NDArray[np.float64],
    ended: bool,
    discount: float,
) -> NDArray[np.float64]:
    """The shaped rewards of an episode.

    Parameters
    ----------
    rewards : (T,), reward of each step.
    potentials : (T + 1,), potential of the state before each step, and after the last.
    ended : whether the episode ended with the last step; if it was only cut off, the
        last state keeps its potential.
    discount : discount factor in [0, 1].

    Returns
    -------
    (T,), the shaped rewards.
    """
    ### BEGIN SOLUTION
    following = potentials[1:].copy()
    if ended:
        following[-1:] = 0.0
    return rewards + discount * following - potentials[:-1]
    ### END SOLUTION
