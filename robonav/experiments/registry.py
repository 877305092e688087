"""All experiments by name. Each module of the list below has a tuple ``EXPERIMENTS``."""

from __future__ import annotations

import importlib

from .runner.experiment import Experiment

MODULES = (
    "baselines",
    "reflex",
    "chapter2",
    "chapter3.tables",
    "chapter4.tables",
    "chapter4.ablations",
    "chapter4.tuning",
    "chapter5.tables",
    "chapter5.ablations",
    "chapter5.inputs",
    "chapter5.transfer",
    "chapter5.tuning",
    "chapter6.planners",
    "chapter6.tuning",
    "chapter6.ppo",
    "chapter6.curriculum",
    "chapter6.memory",
    "chapter6.sensing",
    "chapter6.senses_and_memory",
    "chapter6.gail",
    "chapter6.team",
    "chapter6.body",
    "single_runs",
    "leaderboard",
    "labs",
)


def names() -> list[str]:
    """Return the names of all experiments by chapter.

    Returns
    -------
    list of str
        The names that ``robonav reproduce`` takes.

    Examples
    --------
    >>> "table-4.3" in names()
    True
    """
    return list(_all())


def experiment(name: str) -> Experiment:
    """Return the experiment of this name.

    Parameters
    ----------
    name : str
        One of :func:`names`.

    Returns
    -------
    Experiment
        Its cases, seeds and settings.

    Raises
    ------
    ValueError
        If there is no such experiment. The message contains the known names.

    Examples
    --------
    >>> experiment("table-4.3").seeds
    {'quick': 2, 'thesis': 50}
    """
    known = _all()
    if name not in known:
        raise ValueError(f"name must be all or one of {', '.join(known)}, got {name!r}")
    return known[name]


def _all() -> dict[str, Experiment]:
    modules = [importlib.import_module(f"{__package__}.{name}") for name in MODULES]
    return {found.name: found for module in modules for found in module.EXPERIMENTS}
