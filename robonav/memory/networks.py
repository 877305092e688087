"""Networks with a memory: one sees the last k steps, the other is recurrent.

Both read the same inputs, one a step: what the robot senses now, encoded, and the action that it took before, as a 1
among zeros. Both have the same three methods. ``begin`` makes empty memories. ``step`` reads one input of each robot,
and returns logits and new memories. Calling the network does the same for whole sequences, to train it.
"""

from __future__ import annotations

import torch

from robonav.networks import random_network
from robonav.networks.torch_module import as_module

from .gru import GRU

ACTIONS = 5  # F, L30, L60, R30, R60


class WindowNetwork(torch.nn.Module):
    """A network with one hidden layer that sees the last k states and the k - 1 actions between them.

    With k = 1 it is the network of a policy that remembers nothing.

    Parameters
    ----------
    encoded : int
        Numbers of an encoded state.
    k : int
        Length of the window.
    hidden : int
        Number of hidden units.
    seed : int
        Seed of the weights.

    Examples
    --------
    >>> import torch
    >>> from robonav.memory import WindowNetwork
    >>> network = WindowNetwork(12, k=3, hidden=16, seed=0)
    >>> xs = torch.rand(9, 2, 12 + 5, dtype=torch.float64)
    >>> logits = network(xs)
    >>> changed = torch.cat([torch.zeros(6, 2, 17, dtype=torch.float64), xs[6:]])
    >>> bool((network(changed)[-1] == logits[-1]).all())  # it sees no more than the last three
    True
    """

    def __init__(self, encoded: int, *, k: int, hidden: int, seed: int) -> None:
        super().__init__()
        self.k, self.inputs = k, encoded + ACTIONS
        self.seen = k * self.inputs - ACTIONS  # the oldest action is left out
        self.layers = as_module(random_network((self.seen, hidden, ACTIONS), seed=seed))

    def begin(self, n: int) -> torch.Tensor:
        """Return empty windows.

        Parameters
        ----------
        n : int
            Number of robots.

        Returns
        -------
        (n, k, D) tensor
            Their memories.

        Examples
        --------
        >>> from robonav.memory import WindowNetwork
        >>> WindowNetwork(12, k=3, hidden=4, seed=0).begin(2).shape
        torch.Size([2, 3, 17])
        """
        return torch.zeros(n, self.k, self.inputs, dtype=torch.float64)

    def step(
        self, memory: torch.Tensor, x: torch.Tensor
    ) -> tuple[torch.Tensor, torch.Tensor]:
        """Put the new input into the window, and leave out the oldest one.

        Parameters
        ----------
        memory : (N, k, D) tensor
            The memories of N robots.
        x : (N, D) tensor
            Their inputs: encoded states, and what the robots did before.

        Returns
        -------
        logits : (N, 5) tensor
        memory : (N, k, D) tensor
            The memories afterwards.

        Examples
        --------
        >>> import torch
        >>> from robonav.memory import WindowNetwork
        >>> network = WindowNetwork(12, k=3, hidden=4, seed=0)
        >>> logits, memory = network.step(network.begin(2), torch.ones(2, 17).double())
        >>> logits.shape, memory.shape
        (torch.Size([2, 5]), torch.Size([2, 3, 17]))
        """
        memory = torch.cat([x[:, None], memory[:, :-1]], dim=1)
        return self.layers(memory.flatten(1)[:, : self.seen]), memory

    def forward(self, xs: torch.Tensor) -> torch.Tensor:
        """Read whole sequences, to train the network.

        Parameters
        ----------
        xs : (T, N, D) tensor
            T inputs of each of N robots, whose memories are empty before.

        Returns
        -------
        (T, N, 5) tensor
            The logits of all steps.

        Examples
        --------
        >>> import torch
        >>> from robonav.memory import WindowNetwork
        >>> WindowNetwork(12, k=3, hidden=4, seed=0)(torch.ones(9, 2, 17).double()).shape
        torch.Size([9, 2, 5])
        """
        before = self.begin(xs.shape[1]).transpose(0, 1)
        padded, steps = torch.cat([before, xs]), len(xs)
        shifted = [padded[self.k - j : self.k - j + steps] for j in range(self.k)]
        return self.layers(torch.cat(shifted, dim=-1)[..., : self.seen])


class RecurrentNetwork(torch.nn.Module):
    """A layer of gated recurrent units, and a linear layer that reads the logits from their states.

    Parameters
    ----------
    encoded : int
        Numbers of an encoded state.
    units : int
        Number of recurrent units.
    seed : int
        Seed of the weights.

    Examples
    --------
    >>> import torch
    >>> from robonav.memory import RecurrentNetwork
    >>> network = RecurrentNetwork(12, units=8, seed=0)
    >>> network(torch.rand(9, 2, 12 + 5, dtype=torch.float64)).shape
    torch.Size([9, 2, 5])
    """

    def __init__(self, encoded: int, *, units: int, seed: int) -> None:
        super().__init__()
        self.units = units
        self.gru = GRU(encoded + ACTIONS, units, seed=seed)
        self.readout = as_module(random_network((units, ACTIONS), seed=seed))

    def begin(self, n: int) -> torch.Tensor:
        """Return the first states, which are 0.

        Parameters
        ----------
        n : int
            Number of robots.

        Returns
        -------
        (n, units) tensor
            Their memories.

        Examples
        --------
        >>> from robonav.memory import RecurrentNetwork
        >>> RecurrentNetwork(12, units=8, seed=0).begin(2).shape
        torch.Size([2, 8])
        """
        return torch.zeros(n, self.units, dtype=torch.float64)

    def step(
        self, memory: torch.Tensor, x: torch.Tensor
    ) -> tuple[torch.Tensor, torch.Tensor]:
        """Read one input of each robot.

        Parameters
        ----------
        memory : (N, units) tensor
            The memories of N robots.
        x : (N, D) tensor
            Their inputs: encoded states, and what the robots did before.

        Returns
        -------
        logits : (N, 5) tensor
        memory : (N, units) tensor
            The memories afterwards.

        Examples
        --------
        >>> import torch
        >>> from robonav.memory import RecurrentNetwork
        >>> network = RecurrentNetwork(12, units=8, seed=0)
        >>> logits, memory = network.step(network.begin(2), torch.ones(2, 17).double())
        >>> logits.shape, memory.shape
        (torch.Size([2, 5]), torch.Size([2, 8]))
        """
        memory = self.gru.step(x, memory)
        return self.readout(memory), memory

    def forward(self, xs: torch.Tensor) -> torch.Tensor:
        """Read whole sequences, to train the network.

        Parameters
        ----------
        xs : (T, N, D) tensor
            T inputs of each of N robots, whose memories are empty before.

        Returns
        -------
        (T, N, 5) tensor
            The logits of all steps.

        Examples
        --------
        >>> import torch
        >>> from robonav.memory import RecurrentNetwork
        >>> RecurrentNetwork(12, units=8, seed=0)(torch.ones(9, 2, 17).double()).shape
        torch.Size([9, 2, 5])
        """
        return self.readout(self.gru(xs, self.begin(xs.shape[1])))


MemoryNetwork = WindowNetwork | RecurrentNetwork
"""A network with a memory."""
