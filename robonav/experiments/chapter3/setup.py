"""The conditions of section 3.6, which all experiments of chapter 3 share.

A run is one seed: 25 maps with their demonstrations, one network, and new maps to drive through. Worlds that are shown,
those of DAgger's rounds, those driven and those that anything was tuned on never meet.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from robonav.lfd import (
    Aggregation,
    Demonstrations,
    dagger,
    demonstrate,
    labelled_states,
    learn_policy,
)
from robonav.lfd.computer_expert import CAUTION, MARGIN
from robonav.networks import Network, NetworkPolicy, Training, fit
from robonav.robot import (
    COLLISION_DISTANCE,
    Encoder,
    Policy,
    Worlds,
    navigate,
    random_worlds,
)

from ..outcome_rates import rates

DEMONSTRATIONS = 25
ROUNDS = 3  # of DAgger
NAVIGATIONS = {"quick": 100, "thesis": 400}
SEEDS = {"quick": 1, "thesis": 25}
SHOWN_WORLDS = 30_000  # run k is shown the worlds of this seed + k
MORE_WORLDS = 31_000  # and meets those of this one + 10 k in DAgger's first round, + 10 k + 1 in the next
TEST_WORLDS = 35_000  # and drives through those of this one + k

EXPERTS = {
    "keeps off": {"margin": MARGIN, "caution": CAUTION},
    "shortest way": {"margin": COLLISION_DISTANCE, "caution": 0.0},
}
INPUTS = {"0 to 7": np.array([7.0] * 9 + [9, 1]), "0 to 1": np.ones(11)}
"""The 11 numbers of Eq. (3.17), by what the encoder gives."""

Numbers = dict[str, ArrayLike]

ABOUT = {
    "demonstrations": DEMONSTRATIONS,
    "drives a run": NAVIGATIONS,
    "speed in m/s": 2.0,
    "experts": EXPERTS,
    "first seeds of the worlds": {
        "shown": SHOWN_WORLDS,
        "of DAgger's rounds": MORE_WORLDS,
        "driven": TEST_WORLDS,
    },
}


@lru_cache(64)
def shown(
    seed: int,
    obstacles: int = 10,
    *,
    drives: int = DEMONSTRATIONS,
    expert: str = "keeps off",
) -> Demonstrations:
    """The computer expert's demonstrations of a run; more of them begin with the same ones.

    Parameters
    ----------
    expert : "keeps off" is the package's, "shortest way" is Algorithm 4 to the letter: no collision, and no more.
    """
    keeps = EXPERTS[expert]
    worlds = random_worlds(drives, obstacles, seed=SHOWN_WORLDS + seed)
    return demonstrate(worlds, margin=keeps["margin"], caution=keeps["caution"])


def new_worlds(seed: int, scale: str, obstacles: int = 10, moving: int = 0) -> Worlds:
    """The worlds that a run drives through."""
    return random_worlds(NAVIGATIONS[scale], obstacles, moving, seed=TEST_WORLDS + seed)


@lru_cache(32)
def expert_in_new_worlds(seed: int, scale: str, obstacles: int) -> Demonstrations:
    """The computer expert's drives through the worlds that a run drives through."""
    return demonstrate(new_worlds(seed, scale, obstacles))


def driven(policy: Policy, worlds: Worlds) -> Numbers:
    """How drives of 500 steps at most end, in per cent."""
    return dict(rates(navigate(policy, worlds)))


@lru_cache(64)
def cloned(
    seed: int, obstacles: int = 10, *, target: str = "sine-cosine"
) -> NetworkPolicy:
    """A network that has learned from the demonstrations of a run (Algorithm 3)."""
    return learn_policy(
        shown(seed, obstacles), seed=seed, encoder=Encoder(target=target)
    )


@lru_cache(64)
def trained(
    seed: int,
    expert: str,
    degrees: str,
    *,
    drives: int = DEMONSTRATIONS,
    iterations: int = 300,
) -> Training:
    """A training on the thesis's 11 numbers, with the network of every iteration.

    Parameters
    ----------
    expert : see :func:`shown`.
    degrees : "0 to 7" as they are, or "0 to 1", all numbers divided by the largest that they can be.
    """
    x, y = labelled_states(
        shown(seed, drives=drives, expert=expert), Encoder(target="number")
    )
    return fit(x * INPUTS[degrees], y, iterations=iterations, seed=seed, record=True)


def unscaled(network: Network, degrees: str) -> NetworkPolicy:
    """The policy of a network trained on such degrees: as the encoder gives 0 to 1, the weights make up for it."""
    first, *others = network.weights
    return NetworkPolicy(
        Network((first * INPUTS[degrees], *others), network.biases),
        Encoder(target="number"),
    )


@lru_cache(32)
def aggregated(
    seed: int, obstacles: int = 10, *, target: str = "sine-cosine", rounds: int = ROUNDS
) -> Aggregation:
    """The same, and then DAgger's rounds, with as many new maps in each as there were demonstrations."""
    worlds = [
        random_worlds(DEMONSTRATIONS, obstacles, seed=MORE_WORLDS + 10 * seed + number)
        for number in range(rounds)
    ]
    return dagger(
        shown(seed, obstacles), worlds, seed=seed, encoder=Encoder(target=target)
    )
