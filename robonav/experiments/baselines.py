"""The baselines as an experiment. Every table is compared with these policies, which have learned nothing."""

from __future__ import annotations

from robonav.benchmark import BASELINES, EXACT_REFLEX, outcome_rates
from robonav.robot import navigate, random_worlds

from .runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers

FIRST_SEED = 9_000  # run k is tested in the worlds of this seed + k
WORLDS = {"quick": 100, "thesis": 1000}


def evaluate_baseline(case: Case, seed: int, scale: str) -> Numbers:
    """Outcome rates of a baseline in one batch of worlds."""
    worlds = random_worlds(
        WORLDS[scale],
        int(case["obstacles"]),
        int(case["moving"]),
        seed=FIRST_SEED + seed,
    )
    policy = BASELINES[str(case["method"])]
    speed = float(case["speed"])
    return outcome_rates(navigate(policy, worlds, speed, reflex=EXACT_REFLEX))


EXPERIMENTS = (
    Experiment(
        name="baselines",
        title="Outcomes of two baselines: straight ahead, and turning to the clearer side",
        cases=[
            {"method": name, "obstacles": obstacles, "moving": moving, "speed": speed}
            for name in BASELINES
            for obstacles, moving, speed in (
                (10, 0, 2.0),
                (10, 0, 2.5),
                (20, 0, 2.0),
                (30, 0, 2.0),
                (10, 10, 2.0),
            )
        ],
        run=evaluate_baseline,
        seeds={"quick": 5, "thesis": 25},
        settings={"worlds a run": WORLDS, "first seed of the worlds": FIRST_SEED},
        plot=SUCCESS_BARS,
    ),
)
