"""Tables 5.1 and 5.2, Figs. 5.4, 5.7, 5.8 and 5.10 to 5.12, and controls to compare them with."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from robonav.benchmark import display_name
from robonav.robot import nnql_state

from ..runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers, Plot
from .setup import (
    CONTROLS,
    DEFAULTS,
    DEMONSTRATION_SEED,
    DEMONSTRATIONS,
    DISCOUNT,
    EPISODES_PER_ITERATION,
    ITERATIONS,
    LEARNERS,
    METHODS,
    OTHER_DISCOUNT,
    SETUP,
    demonstrations,
    trained,
    trained_policy,
    tuned,
)

DISCOUNTS = (DISCOUNT, OTHER_DISCOUNT)
NUMBERS = (20, 25, 30, 35, 40, 50)
DENSITIES = (5, 10, 15, 20, 25, 30)


def compare(case: Case, seed: int, scale: str) -> Numbers:
    """Table 5.2: one run of a method, a control or a baseline."""
    method = str(case["method"])
    with_discount = method in (*LEARNERS, *CONTROLS)
    settings = tuned(method, float(case["discount"])) if with_discount else None
    policy = trained_policy(method, seed, settings)
    return SETUP.evaluate(policy, SETUP.test_worlds(seed, scale))


def compare_without_bonus(case: Case, seed: int, scale: str) -> Numbers:
    """Table 5.2 with neutral terminal values, so that the learned reward alone determines the behaviour."""
    method, discount = str(case["method"]), float(case["discount"])
    settings = tuned(method, discount, terminal_values="neutral")
    policy = trained_policy(method, seed, settings)
    return SETUP.evaluate(policy, SETUP.test_worlds(seed, scale))


def from_experts(case: Case, seed: int, scale: str) -> Numbers:
    """Table 5.1: NIRL or cloning, from a number of demonstrations of one expert."""
    policy = trained_policy(
        str(case["method"]),
        seed,
        number=int(case["demonstrations"]),
        expert=str(case["expert"]),
    )
    return SETUP.evaluate(policy, SETUP.test_worlds(seed, scale))


def count_samples(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 5.4: samples and distinct states in a trajectory. A state is the 16 numbers of Eq. (4.5)."""
    number = int(case["demonstrations"])
    pairs = demonstrations(seed, number, str(case["expert"])).effective
    states = np.unique(nnql_state(pairs.sensing), axis=0)
    return {"samples": len(pairs) / number, "states": len(states) / number}


def over_iterations(
    case: Case, seed: int, scale: str, *, metrics: tuple[str, ...]
) -> Numbers:
    """Figs. 5.7, 5.8 and 5.11: margin, cost and weight changes of a run with the default settings of NIRL.

    "At the end" is the mean of the last 20 iterations.
    """
    settings = DEFAULTS | {"discount": float(case["discount"])}
    history = trained("nirl", seed, settings).history
    series = {
        "margin": history.margins,
        "cost": history.costs,
        "first layer": history.changes[:, 0],
        "second layer": history.changes[:, 1],
    }
    ends = {f"{name} at the end": series[name][-20:].mean() for name in metrics}
    return {name: series[name] for name in metrics} | ends


def at_density(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 5.10: a policy trained with 20 obstacles at 2 m/s, or a baseline, with other obstacles and speeds."""
    worlds = SETUP.test_worlds(seed, scale, int(case["obstacles"]))
    fewer = worlds[: SETUP.navigations[scale] // 5]
    policy = trained_policy(str(case["method"]), seed)
    return SETUP.evaluate(policy, fewer, float(case["speed"]))


def among_moving_obstacles(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 5.12: standing and moving obstacles, for a robot trained with standing ones, or a baseline."""
    worlds = SETUP.test_worlds(seed, scale, int(case["obstacles"]), int(case["moving"]))
    return SETUP.evaluate(trained_policy(str(case["method"]), seed), worlds)


def _tuned_by_discount(method: str) -> dict[str, Any]:
    if method == "lfd":
        return dict(tuned(method))
    return {str(discount): dict(tuned(method, discount)) for discount in DISCOUNTS}


_ABOUT = {
    "demonstrations": DEMONSTRATIONS,
    "iterations": ITERATIONS,
    "episodes an iteration": EPISODES_PER_ITERATION,
    "navigations a run": SETUP.navigations,
    "first seeds of the worlds": {
        "demonstrations": DEMONSTRATION_SEED,
        "tests": SETUP.test_seed,
    },
    "settings": {method: _tuned_by_discount(method) for method in METHODS},
}
_ABOUT_ITERATIONS = {
    key: _ABOUT[key]
    for key in ("demonstrations", "iterations", "episodes an iteration")
} | {"settings": dict(DEFAULTS)}


def _cases(methods: Sequence[str], discount: float | str) -> list[Case]:
    return [{"method": method, "discount": discount} for method in methods]


def _inputs_of_methods() -> str:
    """Return the sentence on what the networks of Table 5.2 read: each method has the encoding of its best trial."""
    by_target: dict[str, list[str]] = {}
    for method in METHODS:
        target = str(tuned(method)["target"])
        by_target.setdefault(target, []).append(display_name(method))
    groups = [f"{', '.join(names)}: {target}" for target, names in by_target.items()]
    return (
        "All networks read seven sensors, their wall flags, whether the target is seen, and its sector, in the "
        f"encoding of the method's best trial ({'; '.join(groups)})."
    )


# The order of the baselines differs from that of the other tables; the order of results is kept.
_BASELINES = ("freer-side", "straight")

COMPARED = [
    *_cases(LEARNERS, DISCOUNT),
    *_cases(LEARNERS, OTHER_DISCOUNT),
    *_cases(CONTROLS, DISCOUNT),
    *_cases(("lfd", *_BASELINES), "none"),
]

TABLE_5_1 = Experiment(
    name="table-5.1",
    title="Success in new maps by number of demonstrations: NIRL and cloning, from computer and human experts",
    cases=[
        {"method": method, "expert": expert, "demonstrations": n}
        for method in ("nirl", "lfd")
        for expert in ("computer", "human")
        for n in (25, 30, 40, 50)
    ],
    run=from_experts,
    seeds={"quick": 1, "thesis": 10},
    thesis={"success": [90, 91, 89, 87, 82, 85, 84, 84, *[None] * 8]},
    settings=_ABOUT,
    plot=SUCCESS_BARS,
)
TABLE_5_2 = Experiment(
    name="table-5.2",
    title="Success in new maps: NIRL, apprenticeship learning, relative entropy, SCIRL, cloning, and baselines",
    cases=COMPARED,
    run=compare,
    seeds={"quick": 2, "thesis": 25},
    thesis={"success": [83, 66, 78, 79, *[None] * (len(COMPARED) - 4)]},
    settings=_ABOUT,
    note=_inputs_of_methods(),
    plot=Plot("nirl.plot_comparison", discount=DISCOUNT),
)
WITHOUT_BONUS = Experiment(
    name="nirl-controls",
    title="Success without a bonus at the end of an episode: learned rewards, no reward, and a random reward",
    cases=_cases((*LEARNERS, *CONTROLS), DISCOUNT),
    run=compare_without_bonus,
    seeds={"quick": 1, "thesis": 10},
    settings=_ABOUT,
    plot=SUCCESS_BARS,
)
FIGURE_5_4 = Experiment(
    name="figure-5.4",
    title="Samples and distinct states in a trajectory, by number of demonstrations",
    cases=[
        {"expert": expert, "demonstrations": n}
        for expert in ("computer", "human")
        for n in NUMBERS
    ],
    run=count_samples,
    seeds={"quick": 2, "thesis": 10},
    settings=_ABOUT,
    plot=Plot("nirl.plot_counts"),
)
FIGURE_5_7 = Experiment(
    name="figure-5.7",
    title="Margin by which the reward prefers the expert, over iterations",
    cases=[{"discount": discount} for discount in DISCOUNTS],
    run=partial(over_iterations, metrics=("margin",)),
    seeds={"quick": 2, "thesis": 10},
    thesis={"margin at the end": [3.0, None]},
    settings=_ABOUT_ITERATIONS,
    plot=Plot("nirl.plot_iterations", metric="margin", label="margin"),
)
FIGURE_5_8 = Experiment(
    name="figure-5.8",
    title="Cost of the network, over iterations",
    cases=[{"discount": discount} for discount in DISCOUNTS],
    run=partial(over_iterations, metrics=("cost",)),
    seeds={"quick": 2, "thesis": 10},
    thesis={"cost at the end": [3.23, None]},
    settings=_ABOUT_ITERATIONS,
    plot=Plot("nirl.plot_iterations", metric="cost", label="cost"),
)
FIGURE_5_11 = Experiment(
    name="figure-5.11",
    title="Changes of the weights in each iteration",
    cases=[{"discount": discount} for discount in DISCOUNTS],
    run=partial(over_iterations, metrics=("first layer", "second layer")),
    seeds={"quick": 2, "thesis": 10},
    settings=_ABOUT_ITERATIONS,
    plot=Plot("nirl.plot_changes"),
)
FIGURE_5_10 = Experiment(
    name="figure-5.10",
    title="Success by number of obstacles at three speeds: NIRL and cloning, trained with 20 at 2 m/s, and a baseline",
    cases=[
        {"method": method, "speed": speed, "obstacles": obstacles}
        for method in ("nirl", "lfd", "freer-side")
        for speed in (1.0, 2.0, 3.0)
        for obstacles in DENSITIES
    ],
    run=at_density,
    seeds={"quick": 1, "thesis": 25},
    settings=_ABOUT,
    plot=Plot("nirl.plot_densities"),
)
FIGURE_5_12 = Experiment(
    name="figure-5.12",
    title="Success with standing and moving obstacles: NIRL and cloning, trained with standing ones, and two baselines",
    cases=[
        {"method": method, "obstacles": obstacles, "moving": moving}
        for method in ("nirl", "lfd", *_BASELINES)
        for obstacles, moving in ((20, 0), (10, 10), (0, 20))
    ],
    run=among_moving_obstacles,
    seeds={"quick": 2, "thesis": 25},
    settings=_ABOUT,
    plot=SUCCESS_BARS,
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
    WITHOUT_BONUS,
)
