"""Chapter 5 again: Table 5.1 and 5.2, Fig. 5.4, 5.7, 5.8, 5.10 to 5.12, and the controls that belong beside them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from robonav.robot import Policy, nnql_state, straight, turn_to_clearer_side

from ..runner.experiment import Case, Experiment
from ..runner.results import RESULTS as RESULTS
from .setup import (
    CONTROLS,
    DEMONSTRATIONS,
    ITERATIONS,
    NAVIGATIONS,
    SHOWN_WORLDS,
    SPEED,
    TEST_WORLDS,
    TRAJECTORIES,
    Numbers,
    demonstrations,
    driven,
    learned,
    new_worlds,
    policy,
)
from .tuning import DISCOUNTS, METHODS, trial_settings

CHOSEN: dict[str, dict[float, int]] = {
    "nirl": {0.65: 1, 0.9: 1},
    "apprenticeship": {0.65: 4, 0.9: 4},
    "relative_entropy": {0.65: 7, 0.9: 1},
    "scirl": {0.65: 2, 0.9: 2},
    "cloning": {0.65: 0, 0.9: 5},
}
"""The best trial of each method with each discount; of cloning, which knows none, the better of the two is taken."""

LEARNERS = METHODS[:4]
RULES: dict[str, Policy] = {"freer side": turn_to_clearer_side, "straight": straight}
NUMBERS = (20, 25, 30, 35, 40, 50)
DENSITIES = (5, 10, 15, 20, 25, 30)


def settings(
    method: str, discount: float = 0.65, *, ends: str = "bonus"
) -> dict[str, Any]:
    """What was chosen for a method, see :data:`robonav.experiments.chapter5.tuning.SPACE`; a control takes NIRL's."""
    chosen = method if method in CHOSEN else "nirl"
    found = trial_settings(chosen, CHOSEN[chosen][discount], discount)
    return found if method == "cloning" or ends == "bonus" else found | {"ends": ends}


CLONING = 0.65
"""Which of cloning's two sets of trials the chosen one is from."""


def robot(name: str, seed: int) -> Policy:
    """A rule by its name, or what one run of a method comes to with the settings chosen for it."""
    return RULES[name] if name in RULES else policy(name, seed, settings(name))


def compare(case: Case, seed: int, scale: str) -> Numbers:
    """Table 5.2: one run of a method, a control or a rule."""
    method, worlds = str(case["method"]), new_worlds(scale, seed)
    if method in RULES:
        return driven(RULES[method], worlds)
    discount = CLONING if method == "cloning" else float(case["discount"])
    return driven(policy(method, seed, settings(method, discount)), worlds)


def end(case: Case, seed: int, scale: str) -> Numbers:
    """The same where any end is worth what the mean reward would be for ever: nothing is left but the reward."""
    method, discount = str(case["method"]), float(case["discount"])
    return driven(
        policy(method, seed, settings(method, discount, ends="neutral")),
        new_worlds(scale, seed),
    )


def from_experts(case: Case, seed: int, scale: str) -> Numbers:
    """Table 5.1: NIRL, or plain cloning, from so many demonstrations of one expert or the other."""
    method, number, expert = (
        str(case["method"]),
        int(case["demonstrations"]),
        str(case["expert"]),
    )
    return driven(
        policy(method, seed, settings(method), number, expert), new_worlds(scale, seed)
    )


def count(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 5.4: samples, and different states among them, a trajectory; a state is the 16 numbers of Eq. (4.5)."""
    number = int(case["demonstrations"])
    pairs = demonstrations(seed, number, str(case["expert"])).effective
    states = np.unique(nnql_state(pairs.sensing), axis=0)
    return {"samples": len(pairs) / number, "states": len(states) / number}


def follow(case: Case, seed: int, scale: str, *, metrics: tuple[str, ...]) -> Numbers:
    """Fig. 5.7, 5.8 and 5.11: margin, cost and weight changes of a run, and each at the end: the last 20 iterations."""
    history = learned("nirl", seed, settings("nirl", float(case["discount"]))).history
    series = {
        "margin": history.margins,
        "cost": history.costs,
        "first layer": history.changes[:, 0],
        "second layer": history.changes[:, 1],
    }
    ends = {f"{name} at the end": series[name][-20:].mean() for name in metrics}
    return {name: series[name] for name in metrics} | ends


def at_density(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 5.10: one policy, learned among 20 obstacles at 2 m/s, or a rule, with other obstacles and speeds."""
    method, speed = str(case["method"]), float(case["speed"])
    worlds = new_worlds(scale, seed, int(case["obstacles"]))[: NAVIGATIONS[scale] // 5]
    return driven(robot(method, seed), worlds, speed)


def among_movers(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 5.12: standing and moving obstacles, for a robot that learned among standing ones, or a rule."""
    method = str(case["method"])
    worlds = new_worlds(scale, seed, int(case["standing"]), int(case["moving"]))
    return driven(robot(method, seed), worlds, SPEED)


_ABOUT = {
    "demonstrations": DEMONSTRATIONS,
    "iterations": ITERATIONS,
    "drives an iteration": TRAJECTORIES,
    "drives a run": NAVIGATIONS,
    "first seeds of the worlds": {"shown": SHOWN_WORLDS, "tested": TEST_WORLDS},
    "settings": {
        m: {str(discount): settings(m, discount) for discount in DISCOUNTS}
        for m in METHODS
    },
}


def _cases(methods: Sequence[str], discount: float | str) -> list[Case]:
    return [{"method": method, "discount": discount} for method in methods]


COMPARED = [
    *_cases(LEARNERS, 0.65),
    *_cases(LEARNERS, 0.9),
    *_cases(CONTROLS, 0.65),
    *_cases(("cloning", *RULES), "none"),
]

TABLE_5_1 = Experiment(
    name="table-5.1",
    title="NIRL and cloning from computer and human experts: success in new maps by number of demonstrations",
    cases=[
        {"method": method, "expert": expert, "demonstrations": n}
        for method in ("nirl", "cloning")
        for expert in ("computer", "human")
        for n in (25, 30, 40, 50)
    ],
    run=from_experts,
    seeds={"quick": 1, "thesis": 10},
    thesis={"success": [90, 91, 89, 87, 82, 85, 84, 84, *[None] * 8]},
    settings=_ABOUT,
)
TABLE_5_2 = Experiment(
    name="table-5.2",
    title="NIRL, apprenticeship learning, relative entropy, SCIRL, and what they have to beat: success in new maps",
    cases=COMPARED,
    run=compare,
    seeds={"quick": 2, "thesis": 25},
    thesis={"success": [83, 66, 78, 79, *[None] * (len(COMPARED) - 4)]},
    settings=_ABOUT,
)
ENDINGS = Experiment(
    name="nirl-controls",
    title="Where the end of a drive is worth nothing in itself: each method's reward, none, and one of chance",
    cases=_cases((*LEARNERS, *CONTROLS), 0.65),
    run=end,
    seeds={"quick": 1, "thesis": 10},
    settings=_ABOUT,
)
FIGURE_5_4 = Experiment(
    name="figure-5.4",
    title="Samples and different states a trajectory, by number of demonstrations",
    cases=[
        {"expert": expert, "demonstrations": n}
        for expert in ("computer", "human")
        for n in NUMBERS
    ],
    run=count,
    seeds={"quick": 2, "thesis": 10},
    settings=_ABOUT,
)
FIGURE_5_7 = Experiment(
    name="figure-5.7",
    title="The margin by which the reward prefers the expert, over iterations",
    cases=[{"discount": discount} for discount in DISCOUNTS],
    run=partial(follow, metrics=("margin",)),
    seeds={"quick": 2, "thesis": 10},
    thesis={"margin at the end": [3.0, None]},
    settings=_ABOUT,
)
FIGURE_5_8 = Experiment(
    name="figure-5.8",
    title="The cost of the network, over iterations",
    cases=[{"discount": discount} for discount in DISCOUNTS],
    run=partial(follow, metrics=("cost",)),
    seeds={"quick": 2, "thesis": 10},
    thesis={"cost at the end": [3.23, None]},
    settings=_ABOUT,
)
FIGURE_5_11 = Experiment(
    name="figure-5.11",
    title="What the weights change by in each iteration",
    cases=[{"discount": discount} for discount in DISCOUNTS],
    run=partial(follow, metrics=("first layer", "second layer")),
    seeds={"quick": 2, "thesis": 10},
    settings=_ABOUT,
)
FIGURE_5_10 = Experiment(
    name="figure-5.10",
    title="Success by number of obstacles at three speeds, learned among 20 at 2 m/s; beside cloning and a rule",
    cases=[
        {"method": method, "speed": speed, "obstacles": obstacles}
        for method in ("nirl", "cloning", "freer side")
        for speed in (1.0, 2.0, 3.0)
        for obstacles in DENSITIES
    ],
    run=at_density,
    seeds={"quick": 1, "thesis": 25},
    settings=_ABOUT,
)
FIGURE_5_12 = Experiment(
    name="figure-5.12",
    title="Standing and moving obstacles, learned among standing ones; beside cloning and two rules",
    cases=[
        {"method": method, "standing": standing, "moving": moving}
        for method in ("nirl", "cloning", *RULES)
        for standing, moving in ((20, 0), (10, 10), (0, 20))
    ],
    run=among_movers,
    seeds={"quick": 2, "thesis": 25},
    settings=_ABOUT,
)

EXPERIMENTS = (
    FIGURE_5_4,
    FIGURE_5_7,
    FIGURE_5_8,
    TABLE_5_1,
    FIGURE_5_10,
    FIGURE_5_11,
    FIGURE_5_12,
    TABLE_5_2,
    ENDINGS,
)
