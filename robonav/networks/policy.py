"""A network as the robot's policy."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.robot import Encoder, Sensing
from robonav.validation import check_real

from .multilayer_perceptron import Network


@dataclass(frozen=True, eq=False)
class NetworkPolicy:
    """Takes the action of the network's strongest output, or at some temperature one of the stronger by chance.

    Attributes
    ----------
    network : a single network, as many inputs as the encoder gives, one output an action.
    encoder : how what is sensed becomes the network's inputs.
    temperature : T of the Boltzmann distribution, ``exp(z / T)`` over its sum, that actions are drawn from, with z the
        logits; 0 leaves nothing to chance. A robot without a memory can go round in circles; a little chance ends that.

    Raises
    ------
    ValueError : if network and encoder do not fit, or the temperature is negative.
    """

    network: Network
    encoder: Encoder = field(default_factory=Encoder)
    temperature: float = 0.0

    def __post_init__(self) -> None:
        check_real("temperature", self.temperature, at_least=0)
        if self.network.stack or self.network.sizes[0] != self.encoder.size:
            raise ValueError(
                f"network must be a single one with {self.encoder.size} inputs, as its encoder gives, "
                f"got sizes {self.network.sizes} and stack {self.network.stack}"
            )

    def logits(self, sensing: Sensing) -> NDArray[np.float64]:
        """The output units (N, A) before their sigmoid: no two large ones round to the same 1."""
        return self.network.logits(self.encoder(sensing))

    def __call__(self, sensing: Sensing, rng: np.random.Generator) -> NDArray[np.int64]:
        """Actions (N,); the largest of logits with Gumbel noise of scale T is distributed as Boltzmann has it."""
        z = self.logits(sensing)
        if self.temperature > 0:
            z = z + self.temperature * rng.gumbel(size=z.shape)
        return z.argmax(axis=1).astype(np.int64)


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
