"""The conditions of section 4.5, which all experiments of chapter 4 share.

A run is one training seed: it trains a network and drives its greedy policy through new worlds. Worlds to train in, to
tune on and to test on never meet.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from robonav.networks import NetworkPolicy
from robonav.nnql import STARTS, TARGETS, NavigationTask
from robonav.robot import NNQL_SENSORS, Encoder, Policy, Worlds, navigate, random_worlds

from ..outcome_rates import rates

EPISODES = 300
SHORTENED = {
    "quick": 0.2,
    "thesis": 1.0,
}  # of a training, in experiments that have very many
NAVIGATIONS = {"quick": 100, "thesis": 1000}
SPEED = 2.5
TEST_WORLDS = 40_000  # run k drives through the worlds of this seed + k
COLD = 0.4  # temperature of a policy that is all but greedy: it takes the second best where that is nearly as good
COLD_DQN = 0.04  # its outputs are the Q-values themselves, and lie closer together than the logits of the others
BLOCK = 30  # episodes that Fig. 4.4 and 4.6 count successes in

Numbers = Mapping[str, ArrayLike]


def course(*, target: str = "number", **changes: Any) -> NavigationTask:
    """What section 4.5 trains on, with the target's sector written in one way or another."""
    return NavigationTask(
        **({"encoder": Encoder(NNQL_SENSORS, walls=True, target=target)} | changes)
    )


def new_worlds(n: int, seed: int, obstacles: int = 10, moving: int = 0) -> Worlds:
    """Worlds to drive in, with the starts and targets of section 4.5."""
    return random_worlds(
        n, obstacles, moving, seed=seed, starts=STARTS, targets=TARGETS
    )


def driven(policy: Policy, worlds: Worlds, speed: float = SPEED) -> dict[str, float]:
    """How drives of 400 steps at most end, in per cent (Algorithm 9)."""
    return rates(navigate(policy, worlds, speed, NavigationTask().max_steps))


def judged(
    policy: Policy, worlds: Worlds, speed: float = SPEED, *, temperature: float = COLD
) -> dict[str, float]:
    """As :func:`driven`; for a network also ``success, cold``: with the policy at a low temperature."""
    numbers = driven(policy, worlds, speed)
    if isinstance(policy, NetworkPolicy):
        numbers["success, cold"] = driven(
            replace(policy, temperature=temperature), worlds, speed
        )["success"]
    return numbers


def blocks(successes: ArrayLike, size: int = BLOCK) -> np.ndarray:
    """Successes (S, E) counted in blocks of ``size`` episodes: (S, E / size); what is left over is dropped."""
    arrived = np.asarray(successes)
    seeds, episodes = arrived.shape
    counts: np.ndarray = (
        arrived[:, : episodes // size * size].reshape(seeds, -1, size).sum(axis=2)
    )
    return counts
