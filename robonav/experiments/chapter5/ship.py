"""The networks of chapter 5 that ship with the package; ``python -m robonav.experiments.chapter5.ship`` makes them.

Of each method a few robots learn as for Table 5.2, and the one that drives best in worlds kept for tuning is shipped,
with the reward it learned for.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from robonav.networks import NetworkPolicy, Weights, save_weights
from robonav.nirl import Learned
from robonav.progress import Progress, bar
from robonav.robot import random_worlds

from .setup import (
    DEMONSTRATIONS,
    ITERATIONS,
    NAVIGATIONS,
    OBSTACLES,
    SPEED,
    driven,
    learned,
)
from .tables import LEARNERS, settings
from .tuning import TUNING_SEEDS, TUNING_WORLDS

SHIPPED = Path(__file__).parents[2] / "nirl" / "shipped"
SEEDS = tuple(range(TUNING_SEEDS + 10, TUNING_SEEDS + 14))
COLD = 0.05  # temperature: a robot without a memory can go round in circles, and a little chance ends that


def best_of(
    method: str,
    seeds: tuple[int, ...] = SEEDS,
    *,
    length: float = 1.0,
    discount: float = 0.9,
) -> Weights:
    """Learn once a seed; the policy that arrives most often in tuning worlds, and what made it."""
    worlds = random_worlds(
        NAVIGATIONS["thesis"], OBSTACLES, seed=TUNING_WORLDS + len(SEEDS)
    )
    chosen = settings(method, discount)
    rates: dict[float, tuple[int, Learned, NetworkPolicy]] = {}
    for seed in seeds:
        found = learned(method, seed, chosen, length=length)
        policy = replace(found.policy, temperature=COLD)
        rates.setdefault(
            driven(policy, worlds)["success"], (seed, found, policy)
        )  # of equals, the first
    best = max(rates)
    seed, found, policy = rates[best]
    made = {
        "command": "python -m robonav.experiments.chapter5.ship",
        "seed": seed,
        "seeds": list(seeds),
        "demonstrations": DEMONSTRATIONS,
        "iterations": round(ITERATIONS * length),
        "speed": SPEED,
        "obstacles": OBSTACLES,
        "settings": chosen,
        "success in tuning worlds (%)": best,
        "reward weights": found.reward_weights.tolist(),
    }
    return Weights(policy.network, method, policy.encoder, made, policy.temperature)


def ship(folder: Path = SHIPPED, *, progress: Progress | None = None) -> None:
    """Write a file for every method of chapter 5: ``nirl.safetensors``, ``relative-entropy.safetensors`` and so on."""
    folder.mkdir(exist_ok=True)
    for done, method in enumerate(LEARNERS):
        if progress is not None:
            progress(done, len(LEARNERS))
        save_weights(
            folder / f"{method.replace('_', '-')}.safetensors", best_of(method)
        )


if __name__ == "__main__":
    with bar("chapter 5's networks") as shown:
        ship(progress=shown)
