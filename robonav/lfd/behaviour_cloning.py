"""Behaviour cloning: policy learning from multiple demonstrations (section 3.4)."""

from __future__ import annotations

import numpy as np

from robonav.networks.multilayer_perceptron import Array, random_network
from robonav.networks.optimisers import lbfgs, one_hot
from robonav.networks.policy import NetworkPolicy
from robonav.progress import Progress
from robonav.robot import Encoder
from robonav.validation import check_instance, check_integer

from .demonstrations import LEARNED, Demonstrations


def stacked_pairs(
    demonstrations: Demonstrations, encoder: Encoder
) -> tuple[Array, Array]:
    """Stack the effective pairs of all demonstrations, Eqs. (3.29) and (3.30).

    Parameters
    ----------
    demonstrations : Demonstrations
        Their steps lie one trajectory below the other already.
    encoder : Encoder
        Gives the components of a state.

    Returns
    -------
    S : (m, n) array
        States.
    A : (m, 5) array
        Action labels.
    """
    pairs = demonstrations.effective
    X, Y = encoder(pairs.sensing), one_hot(pairs.actions, LEARNED)  # Eq. (3.30)
    S, A = X, Y  # Eq. (3.29): the rows of demonstration 1, then those of 2, and so on
    return S, A


def labelled_states(
    demonstrations: Demonstrations, encoder: Encoder | None = None
) -> tuple[Array, Array]:
    """Return the training examples in demonstrations: the effective pairs, encoded.

    Parameters
    ----------
    demonstrations : Demonstrations
        Of any expert.
    encoder : Encoder, optional
        How sensing becomes the network's inputs.

    Returns
    -------
    x : (m, n) array
        Inputs.
    y : (m, 5) array
        One-hot actions.

    Raises
    ------
    TypeError
        If these are not Demonstrations, or not an Encoder.
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
    x, y = stacked_pairs(demonstrations, encoder)
    if len(x) == 0:
        raise ValueError(
            "demonstrations must hold an effective pair: a step with something in range, got none"
        )
    return x, y


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

    Parameters and errors are those of :func:`learn_policy`.

    Returns
    -------
    NetworkPolicy

    Examples
    --------
    >>> from robonav.lfd import behaviour_cloning, demonstrate
    >>> from robonav.robot import random_worlds
    >>> shown = demonstrate(random_worlds(2, obstacles=10, seed=1))
    >>> behaviour_cloning(shown, iterations=20).network.sizes
    (12, 8, 5)
    """
    encoder = encoder or Encoder()
    sizes = (encoder.size, hidden, LEARNED)
    network = random_network(sizes, seed=seed)  # 1
    # 2 to 4: the demonstrations hold every step of every trajectory
    x, y = labelled_states(demonstrations, encoder)  # 5 and 6
    training = lbfgs(
        network, x, y, regularisation=regularisation, iterations=iterations,
        progress=progress,
    )  # 7  # fmt: skip
    return NetworkPolicy(training.network, encoder)  # 8


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
    """Learn a policy from demonstrations: check the arguments, then :func:`behaviour_cloning`.

    Parameters
    ----------
    demonstrations : Demonstrations
        Of any expert.
    hidden : int
        Units of the hidden layer.
    regularisation : float
        lambda of the cost, Eq. (3.22).
    iterations : int
        Of L-BFGS, at most.
    seed : int or Generator
        Of the initial weights.
    encoder : Encoder, optional
        How sensing becomes the network's inputs; by default all nine sensors, and sine and cosine of the target's
        sector. ``Encoder(target="number")`` gives the thesis's 11 numbers.
    progress : callable, optional
        Called as ``progress(done, iterations)``.

    Returns
    -------
    NetworkPolicy

    Raises
    ------
    TypeError
        If these are not Demonstrations, or an argument is of another type.
    ValueError
        If there is no effective pair, or an argument lies outside its range.

    Examples
    --------
    >>> from robonav.lfd import demonstrate, learn_policy
    >>> from robonav.robot import navigate, random_worlds
    >>> policy = learn_policy(demonstrate(random_worlds(4, obstacles=10, seed=1)), iterations=50)
    >>> len(navigate(policy, random_worlds(5, obstacles=10, seed=2)).outcome)
    5
    """
    check_instance("demonstrations", demonstrations, Demonstrations)
    if encoder is not None:
        check_instance("encoder", encoder, Encoder)
    return behaviour_cloning(
        demonstrations,
        hidden=check_integer("hidden", hidden, at_least=1),
        regularisation=regularisation,
        iterations=iterations,
        seed=seed,
        encoder=encoder,
        progress=progress,
    )
