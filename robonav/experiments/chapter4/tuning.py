"""How the settings of chapter 4's methods were chosen: the same number of trials for each, on worlds kept for that.

Sixteen trials of four seeds each; the four best then try again with twelve other seeds, which decide. The best of
sixteen short trials is partly the luckiest, and its second result says how lucky it was.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from robonav.nnql import METHODS, TrainingResult, train

from ..runner.experiment import Case, Experiment, Results
from .setup import EPISODES, NAVIGATIONS, SHORTENED, Numbers, course, driven, new_worlds

TRIALS = 16
TOGETHER = {"quick": 1, "thesis": 8}  # seeds that train at once
TUNING_WORLDS = (
    41_000  # run k drives through the worlds of this seed + k; tables take others
)
TUNING_SEEDS = 10_000  # run k trains with this seed + k; tables take others

_NEURAL: dict[str, list[Any]] = {
    "alpha": [0.8, (0.8, 0.1), (0.4, 0.05)],
    "rate": [0.3, (0.3, 0.05), 0.1],
    "passes": [1, 3],
    "rescale": ["clip", "shift"],
}
_SHARED: dict[str, list[Any]] = {
    "gamma": [0.6, 0.7, 0.8, 0.9],
    "target": ["number", "one-hot", "sine-cosine"],
    "temperature": [(0.9, 0.1), (0.9, 0.05), (0.9, 0.03)],
}
_NFQ: dict[str, list[Any]] = {
    "collect": [5, 10, 20],
    "fitting": [(5, 100), (10, 50), (20, 30)],
}
_DQN: dict[str, list[Any]] = {
    "rate": [0.001, 0.003, 0.01],
    "refresh": [100, 300, 1000],
    "batch": [32, 64],
}
SPACE: dict[str, dict[str, list[Any]]] = {
    "nnql": _NEURAL | _SHARED,
    "online": _NEURAL | _SHARED,
    "nfq": _NFQ | _SHARED,
    "dqn": _DQN | _SHARED,
}
"""What a trial draws from, evenly and setting by setting; ``fitting`` is sweeps and epochs."""

_OWN = {"gamma": 0.7, "target": "number", "temperature": (0.9, 0.1)}
FIRST: dict[str, dict[str, Any]] = {
    "nnql": _OWN | {"alpha": 0.8, "rate": 0.3, "passes": 1, "rescale": "clip"},
    "online": _OWN | {"alpha": 0.8, "rate": 0.3, "passes": 1, "rescale": "clip"},
    "nfq": _OWN | {"collect": 10, "fitting": (5, 100)},
    "dqn": _OWN | {"rate": 0.003, "refresh": 300, "batch": 32},
}
"""Trial 0: what the thesis has, where it has anything."""


FINALISTS = {
    "nnql": (4, 12, 2, 8),
    "online": (0, 15, 12, 2),
    "nfq": (3, 13, 6, 9),
    "dqn": (15, 12, 14, 10),
}
"""The four best trials of each method: the beginning of the :func:`ranking` of their results."""


def trial_settings(method: str, trial: int) -> dict[str, Any]:
    """The settings of a trial; NNQL and online learning, which share a space, get the same ones."""
    if trial == 0:
        return FIRST[method]
    rng = np.random.default_rng([TUNING_SEEDS, trial])
    return {
        name: choices[int(rng.integers(len(choices)))]
        for name, choices in SPACE[method].items()
    }


def trained(
    method: str,
    seed: int,
    scale: str,
    settings: Mapping[str, Any],
    *,
    length: float = 1.0,
    **changes: Any,
) -> TrainingResult:
    """One seed of a method with settings such as :func:`trial_settings` gives, or their JSON.

    ``length`` is of the training, in times the usual; ``changes`` are what is not as in section 4.5, see
    :class:`robonav.nnql.NavigationTask`, and ``record``. At the thesis's scale seeds train ``TOGETHER``, which is
    quicker than one by one and comes to the same. What was trained once in a process is not trained again: several
    tables look at the same networks.
    """
    together, episodes = TOGETHER[scale], round(EPISODES * length)
    seeds = block(seed, together)
    training = _trained(
        method,
        seeds,
        episodes,
        json.dumps(settings, sort_keys=True),
        tuple(sorted(changes.items())),
    )
    return training[seed % together]


def block(seed: int, together: int) -> range:
    """The seeds that train with this one, where so many train at once."""
    first = seed - seed % together
    return range(first, first + together)


@lru_cache(maxsize=64)
def _trained(
    method: str,
    seeds: range,
    episodes: int,
    settings: str,
    changes: tuple[tuple[str, Any], ...],
) -> TrainingResult:
    options = arguments(json.loads(settings))
    of_course = dict(changes)
    record = bool(of_course.pop("record", False))
    where = course(target=options.pop("target"), **of_course)
    if "fitting" in options:
        options["sweeps"], options["epochs"] = options.pop("fitting")
    return train(method, seeds, episodes, task=where, record=record, **options)


ARGUMENTS = {
    "alpha": "learning_rate",
    "gamma": "discount",
    "rate": "gradient_step",
    "collect": "episodes_per_fit",
    "refresh": "target_update_interval",
    "batch": "batch_size",
}
"""What :func:`robonav.nnql.train` calls the settings that the results have under an older name."""


def arguments(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Settings of a trial, as :func:`robonav.nnql.train` takes them."""
    return {ARGUMENTS.get(name, name): _span(value) for name, value in settings.items()}


def _span(value: Any) -> Any:
    """JSON has no tuples."""
    return tuple(value) if isinstance(value, list) else value


def tune(case: Case, seed: int, scale: str) -> Numbers:
    """One seed of one trial, on tuning worlds."""
    settings = json.loads(str(case["settings"]))
    training = trained(
        str(case["method"]),
        TUNING_SEEDS + seed,
        scale,
        settings,
        length=SHORTENED[scale],
    )
    return driven(
        training.policies[0], new_worlds(NAVIGATIONS[scale] // 2, TUNING_WORLDS + seed)
    )


def decide(case: Case, seed: int, scale: str) -> Numbers:
    """One seed of a finalist: other seeds and other worlds than those it was picked by."""
    return tune(case, seed + TUNING.seeds["thesis"], scale)


def _case(method: str, trial: int) -> Case:
    return {
        "method": method,
        "trial": trial,
        "settings": json.dumps(trial_settings(method, trial), sort_keys=True),
    }


def ranking(results: Results) -> dict[str, list[int]]:
    """The trials of each method, by their mean success over seeds, the best first; of equals the earlier first."""
    means: dict[str, dict[int, float]] = {}
    for k, case in enumerate(results.experiment.cases):
        means.setdefault(str(case["method"]), {})[int(case["trial"])] = results.summary(
            "success", k
        ).mean
    return {
        method: sorted(found, key=lambda trial: -round(found[trial], 6))
        for method, found in means.items()
    }


_ABOUT = {
    "episodes": EPISODES,
    "drives a run": {scale: n // 2 for scale, n in NAVIGATIONS.items()},
}

_SHORTENED = "a fifth of the episodes"

TUNING = Experiment(
    name="nnql-tuning",
    title="Trials from which the settings of chapter 4's methods were chosen, as many for each",
    cases=[_case(method, trial) for method in METHODS for trial in range(TRIALS)],
    run=tune,
    seeds={"quick": 1, "thesis": 4},
    shortened=_SHORTENED,
    settings=_ABOUT,
)
FINALS = Experiment(
    name="nnql-finals",
    title="The four best trials of each method once more, with other seeds",
    cases=[
        _case(method, trial) for method, trials in FINALISTS.items() for trial in trials
    ],
    run=decide,
    seeds={"quick": 1, "thesis": 12},
    shortened=_SHORTENED,
    settings=_ABOUT,
)

EXPERIMENTS = (TUNING, FINALS)
