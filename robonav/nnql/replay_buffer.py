"""Experience replay: the transitions that an agent has made, kept to be learned from again."""

from __future__ import annotations

from typing import NamedTuple, SupportsFloat

import numpy as np
import torch
from numpy.typing import NDArray


class Transitions(NamedTuple):
    """m transitions as tensors; the first axis runs over the transitions.

    Attributes
    ----------
    states, next_states : (m, n) tensors
        What the network reads before and after a step.
    actions : (m,) tensor of int
        Actions taken.
    rewards : (m,) tensor
        Rewards received.
    terminal : (m,) tensor of bool
        Whether the episode ended with this step, so that nothing followed.
    """

    states: torch.Tensor
    actions: torch.Tensor
    rewards: torch.Tensor
    next_states: torch.Tensor
    terminal: torch.Tensor


class ReplayBuffer:
    """All transitions made so far.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nnql import ReplayBuffer
    >>> buffer = ReplayBuffer()
    >>> for k in range(5):
    ...     buffer.append(np.array([k, 0.0]), k % 2, 1.0, np.array([k + 1, 0.0]), k == 4)
    >>> buffer.sample(3, np.random.default_rng(0)).states[:, 0].tolist()
    [4.0, 3.0, 2.0]
    >>> len(buffer), buffer.all().terminal.tolist()
    (5, [False, False, False, False, True])
    """

    def __init__(self) -> None:
        self._transitions: list[tuple] = []

    def __len__(self) -> int:
        return len(self._transitions)

    def append(
        self,
        state: NDArray[np.float64],
        action: int | NDArray[np.int64],
        reward: SupportsFloat,
        next_state: NDArray[np.float64],
        terminal: bool,
    ) -> None:
        """Keep one transition."""
        before, after = np.asarray(state, float), np.asarray(next_state, float)
        self._transitions.append((before, action, float(reward), after, terminal))

    def all(self) -> Transitions:
        """Every transition, in the order in which they were made."""
        return self._at(range(len(self)))

    def sample(self, size: int, rng: np.random.Generator) -> Transitions:
        """Transitions drawn at random, with replacement."""
        return self._at(rng.integers(len(self), size=size))

    def _at(self, indices: range | NDArray[np.int64]) -> Transitions:
        columns = zip(*(self._transitions[k] for k in indices), strict=True)
        return Transitions(*(torch.as_tensor(np.array(column)) for column in columns))
