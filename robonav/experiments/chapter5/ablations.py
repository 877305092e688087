"""From Algorithm 10 as it is written to what works, one change at a time; and by what a policy is chosen."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from robonav.networks import Network, NetworkPolicy
from robonav.nirl import (
    ZERO_TERMINAL_VALUES,
    Learned,
    LeastSquaresReward,
    ReplaySGD,
    SingleGradientStep,
    SubgradientMaxMargin,
    accuracy,
    balanced_accuracy,
    learn,
)
from robonav.robot import Worlds, navigate, random_worlds

from ..runner.experiment import Case, Experiment
from .setup import (
    ITERATIONS,
    NAVIGATIONS,
    OBSTACLES,
    Numbers,
    course,
    demonstrations,
    driven,
    learned,
    new_worlds,
)
from .tables import settings

CHOOSING_WORLDS = (
    80_000  # test drives by which a policy is chosen: not those it is tested on
)
EVERY = 5  # of a run's networks are tried, where test drives choose

_FAST = ReplaySGD(rate=(0.4, 0.4), ends=ZERO_TERMINAL_VALUES)
CHANGES: dict[str, Mapping[str, Any]] = {
    "Algorithm 10 as written": {
        "reward": LeastSquaresReward(),
        "improve": SingleGradientStep(),
        "score": accuracy,
        "target": "number",
    },
    "reward: expert against policy, in the expert's states": {
        "reward": SubgradientMaxMargin(power=0.0)
    },
    "rewards in [0, 1]; 300 steps, this iteration's drives": {
        "improve": replace(_FAST, samples=300, replay=1)
    },
    "9,600 steps, 20 iterations' drives": {"improve": _FAST},
    "rare actions count alike": {"reward": SubgradientMaxMargin()},
    "chosen by balanced accuracy": {"score": balanced_accuracy},
    "the target's sector as sine and cosine": {"target": "sine-cosine"},
    "any end but a collision is worth the most": {
        "improve": ReplaySGD(rate=(0.4, 0.4))
    },
    "learning rate falls": {"improve": ReplaySGD()},
    "discount 0.9": {"improve": ReplaySGD(discount=0.9)},
}
"""What each step changes; all that came before it stays."""


def up_to(step: str) -> dict[str, Any]:
    """The settings after a step and all before it."""
    names = list(CHANGES)
    merged: dict[str, Any] = {}
    for name in names[: names.index(step) + 1]:
        merged |= CHANGES[name]
    return merged


def mend(case: Case, seed: int, scale: str) -> Numbers:
    """One run after so many changes."""
    options = up_to(str(case["step"]))
    ground = course(options.pop("target"))
    found = learn(
        demonstrations(seed),
        "nirl",
        seed,
        course=ground,
        iterations=ITERATIONS,
        **options,
    )
    return driven(found.policy, new_worlds(scale, seed))


def member(found: Learned, k: int) -> NetworkPolicy:
    """The k-th policy of a run."""
    stack = found.history.networks
    network = Network(
        tuple(w[k] for w in stack.weights), tuple(b[k] for b in stack.biases)
    )
    return replace(found.policy, network=network)


def by_drives(found: Learned, worlds: Worlds) -> int:
    """The policy that drives best in some worlds, of every so-many-th."""
    tried = range(0, len(found.history.accuracies), EVERY)
    return tried[
        int(
            np.argmax(
                [navigate(member(found, k), worlds).success.mean() for k in tried]
            )
        )
    ]


CHOICES: dict[str, Callable[[Learned, Worlds], int]] = {
    "accuracy": lambda found, worlds: int(found.history.accuracies.argmax()),
    "balanced accuracy": lambda found, worlds: int(found.history.balanced.argmax()),
    "the last": lambda found, worlds: len(found.history.accuracies) - 1,
    "test drives": by_drives,
}


def choose(case: Case, seed: int, scale: str) -> Numbers:
    """One run, with the reward learned or none at all, its policy chosen in one way or another."""
    method = "nirl" if case["reward"] == "learned" else "zero reward"
    found = learned(method, seed, settings(method))
    worlds = random_worlds(
        NAVIGATIONS[scale] // 5, OBSTACLES, seed=CHOOSING_WORLDS + seed
    )
    k = CHOICES[str(case["chosen by"])](found, worlds)
    scores = {
        "accuracy": 100 * found.history.accuracies[k],
        "balanced accuracy": 100 * found.history.balanced[k],
    }
    return driven(member(found, k), new_worlds(scale, seed)) | scores


STEPS = Experiment(
    name="nirl-steps",
    title="From Algorithm 10 as it is written to what works, one change at a time",
    cases=[{"step": step} for step in CHANGES],
    run=mend,
    seeds={"quick": 1, "thesis": 10},
    settings={"iterations": ITERATIONS, "drives a run": NAVIGATIONS},
)
CHOICE = Experiment(
    name="nirl-choice",
    title="Which of a run's policies to keep, where a reward was learned and where there was none",
    cases=[
        {"reward": reward, "chosen by": choice}
        for reward in ("learned", "none")
        for choice in CHOICES
    ],
    run=choose,
    seeds={"quick": 1, "thesis": 10},
    settings={"drives a run": NAVIGATIONS, "settings": settings("nirl")},
)

EXPERIMENTS = (STEPS, CHOICE)
