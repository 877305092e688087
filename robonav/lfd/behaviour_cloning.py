"""Policy learning from multiple demonstrations (Algorithm 3)."""

from __future__ import annotations

import numpy as np

from robonav.networks.multilayer_perceptron import Array
from robonav.networks.optimisers import fit, one_hot
from robonav.networks.policy import NetworkPolicy
from robonav.progress import Progress
from robonav.robot import Encoder
from robonav.validation import check_instance

from .demonstrations import LEARNED, Demonstrations


def labelled_states(
    demonstrations: Demonstrations, encoder: Encoder | None = None
) -> tuple[Array, Array]:
    """The training examples in demonstrations: inputs (m, n) and one-hot actions (m, 5) of the effective pairs.

    Raises
    ------
    TypeError : if these are no demonstrations, or no encoder.
    ValueError : if there is no effective pair.
    """
    encoder = (
        Encoder() if encoder is None else check_instance("encoder", encoder, Encoder)
    )
    pairs = check_instance("demonstrations", demonstrations, Demonstrations).effective
    if len(pairs) == 0:
        raise ValueError(
            "demonstrations must hold an effective pair: a step with something in range, got none"
        )
    return encoder(pairs.sensing), one_hot(pairs.actions, LEARNED)


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
    """Learn a policy from demonstrations (Algorithm 3): a network with one hidden layer on the effective pairs.

    Parameters
    ----------
    demonstrations : of any expert.
    hidden : units of the hidden layer.
    regularisation : lambda of Eq. (3.22).
    iterations : of L-BFGS.
    seed : of the initial weights.
    encoder : how sensing becomes the network's inputs; by default all nine sensors, and sine and cosine of the target's
        sector (``Encoder(target="number")`` is the thesis's 11 numbers).

    Raises
    ------
    TypeError : if these are no demonstrations, or an argument is of another type.
    ValueError : if there is no effective pair, or an argument lies outside its range.
    """
    encoder = encoder or Encoder()
    x, y = labelled_states(demonstrations, encoder)
    training = fit(
        x,
        y,
        hidden=hidden,
        regularisation=regularisation,
        iterations=iterations,
        seed=seed,
        progress=progress,
    )
    return NetworkPolicy(training.network, encoder)
