"""The robot's policy with a memory."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import torch
from numpy.typing import NDArray

from robonav.networks.policy import draw_actions
from robonav.robot import ActionSelector, Encoder, Sensing, Simulator
from robonav.validation import check_real

from .networks import ACTIONS, MemoryNetwork

Actions = NDArray[np.int64]


class Memories:
    """The memories of N robots, with what each of them did last.

    Parameters
    ----------
    network : WindowNetwork or RecurrentNetwork
        Its memories.
    encoder : Encoder
        Encodes what a robot senses.
    n : int
        N.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.memory import WindowNetwork
    >>> from robonav.memory.policies import Memories
    >>> from robonav.robot import Encoder, make_world, sense
    >>> encoder = Encoder()
    >>> memories = Memories(WindowNetwork(encoder.size, k=2, hidden=4, seed=0), encoder, n=1)
    >>> x, logits = memories.read(sense(make_world(), [(50, 50, 0)]), np.array([0]))
    >>> x.shape, logits.shape
    ((1, 17), (1, 5))
    """

    def __init__(self, network: MemoryNetwork, encoder: Encoder, n: int) -> None:
        self.network, self.encoder = network, encoder
        self.kept = network.begin(n)
        self.last = np.zeros((n, ACTIONS))

    def forget(self, robots: Actions) -> None:
        """Empty the memories of robots whose episodes begin."""
        self.kept[robots], self.last[robots] = self.network.begin(len(robots)), 0

    def read(
        self, sensing: Sensing, robots: Actions
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Let the network read what robots (K,) sense; return its inputs (K, D) and its logits (K, 5)."""
        x, logits, self.kept[robots] = self._step(sensing, robots)
        return x, logits

    def with_next(self, sensing: Sensing, robots: Actions) -> torch.Tensor:
        """Return what the memories of robots (K,) will be when they have read this; they stay as they are."""
        return self._step(sensing, robots)[2]

    def _step(
        self, sensing: Sensing, robots: Actions
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], torch.Tensor]:
        """Return inputs, logits and new memories."""
        x = np.concatenate([self.encoder(sensing), self.last[robots]], axis=1)
        with torch.no_grad():
            logits, kept = self.network.step(self.kept[robots], torch.from_numpy(x))
        return x, logits.numpy(), kept

    def acted(self, robots: Actions, actions: Actions) -> None:
        """Remember what robots (K,) do now."""
        self.last[robots] = np.eye(ACTIONS)[actions]


@dataclass(frozen=True, eq=False)
class MemoryPolicy:
    """A policy whose network has a memory. :func:`robonav.robot.navigate` calls ``begin`` before the episodes.

    Parameters
    ----------
    network : WindowNetwork or RecurrentNetwork
        What reads and remembers.
    encoder : Encoder
        Turns what the robot senses into numbers.
    temperature : float
        As in :class:`robonav.networks.NetworkPolicy`.

    Examples
    --------
    >>> from robonav.memory import MemoryPolicy, RecurrentNetwork
    >>> from robonav.robot import Encoder, navigate, random_worlds
    >>> policy = MemoryPolicy(RecurrentNetwork(Encoder().size, units=8, seed=0))
    >>> len(navigate(policy, random_worlds(3, obstacles=0, seed=0), reflex=None).outcome)
    3
    """

    network: MemoryNetwork
    encoder: Encoder = field(default_factory=Encoder)
    temperature: float = 0.0

    def __post_init__(self) -> None:
        check_real("temperature", self.temperature, at_least=0)

    def begin(self, simulator: Simulator, rng: np.random.Generator) -> ActionSelector:
        """Return the selector of actions for the robots of a simulator, which remembers their episodes.

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
        >>> from robonav.memory import MemoryPolicy, WindowNetwork
        >>> from robonav.robot import Encoder, Simulator, random_worlds
        >>> policy = MemoryPolicy(WindowNetwork(Encoder().size, k=4, hidden=8, seed=0))
        >>> simulator, rng = Simulator(random_worlds(2, seed=1)), np.random.default_rng(0)
        >>> policy.begin(simulator, rng)(simulator, simulator.sense(), np.arange(2)).shape
        (2,)
        """
        memories = Memories(self.network, self.encoder, len(simulator))
        asked = np.full(len(simulator), -1)

        def select_actions(
            simulator: Simulator, sensing: Sensing, robots: Actions
        ) -> Actions:
            """Return the actions (K,) of K robots; a new episode has no memories."""
            memories.forget(robots[simulator.steps[robots] <= asked[robots]])
            asked[robots] = simulator.steps[robots]
            _, logits = memories.read(sensing, robots)
            actions = draw_actions(logits, self.temperature, rng)
            memories.acted(robots, actions)
            return actions

        return select_actions
