"""Behaviour cloning: learning a policy from demonstrations by supervised learning (section 3.4)."""

from __future__ import annotations

import numpy as np

from robonav.networks import random_network
from robonav.networks.multilayer_perceptron import Array
from robonav.networks.optimisers import lbfgs, one_hot
from robonav.networks.policy import NetworkPolicy
from robonav.progress import Progress
from robonav.robot import Encoder
from robonav.validation import check_instance

from ._arguments import checked
from .demonstrations import LEARNED, Demonstrations


@checked
def behaviour_cloning(
    demonstrations: Demonstrations,
    *,
    hidden: int = 8,
    regularisation: float = 1.0,
    iterations: int = 300,
    seed: int | np.random.Generator = 0,
    encoder: Encoder | None = None,
    progress: Progress | None = None,
) -> NetworkPolicy:
    """Policy learning from multiple demonstrations, Algorithm 3.

    This is behaviour cloning: a network is trained, by supervised learning, to answer each state in the demonstrations
    with the expert's action. The numbers in the comments are the lines of Algorithm 3.

    Parameters
    ----------
    demonstrations : Demonstrations
        By any expert.
    hidden : int
        Number of units in the hidden layer.
    regularisation : float
        lambda in the cost, Eq. (3.22).
    iterations : int
        The most iterations of L-BFGS.
    seed : int or Generator
        Of the initial weights.
    encoder : Encoder, optional
        Turns what the robot senses into the network's inputs, see :func:`learn_policy`.
    progress : callable, optional
        Called as ``progress(done, iterations)``.

    Returns
    -------
    NetworkPolicy

    Examples
    --------
    >>> from robonav.lfd import behaviour_cloning, demonstrate
    >>> from robonav.robot import random_worlds
    >>> demonstrations = demonstrate(random_worlds(2, obstacles=10, seed=1))
    >>> behaviour_cloning(demonstrations, iterations=20).network.sizes
    (12, 8, 5)
    """
    encoder = encoder or Encoder()
    network = random_network((encoder.size, hidden, LEARNED), seed=seed)  # 1
    # 2 to 4: the demonstrations hold the state-action pairs of all trajectories.
    states, actions = labelled_states(demonstrations, encoder)  # 5 and 6
    training = lbfgs(  # 7
        network,
        states,
        actions,
        regularisation=regularisation,
        iterations=iterations,
        progress=progress,
    )
    return NetworkPolicy(training.network, encoder)  # 8: to be put on a robot


def learn_policy(
    demonstrations: Demonstrations,
    hidden: int = 8,
    regularisation: float = 1.0,
    iterations: int = 300,
    seed: int | np.random.Generator = 0,
    *,
    encoder: Encoder | None = None,
    progress: Progress | None = None,
) -> NetworkPolicy:
    """Learn a policy from demonstrations by :func:`behaviour_cloning`, whose options it takes without their names.

    Parameters
    ----------
    demonstrations : Demonstrations
        By any expert.
    hidden : int
        Number of units in the hidden layer.
    regularisation : float
        lambda in the cost, Eq. (3.22).
    iterations : int
        The most iterations of L-BFGS.
    seed : int or Generator
        Of the initial weights.
    encoder : Encoder, optional
        Turns what the robot senses into the network's inputs. By default these are the nine sensors' degrees of
        danger, sine and cosine of the target's sector, and whether the target is in range.
        ``Encoder(target="number")`` gives the thesis's 11 numbers.
    progress : callable, optional
        Called as ``progress(done, iterations)``.

    Returns
    -------
    NetworkPolicy

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If there is no effective pair, or if an argument is out of bounds.

    Examples
    --------
    >>> from robonav.lfd import demonstrate, learn_policy
    >>> from robonav.robot import navigate, random_worlds
    >>> policy = learn_policy(demonstrate(random_worlds(4, obstacles=10, seed=1)), iterations=50)
    >>> len(navigate(policy, random_worlds(5, obstacles=10, seed=2)).outcome)
    5
    """
    return behaviour_cloning(
        demonstrations,
        hidden=hidden,
        regularisation=regularisation,
        iterations=iterations,
        seed=seed,
        encoder=encoder,
        progress=progress,
    )


def stacked_pairs(
    demonstrations: Demonstrations, encoder: Encoder
) -> tuple[Array, Array]:
    """Stack the effective pairs of all demonstrations, Eqs. (3.29) and (3.30).

    Parameters
    ----------
    demonstrations : Demonstrations
        M trajectories, at least one.
    encoder : Encoder
        Turns what the robot senses into the components of a state.

    Returns
    -------
    S : (m, n) array
        States.
    A : (m, 5) array
        Actions, each a 1 among zeros.

    Examples
    --------
    >>> from robonav.lfd import demonstrate
    >>> from robonav.lfd.behaviour_cloning import stacked_pairs
    >>> from robonav.robot import Encoder, random_worlds
    >>> demonstrations = demonstrate(random_worlds(2, obstacles=10, seed=1))
    >>> S, A = stacked_pairs(demonstrations, Encoder())
    >>> S.shape == (len(demonstrations.effective), 12), A.shape == (len(S), 5)
    (True, True)
    """
    X, Y = [], []
    for number in range(len(demonstrations.worlds)):
        pairs = demonstrations.select_trajectories([number]).effective
        X.append(encoder(pairs.sensing))  # Eq. (3.30): a row for each pair
        Y.append(one_hot(pairs.actions, LEARNED))
    S, A = np.concatenate(X), np.concatenate(Y)  # Eq. (3.29)
    return S, A


def labelled_states(
    demonstrations: Demonstrations, encoder: Encoder | None = None
) -> tuple[Array, Array]:
    """Return the training examples in demonstrations: the effective pairs, encoded.

    Parameters
    ----------
    demonstrations : Demonstrations
        By any expert.
    encoder : Encoder, optional
        Turns what the robot senses into the network's inputs.

    Returns
    -------
    x : (m, n) array
        Inputs.
    y : (m, 5) array
        Labels: the actions, each a 1 among zeros.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If there is no effective pair.

    Examples
    --------
    >>> from robonav.lfd import demonstrate, labelled_states
    >>> from robonav.robot import random_worlds
    >>> x, y = labelled_states(demonstrate(random_worlds(2, obstacles=10, seed=1)))
    >>> len(x) == len(y), y.shape[1], bool((y.sum(axis=1) == 1).all())
    (True, 5, True)
    """
    encoder = (
        Encoder() if encoder is None else check_instance("encoder", encoder, Encoder)
    )
    check_instance("demonstrations", demonstrations, Demonstrations)
    if len(demonstrations.effective) == 0:
        raise ValueError(
            "demonstrations must hold an effective pair: a step with something in range, got none"
        )
    return stacked_pairs(demonstrations, encoder)
