"""A given episode as an environment, and given random numbers: for one known update of a learner."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any


@dataclass
class Episode:
    """An environment in which one episode always happens.

    Attributes
    ----------
    states : sequence of int
        The states in order, the first one at the reset.
    rewards : sequence of float
        The reward of each step.
    terminated : bool
        Whether the last state is terminal. If not, the episode is cut off there.

    Examples
    --------
    >>> episode = Episode([0, 1], [5.0])
    >>> episode.reset(), episode.step(0)
    ((0, {}), (1, 5.0, True, False, {}))
    """

    states: Sequence[int]
    rewards: Sequence[float]
    terminated: bool = True
    at: int = field(default=0, init=False)

    def reset(self) -> tuple[int, dict[str, Any]]:
        """Go to the first state."""
        self.at = 0
        return self.states[0], {}

    def step(self, action: int) -> tuple[int, float, bool, bool, dict[str, Any]]:
        """Go to the next state, whatever the action is."""
        reward, self.at = self.rewards[self.at], self.at + 1
        last = self.at == len(self.rewards)
        ends, cut = last and self.terminated, last and not self.terminated
        return self.states[self.at], reward, ends, cut, {}


@dataclass
class Numbers:
    """A source of random numbers that gives these, one after the other.

    Examples
    --------
    >>> numbers = Numbers([0.5, 0.1])
    >>> numbers.random(), numbers.random()
    (0.5, 0.1)
    """

    values: Sequence[float]
    at: int = field(default=0, init=False)

    def random(self) -> float:
        """Return the next number."""
        self.at += 1
        return self.values[self.at - 1]
