"""What a robot does that has learned nothing: the numbers that every table is held against."""

from __future__ import annotations

from robonav.robot import (
    Policy,
    navigate,
    random_worlds,
    straight,
    turn_to_clearer_side,
)

from .outcome_rates import rates
from .runner.experiment import Case, Experiment

RULES: dict[str, Policy] = {"straight": straight, "freer side": turn_to_clearer_side}
SEED = 9_000  # of the worlds; run k drives through those of SEED + k
WORLDS = {"quick": 100, "thesis": 1000}


def drive(case: Case, seed: int, scale: str) -> dict[str, float]:
    """How drives through one batch of worlds end."""
    worlds = random_worlds(
        WORLDS[scale], int(case["standing"]), int(case["moving"]), seed=SEED + seed
    )
    return rates(navigate(RULES[str(case["rule"])], worlds, float(case["speed"])))


YARDSTICKS = Experiment(
    name="yardsticks",
    title="Robots that have learned nothing: straight on, and a rule of three lines",
    cases=[
        {"rule": rule, "standing": standing, "moving": moving, "speed": speed}
        for rule in RULES
        for standing, moving, speed in (
            (10, 0, 2.0),
            (10, 0, 2.5),
            (20, 0, 2.0),
            (30, 0, 2.0),
            (10, 10, 2.0),
        )
    ],
    run=drive,
    seeds={"quick": 5, "thesis": 25},
    settings={"worlds a run": WORLDS, "first seed of the worlds": SEED},
)

EXPERIMENTS = (YARDSTICKS,)
