"""Chapter 4 again: Table 4.2, Table 4.3 with Fig. 4.6, and what the thesis does not have: tuning, denser maps, ablations.

A run is one training seed: it trains a network and drives its greedy policy through new worlds. Worlds to tune on, worlds
to test on and worlds to train in never meet, and neither do the seeds that methods are tuned and tested with.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from robonav.nnql import METHODS, STARTS, TARGETS, Course, Training
from robonav.robot import NNQL_SENSORS, Encoder, Policy, Worlds, freer_side, navigate, random_worlds, straight

from .experiment import Case, Experiment

RESULTS = Path(__file__).parent / "results"
"""Where the results of the thesis's scale are kept, which the pages show."""

EPISODES = {"quick": 60, "thesis": 300}
NAVIGATIONS = {"quick": 100, "thesis": 1000}
SPEED = 2.5
BLOCK = 30  # episodes that Fig. 4.4 and 4.6 count successes in
TEST_WORLDS, TUNING_WORLDS = 40_000, 41_000  # seeds: run k drives through the worlds of seed + k
TUNING_SEEDS = 10_000  # run k of a trial trains with this seed + k

Numbers = dict[str, ArrayLike]


def course(obstacles: int = 10, *, target: str = "one-hot", moving: int = 0, speed: float = SPEED) -> Course:
    """The conditions of section 4.5 with the target's sector written in one way or another."""
    return Course(obstacles, moving, speed, encoder=Encoder(NNQL_SENSORS, walls=True, target=target))


def new_worlds(n: int, seed: int, obstacles: int = 10, moving: int = 0) -> Worlds:
    """Worlds to drive in, with the starts and targets of section 4.5."""
    return random_worlds(n, obstacles, moving, seed=seed, starts=STARTS, targets=TARGETS)


def driven(policy: Policy, worlds: Worlds, speed: float = SPEED) -> Numbers:
    """How many of some drives arrive, collide and run out of steps, in per cent (Algorithm 9)."""
    drives = navigate(policy, worlds, speed, Course().max_steps)
    arrived, collided = 100 * drives.success.mean(), 100 * drives.collision.mean()
    return {"success": arrived, "collision": collided, "out of steps": 100 - arrived - collided}


# ---------------------------------------------------------------------------------------------------------------------
# Tuning: the same number of trials for every method

TRIALS = 16
_NEURAL = {
    "alpha": [0.8, (0.8, 0.1), (0.4, 0.05)],
    "rate": [0.3, (0.3, 0.05), 0.1],
    "passes": [1, 3],
    "rescale": ["clip", "shift"],
}
_SHARED = {
    "gamma": [0.6, 0.7, 0.8, 0.9],
    "target": ["number", "one-hot", "sine-cosine"],
    "temperature": [(0.9, 0.1), (0.9, 0.05), (0.9, 0.03)],
}
SPACE: dict[str, dict[str, list[Any]]] = {
    "nnql": _NEURAL | _SHARED,
    "online": _NEURAL | _SHARED,
    "nfq": {"collect": [5, 10, 20], "fitting": [(5, 100), (10, 50), (20, 30)]} | _SHARED,
    "dqn": {"rate": [0.001, 0.003, 0.01], "refresh": [100, 300, 1000], "batch": [32, 64]} | _SHARED,
}
"""What a trial draws from, evenly and setting by setting; ``fitting`` is sweeps and epochs."""

OWN = {"gamma": 0.7, "target": "number", "temperature": (0.9, 0.1)}
FIRST: dict[str, dict[str, Any]] = {
    "nnql": OWN | {"alpha": 0.8, "rate": 0.3, "passes": 1, "rescale": "clip"},
    "online": OWN | {"alpha": 0.8, "rate": 0.3, "passes": 1, "rescale": "clip"},
    "nfq": OWN | {"collect": 10, "fitting": (5, 100)},
    "dqn": OWN | {"rate": 0.003, "refresh": 300, "batch": 32},
}
"""Trial 0: what the thesis has, where it has anything."""


def trial_settings(method: str, trial: int) -> dict[str, Any]:
    """The settings of a trial; NNQL and online learning, which share a space, get the same ones."""
    if trial == 0:
        return FIRST[method]
    rng = np.random.default_rng([TUNING_SEEDS, trial])
    return {name: choices[int(rng.integers(len(choices)))] for name, choices in SPACE[method].items()}


def trained(method: str, seed: int, episodes: int, settings: Mapping[str, Any], obstacles: int = 10) -> Training:
    """One seed of a method with settings such as :func:`trial_settings` gives."""
    options = {name: tuple(value) if isinstance(value, list) else value for name, value in settings.items()}
    where = course(obstacles, target=options.pop("target"))
    if "fitting" in options:
        options["sweeps"], options["epochs"] = options.pop("fitting")
    return METHODS[method]([seed], episodes, course=where, **options)


def tune(case: Case, seed: int, scale: str) -> Numbers:
    """One seed of one trial, on tuning worlds."""
    settings = json.loads(str(case["settings"]))
    training = trained(str(case["method"]), TUNING_SEEDS + seed, EPISODES[scale], settings)
    return driven(training.policies[0], new_worlds(NAVIGATIONS[scale] // 2, TUNING_WORLDS + seed))


TUNING = Experiment(
    name="nnql-tuning",
    title="Trials from which the settings of chapter 4's methods were chosen, as many for each",
    cases=[
        {"method": method, "trial": trial, "settings": json.dumps(trial_settings(method, trial), sort_keys=True)}
        for method in METHODS
        for trial in range(TRIALS)
    ],
    run=tune,
    seeds={"quick": 1, "thesis": 8},
    settings={"episodes": EPISODES, "drives a run": {scale: n // 2 for scale, n in NAVIGATIONS.items()}},
)
