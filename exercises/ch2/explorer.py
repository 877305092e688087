# Exercise 2.8: Optimism in the face of the unknown.
# 10 points, project, about 60 minutes.
# Check it with: robonav check 2.8
r"""A small project: R-max (Brafman and Tennenholtz, 2002), a method that explores
because it is optimistic. Estimate a model by counting the steps recorded so far. Use
the estimate only for pairs of state and action that were tried a given number of times.
Every other pair gets the largest possible value, $r_{max} / (1 - \gamma)$. Then
compute the optimal action values of this model. A robot that acts greedily on them
explores the unknown pairs until all pairs that it can reach are known.
"""

import numpy as np
from numpy.typing import NDArray


def explorer(
    steps: NDArray[np.int64],
    rewards: NDArray[np.float64],
    terminated: NDArray[np.bool_],
    size: tuple[int, int],
    known_after: int,
    largest_reward: float,
    discount: float,
) -> NDArray[np.float64]:
    """Action values of the optimistic model.

    Parameters
    ----------
    steps : (N, 3), state, action and next state of each recorded step.
    rewards : (N,), its reward.
    terminated : (N,), whether the episode ended with it; the next state then counts
        nothing.
    size : numbers of states S and of actions A.
    known_after : number of tries after which a pair is known, at least 1.
    largest_reward : the largest possible reward.
    discount : discount factor in [0, 1).

    Returns
    -------
    (S, A), optimal values of the pairs in the model, exact to 1e-6. The reward of a
    known pair is the mean of its recorded rewards; the value of an unknown pair is
    ``largest_reward / (1 - discount)``.
    """
    raise NotImplementedError("explorer is yours to write")
