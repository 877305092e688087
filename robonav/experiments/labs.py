"""The trainings that the training labs replay, in every combination of some settings, by chapter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.lfd import labelled_states
from robonav.networks import NetworkPolicy, fit
from robonav.robot import Encoder

from .chapter3 import setup as chapter3
from .chapter4 import setup as chapter4
from .chapter5 import setup as chapter5
from .chapter5.tuning import trial_settings
from .runner.experiment import Case, Experiment, Numbers, Results

# The first 50 iterations change the network most.
EARLY = (0, 5, 10, 15, 20, 25, 30, 40, 50, 75, 100, 150, 200, 250, 300)
BIN = 30  # episodes, as in Fig. 4.4
EPISODES = 300
METHODS = ("nnql", "online", "nfq", "dqn")
TEMPERATURES = {
    "0.9 to 0.1": (0.9, 0.1),
    "0.9 to 0.03": (0.9, 0.03),
    "0.9 throughout": (0.9, 0.9),
}
UPDATES: dict[str, dict[str, dict[str, Any]]] = {
    "the thesis's": {"nnql": {}, "online": {}, "nfq": {}, "dqn": {}},
    "a quarter": {
        "nnql": {"learning_rate": 0.2},
        "online": {"learning_rate": 0.2},
        "nfq": {"sweeps": 5, "epochs": 25},
        "dqn": {"gradient_step": 0.00075},
    },
}
"""The learning rate of each method. For NFQ, which has none, it is the number of epochs of a fit."""

STEPS: dict[str, dict[str, Sequence[int]]] = {
    "lab-lfd": {"cost": EARLY, "accuracy": EARLY, "success": EARLY},
    "lab-nnql": {
        name: range(BIN, EPISODES + 1, BIN) for name in ("success", "collision")
    },
    "lab-nirl": {
        name: range(5, 141, 5)
        for name in ("margin", "cost", "success", "balanced accuracy")
    },
}
"""The iterations or episodes at which each number of a run is taken."""


def from_demonstrations(case: Case, seed: int, scale: str) -> Numbers:
    """Return cost, accuracy on the demonstrations, and success in new maps over the iterations of Algorithm 3."""
    x, y = labelled_states(
        chapter3.demonstrations(seed, number=int(case["demonstrations"]))
    )
    training = fit(
        x,
        y,
        hidden=int(case["hidden"]),
        regularisation=float(case["regularisation"]),
        iterations=EARLY[-1],
        seed=seed,
        record=True,
    )
    assert training.networks is not None
    at = np.minimum(EARLY, training.iterations)
    setup, networks = chapter3.SETUP, training.networks
    worlds = setup.test_worlds(seed, scale)
    success = {
        k: setup.evaluate(NetworkPolicy(networks[k], Encoder()), worlds)["success"]
        for k in {*at.tolist()}
    }
    return {
        "cost": training.costs[at],
        "accuracy": 100 * training.accuracies[at],
        "success": [success[k] for k in at.tolist()],
    }


def from_reward(case: Case, seed: int, scale: str) -> Numbers:
    """Return successes and collisions while a method of chapter 4 trains, in per cent of every 30 episodes."""
    method = str(case["method"])
    settings = chapter4.THESIS[method] | UPDATES[str(case["learning rate"])][method]
    settings |= {"temperature": TEMPERATURES[str(case["temperature"])]}
    length = chapter4.SHORTENED[scale]
    training = chapter4.training(method, seed, scale, settings, length=length)
    outcomes = training.outcomes[0]
    bins = outcomes[: len(outcomes) // BIN * BIN].reshape(-1, BIN)
    named = {"success": "arrived", "collision": "collided"}
    return {name: 100 * (bins == end).mean(axis=1) for name, end in named.items()}


def from_expert(case: Case, seed: int, scale: str) -> Numbers:
    """Return margin, cost, episodes that arrive, and balanced accuracy over the iterations of Algorithm 10."""
    settings = trial_settings("nirl", 0, float(case["discount"])) | {
        "terminal_values": str(case["terminal values"])
    }
    number = int(case["demonstrations"])
    history = chapter5.trained("nirl", seed, settings, number).history
    at = np.minimum(np.array(STEPS["lab-nirl"]["cost"]), len(history.costs)) - 1

    def recent(series: NDArray[np.float64]) -> NDArray[np.float64]:
        """The mean of the last five iterations, since one alone has ten episodes."""
        return np.array([series[max(k - 4, 0) : k + 1].mean() for k in at])

    return {
        "margin": history.margins[at],
        "cost": history.costs[at],
        "success": 100 * recent(history.arrived),
        "balanced accuracy": 100 * history.balanced[at + 1],
    }


def _combinations(settings: Mapping[str, Sequence[Any]]) -> list[dict[str, Any]]:
    """Return every combination of the settings. The last setting changes fastest."""
    cases: list[dict[str, Any]] = [{}]
    for name, values in settings.items():
        cases = [case | {name: value} for case in cases for value in values]
    return cases


def choices(results: Results) -> dict[str, list[str]]:
    """The settings that an experiment varies, with their values as text."""
    cases = results.experiment.cases
    return {
        name: list(dict.fromkeys(str(case[name]) for case in cases))
        for name in cases[0]
    }


EXPERIMENTS = (
    Experiment(
        name="lab-lfd",
        title="Training lab: learning from demonstration in 27 settings",
        cases=_combinations(
            {
                "demonstrations": (5, 25, 40),
                "regularisation": (0, 1, 10),
                "hidden": (2, 8, 20),
            }
        ),
        run=from_demonstrations,
        seeds={"quick": 1, "thesis": 3},
        settings={"iterations": EARLY, "target": "sine-cosine"},
        plot="the training lab draws it",
    ),
    Experiment(
        name="lab-nnql",
        title="Training lab: the methods of chapter 4 in 24 settings",
        cases=_combinations(
            {
                "method": METHODS,
                "temperature": tuple(TEMPERATURES),
                "learning rate": tuple(UPDATES),
            }
        ),
        run=from_reward,
        seeds={"quick": 1, "thesis": 5},
        shortened="a fifth of the episodes",
        settings={"updates": UPDATES, "bin": BIN},
        plot="the training lab draws it",
    ),
    Experiment(
        name="lab-nirl",
        title="Training lab: neural inverse reinforcement learning in 12 settings",
        cases=_combinations(
            {
                "demonstrations": (10, 30, 50),
                "discount": (0.65, 0.9),
                "terminal values": ("bonus", "neutral"),
            }
        ),
        run=from_expert,
        seeds={"quick": 1, "thesis": 3},
        settings={"trial": 0},
        plot="the training lab draws it",
    ),
)
