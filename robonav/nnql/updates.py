"""One update of a network's Q-values: target, rescaling, error, cost and gradient descent (section 4.4.4)."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.networks.multilayer_perceptron import (
    Network,
    backpropagate,
    gradient_descent_step,
)
from robonav.validation import ArrayArgument

from ._arguments import checked_arguments

Array = NDArray[np.float64]


@checked_arguments
def q_targets(
    q: Array,
    action: ArrayArgument,
    reward: ArrayArgument,
    next_value: ArrayArgument,
    learning_rate: ArrayArgument,
    discount: float,
) -> Array:
    """Q-values after one update of the action taken, Eq. (4.9).

    The values of the other actions stay as they are. The function takes one state, or a batch of them along leading
    axes.

    Parameters
    ----------
    q : (..., A) array
        Q-values in the states left.
    action : (...) array of int
        Actions taken there.
    reward : (...) array
        Rewards received.
    next_value : (...) array
        Greatest Q-value in the states reached; 0 where the episode ended.
    learning_rate : float or (...) array
        The thesis's alpha, 0 to 1.
    discount : float
        The thesis's gamma, 0 to 1.

    Returns
    -------
    (..., A) array
        The updated values.

    Raises
    ------
    ValueError, TypeError
        If an argument is out of bounds, an action does not exist, or the shapes do not belong together.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nnql import q_targets
    >>> q_targets(np.array([0.4, 0.6]), 1, 0.5, 1.0, learning_rate=0.5, discount=0.6)
    array([0.4 , 0.85])
    """
    taken = np.arange(q.shape[-1]) == action[..., None]
    td_target = (reward + discount * next_value)[..., None]
    alpha = learning_rate[..., None]
    moved = q + alpha * (td_target - q)  # Eq. (4.9)
    return np.where(taken, moved, q)


@checked_arguments
def clip(q: Array) -> Array:
    """Move Q-values outside [0, 1] to the nearer end.

    Parameters
    ----------
    q : (..., A) array

    Returns
    -------
    (..., A) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nnql import clip
    >>> clip(np.array([-0.5, 0.25, 2.0]))
    array([0.  , 0.25, 1.  ])
    """
    return q.clip(0.0, 1.0)


@checked_arguments
def shift(q: Array) -> Array:
    """Shift and divide the Q-values of a state (..., A), so that all lie in [0, 1]. The order of the actions stays.

    Parameters
    ----------
    q : (..., A) array

    Returns
    -------
    (..., A) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nnql import shift
    >>> shift(np.array([-0.5, 0.25, 1.5]))
    array([0.   , 0.375, 1.   ])
    """
    low = np.minimum(q.min(axis=-1, keepdims=True), 0.0)
    high = np.maximum(q.max(axis=-1, keepdims=True), 1.0)
    return (q - low) / (high - low)


RESCALE: dict[str, Callable[[Array], Array]] = {"clip": clip, "shift": shift}
"""Two readings of the thesis's "rescale"."""


def network_error(targets: Array, q: Array) -> Array:
    """The network's error, Eq. (4.10): rescaled targets minus the network's outputs, (..., A).

    Parameters
    ----------
    targets : (..., A) array
        Rescaled Q-values.
    q : (..., A) array
        Outputs of the network.

    Returns
    -------
    (..., A) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nnql import network_error
    >>> network_error(np.array([0.5, 1.0]), np.array([0.5, 0.75]))
    array([0.  , 0.25])
    """
    return targets - q  # Eq. (4.10)


def cross_entropy(targets: ArrayLike, logits: ArrayLike) -> Array:
    """The cost J of the network's outputs, Eq. (4.11), summed over the actions.

    The thesis prints ``1 - log Q`` where the cross-entropy has ``log(1 - Q)``. The function takes the logits z of the
    outputs, because ``log(1 + exp(z)) - target z`` is the same number and never takes the logarithm of a zero.

    Parameters
    ----------
    targets : (..., A) array
        Rescaled Q-values in [0, 1].
    logits : (..., A) array
        Outputs of the network before the sigmoid.

    Returns
    -------
    (...) array
        Costs.

    Examples
    --------
    >>> from robonav.nnql import cross_entropy
    >>> cross_entropy([1.0, 0.0], [0.0, 0.0]).round(4)  # 2 log 2: both outputs are 1/2
    np.float64(1.3863)
    """
    costs = np.logaddexp(0.0, logits) - np.multiply(targets, logits)  # Eq. (4.11)
    return costs.sum(axis=-1)


def train_on_pairs(
    network: Network,
    inputs: Sequence[Array],
    targets: Sequence[Array],
    gradient_step: float | Array,
    passes: int,
    tolerance: float,
) -> Network:
    """Train a network on pairs of state and target, one pair at a time, until its cost settles.

    Uses Eqs. (4.10), (4.11) and (4.12), and the backpropagation of chapter 3.

    Parameters
    ----------
    network : Network
        The network to start from.
    inputs, targets : sequences of (n,) and (A,) arrays
        The pairs.
    gradient_step : float
        The thesis's sigma.
    passes : int
        The largest number of passes through the pairs.
    tolerance : float
        Stop when the mean cost changes by less from one pass to the next.

    Returns
    -------
    Network
        The trained network.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import random_network
    >>> from robonav.nnql import train_on_pairs
    >>> network, state, target = random_network((4, 8, 2), seed=0), np.eye(4)[0], np.array([0.2, 0.9])
    >>> trained = train_on_pairs(network, [state], [target], gradient_step=1, passes=500, tolerance=0)
    >>> trained.forward(state).round(2)
    array([0.2, 0.9])
    """
    previous = np.inf
    for _ in range(passes):
        cost = 0.0
        for state, target in zip(inputs, targets, strict=True):
            layers = network.activations(state[None])
            cost += float(cross_entropy(target, network.logits(state))) / len(inputs)
            delta = network_error(target, layers[-1])
            gradient = backpropagate(network.weights, layers, -delta)  # of the cost
            network = gradient_descent_step(network, gradient, gradient_step)
        if abs(previous - cost) < tolerance:
            break
        previous = cost
    return network
