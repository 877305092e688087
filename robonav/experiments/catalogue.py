"""All experiments by name. A module listed here has a tuple ``EXPERIMENTS``."""

from __future__ import annotations

import importlib

from .experiment import Experiment

MODULES = (
    "yardsticks",
    "lfd",
    "nnql",
    "nnql_circles",
    "nnql_tuning",
    "nirl",
    "nirl_steps",
    "nirl_transfer",
    "nirl_tuning",
    "pictures",
    "leaderboard",
    "labs",
)


def names() -> list[str]:
    """The names of all experiments, in the order of the chapters."""
    return list(_all())


def experiment(name: str) -> Experiment:
    """The experiment of this name.

    Raises
    ------
    ValueError : if there is none, naming those there are.
    """
    known = _all()
    if name not in known:
        raise ValueError(f"name must be all or one of {', '.join(known)}, got {name!r}")
    return known[name]


def _all() -> dict[str, Experiment]:
    modules = [importlib.import_module(f"{__package__}.{module}") for module in MODULES]
    return {found.name: found for module in modules for found in module.EXPERIMENTS}
