"""How the settings of chapter 5's methods were chosen: as many trials for each, on worlds kept for that."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from robonav.robot import random_worlds

from ..runner.experiment import Case, Experiment, Results
from .setup import NAVIGATIONS, OBSTACLES, SHORTENED, Numbers, driven, policy

TRIALS = 8  # with each of two discounts
DISCOUNTS = (0.65, 0.9)
TUNING_SEEDS = 1000  # run k learns with this seed + k, from demonstrations of its own; tables take others
TUNING_WORLDS = (
    70_000  # run k drives through the worlds of this seed + k; tables take others
)

METHODS = ("nirl", "apprenticeship", "relative_entropy", "scirl", "cloning")
_SHARED: dict[str, list[Any]] = {
    "eta": [15.0, 25.0, 40.0],
    "rate": [(0.4, 0.4), (0.4, 0.1), (0.4, 0.02)],
    "hidden": [10, 16],
    "replay": [10, 20, 40],
    "target": ["signed", "sine-cosine"],
}
_OWN: dict[str, dict[str, list[Any]]] = {
    "nirl": {"power": [0.5, 1.0]},
    "apprenticeship": {"expectations": ["everywhere", "start"], "guesses": [7, 14, 28]},
    "relative_entropy": {"horizon": [3, 5, 8], "slack": [0.02, 0.05, 0.1]},
    "scirl": {
        "estimate": ["lstd", "heuristic"],
        "power": [0.0, 0.5, 1.0],
        "ridge": [1e-6, 1e-4, 1e-2],
    },
}
SPACE: dict[str, dict[str, list[Any]]] = {
    method: _SHARED | own for method, own in _OWN.items()
} | {
    "cloning": {
        "hidden": [8, 10, 16, 30],
        "regularisation": [0.1, 0.3, 1.0, 3.0, 10.0],
        "iterations": [100, 300],
        "target": ["signed", "sine-cosine"],
    }
}
"""What a trial draws from, evenly and setting by setting; what all methods share is drawn alike for all."""

_FIRST = {
    "eta": 25.0,
    "rate": (0.4, 0.4),
    "hidden": 10,
    "replay": 20,
    "target": "sine-cosine",
}
FIRST: dict[str, dict[str, Any]] = {
    "nirl": _FIRST | {"power": 1.0},
    "apprenticeship": _FIRST | {"expectations": "everywhere", "guesses": 14},
    "relative_entropy": _FIRST | {"horizon": 5, "slack": 0.05},
    "scirl": _FIRST | {"estimate": "lstd", "power": 1.0, "ridge": 1e-6},
    "cloning": {
        "hidden": 8,
        "regularisation": 1.0,
        "iterations": 300,
        "target": "sine-cosine",
    },
}
"""Trial 0: what the thesis has, where it has anything."""

SAMPLES = 9600


def draws(method: str, discount: float) -> list[dict[str, Any]]:
    """The settings of all trials but the first: each choice about as often as the others, combined by chance.

    Cloning knows no discount: it gets other draws instead.
    """
    seed = [TUNING_SEEDS, DISCOUNTS.index(discount) if method == "cloning" else 0]
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


def trial_settings(method: str, trial: int, discount: float) -> dict[str, Any]:
    """The settings of a trial."""
    first = trial == 0 and (method != "cloning" or discount == DISCOUNTS[0])
    drawn = FIRST[method] if first else draws(method, discount)[trial]
    return (
        dict(drawn)
        if method == "cloning"
        else {**drawn, "discount": discount, "samples": SAMPLES}
    )


def tune(case: Case, seed: int, scale: str) -> Numbers:
    """One seed of one trial, on tuning worlds."""
    chosen = json.loads(str(case["settings"]))
    robot = policy(
        str(case["method"]), TUNING_SEEDS + seed, chosen, length=SHORTENED[scale]
    )
    return driven(
        robot, random_worlds(NAVIGATIONS[scale], OBSTACLES, seed=TUNING_WORLDS + seed)
    )


TUNING = Experiment(
    name="nirl-tuning",
    title="Trials from which the settings of chapter 5's methods were chosen, as many for each",
    cases=[
        {
            "method": method,
            "discount": discount,
            "trial": trial,
            "settings": json.dumps(
                trial_settings(method, trial, discount), sort_keys=True
            ),
        }
        for method in METHODS
        for discount in DISCOUNTS
        for trial in range(TRIALS)
    ],
    run=tune,
    seeds={"quick": 1, "thesis": 2},
    shortened="a tenth of the iterations",
    settings={"drives a run": NAVIGATIONS},
)


def best_trials(results: Results) -> dict[str, dict[float, int]]:
    """For each method and discount the trial with the greatest mean success over seeds."""
    means = np.array(
        [results.summary("success", case).mean for case in range(len(TUNING.cases))]
    )
    best = means.reshape(len(METHODS), len(DISCOUNTS), TRIALS).argmax(axis=2).tolist()
    return {
        m: dict(zip(DISCOUNTS, trials, strict=True))
        for m, trials in zip(METHODS, best, strict=True)
    }


EXPERIMENTS = (TUNING,)
