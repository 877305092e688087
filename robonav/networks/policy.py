"""A network as the robot's policy."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.robot import Encoder, Sensing
from robonav.validation import check_real

from ._checks import check_single
from .multilayer_perceptron import Network


@dataclass(frozen=True, eq=False)
class NetworkPolicy:
    """A policy that takes the action with the largest output, or draws one from the softmax of the outputs.

    Parameters
    ----------
    network : Network
        A single network, with as many inputs as the encoder gives and one output for each action.
    encoder : Encoder
        Turns what the robot senses into the network's inputs.
    temperature : float
        T of the distribution proportional to ``exp(z / T)`` that actions are drawn from, with z the logits. At 0 the
        policy takes the largest. A robot without memory can go round in circles; random actions end that.

    Raises
    ------
    ValueError
        If network and encoder do not fit, or the temperature is negative.

    Examples
    --------
    >>> from robonav.networks import NetworkPolicy, random_network
    >>> from robonav.robot import Encoder, navigate, random_worlds
    >>> encoder = Encoder(target="number")
    >>> policy = NetworkPolicy(random_network((encoder.size, 8, 5), seed=0), encoder)
    >>> navigate(policy, random_worlds(3, obstacles=0, seed=0)).success.tolist()
    [True, True, True]
    """

    network: Network
    encoder: Encoder = field(default_factory=Encoder)
    temperature: float = 0.0

    def __post_init__(self) -> None:
        check_real("temperature", self.temperature, at_least=0)
        check_single(self.network)
        if self.network.sizes[0] != self.encoder.size:
            raise ValueError(
                f"network must have {self.encoder.size} inputs, as its encoder gives, got sizes {self.network.sizes}"
            )

    def logits(self, sensing: Sensing) -> NDArray[np.float64]:
        """Return the weighted sums of the output units. Their sigmoids would round to 1 if they are large.

        Parameters
        ----------
        sensing : Sensing
            What N robots perceive.

        Returns
        -------
        (N, A) array

        Examples
        --------
        >>> from robonav.networks import NetworkPolicy, random_network
        >>> from robonav.robot import Encoder, make_world, sense
        >>> encoder = Encoder()
        >>> policy = NetworkPolicy(random_network((encoder.size, 8, 5), seed=0), encoder)
        >>> policy.logits(sense(make_world(), [(50, 50, 0)])).shape
        (1, 5)
        """
        return self.network.logits(self.encoder(sensing))

    def __call__(self, sensing: Sensing, rng: np.random.Generator) -> NDArray[np.int64]:
        """Return actions (N,)."""
        return draw_actions(self.logits(sensing), self.temperature, rng)


def draw_actions(
    logits: NDArray[np.float64], temperature: float, rng: np.random.Generator
) -> NDArray[np.int64]:
    """Draw one action from each row of logits z, with the probabilities ``exp(z / T)`` over their sum.

    The largest of ``z + T * Gumbel noise`` has these probabilities (the Gumbel-max trick). At the temperature 0 it is
    the action with the largest logit.

    Parameters
    ----------
    logits : (N, A) array
        z.
    temperature : float
        T, at least 0.
    rng : numpy.random.Generator
        Draws the noise.

    Returns
    -------
    (N,) array of int
        Indices of actions.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks.policy import draw_actions
    >>> draw_actions(np.array([[0.0, 2.0, 1.0]]), 0.0, np.random.default_rng(0))
    array([1])
    """
    if temperature > 0:
        logits = logits + temperature * rng.gumbel(size=logits.shape)
    return logits.argmax(axis=1).astype(np.int64)


def sample_actions(
    probabilities: NDArray[np.float64], uniforms: ArrayLike
) -> NDArray[np.int64]:
    """Draw one action from each row of probabilities, by inverting their cumulative sums.

    Parameters
    ----------
    probabilities : (..., A) array
        Of the actions.
    uniforms : (...) array
        Uniform random numbers in [0, 1), one for each action drawn.

    Returns
    -------
    (...) array of int
        Indices of actions.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks.policy import sample_actions
    >>> sample_actions(np.array([[0.2, 0.5, 0.3]] * 3), np.array([0.1, 0.6, 0.9])).tolist()
    [0, 1, 2]
    """
    passed = probabilities.cumsum(axis=-1) <= np.asarray(uniforms)[..., None]
    return np.minimum(passed.sum(axis=-1), probabilities.shape[-1] - 1)
