# Exercise 6.7: Learn to drive with a policy gradient.
# 10 points, open task, about 90 minutes.
# Your marks come from new random cases, which are drawn again whenever your submission
# changes. Two right answers were tried on 30 draws of the cases: they passed all parts
# every time. A call may take 5 s and all calls 30 s; theirs took at most 0.1 s and 1.8
# s.
# Check it with: robonav check 6.7
r"""An open task: let a robot learn with a policy gradient. The check makes two small
networks with random weights. The five outputs of the policy's network are those whose
softmax is the policy, and the critic's single output is to become the value of a state.
Then robots practise in twelve rounds, each in 60 new worlds. With nothing in range, a
robot turns to its target and goes. Elsewhere it draws its action from the policy. After
each round your function gets the weights and the steps of this round alone, since older
ones come from another policy, and returns better weights. So you compute rewards,
returns or advantages, and the gradient, and you choose how many steps of what size to
take: PPO as on the page, with what you wrote for exercises 6.4 and 6.5, an actor with a
critic, REINFORCE with a baseline, or what you like. You need not use the critic.

Nobody knows in which order the sensors and the motors of a robot are wired, and which
of its inputs have the opposite sign, so that weights found for one robot are of no use
to the next. After the last round the robot drives through 100 new worlds, always with
the action of the largest output. A robot that has not arrived after 150 s has failed,
and one that goes in circles never arrives. Among ten obstacles 80 of the 100 must
arrive; in the second part, with a new robot that practises among twenty, 70 must. This
asks that your robot learns, and not that it learns as well as possible: several methods
are good enough. A call may take five seconds.
"""

import numpy as np
from numpy.typing import NDArray


def reinforce(
    layers: list[NDArray[np.float64]],
    states: NDArray[np.float64],
    actions: NDArray[np.int64],
    log_before: NDArray[np.float64],
    episodes: NDArray[np.int64],
    ends: NDArray[np.int64],
    rounds_left: int,
) -> list[NDArray[np.float64]]:
    """Weights of the policy and of the critic after a round.

    Parameters
    ----------
    layers : the layers (16, 13) and (5, 17) of the policy that drove in this round, and
        (16, 13) and (1, 17) of the critic, with the bias in column 0. The hidden units
        are hyperbolic tangents, the outputs are linear.
    states : (M, 12), what the policy was asked in this round: nine degrees of danger
        over 7, in the order in which the sensors are wired, cosine and sine of the
        direction of the target's sector, and whether the target is in range. Some of
        these twelve are negated, always the same.
    actions : (M,), the action that was taken, 0 to 4, as the motors are wired.
    log_before : (M,), logarithm of its probability when it was taken.
    episodes : (M,), the number of the episode. Its steps follow each other in time.
    ends : (M,), 1 if the robot arrived before the policy was asked again, -1 if it
        collided or the time was over, else 0.
    rounds_left : rounds still to come, from 11 to 0; then the weights count.

    Returns
    -------
    The layers (16, 13), (5, 17), (16, 13) and (1, 17) after the training.
    """
    raise NotImplementedError("reinforce is yours to write")
