"""Gradient ascent by Adam: a step for the parameters of some networks."""

from __future__ import annotations

import torch


def adam(step: float, *modules: torch.nn.Module) -> torch.optim.Optimizer:
    """Return Adam for the parameters of some networks."""
    parameters = [part for module in modules for part in module.parameters()]
    return torch.optim.Adam(parameters, lr=step)


def ascend(optimiser: torch.optim.Optimizer, gain: torch.Tensor) -> None:
    """Make one step of gradient ascent. The sum is over seeds, which share no parameter."""
    optimiser.zero_grad()
    (-gain.sum()).backward()
    optimiser.step()
