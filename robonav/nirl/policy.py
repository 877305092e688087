"""The neural policy: action values by a network, and two policies over these values (sections 5.4.2 and 5.4.3)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from robonav.networks.multilayer_perceptron import Network, sigmoid
from robonav.validation import ArrayArgument

from ._arguments import checked

Floats = NDArray[np.float64]

ActionProbabilities = Callable[[Floats], Floats]
"""``action_probabilities(inputs (N, k)) -> (N, A)``: the probability with which a policy takes each action."""


def neural_action_values(network: Network, inputs: Floats) -> Floats:
    """Action values that the network's outputs stand for, Eq. (5.9).

    The bias units of the equation are the vectors ``biases``.

    Parameters
    ----------
    network : Network
        k inputs, one hidden layer, A outputs.
    inputs : (N, k) array
        phi(s) of N states.

    Returns
    -------
    (N, A) array
        Numbers between 0 and 1.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import Network
    >>> from robonav.nirl import neural_action_values
    >>> network = Network((np.ones((1, 2)), np.ones((2, 1))), (np.zeros(1), np.zeros(2)))
    >>> neural_action_values(network, np.array([[0.0, 0.0]])).round(3)
    array([[0.622, 0.622]])
    """
    w1, w2 = network.weights
    b1, b2 = network.biases
    hidden = sigmoid(inputs @ w1.T + b1)
    return sigmoid(hidden @ w2.T + b2)  # Eq. (5.9)


@checked
def boltzmann_policy(
    action_values: ArrayArgument, inverse_temperature: float
) -> Floats:
    """Probability of each action, in proportion to exp(eta Q(s, a)), Eq. (5.10).

    At eta = 0 all actions are equally likely. The larger eta is, the more probable is the best action. It is the
    softmax policy of chapter 4, Eq. (4.7), at the temperature 1 / eta, :func:`robonav.nnql.softmax_policy`; both
    functions exist because the thesis numbers both equations. At eta = 0 this temperature would be infinite, so eta
    multiplies the values instead. The sum in the denominator runs over the actions; the thesis names the action
    values of the state as its index.

    Parameters
    ----------
    action_values : (..., A) array
        Q(s, a).
    inverse_temperature : float
        eta, at least 0.

    Returns
    -------
    (..., A) array

    Examples
    --------
    >>> from robonav.nirl import boltzmann_policy
    >>> boltzmann_policy([0.2, 0.2, 0.9], 5.0).round(3)
    array([0.028, 0.028, 0.943])
    """
    scaled = inverse_temperature * action_values
    largest = scaled.max(axis=-1, keepdims=True)  # it cancels; no exponential overflows
    weights = np.exp(scaled - largest)
    return weights / weights.sum(axis=-1, keepdims=True)  # Eq. (5.10)


def greedy_actions(network: Network, inputs: Floats) -> NDArray[np.intp]:
    """The action with the largest value in each state, Eq. (5.11).

    The sigmoid of the output layer is increasing, so the largest logit belongs to the largest value. Two large values
    can round to the same number; their logits differ.

    Parameters
    ----------
    network : Network
        k inputs, A outputs.
    inputs : (N, k) array
        phi(s) of N states.

    Returns
    -------
    (N,) array of int

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import Network
    >>> from robonav.nirl import greedy_actions
    >>> network = Network((np.ones((1, 2)), np.ones((2, 1))), (np.zeros(1), np.array([0.0, 1.0])))
    >>> greedy_actions(network, np.array([[0.0, 0.0]]))
    array([1])
    """
    return network.logits(inputs).argmax(axis=1)  # Eq. (5.11)


def exploring_policy(
    network: Network, inverse_temperature: float
) -> ActionProbabilities:
    """The policy of a network during training: :func:`boltzmann_policy` over :func:`neural_action_values`.

    Parameters
    ----------
    network : Network
        k inputs, A outputs.
    inverse_temperature : float
        eta.

    Returns
    -------
    callable
        ``policy(inputs (N, k)) -> (N, A)`` probabilities.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import random_network
    >>> from robonav.nirl import exploring_policy
    >>> exploring_policy(random_network((2, 3, 4), seed=0), 0.0)(np.zeros((1, 2)))
    array([[0.25, 0.25, 0.25, 0.25]])
    """
    return lambda inputs: boltzmann_policy(
        neural_action_values(network, inputs), inverse_temperature
    )
