"""The conditions of section 3.6, which all experiments of chapter 3 share. They are in ``settings.toml``.

A run is one seed: 25 maps with their demonstrations, one network, and new maps in which the network is tested. The
worlds of demonstrations, of DAgger's rounds, and of tests are all different.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np

from robonav.lfd import (
    DaggerResult,
    Demonstrations,
    dagger,
    demonstrate,
    labelled_states,
    learn_policy,
)
from robonav.networks import Network, NetworkPolicy, TrainingHistory, fit
from robonav.robot import Encoder, Reflex, random_worlds

from ..runner.settings import read_settings
from ..runner.setup import Setup

CONDITIONS = read_settings(Path(__file__).parent / "settings.toml")
SETUP = Setup(**CONDITIONS["test"])
DEMONSTRATIONS: int = CONDITIONS["demonstrations"]
ROUNDS: int = CONDITIONS["rounds"]
SEEDS: dict[str, int] = CONDITIONS["seeds"]
DEMONSTRATION_SEED: int = CONDITIONS["demonstration_seed"]
DAGGER_SEED: int = CONDITIONS["dagger_seed"]
EXPERTS: Mapping[str, Mapping[str, float]] = CONDITIONS["experts"]
INPUTS = {"0 to 7": np.array([7.0] * 9 + [9, 1]), "0 to 1": np.ones(11)}
"""What the encoder's numbers are multiplied by to give the 11 numbers of Eq. (3.17), or numbers of at most 1."""

ABOUT = {
    "demonstrations": DEMONSTRATIONS,
    "navigations a run": SETUP.navigations,
    "speed in m/s": SETUP.speed,
    "experts": EXPERTS,
    "first seeds of the worlds": {
        "demonstrations": DEMONSTRATION_SEED,
        "DAgger's rounds": DAGGER_SEED,
        "tests": SETUP.test_seed,
    },
}


@lru_cache(64)
def demonstrations(
    seed: int,
    obstacles: int = 10,
    *,
    number: int = DEMONSTRATIONS,
    expert: str = "keeps clear",
    reflex: Reflex = SETUP.reflex,
) -> Demonstrations:
    """The computer expert's demonstrations of a run. A larger number begins with the same ones.

    Parameters
    ----------
    seed : int
        The run.
    obstacles : int
        In each map.
    number : int
        Of demonstrations.
    expert : str
        A key of :data:`EXPERTS`.
    reflex : Reflex
        Of the robot that the expert steers.
    """
    worlds = random_worlds(number, obstacles, seed=DEMONSTRATION_SEED + seed)
    keeps = EXPERTS[expert]
    return demonstrate(
        worlds, margin=keeps["margin"], caution=keeps["caution"], reflex=reflex
    )


@lru_cache(32)
def expert_in_test_worlds(seed: int, scale: str, obstacles: int) -> Demonstrations:
    """Return the computer expert's episodes in the worlds in which a run is tested."""
    worlds = SETUP.test_worlds(seed, scale, obstacles)
    return demonstrate(worlds, reflex=SETUP.reflex)


@lru_cache(64)
def cloned_policy(
    seed: int,
    obstacles: int = 10,
    *,
    target: str = "sine-cosine",
    reflex: Reflex = SETUP.reflex,
) -> NetworkPolicy:
    """Return the policy learned from a run's demonstrations (Algorithm 3)."""
    taught = demonstrations(seed, obstacles, reflex=reflex)
    return learn_policy(taught, seed=seed, encoder=Encoder(target=target))


@lru_cache(64)
def training(
    seed: int,
    expert: str,
    inputs: str,
    *,
    number: int = DEMONSTRATIONS,
    iterations: int = CONDITIONS["iterations"],
) -> TrainingHistory:
    """A training on the thesis's 11 numbers, with the network of every iteration.

    Parameters
    ----------
    seed : int
        The run.
    expert : str
        A key of :data:`EXPERTS`.
    inputs : str
        "0 to 7" for the numbers of Eq. (3.17), "0 to 1" for each divided by its maximum.
    number : int
        Of demonstrations.
    iterations : int
        Of the training.
    """
    x, y = labelled_states(
        demonstrations(seed, number=number, expert=expert), Encoder(target="number")
    )
    return fit(x * INPUTS[inputs], y, iterations=iterations, seed=seed, record=True)


def policy_of(network: Network, inputs: str) -> NetworkPolicy:
    """Return the policy of a network trained on scaled inputs. The encoder gives 0 to 1; the weights have the scale."""
    first, *others = network.weights
    return NetworkPolicy(
        Network((first * INPUTS[inputs], *others), network.biases),
        Encoder(target="number"),
    )


@lru_cache(32)
def dagger_result(
    seed: int,
    obstacles: int = 10,
    *,
    target: str = "sine-cosine",
    rounds: int = ROUNDS,
    max_steps: int = SETUP.max_steps,
    reflex: Reflex = SETUP.reflex,
) -> DaggerResult:
    """Run DAgger from a run's demonstrations. Each round has as many new maps as there are demonstrations."""
    worlds = [
        random_worlds(DEMONSTRATIONS, obstacles, seed=DAGGER_SEED + 10 * seed + number)
        for number in range(rounds)
    ]
    return dagger(
        demonstrations(seed, obstacles, reflex=reflex),
        worlds,
        # the committed results have one seed for all
        seed=np.full((rounds + 1, 2), seed),
        encoder=Encoder(target=target),
        max_steps=max_steps,
        reflex=reflex,
    )
