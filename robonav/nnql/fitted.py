"""Neural fitted Q iteration (Riedmiller 2005): collect, then fit a network to all that was ever collected."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from numpy.typing import NDArray

from robonav import expect

from .exploration import Span
from .learners import Learner, Steps
from .memory import Memory
from .networks import Networks, Rows, torch_propagate
from .practice import Course
from .training import Common, Training, school

if TYPE_CHECKING:
    import torch


_GROW, _SHRINK, _FIRST_STEP, _SIZES = 1.2, 0.5, 0.01, (1e-6, 50.0)  # of Rprop, as its authors have them


class Fitting(Learner):
    """Keeps every step, and refits the network to all of them after every so many episodes.

    Parameters
    ----------
    networks : of S seeds.
    shape : (S, n).
    gamma : discount.
    collect : episodes between two refits.
    sweeps : targets are computed anew so often in a refit.
    epochs, tolerance : Rprop goes over all steps at most so many times, and until the mean cost settles.
    """

    def __init__(
        self,
        networks: Networks,
        shape: tuple[int, int],
        *,
        gamma: float,
        collect: int,
        sweeps: int,
        epochs: int,
        tolerance: float,
    ) -> None:
        super().__init__(networks)
        self.memory = Memory(*shape)
        self.gamma, self.collect, self.sweeps, self.epochs, self.tolerance = gamma, collect, sweeps, epochs, tolerance

    def observe(self, rows: Rows, steps: Steps) -> None:
        self.memory.append(rows, steps)

    def close(self, rows: Rows, episodes: Rows) -> None:
        for row in rows[(episodes % self.collect == 0) & (self.memory.count[rows] > 0)]:
            self._refit(int(row))

    def _refit(self, row: int) -> None:
        """Fit network ``row`` to its memory, ``sweeps`` times over."""
        import torch

        own = [tensor[row] for tensor in self.networks.tensors()]
        memory, device, kept = self.memory, own[0].device, slice(0, int(self.memory.count[row]))
        parts = (memory.inputs, memory.actions, memory.rewards, memory.reached, memory.terminal)
        x, actions, rewards, reached, terminal = (torch.as_tensor(part[row, kept], device=device) for part in parts)
        for _ in range(self.sweeps):
            following = torch_logits(own, reached).max(dim=1).values.sigmoid() * ~terminal
            targets = (rewards + self.gamma * following).clamp(0, 1)
            fit(own, x, actions, targets, epochs=self.epochs, tolerance=self.tolerance)

    def state(self) -> dict[str, NDArray]:
        return super().state() | self.memory.state()

    def restore(self, state: dict[str, NDArray]) -> None:
        super().restore(state)
        self.memory.restore(state)


def torch_logits(parameters: list[torch.Tensor], x: torch.Tensor) -> torch.Tensor:
    """Logits (..., m, A) of networks with parameters ``w1, b1, w2, b2`` for inputs (..., m, n)."""
    w1, b1, w2, b2 = parameters
    _, z = torch_propagate([w1, w2], [b1, b2], x)
    return z


def fit(
    parameters: list[torch.Tensor],
    x: torch.Tensor,
    actions: torch.Tensor,
    targets: torch.Tensor,
    *,
    epochs: int,
    tolerance: float,
) -> float:
    """Fit one network, in place, to the values of the actions taken, by Rprop (Riedmiller and Braun 1993).

    Parameters
    ----------
    parameters : ``w1`` (n, H), ``b1`` (H,), ``w2`` (H, A), ``b2`` (A,).
    x : inputs (m, n).
    actions, targets : (m,) taken, and what their values should be, in [0, 1]. Other outputs are left free.
    epochs : at most.
    tolerance : ends when the mean cross-entropy moves by less in an epoch.

    Returns
    -------
    The mean cross-entropy before the last epoch.
    """
    import torch

    leaves = [parameter.clone().requires_grad_() for parameter in parameters]
    sizes = [torch.full_like(leaf, _FIRST_STEP) for leaf in leaves]
    before = [torch.zeros_like(leaf) for leaf in leaves]
    cost = torch.nn.functional.binary_cross_entropy_with_logits
    last = now = np.inf
    for _ in range(epochs):
        error = cost(torch_logits(leaves, x).gather(1, actions[:, None])[:, 0], targets)
        slopes = torch.autograd.grad(error, leaves)
        with torch.no_grad():
            for leaf, slope, size, old in zip(leaves, slopes, sizes, before, strict=True):
                leaf -= rprop(slope, size, old)
        last, now = now, error.item()
        if abs(last - now) < tolerance:
            break
    for parameter, leaf in zip(parameters, leaves, strict=True):
        parameter.copy_(leaf.detach())
    return now


def rprop(slope: torch.Tensor, size: torch.Tensor, before: torch.Tensor) -> torch.Tensor:
    """One step of Rprop (Riedmiller and Braun 1993): only the signs of the slopes count.

    A parameter's step grows while its slope keeps its sign. Where the sign turned, a minimum was jumped over: the
    step shrinks, and the parameter waits for once.

    Parameters
    ----------
    slope : of the cost.
    size : of the last step, positive; changed in place.
    before : the slope before, 0 where the parameter waited; changed in place.

    Returns
    -------
    What to take off the parameters.
    """
    turned = slope * before
    longer, shorter = (turned > 0).to(slope), (turned < 0).to(slope)
    size.mul_(1 + (_GROW - 1) * longer + (_SHRINK - 1) * shorter).clamp_(*_SIZES)
    before.copy_(slope * (1 - shorter))
    return before.sign() * size


def nfq(
    seeds: int | Sequence[int] = 16,
    episodes: int = 300,
    *,
    gamma: float = 0.7,
    temperature: Span = (0.9, 0.1),
    collect: int = 10,
    sweeps: int = 5,
    epochs: int = 100,
    tolerance: float = 1e-5,
    **common: Unpack[Common],
) -> Training:
    """Neural fitted Q iteration: after every so many episodes, fit the network to all steps ever made.

    Targets are ``r + gamma max Q`` in [0, 1], computed anew at every sweep, and the whole batch is fitted with Rprop
    until its cost settles. Riedmiller's network takes state and action as inputs and has one output; ours has one
    output an action, as in Fig. 4.1, of which only that of the action taken is fitted.

    Parameters
    ----------
    seeds : S, or the seeds themselves.
    episodes : E, each in a new world.
    gamma : discount.
    temperature : T of the Boltzmann policy, Eq. (4.7); a number, or its start and end.
    collect : episodes between two refits.
    sweeps : how often a refit computes its targets anew.
    epochs, tolerance : Rprop goes over all steps at most so many times a sweep, and until the mean cost settles.
    common : see :class:`Common`.

    Raises
    ------
    ValueError, TypeError : if an argument is out of bounds.
    """
    settings: dict[str, Any] = {
        "gamma": expect.real("gamma", gamma, at_least=0, at_most=1),
        "collect": expect.integer("collect", collect, at_least=1),
        "sweeps": expect.integer("sweeps", sweeps, at_least=1),
        "epochs": expect.integer("epochs", epochs, at_least=1),
        "tolerance": expect.real("tolerance", tolerance, at_least=0),
    }
    make = partial(_fitting, settings=settings)
    return school("nfq", make, seeds, episodes, temperature=temperature, settings=settings, **common)


def _fitting(networks: Networks, seeds: tuple[int, ...], course: Course, *, settings: dict[str, Any]) -> Fitting:
    return Fitting(networks, (len(seeds), course.encoder.size), **settings)
