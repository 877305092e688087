"""What came after: the deep Q-network (Mnih et al. 2015) with the double estimator (van Hasselt et al. 2016)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from numpy.typing import NDArray

from robonav import expect

from .exploration import Span
from .fitted import torch_logits
from .learners import Learner, Steps
from .memory import Memory
from .networks import Array, Networks, Rows
from .practice import REPLAYING, Course, chance
from .training import Common, Training, school

if TYPE_CHECKING:
    import torch

_MOMENTS = (0.9, 0.999)  # Adam's, as Kingma and Ba (2015) have them


class Replaying(Learner):
    """Trains, after each step, on steps drawn from all that were ever made; its outputs are linear.

    Parameters
    ----------
    networks : of S seeds.
    seeds : (S,).
    inputs : n.
    gamma : discount.
    rate : of Adam.
    batch : steps drawn for an update.
    refresh : updates after which the target network becomes the network.
    """

    def __init__(
        self,
        networks: Networks,
        seeds: tuple[int, ...],
        inputs: int,
        *,
        gamma: float,
        rate: float,
        batch: int,
        refresh: int,
    ) -> None:
        super().__init__(networks)
        import torch

        self.seeds, self.memory = seeds, Memory(len(seeds), inputs)
        self.gamma, self.rate, self.batch, self.refresh = gamma, rate, batch, refresh
        self.target = [tensor.clone() for tensor in networks.tensors()]
        self.first, self.second = ([torch.zeros_like(tensor) for tensor in self.target] for _ in range(2))

    def values(self, rows: Rows, x: Array) -> Array:
        return self.networks.logits(rows, x)

    def observe(self, rows: Rows, steps: Steps) -> None:
        self.memory.append(rows, steps)
        ready = rows[self.memory.count[rows] >= self.batch]
        if len(ready):
            self._update(ready)
            updates = self.memory.count[ready] - self.batch + 1
            for live, target in zip(self.networks.tensors(), self.target, strict=True):
                due = ready[updates % self.refresh == 0]
                target[due] = live[due]

    def _update(self, rows: Rows) -> None:
        """One step of Adam on a batch of each of ``rows``."""
        import torch

        live = self.networks.tensors()
        leaves = [tensor[rows].requires_grad_() for tensor in live]
        x, actions, rewards, reached, terminal = self._draw(rows, live[0].device)
        with torch.no_grad():
            best = torch_logits(leaves, reached).argmax(dim=2, keepdim=True)
            frozen = torch_logits([tensor[rows] for tensor in self.target], reached)
            goal = rewards + self.gamma * frozen.gather(2, best)[..., 0] * ~terminal
        q = torch_logits(leaves, x).gather(2, actions[..., None])[..., 0]
        error = torch.nn.functional.smooth_l1_loss(q, goal, reduction="none").mean(dim=1).sum()
        slopes = torch.autograd.grad(error, leaves)
        number = torch.as_tensor(self.memory.count[rows] - self.batch + 1.0, device=live[0].device)
        for tensor, slope, first, second in zip(live, slopes, self.first, self.second, strict=True):
            tensor[rows] -= self.rate * _adam(slope, first, second, rows, number)

    def _draw(self, rows: Rows, device: torch.device) -> tuple[torch.Tensor, ...]:
        """A batch of steps of each of ``rows``: inputs, actions, rewards, inputs reached, terminal; (K, batch, ...)."""
        import torch

        memory = self.memory
        counts = [int(count) for count in memory.count[rows]]
        drawn = [
            chance(self.seeds[row], REPLAYING, count).integers(count, size=self.batch)
            for row, count in zip(rows, counts, strict=True)
        ]
        at = (rows[:, None], np.array(drawn))
        parts = (memory.inputs, memory.actions, memory.rewards, memory.reached, memory.terminal)
        return tuple(torch.as_tensor(part[at], device=device) for part in parts)

    def state(self) -> dict[str, NDArray]:
        groups = {"target": self.target, "first": self.first, "second": self.second}
        more = {f"{name}.{k}": t.cpu().numpy().copy() for name, group in groups.items() for k, t in enumerate(group)}
        return super().state() | self.memory.state() | more

    def restore(self, state: dict[str, NDArray]) -> None:
        import torch

        super().restore(state)
        self.memory.restore(state)
        for name, group in (("target", self.target), ("first", self.first), ("second", self.second)):
            for k, tensor in enumerate(group):
                tensor.copy_(torch.from_numpy(state[f"{name}.{k}"]))


def _adam(
    slope: torch.Tensor, first: torch.Tensor, second: torch.Tensor, rows: Rows, number: torch.Tensor
) -> torch.Tensor:
    """The direction of Adam (Kingma and Ba 2015, Algorithm 1) for ``rows`` at their step ``number``.

    torch.optim.Adam would move the moments of every network, also of those that do not learn just now.
    """
    (a, b), shape = _MOMENTS, (-1, *[1] * (slope.ndim - 1))
    first[rows] = a * first[rows] + (1 - a) * slope
    second[rows] = b * second[rows] + (1 - b) * slope**2
    mean = first[rows] / (1 - a**number).reshape(shape)
    spread = second[rows] / (1 - b**number).reshape(shape)
    return mean / (spread.sqrt() + 1e-8)


def dqn(
    seeds: int | Sequence[int] = 16,
    episodes: int = 300,
    *,
    gamma: float = 0.7,
    rate: float = 0.003,
    temperature: Span = (0.9, 0.1),
    batch: int = 32,
    refresh: int = 200,
    **common: Unpack[Common],
) -> Training:
    """Deep Q-learning: after each step, one update on a batch drawn from all steps ever made.

    Three things set it apart from online Q-learning: replay, a target network that stands still between refreshes,
    and the double estimator, in which the network chooses the next action and the target network values it. Outputs
    are linear, so that Q needs no rescaling; the loss is Huber's.

    Parameters
    ----------
    seeds : S, or the seeds themselves.
    episodes : E, each in a new world.
    gamma : discount.
    rate : of Adam.
    temperature : T of the Boltzmann policy, Eq. (4.7); a number, or its start and end.
    batch : steps drawn for an update.
    refresh : updates between two refreshes of the target network.
    common : see :class:`Common`.

    Raises
    ------
    ValueError, TypeError : if an argument is out of bounds.
    """
    settings: dict[str, Any] = {
        "gamma": expect.real("gamma", gamma, at_least=0, at_most=1),
        "rate": expect.positive("rate", rate),
        "batch": expect.integer("batch", batch, at_least=1),
        "refresh": expect.integer("refresh", refresh, at_least=1),
    }
    make = partial(_replaying, settings=settings)
    return school("dqn", make, seeds, episodes, temperature=temperature, settings=settings, **common)


def _replaying(networks: Networks, seeds: tuple[int, ...], course: Course, *, settings: dict[str, Any]) -> Replaying:
    return Replaying(networks, seeds, course.encoder.size, **settings)
