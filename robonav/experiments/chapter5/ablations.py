"""Readings of Algorithm 10, changes from one to the next, and the choice among the policies of a run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from robonav.networks import NetworkPolicy
from robonav.nirl import (
    ZERO_TERMINAL_VALUES,
    FullBatchDescent,
    IRLResult,
    LeastSquaresReward,
    ReplaySGD,
    SubgradientMaxMargin,
    accuracy,
    balanced_accuracy,
    learn,
)
from robonav.nirl.reward_update import RewardUpdate
from robonav.robot import Worlds, navigate

from ..runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers, Plot
from .setup import (
    CONDITIONS,
    ITERATIONS,
    SETUP,
    SHORTENED,
    demonstrations,
    task,
    trained,
    tuned,
)

CHOOSING_SEED: int = CONDITIONS["choosing_seed"]
EVERY = (
    5  # every fifth policy of a run is tested, if navigation in other worlds chooses
)

_FAST = ReplaySGD(gradient_step=(0.4, 0.4), terminal_values=ZERO_TERMINAL_VALUES)
CHANGES: dict[str, Mapping[str, Any]] = {
    "Algorithm 10, one gradient step an iteration": {
        "reward_update": LeastSquaresReward(),
        "improver": FullBatchDescent(),
        "score": accuracy,
        "target": "number",
    },
    "reward: feature gaps in the expert's states": {
        "reward_update": SubgradientMaxMargin(power=0.0)
    },
    "300 steps on the latest episodes, rewards scaled to [0, 1]": {
        "improver": replace(_FAST, n_samples=300, replay=1)
    },
    "9,600 steps, episodes of 20 iterations": {"improver": _FAST},
    "each action has the same total weight": {"reward_update": SubgradientMaxMargin()},
    "policy chosen by balanced accuracy": {"score": balanced_accuracy},
    "target's sector as sine and cosine": {"target": "sine-cosine"},
    "terminal values reward survival": {
        "improver": ReplaySGD(gradient_step=(0.4, 0.4))
    },
    "gradient step falls": {"improver": ReplaySGD()},
    "discount 0.9": {"improver": ReplaySGD(discount=0.9)},
}
"""The options that each change sets, in addition to all changes before it."""


def options_up_to(change: str) -> dict[str, Any]:
    """Return the options after a change and all changes before it."""
    names = list(CHANGES)
    merged: dict[str, Any] = {}
    for name in names[: names.index(change) + 1]:
        merged |= CHANGES[name]
    return merged


def ablation(case: Case, seed: int, scale: str) -> Numbers:
    """One run after a number of changes."""
    options = options_up_to(str(case["change"]))
    where = task(options.pop("target"))
    trajectories = demonstrations(seed)
    learned = learn(
        trajectories, "nirl", seed, task=where, iterations=ITERATIONS, **options
    )
    return SETUP.evaluate(learned.policy, SETUP.test_worlds(seed, scale))


def policy_at(learned: IRLResult, k: int) -> NetworkPolicy:
    """Return the policy of a run after iteration k."""
    return replace(learned.policy, network=learned.history.networks[k])


def best_by_navigation(learned: IRLResult, worlds: Worlds) -> int:
    """Return the iteration, among every fifth one, whose policy has the greatest success in some worlds."""
    tried = range(0, len(learned.history.accuracies), EVERY)
    success = [
        navigate(policy_at(learned, k), worlds, reflex=SETUP.reflex).success.mean()
        for k in tried
    ]
    return tried[int(np.argmax(success))]


REWARDS: dict[str, RewardUpdate] = {
    "least squares, (5.14)": LeastSquaresReward(),
    "feature gaps": SubgradientMaxMargin(power=0.0),
}
"""Line 5 of Algorithm 10 as printed, and as this book has it."""
GRADIENT_STEPS = (1, 3, 10, 30, 100, 300)


def gradient_steps(case: Case, seed: int, scale: str) -> Numbers:
    """One run of Algorithm 10 with a number of gradient steps an iteration, which the thesis leaves open.

    All else is as printed: the targets are computed once an iteration, the rewards are not scaled, the sector of the
    target is a number, and accuracy chooses the policy.
    """
    learned = learn(
        demonstrations(seed),
        "nirl",
        seed,
        task=task("number"),
        iterations=round(ITERATIONS * SHORTENED[scale]),
        reward_update=REWARDS[str(case["reward"])],
        improver=FullBatchDescent(int(case["gradient steps"])),
        score=accuracy,
    )
    return SETUP.evaluate(learned.policy, SETUP.test_worlds(seed, scale))


CHOICES: dict[str, Callable[[IRLResult, Worlds], int]] = {
    "accuracy": lambda learned, worlds: int(learned.history.accuracies.argmax()),
    "balanced accuracy": lambda learned, worlds: int(learned.history.balanced.argmax()),
    "the last": lambda learned, worlds: len(learned.history.accuracies) - 1,
    "navigation": best_by_navigation,
}


def choose_policy(case: Case, seed: int, scale: str) -> Numbers:
    """Test one run with a learned or a zero reward, and with its policy chosen in one of four ways."""
    method = "nirl" if case["reward"] == "learned" else "zero-reward"
    learned = trained(method, seed, tuned(method))
    worlds = SETUP.worlds(SETUP.navigations[scale] // 5, CHOOSING_SEED + seed)
    k = CHOICES[str(case["chosen by"])](learned, worlds)
    rates = SETUP.evaluate(policy_at(learned, k), SETUP.test_worlds(seed, scale))
    return rates | {
        "accuracy": 100 * learned.history.accuracies[k],
        "balanced accuracy": 100 * learned.history.balanced[k],
    }


STEPS = Experiment(
    name="nirl-steps",
    title="Success of NIRL after each change from Algorithm 10 with one gradient step an iteration",
    cases=[{"change": change} for change in CHANGES],
    run=ablation,
    seeds={"quick": 1, "thesis": 10},
    settings={"iterations": ITERATIONS, "navigations a run": SETUP.navigations},
    plot=Plot("nirl.plot_steps"),
)
GRADIENT_STEPS_OF_ALGORITHM_10 = Experiment(
    name="nirl-gradient-steps",
    title="Success of Algorithm 10 by its number of gradient steps an iteration, which the thesis leaves open",
    cases=[
        {"reward": reward, "gradient steps": steps}
        for reward in REWARDS
        for steps in GRADIENT_STEPS
    ],
    run=gradient_steps,
    seeds={"quick": 1, "thesis": 10},
    shortened="a tenth of the iterations",
    settings={"iterations": ITERATIONS, "navigations a run": SETUP.navigations},
    plot=Plot("nirl.plot_gradient_steps"),
)
CHOICE = Experiment(
    name="nirl-choice",
    title="Success by the rule that chooses one policy of a run, with a learned reward and with none",
    cases=[
        {"reward": reward, "chosen by": choice}
        for reward in ("learned", "none")
        for choice in CHOICES
    ],
    run=choose_policy,
    seeds={"quick": 1, "thesis": 10},
    settings={
        "navigations a run": SETUP.navigations,
        "settings": dict(tuned("nirl")),
    },
    plot=SUCCESS_BARS,
)

EXPERIMENTS = (STEPS, GRADIENT_STEPS_OF_ALGORITHM_10, CHOICE)
