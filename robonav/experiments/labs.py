"""What the training lab replays: learning runs in every combination of some settings, one experiment a chapter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.lfd import labelled_states
from robonav.networks import NetworkPolicy, fit
from robonav.robot import Encoder, navigate

from .chapter3.setup import Numbers, new_worlds, shown
from .chapter4.setup import SHORTENED
from .chapter4.tuning import FIRST, trained
from .chapter5.setup import learned
from .chapter5.tuning import trial_settings
from .runner.experiment import Case, Experiment, Results
from .runner.results import RESULTS as RESULTS

EARLY = (
    0,
    5,
    10,
    15,
    20,
    25,
    30,
    40,
    50,
    75,
    100,
    150,
    200,
    250,
    300,
)  # most happens in the first 50 iterations
BIN = 30  # episodes, as in Fig. 4.4
EPISODES = 300
METHODS = ("nnql", "online", "nfq", "dqn")
TEMPERATURES = {
    "0.9 to 0.1": (0.9, 0.1),
    "0.9 to 0.03": (0.9, 0.03),
    "0.9 throughout": (0.9, 0.9),
}
UPDATES: dict[str, dict[str, dict[str, Any]]] = {
    "as the thesis has it": {"nnql": {}, "online": {}, "nfq": {}, "dqn": {}},
    "a quarter of that": {
        "nnql": {"alpha": 0.2},
        "online": {"alpha": 0.2},
        "nfq": {"fitting": (5, 25)},
        "dqn": {"rate": 0.00075},
    },
}
"""How far an update goes: the learning rate of each method, which for NFQ is how long it fits."""

STEPS: dict[str, dict[str, Sequence[int]]] = {
    "lab-lfd": {"cost": EARLY, "accuracy": EARLY, "success": EARLY},
    "lab-nnql": {
        name: range(BIN, EPISODES + 1, BIN) for name in ("success", "collision")
    },
    "lab-nirl": {
        name: range(5, 141, 5) for name in ("margin", "cost", "success", "agreement")
    },
}
"""At which iterations or episodes each number of a run is taken."""


def from_demonstrations(case: Case, seed: int, scale: str) -> Numbers:
    """Algorithm 3 while it goes on: cost, agreement with the demonstrations, and what the robot does in new maps."""
    x, y = labelled_states(shown(seed, drives=int(case["demonstrations"])))
    training = fit(
        x, y, hidden=int(case["hidden"]), regularisation=float(case["lambda"]), iterations=EARLY[-1], seed=seed,
        record=True,
    )  # fmt: skip
    assert training.networks is not None
    at = np.minimum(EARLY, training.iterations)
    worlds, networks = new_worlds(seed, scale), training.networks
    arrived = {
        k: navigate(NetworkPolicy(networks[k], Encoder()), worlds).success.mean()
        for k in {*at.tolist()}
    }
    return {
        "cost": training.costs[at],
        "accuracy": 100 * training.accuracies[at],
        "success": [100 * arrived[k] for k in at.tolist()],
    }


def from_reward(case: Case, seed: int, scale: str) -> Numbers:
    """Successes and collisions while a method of chapter 4 learns, in per cent of the last 30 episodes."""
    method = str(case["method"])
    settings = FIRST[method] | UPDATES[str(case["learning rate"])][method]
    settings |= {"temperature": TEMPERATURES[str(case["temperature"])]}
    outcomes = trained(method, seed, scale, settings, length=SHORTENED[scale]).outcomes[
        0
    ]
    bins = outcomes[: len(outcomes) // BIN * BIN].reshape(-1, BIN)
    ended = {"success": "arrived", "collision": "collided"}
    return {name: 100 * (bins == end).mean(axis=1) for name, end in ended.items()}


def from_expert(case: Case, seed: int, scale: str) -> Numbers:
    """Algorithm 10 while it goes on: margin, cost, practice drives that arrive, and agreement with the expert."""
    settings = trial_settings("nirl", 0, float(case["discount"])) | {
        "ends": str(case["ends"])
    }
    history = learned("nirl", seed, settings, int(case["demonstrations"])).history
    at = np.minimum(np.array(STEPS["lab-nirl"]["cost"]), len(history.costs)) - 1

    def recent(series: NDArray[np.float64]) -> NDArray[np.float64]:
        """The mean of the last five iterations: one alone has ten drives."""
        return np.array([series[max(k - 4, 0) : k + 1].mean() for k in at])

    return {
        "margin": history.margins[at],
        "cost": history.costs[at],
        "success": 100 * recent(history.arrived),
        "agreement": 100 * history.balanced[at + 1],
    }


def _combinations(settings: Mapping[str, Sequence[Any]]) -> list[dict[str, Any]]:
    """Every case, the last setting changing fastest."""
    cases: list[dict[str, Any]] = [{}]
    for name, choices in settings.items():
        cases = [case | {name: choice} for case in cases for choice in choices]
    return cases


def offered(results: Results) -> dict[str, list[str]]:
    """The settings that an experiment varies, and their choices, as text."""
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
            {"demonstrations": (5, 25, 40), "lambda": (0, 1, 10), "hidden": (2, 8, 20)}
        ),
        run=from_demonstrations,
        seeds={"quick": 1, "thesis": 3},
        settings={"iterations": EARLY, "target": "sine-cosine"},
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
    ),
    Experiment(
        name="lab-nirl",
        title="Training lab: neural inverse reinforcement learning in 12 settings",
        cases=_combinations(
            {
                "demonstrations": (10, 30, 50),
                "discount": (0.65, 0.9),
                "ends": ("bonus", "neutral"),
            }
        ),
        run=from_expert,
        seeds={"quick": 1, "thesis": 3},
        settings={"trial": 0},
    ),
)
