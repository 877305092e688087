"""A network as the robot's policy."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from robonav.robot import Encoder, Sensing

from .network import Network


@dataclass(frozen=True, eq=False)
class NetworkPolicy:
    """Takes the action of the network's strongest output.

    Attributes
    ----------
    network : a single network, as many inputs as the encoder gives, one output an action.
    encoder : how what is sensed becomes the network's inputs.

    Raises
    ------
    ValueError : if network and encoder do not fit.
    """

    network: Network
    encoder: Encoder = field(default_factory=Encoder)

    def __post_init__(self) -> None:
        if self.network.stack or self.network.sizes[0] != self.encoder.size:
            raise ValueError(
                f"network must be a single one with {self.encoder.size} inputs, as its encoder gives, "
                f"got sizes {self.network.sizes} and stack {self.network.stack}"
            )

    def logits(self, sensing: Sensing) -> NDArray[np.float64]:
        """The output units (N, A) before their sigmoid: no two large ones round to the same 1."""
        return self.network.logits(self.encoder(sensing))

    def __call__(self, sensing: Sensing, rng: np.random.Generator) -> NDArray[np.int64]:
        """Actions (N,), the same for the same sensing; the generator is not used."""
        return self.logits(sensing).argmax(axis=1).astype(np.int64)
