"""The networks of chapter 4 that ship with the package; ``python -m robonav.experiments.chapter4.ship`` makes them.

Of each method eight robots train as for Table 4.3, and the one that drives best in worlds kept for tuning is shipped.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from robonav.networks import NetworkPolicy, Weights, save_weights
from robonav.nnql import METHODS
from robonav.progress import Progress, bar

from .setup import EPISODES, NAVIGATIONS, SPEED, driven, new_worlds
from .tables import cold, settings
from .tuning import TUNING_SEEDS, TUNING_WORLDS, trained

SHIPPED = Path(__file__).parents[2] / "nnql" / "shipped"
SEEDS = tuple(range(TUNING_SEEDS, TUNING_SEEDS + 8))


def best_of(
    method: str, seeds: tuple[int, ...] = SEEDS, *, length: float = 1.0
) -> Weights:
    """Train one robot a seed; the one that arrives most often in tuning worlds, and what made it."""
    worlds = new_worlds(NAVIGATIONS["thesis"], TUNING_WORLDS + len(SEEDS))
    rates: dict[float, tuple[int, NetworkPolicy]] = {}
    for seed in seeds:
        greedy = trained(
            method, seed, "thesis", settings(method), length=length
        ).policies[0]
        policy = replace(greedy, temperature=cold(method))
        rates.setdefault(
            driven(policy, worlds)["success"], (seed, policy)
        )  # of equals, the first
    best = max(rates)
    seed, policy = rates[best]
    made = {
        "command": "python -m robonav.experiments.chapter4.ship",
        "seed": seed,
        "seeds": list(seeds),
        "episodes": round(EPISODES * length),
        "speed": SPEED,
        "obstacles": 10,
        "settings": settings(method),
        "success in tuning worlds (%)": best,
    }
    return Weights(policy.network, method, policy.encoder, made, policy.temperature)


def ship(folder: Path = SHIPPED, *, progress: Progress | None = None) -> None:
    """Write ``METHOD.safetensors`` for every method of chapter 4."""
    for done, method in enumerate(METHODS):
        if progress is not None:
            progress(done, len(METHODS))
        save_weights(folder / f"{method}.safetensors", best_of(method))


if __name__ == "__main__":
    with bar("chapter 4's networks") as shown:
        ship(progress=shown)
