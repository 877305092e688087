"""The tuning of chapter 4's hyperparameters: equally many trials for each method, in worlds reserved for tuning.

The first stage has sixteen trials of four seeds each. The second stage runs the four best of them again with twelve
other seeds, and its results decide. The best of sixteen short trials is partly lucky, so its first result is too high.
Run both stages, and write ``finalists.toml`` after the first and ``hyperparameters.toml`` after the second::

    robonav reproduce nnql-tuning --scale thesis
    python -m robonav.experiments.chapter4.tuning finalists results
    robonav reproduce nnql-finals --scale thesis
    python -m robonav.experiments.chapter4.tuning hyperparameters results
"""

from __future__ import annotations

import json
import sys
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from robonav.nnql import METHODS

from ..runner.experiment import Case, Experiment, Numbers, Plot, Results
from ..runner.results import RESULTS, read_results
from ..runner.settings import Settings, read_settings, write_hyperparameters
from .setup import (
    EPISODES,
    FOLDER,
    HYPERPARAMETERS,
    SETUP,
    SHORTENED,
    THESIS,
    training,
)

TRIALS = 16
FINAL_TRIALS = 4  # trials of each method that the second stage runs again
TUNING_SEEDS = 10_000  # run k trains with this seed + k; the tables use other seeds
FINALISTS = FOLDER / "finalists.toml"

_NEURAL: dict[str, list[Any]] = {
    "learning_rate": [0.8, (0.8, 0.1), (0.4, 0.05)],
    "gradient_step": [0.3, (0.3, 0.05), 0.1],
    "passes": [1, 3],
    "rescale": ["clip", "shift"],
}
_SHARED: dict[str, list[Any]] = {
    "discount": [0.6, 0.7, 0.8, 0.9],
    "target": ["number", "one-hot", "sine-cosine"],
    "temperature": [(0.9, 0.1), (0.9, 0.05), (0.9, 0.03)],
}
_NFQ: dict[str, list[Any]] = {
    "episodes_per_fit": [5, 10, 20],
    "sweeps and epochs": [(5, 100), (10, 50), (20, 30)],
}
_DQN: dict[str, list[Any]] = {
    "gradient_step": [0.001, 0.003, 0.01],
    "target_update_interval": [100, 300, 1000],
    "batch_size": [32, 64],
}
SPACE: dict[str, dict[str, list[Any]]] = {
    "nnql": _NEURAL | _SHARED,
    "online": _NEURAL | _SHARED,
    "nfq": _NFQ | _SHARED,
    "dqn": _DQN | _SHARED,
}
"""The values of each hyperparameter. A trial draws each of them uniformly."""


def trial_settings(method: str, trial: int) -> Settings:
    """Return the hyperparameters of a trial. NNQL and online learning have the same space and get the same ones.

    Parameters
    ----------
    method : str
        The method.
    trial : int
        Its number; 0 has the thesis's hyperparameters.

    Returns
    -------
    Settings

    Examples
    --------
    >>> from robonav.experiments.chapter4.tuning import trial_settings
    >>> trial_settings("nnql", 1) == trial_settings("online", 1)
    True
    """
    if trial == 0:
        return THESIS[method]
    rng = np.random.default_rng([TUNING_SEEDS, trial])
    drawn = {
        name: choices[int(rng.integers(len(choices)))]
        for name, choices in SPACE[method].items()
    }
    if "sweeps and epochs" in drawn:
        drawn["sweeps"], drawn["epochs"] = drawn.pop("sweeps and epochs")
    return Settings.of(drawn)


def tune(case: Case, seed: int, scale: str) -> Numbers:
    """Test one seed of a trial in tuning worlds."""
    policy = training(
        str(case["method"]),
        TUNING_SEEDS + seed,
        scale,
        Settings.of(json.loads(str(case["settings"]))),
        length=SHORTENED[scale],
    ).policies[0]
    worlds = SETUP.tuning_worlds(seed, SETUP.navigations[scale] // 2)
    return SETUP.evaluate(policy, worlds)


def tune_again(case: Case, seed: int, scale: str) -> Numbers:
    """Test one seed of a finalist, with other seeds and worlds than in the first stage."""
    return tune(case, seed + TUNING.seeds["thesis"], scale)


def ranking(results: Results) -> dict[str, list[Case]]:
    """Return the trials of each method by mean success over seeds, the best first; of equal ones the earlier first.

    Parameters
    ----------
    results : Results
        Of the tuning.

    Returns
    -------
    dict
        The cases of each method, best first.

    Examples
    --------
    >>> from robonav.experiments import Experiment, Results
    >>> trials = [{"method": "nnql", "trial": trial} for trial in (0, 1)]
    >>> tuning = Experiment("tuning", "Tuning", trials, dict, {"quick": 1, "thesis": 1})
    >>> rows = [(0, 0, "success", 0, 80.0), (1, 0, "success", 0, 90.0)]
    >>> [case["trial"] for case in ranking(Results.from_rows(tuning, "quick", rows))["nnql"]]
    [1, 0]
    """
    success = {
        place: round(results.summary("success", place).mean, 6)
        for place in range(len(results.experiment.cases))
    }
    ranked: dict[str, list[Case]] = {}
    for place in sorted(success, key=lambda place: -success[place]):
        case = results.experiment.cases[place]
        ranked.setdefault(str(case["method"]), []).append(case)
    return ranked


@lru_cache(maxsize=1)
def finalists() -> list[Case]:
    """Return the cases of the second stage, from ``finalists.toml``."""
    found = read_settings(FINALISTS)
    return [
        _case(method, int(trial), Settings.of(values))
        for method in METHODS
        for trial, values in found[method].items()
    ]


def write_finalists(folder: str | Path = RESULTS, path: Path = FINALISTS) -> None:
    """Write the best trials of each method to TOML, from the results of ``nnql-tuning``."""
    ranked = ranking(read_results(TUNING, folder))
    best = {
        method: {str(case["trial"]): _settings(case) for case in ranked[method][:FINAL_TRIALS]}
        for method in METHODS
    }  # fmt: skip
    comment = "The best trials of nnql-tuning, the best first. Written by robonav.experiments.chapter4.tuning."
    write_hyperparameters(path, comment, best)


def write_tuned(folder: str | Path = RESULTS, path: Path = HYPERPARAMETERS) -> None:
    """Write the hyperparameters of each method's best finalist to TOML, from the results of ``nnql-finals``."""
    ranked = ranking(read_results(FINALS, folder))
    best = {method: {"": _settings(ranked[method][0])} for method in METHODS}
    comment = "The best finalist of nnql-finals. Written by robonav.experiments.chapter4.tuning."
    write_hyperparameters(path, comment, best)


def _case(method: str, trial: int, settings: Settings) -> Case:
    return {"method": method, "trial": trial, "settings": settings.as_json()}


def _settings(case: Case) -> Settings:
    return Settings.of(json.loads(str(case["settings"])))


_ABOUT = {
    "episodes": EPISODES,
    "navigations a run": {scale: n // 2 for scale, n in SETUP.navigations.items()},
}

_SHORTENED = "a fifth of the episodes"

TUNING = Experiment(
    name="nnql-tuning",
    title="Success of the trials that tuned the methods of chapter 4, equally many for each",
    cases=[
        _case(method, trial, trial_settings(method, trial))
        for method in METHODS
        for trial in range(TRIALS)
    ],
    run=tune,
    seeds={"quick": 1, "thesis": 4},
    shortened=_SHORTENED,
    settings=_ABOUT,
    plot=Plot("nnql.plot_trials"),
)
FINALS = Experiment(
    name="nnql-finals",
    title="Success of the four best trials of each method, trained again with other seeds",
    cases=finalists(),
    run=tune_again,
    seeds={"quick": 1, "thesis": 12},
    shortened=_SHORTENED,
    settings=_ABOUT,
    plot="sixteen numbers, which a table shows better",
)

EXPERIMENTS = (TUNING, FINALS)

if __name__ == "__main__":
    stage, *folder = sys.argv[1:]
    write = {"finalists": write_finalists, "hyperparameters": write_tuned}[stage]
    write(folder[0] if folder else RESULTS)
