"""Methods that can be driven by name: two rules, the networks that ship with the package, and a reader's own."""

from __future__ import annotations

import hashlib
import importlib.util
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

from robonav.networks import NetworkPolicy, load_weights
from robonav.robot import (
    OUTCOMES,
    Policy,
    navigate,
    random_worlds,
    straight,
    turn_to_clearer_side,
)

RULES: dict[str, Policy] = {"straight": straight, "freer-side": turn_to_clearer_side}
CHAPTERS = ("lfd", "nnql", "nirl")


def methods() -> list[str]:
    """The names of all methods: rules first, then shipped networks, chapter by chapter."""
    return [*RULES, *_shipped()]


def method(name: str) -> Policy:
    """The policy of this name; or of a file: weights (.safetensors), or Python (.py) that defines ``policy``.

    Raises
    ------
    ValueError : if there is no such method or file, or the file has no policy.
    """
    if name in RULES:
        return RULES[name]
    path = _shipped().get(name, Path(name))
    if path.suffix not in (".safetensors", ".py") or not path.is_file():
        known = ", ".join(methods())
        raise ValueError(
            f"method must be one of {known}, or a file that ends in .safetensors or .py, got {name!r}"
        )
    return _from_code(path) if path.suffix == ".py" else _from_weights(path)


def fingerprint(name: str) -> str:
    """SHA-256 of the file a method is in, "" for a rule: results hang on it."""
    method(name)
    return (
        ""
        if name in RULES
        else hashlib.sha256(_shipped().get(name, Path(name)).read_bytes()).hexdigest()
    )


def drive(
    name: str, *, obstacles: int, moving: int, speed: float, worlds: int, seed: int
) -> dict[str, Any]:
    """How a method does in new worlds: success rate, its Wilson interval, and how many drives ended how."""
    from scipy.stats import binomtest

    policy = method(name)
    drives = navigate(
        policy, random_worlds(worlds, obstacles, moving, seed=seed), speed
    )
    interval = binomtest(int(drives.success.sum()), worlds).proportion_ci(
        method="wilson"
    )
    settings = {
        "obstacles": obstacles,
        "moving": moving,
        "speed": speed,
        "worlds": worlds,
        "seed": seed,
    }
    return {
        "method": name,
        **settings,
        "success": float(drives.success.mean()),
        "collision": float(drives.collision.mean()),
        "interval": [float(interval.low), float(interval.high)],
        "outcomes": {
            ended: int((drives.outcome == ended).sum())
            for ended in OUTCOMES[1:].tolist()
        },
        "mean_steps_of_arrivals": float(drives.steps[drives.success].mean())
        if drives.success.any()
        else None,
    }


def _shipped() -> dict[str, Path]:
    found: dict[str, Path] = {}
    for chapter in CHAPTERS:
        folder = Path(str(files(f"robonav.{chapter}"))) / "shipped"
        found |= {path.stem: path for path in sorted(folder.glob("*.safetensors"))}
    return found


def _from_weights(path: Path) -> NetworkPolicy:
    weights = load_weights(path)
    return NetworkPolicy(weights.network, weights.encoder, weights.temperature)


def _from_code(path: Path) -> Policy:
    """What a reader's file calls ``policy``; the file is run, so it must be one's own."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None:
        raise ValueError(f"method must be a Python file, got {path}")
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        raise ValueError(
            f"{path.name} does not run: {type(error).__name__}: {error}"
        ) from None
    policy: Callable | None = getattr(module, "policy", None)
    if not callable(policy):
        raise ValueError(f"{path.name} must define policy(sensing, rng), and does not")
    return policy
