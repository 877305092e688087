"""All experiments by name. A module listed here has a tuple ``EXPERIMENTS``."""

from __future__ import annotations

import importlib

from .runner.experiment import Experiment

MODULES = (
    "robonav.experiments.baselines",
    "robonav.experiments.chapter3.tables",
    "robonav.experiments.chapter4.tables",
    "robonav.experiments.chapter4.ablations",
    "robonav.experiments.chapter4.tuning",
    "robonav.experiments.chapter5.tables",
    "robonav.experiments.chapter5.ablations",
    "robonav.experiments.chapter5.transfer",
    "robonav.experiments.chapter5.tuning",
    "robonav.experiments.single_runs",
    "robonav.benchmark.leaderboard",
    "robonav.experiments.labs",
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
    modules = [importlib.import_module(module) for module in MODULES]
    return {found.name: found for module in modules for found in module.EXPERIMENTS}
