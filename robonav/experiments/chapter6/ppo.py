"""PPO with one setting changed at a time, as the page on deep reinforcement learning shows it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.deep import PPOResult, navigation_task, train_ppo
from robonav.nnql import NavigationTask
from robonav.robot import Sensing
from robonav.robot.environment_settings import arrival_or_collision

from ..runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers
from ..runner.setup import Setup
from .setup import CONDITIONS

SETUP = Setup(**CONDITIONS["ppo"])
TRAINING: Mapping[str, Any] = CONDITIONS["ppo-training"]
"""The updates and the actors of the page's training; all other settings are the defaults."""

TEMPERATURE = 0.4
"""At which the shipped policy draws its actions, as those of chapter 4 do; in training the temperature is 1."""

SEEDS = {"quick": 1, "thesis": 16}


def wrong_sign(
    before: Sensing, after: Sensing, outcome: NDArray[np.int8]
) -> NDArray[np.float64]:
    """Return the rewards of arrivals and collisions with the wrong sign."""
    return -arrival_or_collision(before, after, outcome)


VARIATIONS: dict[str, dict[str, Any]] = {
    "as on the page": {},
    "hardly clipped, ε = 0.99": {"clip": 0.99},
    "10 epochs": {"epochs": 10},
    "1 epoch": {"epochs": 1},
    "λ = 0": {"trace_decay": 0.0},
    "λ = 1": {"trace_decay": 1.0},
    "no entropy": {"entropy_weight": 0.0},
    "10 times the entropy": {"entropy_weight": 0.3},
    "rewards with the wrong sign": {"reward": wrong_sign},
}
"""What each variation changes of the page's settings."""


def task(**changes: Any) -> NavigationTask:
    """Return what PPO trains on, with some attributes changed."""
    return navigation_task(
        obstacles=SETUP.obstacles, speed=SETUP.speed, reflex=SETUP.reflex, **changes
    )


@cache
def trained(variation: str, seeds: int) -> PPOResult:
    """Train some seeds of a variation at once; a seed trains as it would alone."""
    changes = VARIATIONS[variation]
    of_task = {name: value for name, value in changes.items() if name == "reward"}
    settings = {name: changes[name] for name in changes if name not in of_task}
    return train_ppo(seeds, task=task(**of_task), **TRAINING, **settings)


def vary(case: Case, seed: int, scale: str) -> Numbers:
    """Test one seed of one variation in new worlds, and say what its training took."""
    result = trained(str(case["variation"]), SEEDS[scale])
    rates = SETUP.evaluate(result.policies[seed], SETUP.test_worlds(seed, scale))
    ended, arrived = result.ended[seed], result.arrived[seed]
    made = result.settings
    return rates | {
        "episodes": ended.sum(),
        "steps of the actors": made["updates"] * made["actors"] * made["steps"],
        "steps of Adam": made["updates"] * made["epochs"] * made["batches"],
        "arrivals of an update": 100 * arrived / np.maximum(ended, 1),
    }


EXPERIMENTS = (
    Experiment(
        name="ppo-variations",
        title="Success of PPO with one setting changed at a time",
        cases=[{"variation": name} for name in VARIATIONS],
        run=vary,
        seeds=SEEDS,
        settings={
            "navigations a run": SETUP.navigations,
            "obstacles": SETUP.obstacles,
            "training": dict(TRAINING),
        },
        note="Arrivals of an update: the share of the episodes that ended while the actors acted for it.",
        plot=SUCCESS_BARS,
    ),
)
