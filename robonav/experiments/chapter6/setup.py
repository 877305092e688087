"""The conditions that the experiments on planners share, and the planners with their settings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from robonav.planners import (
    Bug,
    DynamicWindow,
    KnownMap,
    PotentialField,
    VectorFieldHistogram,
)
from robonav.robot import Policy, PolicyWithMemory

from ..runner.settings import Settings, read_settings
from ..runner.setup import Setup

FOLDER = Path(__file__).parent
CONDITIONS = read_settings(FOLDER / "settings.toml")
SETUP = Setup(**CONDITIONS["tuning"])
WORLDS: Mapping[str, int] = CONDITIONS["board"]["worlds"]
WORLDS_KNOWN_MAP: Mapping[str, int] = CONDITIONS["board"]["worlds_known_map"]
HYPERPARAMETERS = FOLDER / "hyperparameters.toml"
"""The settings of the table, as :mod:`robonav.experiments.chapter6.tuning` wrote them."""

PLANNERS: dict[str, Callable[..., Policy | PolicyWithMemory]] = {
    "potential-field": PotentialField,
    "vfh": VectorFieldHistogram,
    "dynamic-window": DynamicWindow,
    "bug": Bug,
}
"""The planners that are tuned, by their name on the leaderboard."""


def tuned() -> dict[str, Settings]:
    """Return the tuned settings of each planner."""
    found = read_settings(HYPERPARAMETERS)
    return {name: Settings.of(values) for name, values in found.items()}


def planner(
    name: str, settings: Mapping[str, Any], speed: float
) -> Policy | PolicyWithMemory:
    """Return the planner of a name with its settings, for robots of a speed."""
    if name == "known-map":
        return KnownMap()
    made = PLANNERS[name](**settings)
    return replace(made, speed=speed) if isinstance(made, DynamicWindow) else made
