"""GAIL under four rewards, beside behaviour cloning from the same demonstrations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from typing import Any

from robonav.deep import (
    GAILResult,
    constant_reward,
    deceiving_reward,
    hurrying_reward,
    log_odds,
    navigation_task,
    train_gail,
)
from robonav.deep.gail import Reward
from robonav.lfd import Demonstrations, behaviour_cloning, demonstrate
from robonav.nnql import NavigationTask
from robonav.robot import Policy, straight

from ..runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers
from ..runner.setup import Setup
from .ppo import TEMPERATURE
from .setup import CONDITIONS

SETUP = Setup(**CONDITIONS["gail"])
TRAINING: Mapping[str, Any] = CONDITIONS["gail-training"]
"""The updates and the actors; all other settings are the defaults, which are those of PPO. Nothing was tuned."""

REWARDS: dict[str, Reward] = {
    "-log D": deceiving_reward,
    "log(1 - D)": hurrying_reward,
    "log(1 - D) - log D": log_odds,
    "constant 1": constant_reward,
}

LESS = 0.01
"""A weaker regularisation of cloning than that of chapter 3, which was tuned for 25 demonstrations."""

SHIPPED_REWARD, MOST_DEMONSTRATIONS = "-log D", 10
"""Of the policy that ships: the reward that did best on the page, and the most demonstrations that it tries."""

SEEDS = {"quick": 1, "thesis": 10}


@cache
def demonstrations_of_run(number: int, seed: int) -> Demonstrations:
    """Return demonstrations of one run, each in a world of its own."""
    worlds = SETUP.worlds(number, SETUP.tuning_seed + seed)
    return demonstrate(worlds, speed=SETUP.speed, reflex=SETUP.reflex)


def task() -> NavigationTask:
    """Return what GAIL trains on."""
    return navigation_task(
        obstacles=SETUP.obstacles, speed=SETUP.speed, reflex=SETUP.reflex
    )


@cache
def trained(reward: str, number: int, seeds: int) -> GAILResult:
    """Train some seeds at once, each on demonstrations of its own; a seed trains as it would alone."""
    demonstrations = [demonstrations_of_run(number, seed) for seed in range(seeds)]
    return train_gail(
        demonstrations, seeds, task=task(), reward=REWARDS[reward], **TRAINING
    )


def policy(case: Case, seed: int, scale: str) -> Policy:
    """Learn from demonstrations, by the method and under the reward of a case."""
    number = int(case["demonstrations"])
    if case["method"] == "straight":
        return straight
    if case["method"] == "lfd-less-regularised":
        known = demonstrations_of_run(number, seed)
        return behaviour_cloning(known, regularisation=LESS, seed=seed)
    if case["method"] == "lfd":
        return behaviour_cloning(demonstrations_of_run(number, seed), seed=seed)
    result = trained(str(case["reward"]), number, SEEDS[scale])
    return replace(result.policies[seed], temperature=TEMPERATURE)


def run(case: Case, seed: int, scale: str) -> Numbers:
    """Test one seed in new worlds."""
    return SETUP.evaluate(policy(case, seed, scale), SETUP.test_worlds(seed, scale))


CASES: list[Case] = [
    {"method": method, "reward": reward, "demonstrations": number}
    for method, reward, number in (
        *(("gail", reward, 10) for reward in REWARDS),
        *(("gail", "-log D", number) for number in (1, 3)),
        *(("lfd", "no reward", number) for number in (1, 3, 10)),
        *(("lfd-less-regularised", "no reward", number) for number in (1, 3, 10)),
        ("straight", "no reward", 0),
    )
]

EXPERIMENTS = (
    Experiment(
        name="gail",
        title="Success of GAIL under four rewards, and of behaviour cloning",
        cases=CASES,
        run=run,
        seeds=SEEDS,
        settings={
            "navigations a run": SETUP.navigations,
            "obstacles": SETUP.obstacles,
            "training": dict(TRAINING),
            "weaker regularisation": LESS,
        },
        note="D is the discriminator's probability that a step is the learner's. The constant reward is a control: "
        "nothing is learned from the demonstrations.",
        plot=SUCCESS_BARS,
    ),
)
