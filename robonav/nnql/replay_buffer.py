"""All that S robots went through, kept."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .agents import Transitions
from .networks import Rows

_FIRST_ROOM = 1024  # steps a seed; doubled when full
_KEPT = ("inputs", "actions", "rewards", "reached", "terminal")


class ReplayBuffer:
    """Transitions of S robots, n inputs each; what lies beyond ``count`` is not there yet.

    Attributes
    ----------
    inputs, reached : (S, L, n) what the network reads before and after a step.
    actions, rewards, terminal : (S, L).
    count : (S,) steps kept.
    """

    def __init__(self, seeds: int, inputs: int) -> None:
        self.inputs = np.empty((seeds, _FIRST_ROOM, inputs))
        self.reached = np.empty((seeds, _FIRST_ROOM, inputs))
        self.actions = np.empty((seeds, _FIRST_ROOM), np.int64)
        self.rewards = np.empty((seeds, _FIRST_ROOM))
        self.terminal = np.empty((seeds, _FIRST_ROOM), np.bool_)
        self.count = np.zeros(seeds, np.int64)

    def append(self, rows: Rows, steps: Transitions) -> None:
        """Keep one step of each of ``rows``."""
        room = self.inputs.shape[1]
        if self.count[rows].max() == room:
            for name in _KEPT:
                old = getattr(self, name)
                setattr(self, name, np.concatenate([old, np.empty_like(old)], axis=1))
        at = (rows, self.count[rows])
        for name in _KEPT:
            getattr(self, name)[at] = getattr(steps, name)
        self.count[rows] += 1

    def all_of(self, row: Rows) -> tuple[NDArray, ...]:
        """Every step of one seed, ``row`` (1,): inputs, actions, rewards, reached, terminal, each (1, m, ...)."""
        kept = slice(0, int(self.count[row[0]]))
        return tuple(getattr(self, name)[row[0], kept][None] for name in _KEPT)

    def draw(self, rows: Rows, steps: NDArray[np.int64]) -> tuple[NDArray, ...]:
        """Transitions (K, m) of each of ``rows``, in the same order as :meth:`all_of`: each (K, m, ...)."""
        return tuple(getattr(self, name)[rows[:, None], steps] for name in _KEPT)

    def state(self) -> dict[str, NDArray]:
        """Copies, by name, of what is kept."""
        full = int(self.count.max())
        kept = {name: getattr(self, name)[:, :full].copy() for name in _KEPT}
        return {"count": self.count.copy()} | kept

    def restore(self, state: dict[str, NDArray]) -> None:
        """Go on from a :meth:`state`."""
        for name in (*_KEPT, "count"):
            setattr(self, name, state[name].copy())
