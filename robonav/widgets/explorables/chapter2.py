"""The numbers of chapter 2's explorables."""

from __future__ import annotations

from typing import Any

import numpy as np

from robonav import mdp

from .registry import asks


@asks(
    "How far ahead does a discount look?",
    "The near charger gives 4 after 2 steps, the far one 10 after 8 steps. "
    "From which discount on is the far one worth the walk?",
    guesses=["from 0.4", "from 0.6", "from 0.86", "from 0.99"],
)
def discounted_return(
    soon: float = 4.0, soon_steps: int = 2, late: float = 10.0, late_steps: int = 8
) -> dict[str, Any]:
    """Two ways with one reward each at their end, and the discount at which both returns are equal."""
    near, far = np.zeros(soon_steps), np.zeros(late_steps)
    near[-1], far[-1] = soon, late
    equal = (soon / late) ** (1 / (late_steps - soon_steps))
    returns = [float(mdp.discounted_return(way, equal)[0]) for way in (near, far)]
    return {
        "near": near.tolist(),
        "far": far.tolist(),
        "equal": equal,
        "worth": returns[0],
    }
