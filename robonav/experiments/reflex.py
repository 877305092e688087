"""What it costs a robot to know only the sector of its target, and not the target's exact direction."""

from __future__ import annotations

from functools import lru_cache

from robonav.benchmark import BASELINES, outcome_rates
from robonav.robot import Navigation, Policy, Reflex, navigate

from .chapter3 import setup as setup3
from .chapter4 import setup as setup4
from .chapter5 import setup as setup5
from .runner.experiment import Case, Experiment, Numbers, Plot
from .runner.setup import Setup

WORLDS = 400  # in which a run is tested
SETUPS: dict[int, Setup] = {3: setup3.SETUP, 4: setup4.SETUP, 5: setup5.SETUP}
LEARNED = {3: ("lfd", "dagger"), 4: ("nnql",), 5: ("nirl",)}
"""The learned policies by chapter: those of Fig. 3.8, Table 4.3 and Table 5.2, under the conditions of the chapter."""


def trained_policy(name: str, seed: int, scale: str, reflex: Reflex) -> Policy:
    """Return a baseline, or the policy of one training, whose robot has a reflex."""
    if name in BASELINES:
        return BASELINES[name]
    if name == "lfd":
        return setup3.cloned_policy(seed, reflex=reflex)
    if name == "dagger":
        return setup3.dagger_result(seed, reflex=reflex).policy
    if name == "nnql":
        return setup4.trained_policy(name, seed, scale, reflex=reflex)
    return _nirl_policy(seed, reflex)


@lru_cache(maxsize=4)
def _nirl_policy(seed: int, reflex: Reflex) -> Policy:
    settings = setup5.tuned("nirl")
    return setup5.train_irl(
        "nirl",
        setup5.demonstrations(seed, reflex=reflex),
        seed,
        settings,
        task=setup5.task(settings["target"], reflex=reflex),
    ).policy


def compare_directions(case: Case, seed: int, scale: str) -> Numbers:
    """One training of a policy with a reflex, tested with a reflex; and what it loses against exact directions."""
    name, chapter = str(case["method"]), int(case["chapter"])
    exact, test = Reflex("exact"), Reflex(str(case["reflex in test"]))
    training = exact if name in BASELINES else Reflex(str(case["reflex in training"]))
    reached = test_episodes(name, chapter, seed, scale, training, test)
    rates = outcome_rates(reached)
    numbers = rates | {"seconds to the target": reached.steps[reached.success].mean()}
    if (training, test) == (exact, exact):
        return numbers
    usual = outcome_rates(test_episodes(name, chapter, seed, scale, exact, exact))
    return numbers | {"points lost": usual["success"] - rates["success"]}


def test_episodes(
    name: str, chapter: int, seed: int, scale: str, training: Reflex, test: Reflex
) -> Navigation:
    """Return the episodes of a policy in the test worlds of a chapter, the same for all reflexes."""
    setup = SETUPS[chapter]
    policy = trained_policy(name, seed, scale, training)
    worlds = setup.worlds(WORLDS, setup.test_seed + seed)
    return navigate(policy, worlds, setup.speed, setup.max_steps, reflex=test)


def _cases() -> list[Case]:
    """A learned policy trains with either reflex; a baseline does not train."""
    return [
        {
            "chapter": chapter,
            "method": name,
            "reflex in training": training,
            "reflex in test": test,
        }
        for chapter, learned in LEARNED.items()
        for name in (*BASELINES, *learned)
        for training, test in (
            (("none", "exact"), ("none", "sector"))
            if name in BASELINES
            else (("exact", "exact"), ("exact", "sector"), ("sector", "sector"))
        )
    ]


EXPERIMENTS = (
    Experiment(
        name="reflex-direction",
        title="Success of robots whose reflex knows the exact direction of the target, or only its sector",
        cases=_cases(),
        run=compare_directions,
        seeds={"quick": 1, "thesis": 24},
        settings={
            "worlds a run": WORLDS,
            "conditions by chapter": {
                str(chapter): {
                    "obstacles": setup.obstacles,
                    "speed in m/s": setup.speed,
                    "first seed of the worlds": setup.test_seed,
                }
                for chapter, setup in SETUPS.items()
            },
            "settings": {
                "nnql": dict(setup4.tuned()["nnql"]),
                "nirl": dict(setup5.tuned("nirl")),
            },
        },
        plot=Plot("experiments.draw_points_lost"),
    ),
)
