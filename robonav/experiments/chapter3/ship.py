"""Chapter 3's networks that ship with the package: ``python -m robonav.experiments.chapter3.ship`` makes them again."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path

from robonav.networks import NetworkPolicy, Weights, save_weights

from .setup import DEMONSTRATIONS, MORE_WORLDS, ROUNDS, SHOWN_WORLDS, aggregated, cloned

FOLDER = Path(str(files("robonav.lfd"))) / "shipped"
SEED, OBSTACLES = 0, 10


def shipped() -> dict[str, Weights]:
    """``lfd``, cloned from 25 demonstrations, and ``dagger``, after three rounds of as many maps more."""
    made = {
        "seed": SEED,
        "demonstrations": DEMONSTRATIONS,
        "obstacles": OBSTACLES,
        "speed": 2.0,
        "seed of the worlds": SHOWN_WORLDS + SEED,
    }
    rounds = {
        "rounds": ROUNDS,
        "seed of the worlds of round 1": MORE_WORLDS + 10 * SEED,
    }
    return {
        "lfd": _weights("lfd", cloned(SEED, OBSTACLES), made),
        "dagger": _weights("dagger", aggregated(SEED, OBSTACLES).policy, made | rounds),
    }


def _weights(method: str, policy: NetworkPolicy, made: Mapping[str, float]) -> Weights:
    return Weights(policy.network, method, policy.encoder, made, policy.temperature)


def main() -> None:
    """Write them where the package looks for them."""
    FOLDER.mkdir(exist_ok=True)
    for name, weights in shipped().items():
        save_weights(FOLDER / f"{name}.safetensors", weights)
        print(FOLDER / f"{name}.safetensors")


if __name__ == "__main__":
    main()
