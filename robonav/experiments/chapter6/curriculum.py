"""PPO goes on to learn, stage by stage: longer, in harder worlds, and then with smaller steps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

from robonav.deep import PPOResult, navigation_task, train_ppo
from robonav.nnql import NavigationTask

from ..runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers
from ..runner.setup import Setup
from .setup import CONDITIONS

SETUP = Setup(**CONDITIONS["curriculum"])
HARD = {"obstacles": 30, "moving": 6}
STAGES: Mapping[str, tuple[Mapping[str, int], Mapping[str, Any]]] = {
    "1. ten obstacles": ({"obstacles": 10}, CONDITIONS["curriculum-1"]),
    "2. longer, in hard worlds": (HARD, CONDITIONS["curriculum-2"]),
    "3. smaller steps": (HARD, CONDITIONS["curriculum-3"]),
    "4. smaller still": (HARD, CONDITIONS["curriculum-4"]),
}
"""The worlds of each stage, and its settings. A stage goes on with the networks of the stage before."""

CONTROLS: Mapping[str, tuple[str, Mapping[str, int]]] = {
    "as long, in ten obstacles": ("1. ten obstacles", {"obstacles": 10}),
}
"""What goes on with the networks of which stage, and in which worlds. The settings are those of stage 2."""

HIDDEN = (64,)
SEEDS = {"quick": 1, "thesis": 10}
SEEDS_APART = 1000  # between two stages, so that a robot meets other worlds in each

SETTINGS: Mapping[str, Mapping[str, int]] = {
    "20 obstacles": {"obstacles": 20},
    "30 obstacles": {"obstacles": 30},
    "10 and 10 moving": {"obstacles": 10, "moving": 10},
}
"""The worlds of the tests."""


def task(worlds: Mapping[str, int]) -> NavigationTask:
    """Return what a stage trains on."""
    return navigation_task(speed=SETUP.speed, reflex=SETUP.reflex, **worlds)


@cache
def trained(stage: str, seeds: tuple[int, ...], scale: str) -> PPOResult:
    """Train some seeds at once up to the end of a stage; a seed trains as it would alone."""
    before = list(STAGES)[: list(STAGES).index(stage)]
    return continued(before, *STAGES[stage], seeds, scale)


@cache
def control(name: str, seeds: tuple[int, ...], scale: str) -> PPOResult:
    """Train some seeds at once as a control, which changes less than a stage does."""
    last, worlds = CONTROLS[name]
    before = list(STAGES)[: list(STAGES).index(last) + 1]
    return continued(before, worlds, CONDITIONS["curriculum-2"], seeds, scale)


def continued(
    before: Sequence[str],
    worlds: Mapping[str, int],
    settings: Mapping[str, Any],
    seeds: tuple[int, ...],
    scale: str,
) -> PPOResult:
    """Train in some worlds, from the networks of the last of the stages before, or from random ones."""
    start = trained(before[-1], seeds, scale) if before else None
    updates = settings["updates"][scale]
    return train_ppo(
        [seed + SEEDS_APART * len(before) for seed in seeds],
        task=task(worlds), hidden=HIDDEN, start=start, **{**settings, "updates": updates},
    )  # fmt: skip


def run(case: Case, seed: int, scale: str) -> Numbers:
    """Test one seed after one stage, or after one control, in new worlds."""
    seeds = tuple(range(SEEDS[scale]))
    if "stage" in case:
        result = trained(str(case["stage"]), seeds, scale)
    else:
        result = control(str(case["control"]), seeds, scale)
    worlds = SETUP.test_worlds(seed, scale, **SETTINGS[str(case["setting"])])
    return SETUP.evaluate(result.policies[seed], worlds)


EXPERIMENTS = (
    Experiment(
        name="ppo-curriculum",
        title="Success of PPO that goes on to learn in harder worlds",
        cases=[
            {"stage": stage, "setting": setting}
            for stage in STAGES
            for setting in SETTINGS
        ],
        run=run,
        seeds=SEEDS,
        settings={
            "navigations a run": SETUP.navigations,
            "hidden units": list(HIDDEN),
            "stages": {
                stage: {"worlds": dict(worlds), **settings}
                for stage, (worlds, settings) in STAGES.items()
            },
        },
        shortened="A quick run has two updates in each stage.",
        note="A stage goes on with the networks of the stage before. Nine sensors, no map, 2 m/s.",
        plot=SUCCESS_BARS,
    ),
    Experiment(
        name="ppo-curriculum-control",
        title="Success of PPO that trains as long as in stage 2, and in ten obstacles",
        cases=[
            {"control": name, "setting": setting}
            for name in CONTROLS
            for setting in SETTINGS
        ],
        run=run,
        seeds=SEEDS,
        settings={
            "navigations a run": SETUP.navigations,
            "hidden units": list(HIDDEN),
            "controls": {
                name: {"after": before, "worlds": dict(worlds)}
                for name, (before, worlds) in CONTROLS.items()
            },
            "stage 1": dict(CONDITIONS["curriculum-1"]),
            "stage 2": dict(CONDITIONS["curriculum-2"]),
        },
        shortened="A quick run has two updates in each stage.",
        note="The control makes as many steps as stage 2 with the same settings, and leaves out its hard worlds.",
        plot=SUCCESS_BARS,
    ),
)
