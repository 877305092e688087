"""The tuning of chapter 5's hyperparameters: equally many trials for each method, in worlds reserved for tuning.

Run the trials, then write ``hyperparameters.toml`` from their results::

    robonav reproduce nirl-tuning --scale thesis
    python -m robonav.experiments.chapter5.tuning results
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from ..runner.experiment import Case, Experiment, Numbers, Plot, Results
from ..runner.results import RESULTS, read_results
from ..runner.settings import Settings, write_hyperparameters
from .setup import (
    CONDITIONS,
    HYPERPARAMETERS,
    METHODS,
    SETUP,
    SHORTENED,
    THESIS,
    trained_policy,
)

TRIALS = 8  # with each of two discounts
DISCOUNTS: tuple[float, ...] = tuple(CONDITIONS["discounts"])
TUNING_SEEDS = 1000  # run k trains with this seed + k, from its own demonstrations; the tables use other seeds
N_SAMPLES = 9600  # gradient steps in an iteration, in all trials

_SHARED: dict[str, list[Any]] = {
    "inverse_temperature": [15.0, 25.0, 40.0],
    "gradient_step": [(0.4, 0.4), (0.4, 0.1), (0.4, 0.02)],
    "hidden": [10, 16],
    "replay": [10, 20, 40],
    "target": ["signed", "sine-cosine"],
}
_OWN: dict[str, dict[str, list[Any]]] = {
    "nirl": {"power": [0.5, 1.0]},
    "apprenticeship": {
        "expectations": ["all states", "initial state"],
        "n_rewards": [7, 14, 28],
    },
    "relative-entropy": {"horizon": [3, 5, 8], "slack": [0.02, 0.05, 0.1]},
    "scirl": {
        "estimate": ["lstd", "heuristic"],
        "power": [0.0, 0.5, 1.0],
        "regularisation": [1e-6, 1e-4, 1e-2],
    },
}
SPACE: dict[str, dict[str, list[Any]]] = {
    method: _SHARED | own for method, own in _OWN.items()
} | {
    "lfd": {
        "hidden": [8, 10, 16, 30],
        "regularisation": [0.1, 0.3, 1.0, 3.0, 10.0],
        "iterations": [100, 300],
        "target": ["signed", "sine-cosine"],
    }
}
"""The values of each hyperparameter. Methods that share a hyperparameter get the same draws."""


def draws(method: str, discount: float) -> list[dict[str, Any]]:
    """The hyperparameters of a method, one dictionary a trial: random combinations in which all values are as frequent.

    The methods of inverse reinforcement learning try the same combinations with both discounts. Cloning has no
    discount. Its trials for the second discount are further combinations.
    """
    seed = [TUNING_SEEDS, DISCOUNTS.index(discount) if method == "lfd" else 0]
    rng = np.random.default_rng(seed)
    columns = {
        name: [
            choices[k]
            for k in rng.permutation(np.resize(rng.permutation(len(choices)), TRIALS))
        ]
        for name, choices in SPACE[method].items()
    }
    return [
        dict(zip(columns, row, strict=True))
        for row in zip(*columns.values(), strict=True)
    ]


def trial_settings(method: str, trial: int, discount: float) -> Settings:
    """The hyperparameters of a trial: trial 0 has the thesis's, the others have random ones.

    Parameters
    ----------
    method : str
        The method.
    trial : int
        Its number.
    discount : float
        0.65 or 0.9.

    Returns
    -------
    Settings

    Examples
    --------
    >>> from robonav.experiments.chapter5.tuning import trial_settings
    >>> trial_settings("nirl", 1, 0.65)["discount"]
    0.65
    """
    first = trial == 0 and (method != "lfd" or discount == DISCOUNTS[0])
    drawn = dict(THESIS[method]) if first else draws(method, discount)[trial]
    if method != "lfd":
        drawn |= {"discount": discount, "n_samples": N_SAMPLES}
    return Settings.of(drawn)


def tune(case: Case, seed: int, scale: str) -> Numbers:
    """Test one seed of a trial in tuning worlds."""
    settings = Settings.of(json.loads(str(case["settings"])))
    policy = trained_policy(
        str(case["method"]), TUNING_SEEDS + seed, settings, length=SHORTENED[scale]
    )
    worlds = SETUP.tuning_worlds(seed, SETUP.navigations[scale])
    return SETUP.evaluate(policy, worlds)


TUNING = Experiment(
    name="nirl-tuning",
    title="Success of the trials that tuned the methods of chapter 5, equally many for each",
    cases=[
        {
            "method": method,
            "discount": discount,
            "trial": trial,
            "settings": trial_settings(method, trial, discount).as_json(),
        }
        for method in METHODS
        for discount in DISCOUNTS
        for trial in range(TRIALS)
    ],
    run=tune,
    seeds={"quick": 1, "thesis": 2},
    shortened="a tenth of the iterations",
    settings={"navigations a run": SETUP.navigations},
    plot=Plot("nnql.plot_trials"),
)


def best_trials(results: Results) -> dict[str, dict[str, Settings]]:
    """Return the trial with the greatest mean success for each method and discount, and the best of all for cloning."""
    best: dict[tuple[str, str], tuple[float, Settings]] = {}
    for place, case in enumerate(results.experiment.cases):
        method = str(case["method"])
        key = method, "" if method == "lfd" else str(case["discount"])
        success = results.summary("success", place).mean
        if key not in best or success > best[key][0]:
            best[key] = success, Settings.of(json.loads(str(case["settings"])))
    found: dict[str, dict[str, Settings]] = {}
    for (method, discount), (_, settings) in best.items():
        found.setdefault(method, {})[discount] = settings
    return found


def write_tuned(folder: str | Path = RESULTS, path: Path = HYPERPARAMETERS) -> None:
    """Write the hyperparameters of each method's best trial to TOML, from the results of ``nirl-tuning``."""
    comment = "The best trials of nirl-tuning, by discount. Written by robonav.experiments.chapter5.tuning."
    write_hyperparameters(path, comment, best_trials(read_results(TUNING, folder)))


EXPERIMENTS = (TUNING,)

if __name__ == "__main__":
    write_tuned(sys.argv[1] if sys.argv[1:] else RESULTS)
