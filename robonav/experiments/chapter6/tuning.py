"""The tuning of the planners: as many trials as each learner of chapter 4 had, in worlds reserved for tuning.

The first stage has sixteen trials of four runs each. The second stage runs the four best of them again in twelve other
batches of worlds, and its results decide. One command runs both stages, and then the table of the planners::

    python -m robonav.experiments.chapter6.tuning FOLDER

It writes the results to the folder, and ``finalists.toml`` and ``hyperparameters.toml`` to this one.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from ..runner.experiment import Case, Experiment, Numbers, Plot, Results
from ..runner.results import RESULTS
from ..runner.run import reproduce
from ..runner.settings import Settings, read_settings, write_hyperparameters
from .planners import table
from .setup import FOLDER, HYPERPARAMETERS, PLANNERS, SETUP, planner

TRIALS = 16
FINAL_TRIALS = 4  # trials of each planner that the second stage runs again
TUNING_SEED = 60  # of the trials' settings
SEEDS = {"quick": 1, "thesis": 4}
FINAL_SEEDS = {"quick": 1, "thesis": 12}
FINALISTS = FOLDER / "finalists.toml"

_ROOM: dict[str, list[Any]] = {
    "clearance": [1.0, 1.2, 1.5, 2.0],
    "half_width": [0.0, 0.09, 0.17, 0.35],
}
SPACE: dict[str, dict[str, list[Any]]] = {
    "potential-field": {
        "repulsion": [20.0, 40.0, 80.0, 160.0, 320.0],
        "influence": [4.0, 6.0, 8.0, 10.0],
        "inertia": [0.0, 0.5, 1.0, 2.0, 4.0],
    },
    "vfh": _ROOM
    | {
        "threshold": [0.1, 0.3, 0.5, 0.8],
        "wide": [8, 16, 24],
        "keep": [0.2, 0.5, 1.0, 2.0],
    },
    "dynamic-window": _ROOM
    | {"heading": [0.0, 0.1, 0.3, 0.5, 0.8], "distance": [0.2, 0.5, 1.0, 2.0]},
    "bug": _ROOM | {"sight": [3.0, 4.0, 5.0, 6.0, 8.0]},
}
"""The values of each setting. A trial draws each of them uniformly."""


def trial_settings(method: str, trial: int) -> Settings:
    """Return the settings of a trial."""
    rng = np.random.default_rng([TUNING_SEED, trial])
    return Settings.of(
        {
            name: values[int(rng.integers(len(values)))]
            for name, values in SPACE[method].items()
        }
    )


def tune(case: Case, seed: int, scale: str) -> Numbers:
    """Test a trial in one batch of tuning worlds."""
    settings = json.loads(str(case["settings"]))
    policy = planner(str(case["method"]), settings, SETUP.speed)
    worlds = SETUP.tuning_worlds(seed, SETUP.navigations[scale])
    return SETUP.evaluate(policy, worlds)


def tune_again(case: Case, seed: int, scale: str) -> Numbers:
    """Test a finalist in other worlds than those of the first stage."""
    return tune(case, seed + SEEDS["thesis"], scale)


def best_trials(results: Results, number: int) -> dict[str, dict[str, Settings]]:
    """Return the best trials of each method by mean success, the best first; of equal ones the earlier first."""
    cases = results.experiment.cases
    success = [results.summary("success", k).mean for k in range(len(cases))]
    ranked: dict[str, dict[str, Settings]] = {method: {} for method in PLANNERS}
    for k in sorted(range(len(cases)), key=lambda k: -round(success[k], 6)):
        found = ranked[str(cases[k]["method"])]
        if len(found) < number:
            settings = Settings.of(json.loads(str(cases[k]["settings"])))
            found[str(cases[k]["trial"])] = settings
    return ranked


def _case(method: str, trial: int, settings: Settings) -> Case:
    return {"method": method, "trial": trial, "settings": settings.as_json()}


_ABOUT = {"navigations a run": SETUP.navigations, "obstacles": SETUP.obstacles}

TUNING = Experiment(
    name="planner-tuning",
    title="Success of the trials that tuned the planners of chapter 6, equally many for each",
    cases=[
        _case(method, trial, trial_settings(method, trial))
        for method in PLANNERS
        for trial in range(TRIALS)
    ],
    run=tune,
    seeds=SEEDS,
    settings=_ABOUT,
    plot=Plot("nnql.plot_trials"),
)


def finals() -> Experiment:
    """Return the second stage, whose cases are those of ``finalists.toml``."""
    return Experiment(
        name="planner-finals",
        title="Success of the four best trials of each planner in other worlds",
        cases=[
            _case(method, int(trial), Settings.of(values))
            for method, trials in read_settings(FINALISTS).items()
            for trial, values in trials.items()
        ],
        run=tune_again,
        seeds=FINAL_SEEDS,
        settings=_ABOUT,
        plot="sixteen numbers, which a table shows better",
    )


EXPERIMENTS = (TUNING, finals())


def tune_and_test(
    folder: str | Path = RESULTS, *, scale: str = "thesis", jobs: int = -1
) -> None:
    """Run both stages and the table, and write the finalists and the tuned settings."""
    written = "Written by robonav.experiments.chapter6.tuning."
    ranked = best_trials(
        reproduce(TUNING, folder, scale=scale, jobs=jobs), FINAL_TRIALS
    )
    comment = f"The best trials of planner-tuning, the best first. {written}"
    write_hyperparameters(FINALISTS, comment, ranked)
    ranked = best_trials(reproduce(finals(), folder, scale=scale, jobs=jobs), 1)
    best = {method: {"": next(iter(found.values()))} for method, found in ranked.items()}  # fmt: skip
    comment = f"The best finalist of planner-finals. {written}"
    write_hyperparameters(HYPERPARAMETERS, comment, best)
    reproduce(table(), folder, scale=scale, jobs=jobs)


if __name__ == "__main__":
    tune_and_test(sys.argv[1])
