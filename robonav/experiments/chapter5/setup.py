"""The conditions of section 5.6, which all experiments of chapter 5 share.

A run is one seed: demonstrations of its own, a network trained from them, and new worlds to drive through. Worlds that
an expert shows, worlds to tune on and worlds to test on never meet; those a robot practises in are drawn from its seed.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.lfd import (
    Demonstrations,
    demonstrate,
    demonstrate_by_hand,
    learn_policy,
    sketch,
)
from robonav.lfd.demonstrations import LEARNED
from robonav.networks import NetworkPolicy
from robonav.nirl import (
    NEUTRAL_TERMINAL_VALUES,
    SURVIVAL_BONUS,
    Learned,
    ReplaySGD,
    RobotTask,
    SubgradientMaxMargin,
    from_all_states,
    from_initial_state,
    heuristic_estimate,
    learn,
    learn_under_reward,
    lstd_estimate,
)
from robonav.robot import NNQL_SENSORS, Encoder, Policy, Worlds, navigate, random_worlds

from ..outcome_rates import rates

ITERATIONS, TRAJECTORIES = 140, 10
SHORTENED = {
    "quick": 0.1,
    "thesis": 1.0,
}  # of a training, in experiments that have very many
NAVIGATIONS = {"quick": 100, "thesis": 1000}
DEMONSTRATIONS, OBSTACLES, SPEED = 30, 20, 2.0
SHOWN_WORLDS = 50_000  # run k's expert drives through the worlds of this seed + k
TEST_WORLDS = 60_000  # run k drives through those of this seed + k

Numbers = Mapping[str, ArrayLike]
Settings = Mapping[str, Any]

ENDS = {"bonus": SURVIVAL_BONUS, "neutral": NEUTRAL_TERMINAL_VALUES}
EXPECTATIONS = {"everywhere": from_all_states, "start": from_initial_state}
ESTIMATES = {"lstd": lstd_estimate, "heuristic": heuristic_estimate}
CONTROLS = ("zero reward", "random reward")


@lru_cache(maxsize=256)
def demonstrations(
    seed: int, number: int = DEMONSTRATIONS, expert: str = "computer"
) -> Demonstrations:
    """What an expert, "computer" or "human", shows a run, each drive in a map of its own."""
    worlds = random_worlds(number, OBSTACLES, seed=SHOWN_WORLDS + seed)
    if expert == "human":
        return demonstrate_by_hand(worlds, sketch(worlds, seed=seed), speed=SPEED)
    return demonstrate(worlds, speed=SPEED)


def encoder(target: str) -> Encoder:
    """phi(s) of section 5.4.1, the target's sector written in one way or another."""
    return Encoder(NNQL_SENSORS, walls=True, target=target)


def course(target: str = "sine-cosine", **changes: Any) -> RobotTask:
    """Where a robot practises: 20 obstacles, 2 m/s, ten drives an iteration."""
    return RobotTask(TRAJECTORIES, encoder=encoder(target), **changes)


def descent(settings: Settings) -> ReplaySGD:
    """The solver that all methods share."""
    return ReplaySGD(
        discount=settings["discount"],
        rate=tuple(settings["rate"]),
        samples=settings["samples"],
        replay=settings["replay"],
        ends=ENDS[settings.get("ends", "bonus")],
    )


_OWN: dict[str, Callable[[Settings], dict[str, Any]]] = {
    "nirl": lambda s: {"reward": SubgradientMaxMargin(power=s["power"])},
    "apprenticeship": lambda s: {
        "expectations": EXPECTATIONS[s["expectations"]],
        "guesses": s["guesses"],
    },
    "relative_entropy": lambda s: {"horizon": s["horizon"], "slack": s["slack"]},
    "scirl": lambda s: {
        "estimate": ESTIMATES[s["estimate"]],
        "power": s["power"],
        "ridge": s["ridge"],
    },
}
"""What each method has of its own, from its settings."""


def teach(
    method: str,
    shown: Demonstrations,
    seed: int,
    settings: Settings,
    *,
    length: float = 1.0,
    **changes: Any,
) -> Learned:
    """Learn from demonstrations, or practise under a reward of zero or of chance, with settings by name.

    ``length`` is of the training, in times the usual; ``changes`` go to the method.
    """
    iterations = round(ITERATIONS * length)
    practice: dict[str, Any] = {
        "course": course(settings["target"]),
        "improve": descent(settings),
        "iterations": iterations,
        "eta": settings["eta"],
        "hidden": settings["hidden"],
    }
    if method in CONTROLS:
        return learn_under_reward(
            shown,
            control(method, seed, practice["course"].inputs),
            seed=seed,
            **practice,
        )
    own = _OWN[method](settings)
    if "guesses" in own:
        own["guesses"] = min(own["guesses"], iterations)
    return learn(shown, method, seed, **own, **practice, **changes)


def control(name: str, seed: int, inputs: int) -> NDArray[np.float64]:
    """The reward (5, k + 1) of a control: zero, or drawn by chance."""
    shape = (LEARNED, inputs + 1)
    return (
        np.zeros(shape)
        if name == "zero reward"
        else np.random.default_rng([seed, 5]).normal(size=shape)
    )


def clone(shown: Demonstrations, seed: int, settings: Settings) -> NetworkPolicy:
    """Plain cloning: the expert's decisions as examples, as in chapter 3."""
    return learn_policy(
        shown,
        settings["hidden"],
        settings["regularisation"],
        settings["iterations"],
        seed,
        encoder=encoder(settings["target"]),
    )


def learned(
    method: str,
    seed: int,
    settings: Settings,
    number: int = DEMONSTRATIONS,
    expert: str = "computer",
    *,
    length: float = 1.0,
) -> Learned:
    """One run of a method or control; what was learned once in a process is not learned again."""
    return _learned(
        method, seed, json.dumps(settings, sort_keys=True), number, expert, length
    )


@lru_cache(maxsize=300)
def _learned(
    method: str, seed: int, settings: str, number: int, expert: str, length: float
) -> Learned:
    return teach(
        method,
        demonstrations(seed, number, expert),
        seed,
        json.loads(settings),
        length=length,
    )


def policy(
    method: str,
    seed: int,
    settings: Settings,
    number: int = DEMONSTRATIONS,
    expert: str = "computer",
    *,
    length: float = 1.0,
) -> NetworkPolicy:
    """The policy of one run of a method, a control or cloning; what was learned once is not learned again."""
    if method == "cloning":
        return _cloned(seed, json.dumps(settings, sort_keys=True), number, expert)
    return learned(method, seed, settings, number, expert, length=length).policy


@lru_cache(maxsize=300)
def _cloned(seed: int, settings: str, number: int, expert: str) -> NetworkPolicy:
    return clone(demonstrations(seed, number, expert), seed, json.loads(settings))


def new_worlds(
    scale: str, seed: int, obstacles: int = OBSTACLES, moving: int = 0
) -> Worlds:
    """Worlds to test in."""
    return random_worlds(NAVIGATIONS[scale], obstacles, moving, seed=TEST_WORLDS + seed)


def driven(robot: Policy, worlds: Worlds, speed: float = SPEED) -> dict[str, float]:
    """How drives of 500 steps at most end, in per cent."""
    return rates(navigate(robot, worlds, speed))
