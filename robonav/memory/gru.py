"""A gated recurrent unit, GRU (Cho et al. 2014).

A recurrent network reads one input x after the other, and keeps a state h, which it computes from its last state and
the new input. A GRU has two gates, numbers between 0 and 1 for each unit. The reset gate r says how much of the last
state the new one may use. The update gate z says how much of the last state stays::

    r = sigma(W_r x + U_r h + b_r)
    z = sigma(W_z x + U_z h + b_z)
    h~ = tanh(W x + U (r * h) + b)
    h' = z * h + (1 - z) * h~

The products with r and z are elementwise. Where z is 1, the unit keeps its number for as long as z stays 1; and as its
new state is then a copy of the last one, gradients pass through many steps without vanishing. The paper has no biases
b. :class:`torch.nn.GRU` multiplies r with U h instead of h, which is faster on a graphics card.
"""

from __future__ import annotations

import torch


class GRU(torch.nn.Module):
    """A layer of gated recurrent units (Cho et al. 2014).

    Parameters
    ----------
    inputs : int
        Numbers of an input x.
    units : int
        Numbers of a state h.
    seed : int
        Seed of the weights, which are uniform in +-1 / sqrt(units). Biases begin at 0.

    Examples
    --------
    >>> import torch
    >>> from robonav.memory import GRU
    >>> gru = GRU(3, 4, seed=0)
    >>> xs, h = torch.ones(5, 2, 3).double(), torch.zeros(2, 4).double()
    >>> gru(xs, h).shape  # the states after each of 5 steps, of 2 sequences
    torch.Size([5, 2, 4])
    """

    def __init__(self, inputs: int, units: int, *, seed: int) -> None:
        super().__init__()
        draw, most = torch.Generator().manual_seed(seed), units**-0.5

        def uniform(*shape: int) -> torch.nn.Parameter:
            numbers = torch.rand(shape, generator=draw, dtype=torch.float64)
            return torch.nn.Parameter(most * (2 * numbers - 1))

        self.W = uniform(3, inputs, units)  # of the gates r and z, and of h~
        self.U = uniform(3, units, units)
        self.b = torch.nn.Parameter(torch.zeros(3, units, dtype=torch.float64))

    def step(self, x: torch.Tensor, h: torch.Tensor) -> torch.Tensor:
        """Read one input of each of N sequences.

        Parameters
        ----------
        x : (N, inputs) tensor
            The inputs.
        h : (N, units) tensor
            The states before.

        Returns
        -------
        (N, units) tensor
            The states after it.

        Examples
        --------
        >>> import torch
        >>> from robonav.memory import GRU
        >>> x, h = torch.ones(2, 3, dtype=torch.float64), torch.zeros(2, 4, dtype=torch.float64)
        >>> GRU(3, 4, seed=0).step(x, h).shape
        torch.Size([2, 4])
        """
        (W_r, W_z, W), (U_r, U_z, U), (b_r, b_z, b) = self.W, self.U, self.b
        r = torch.sigmoid(x @ W_r + h @ U_r + b_r)
        z = torch.sigmoid(x @ W_z + h @ U_z + b_z)
        candidate = torch.tanh(x @ W + (r * h) @ U + b)
        return z * h + (1 - z) * candidate

    def forward(self, xs: torch.Tensor, h: torch.Tensor) -> torch.Tensor:
        """Read T inputs of each of N sequences.

        Parameters
        ----------
        xs : (T, N, inputs) tensor
            The inputs.
        h : (N, units) tensor
            The states before the first of them.

        Returns
        -------
        (T, N, units) tensor
            The states after each of them.

        Examples
        --------
        >>> import torch
        >>> from robonav.memory import GRU
        >>> gru, h = GRU(3, 4, seed=0), torch.zeros(2, 4, dtype=torch.float64)
        >>> xs = torch.ones(5, 2, 3, dtype=torch.float64)
        >>> bool((gru(xs, h)[0] == gru.step(xs[0], h)).all())
        True
        """
        states = []
        for x in xs:
            h = self.step(x, h)
            states.append(h)
        return torch.stack(states)
