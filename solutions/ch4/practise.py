r"""An open task: let a robot learn by trial and error. The check makes a small network
with random weights, whose five outputs are to become the values $Q(s, a)$ of five
actions. Then robots practise in five rounds, each in 60 new worlds with ten obstacles.
Where nothing is near, a robot turns to its target and goes. Elsewhere it takes the
action of the largest output or a random one: always a random one in the first round,
less often in the next two, and in one step of ten in the last two. After each round
your function gets the weights and all steps so far, and returns better weights. Nobody
gives a reward: a step only says how the episode went on. So you choose the reward, the
discount, the target of a step, and how the network is trained: Q-learning, fitted Q
iteration, NNQL, or what you like.

Nobody knows in which order the sensors and the motors of a robot are wired, and which
of its inputs have the opposite sign, so that weights found for one robot are of no use
to the next. After the last round the robot drives through 100 new worlds, always with
the action of the largest output. The check lets two robots learn one after the other
and counts the arrivals of both. A robot that has not arrived after 150 s has failed,
and one that goes in circles never arrives. A call may take five seconds.
"""

import numpy as np
from numpy.typing import NDArray


def practise(
    weights: list[NDArray[np.float64]],
    states: NDArray[np.float64],
    actions: NDArray[np.int64],
    next_states: NDArray[np.float64],
    ends: NDArray[np.int64],
    rounds_left: int,
) -> list[NDArray[np.float64]]:
    """Weights of the network after a round.

    Parameters
    ----------
    weights : the layers (16, 13) and (5, 17) of the network that drove in this round,
        with the bias in column 0. The hidden units are hyperbolic tangents, the outputs
        are linear.
    states, next_states : (M, 12), what the network was asked in all steps so far, and
        what it was asked next in the episode, zeros if it was not: nine degrees of
        danger over 7, in the order in which the sensors are wired, cosine and sine of
        the direction of the target's sector, and whether the target is in range. Some
        of these twelve are negated, always the same.
    actions : (M,), the action that was taken, 0 to 4, as the motors are wired.
    ends : (M,), 1 if the robot arrived before the network was asked again, -1 if it
        collided or the time was over, else 0.
    rounds_left : rounds still to come, from 4 to 0; then the weights count.

    Returns
    -------
    The layers (16, 13) and (5, 17) of the network after the training.
    """
    ### BEGIN SOLUTION
    rng, discount = np.random.default_rng(0), 0.8
    first, last = (layer.copy() for layer in weights)
    means = [np.zeros_like(first), np.zeros_like(last)]
    squares = [np.zeros_like(first), np.zeros_like(last)]
    rewards = ends - 0.05  # a step costs a little, so that circles do not pay
    rate = [0.0005, 0.0016, 0.0027, 0.0039, 0.005][rounds_left]

    def values(inputs):
        hidden = np.tanh(first[:, 0] + inputs @ first[:, 1:].T)
        return hidden, last[:, 0] + hidden @ last[:, 1:].T

    for n in range(800 if rounds_left else 1600):
        if n % 100 == 0:  # the targets stay for a while, as DQN's do
            best = values(next_states)[1].max(axis=1)
            targets = rewards + np.where(ends == 0, discount * best, 0.0)
        batch = rng.integers(len(states), size=128)
        hidden, q = values(states[batch])
        wrong = np.zeros_like(q)
        taken = np.arange(len(batch)), actions[batch]
        wrong[taken] = (q[taken] - targets[batch]) / len(batch)
        back = wrong @ last[:, 1:] * (1 - hidden**2)
        slopes = [
            np.column_stack([back.sum(axis=0), back.T @ states[batch]]),
            np.column_stack([wrong.sum(axis=0), wrong.T @ hidden]),
        ]
        for layer, mean, square, slope in zip((first, last), means, squares, slopes):
            mean += 0.1 * (slope - mean)
            square += 0.01 * (slope**2 - square)
            step = mean / (1 - 0.9 ** (n + 1))
            layer -= rate * step / (np.sqrt(square / (1 - 0.99 ** (n + 1))) + 1e-6)
    return [first, last]
    ### END SOLUTION
