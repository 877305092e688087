"""The robot's policy with a sensor of its own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray

from robonav.networks.policy import draw_actions
from robonav.robot import ActionSelector, Encoder, Sensing, Simulator
from robonav.validation import check_real

from .networks import SensorNetwork
from .sensors import Robots, Sensor

TARGET_ENCODER = Encoder(sensors=())
"""Encodes where the target is, in the nine sectors of section 2.5: the same for all sensors."""


@dataclass(frozen=True, eq=False)
class SensorPolicy:
    """A policy whose network reads a sensor. :func:`robonav.robot.navigate` calls ``begin`` before the episodes.

    Parameters
    ----------
    sensor : Ring or Picture
        What reads the surroundings.
    network : SensorNetwork
        What chooses the action.
    temperature : float
        As in :class:`robonav.networks.NetworkPolicy`.

    Examples
    --------
    >>> from robonav.robot import navigate, random_worlds
    >>> from robonav.sensing import Ring, SensorPolicy, ring_network
    >>> ring = Ring(18)
    >>> policy = SensorPolicy(ring, ring_network(ring, seed=0))
    >>> navigate(policy, random_worlds(3, obstacles=0, seed=0)).success.tolist()
    [True, True, True]
    """

    sensor: Sensor
    network: SensorNetwork
    temperature: float = 0.0

    def __post_init__(self) -> None:
        check_real("temperature", self.temperature, at_least=0)

    def begin(self, simulator: Simulator, rng: np.random.Generator) -> ActionSelector:
        """Return the selector of actions for the robots of a simulator.

        Parameters
        ----------
        simulator : Simulator
            Its N robots are driven.
        rng : numpy.random.Generator
            Of random actions.

        Returns
        -------
        callable
            ``select_actions(simulator, sensing, robots)`` returns actions.

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.robot import Simulator, random_worlds
        >>> from robonav.sensing import Ring, SensorPolicy, fully_connected
        >>> policy = SensorPolicy(Ring(9), fully_connected(Ring(9), seed=0))
        >>> simulator, rng = Simulator(random_worlds(2, seed=1)), np.random.default_rng(0)
        >>> policy.begin(simulator, rng)(simulator, simulator.sense(), np.arange(2)).shape
        (2,)
        """

        def select_actions(
            simulator: Simulator, sensing: Sensing, robots: Robots
        ) -> NDArray[np.int64]:
            """Return the actions (K,) of K robots."""
            read = inputs_of(self.sensor, simulator, sensing, robots)
            with torch.no_grad():
                logits = self.network(*read).double().numpy()
            return draw_actions(logits, self.temperature, rng)

        return select_actions


def inputs_of(
    sensor: Sensor, simulator: Simulator, sensing: Sensing, robots: Robots
) -> tuple[torch.Tensor, torch.Tensor]:
    """Return what a network reads: the readings of K robots (K, \\*shape), and where their targets are (K, 3).

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot import Simulator, random_worlds
    >>> from robonav.sensing import Picture
    >>> from robonav.sensing.policies import inputs_of
    >>> simulator = Simulator(random_worlds(2, seed=1))
    >>> [part.shape for part in inputs_of(Picture(), simulator, simulator.sense(), np.arange(2))]
    [torch.Size([2, 32, 32]), torch.Size([2, 3])]
    """
    readings, target = sensor(simulator, robots), TARGET_ENCODER(sensing)
    return torch.from_numpy(readings).float(), torch.from_numpy(target).float()
