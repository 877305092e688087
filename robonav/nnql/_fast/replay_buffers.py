"""The replay buffers of S robots, as arrays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .networks import Array, Rows

_CAPACITY = 1024  # transitions of a seed at first; doubled when full
_FIELDS = ("inputs", "actions", "rewards", "reached", "terminal")


class ReplayBuffers:
    """Transitions of S robots with n inputs each; entries beyond ``count`` are not filled yet.

    Attributes
    ----------
    inputs, reached : (S, L, n) arrays
        What the network reads before and after a step.
    actions, rewards, terminal : (S, L) arrays
        The action, the reward, and whether the episode ended.
    count : (S,) array of int
        Transitions kept.
    """

    def __init__(self, seeds: int, inputs: int) -> None:
        self.inputs = np.empty((seeds, _CAPACITY, inputs))
        self.reached = np.empty((seeds, _CAPACITY, inputs))
        self.actions = np.empty((seeds, _CAPACITY), np.int64)
        self.rewards = np.empty((seeds, _CAPACITY))
        self.terminal = np.empty((seeds, _CAPACITY), np.bool_)
        self.count = np.zeros(seeds, np.int64)

    def append(
        self,
        rows: Rows,
        inputs: Array,
        actions: NDArray[np.int64],
        rewards: Array,
        reached: Array,
        terminal: NDArray[np.bool_],
    ) -> None:
        """Keep one transition of each of ``rows`` (K,)."""
        room = self.inputs.shape[1]
        if self.count[rows].max() == room:
            for name in _FIELDS:
                old = getattr(self, name)
                setattr(self, name, np.concatenate([old, np.empty_like(old)], axis=1))
        at = (rows, self.count[rows])
        self.inputs[at], self.actions[at], self.rewards[at] = inputs, actions, rewards
        self.reached[at], self.terminal[at] = reached, terminal
        self.count[rows] += 1

    def all_of(self, row: Rows) -> tuple[NDArray, ...]:
        """All transitions of one seed, ``row`` (1,): inputs, actions, rewards, reached, terminal, each (1, m, ...)."""
        kept = slice(0, int(self.count[row[0]]))
        return tuple(getattr(self, name)[row[0], kept][None] for name in _FIELDS)

    def at(self, rows: Rows, indices: NDArray[np.int64]) -> tuple[NDArray, ...]:
        """The transitions ``indices`` (K, m) of ``rows`` (K,), in the order of :meth:`all_of`: each (K, m, ...)."""
        return tuple(getattr(self, name)[rows[:, None], indices] for name in _FIELDS)

    def state(self) -> dict[str, NDArray]:
        """Copies, by name, of what is kept."""
        full = int(self.count.max())
        kept = {name: getattr(self, name)[:, :full].copy() for name in _FIELDS}
        return {"count": self.count.copy()} | kept

    def restore(self, state: dict[str, NDArray]) -> None:
        """Continue from a :meth:`state`."""
        for name in (*_FIELDS, "count"):
            setattr(self, name, state[name].copy())
