"""The leaderboard as an experiment. A run is one method in one set of worlds of one setting."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from robonav.benchmark import (
    SETTINGS,
    VERSION,
    evaluate_on_board,
    fingerprint,
    leaderboard,
    methods,
)

from .runner.experiment import Case, Experiment, Numbers, Plot

WORLDS = {"quick": 20, "thesis": leaderboard.WORLDS}


def evaluate_entry(
    case: Case, seed: int, scale: str, *, sources: Mapping[str, str]
) -> Numbers:
    """Evaluate a method in one set of worlds of a setting. ``sources`` has the full path of each method in a file."""
    name = str(case["method"])
    return evaluate_on_board(
        sources.get(name, name), str(case["setting"]), seed, WORLDS[scale]
    )


def board(names: Sequence[str]) -> Experiment:
    """Return the experiment of some methods: those of the package, or the reader's own files."""
    sources = {name: str(Path(name).resolve()) for name in names if Path(name).suffix}
    return Experiment(
        name="leaderboard",
        title="Outcomes and SPL of the registered methods in the same unseen worlds",
        cases=[
            {"method": name, "setting": setting}
            for name in names
            for setting in SETTINGS
        ],
        run=partial(evaluate_entry, sources=sources),
        seeds={"quick": 1, "thesis": leaderboard.SETS},
        settings={
            "version of the worlds": VERSION,
            "worlds a set": WORLDS,
            "a run": "a set of worlds; each method is one policy, as it ships",
            "settings": {name: vars(setting) for name, setting in SETTINGS.items()},
            "methods": {name: fingerprint(name) for name in names},
        },
        plot=Plot("experiments.draw_board", metric="success"),
    )


EXPERIMENTS = (board(methods()),)
