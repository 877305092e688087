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
    ### BEGIN SOLUTION
    rng, discount, decay, clip = np.random.default_rng(0), 0.95, 0.9, 0.2
    layers = [layer.copy() for layer in layers]
    means = [np.zeros_like(layer) for layer in layers]
    squares = [np.zeros_like(layer) for layer in layers]
    rewards = ends - 0.02  # a step costs a little, so that circles do not pay

    def outputs(first, last, inputs):
        hidden = np.tanh(first[:, 0] + inputs @ first[:, 1:].T)
        return hidden, last[:, 0] + hidden @ last[:, 1:].T

    values = outputs(*layers[2:], states)[1][:, 0]
    found, later, after = np.zeros(len(states)), 0.0, 0.0
    for t in range(len(states) - 1, -1, -1):
        if ends[t] != 0:
            later = after = 0.0
        later = rewards[t] + discount * (after + decay * later) - values[t]
        found[t], after = later, values[t]
    goals = found + values
    gains = (found - found.mean()) / (found.std() + 1e-8)
    batches = max(1, len(states) // 128)
    for n in range(8 * batches):
        if n % batches == 0:
            order = np.array_split(rng.permutation(len(states)), batches)
        rows = order[n % batches]
        inputs, gain = states[rows], gains[rows]
        hidden, z = outputs(*layers[:2], inputs)
        z = z - z.max(axis=1, keepdims=True)
        log_policy = z - np.log(np.exp(z).sum(axis=1, keepdims=True))
        policy, taken = np.exp(log_policy), np.eye(5)[actions[rows]]
        ratio = np.exp((log_policy * taken).sum(axis=1) - log_before[rows])
        limited = np.clip(ratio, 1 - clip, 1 + clip) * gain
        moving = np.where(limited < ratio * gain, 0.0, ratio * gain)
        entropy = -(policy * log_policy).sum(axis=1, keepdims=True)
        up = moving[:, None] * (taken - policy)
        up -= 0.01 * policy * (log_policy + entropy)
        judged, value = outputs(*layers[2:], inputs)
        slopes = []
        for last, units, wrong in (
            (layers[1], hidden, -up),
            (layers[3], judged, value - goals[rows, None]),
        ):
            back = wrong @ last[:, 1:] * (1 - units**2)
            slopes.append(np.column_stack([back.sum(axis=0), back.T @ inputs]))
            slopes.append(np.column_stack([wrong.sum(axis=0), wrong.T @ units]))
        for layer, mean, square, slope in zip(layers, means, squares, slopes):
            mean += 0.1 * (slope / len(rows) - mean)
            square += 0.01 * ((slope / len(rows)) ** 2 - square)
            step = mean / (1 - 0.9 ** (n + 1))
            layer -= 0.01 * step / (np.sqrt(square / (1 - 0.99 ** (n + 1))) + 1e-6)
    return layers
    ### END SOLUTION
