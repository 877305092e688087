"""The policies of the book in a robot with a body, and what randomised simulators do for a policy."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from robonav.benchmark import board_worlds, outcome_rates
from robonav.benchmark import method as policy_of
from robonav.robot import Policy, Reflex, Simulator, Worlds, navigate_in

from ..runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers
from .setup import CONDITIONS

if TYPE_CHECKING:
    from robonav.body import Body

BODY: dict[str, Any] = CONDITIONS["body"]
TRAINING: dict[str, Any] = CONDITIONS["body-training"]
METHODS = ("freer-side", "lfd", "dagger", "nnql", "ppo")
REFLEX_OF_BODIES = Reflex(BODY["direction"])

BODIES: dict[str, dict[str, Any] | None] = {
    "none": None,
    "usual": {},
    "everything worse": {"friction": 0.3, "torque": 12.0, "delay": 3, "noise": 0.3},
}
"""What differs from the usual body; the simulator of section 2.5 has none."""

TRAININGS = ("simulator", "randomised simulator")


def simulator_of(name: str, worlds: Worlds) -> Simulator:
    """Return a simulator of robots with one body."""
    speed, steps = BODY["speed"], BODY["max_steps"]
    about = BODIES[name]
    if about is None:
        return Simulator(worlds, speed, max_steps=steps)
    from robonav.body import Body, BodySimulator  # the extra `body`

    body: Body = replace(Body(), **about)
    return BodySimulator(worlds, speed, body=body, max_steps=steps)


def rates_of(policy: Policy, body: str, worlds: Worlds, seed: int) -> Numbers:
    """Outcome rates of a policy that drives robots with one body."""
    simulator = simulator_of(body, worlds)
    ends = navigate_in(policy, simulator, reflex=REFLEX_OF_BODIES, seed=seed)
    arrived = ends.steps[ends.success]
    seconds = float(arrived.mean()) if len(arrived) else float(BODY["max_steps"])
    return outcome_rates(ends) | {"seconds to the target": seconds}


def run_body(case: Case, seed: int, scale: str) -> Numbers:
    """Drive the robots of a case through worlds of the leaderboard."""
    worlds = board_worlds(BODY["setting"], seed, BODY["worlds"][scale])
    return rates_of(policy_of(str(case["method"])), str(case["body"]), worlds, seed)


@lru_cache(maxsize=16)
def trained_policy(training: str, seed: int, scale: str) -> Policy:
    """Train a policy by PPO in simulators of one kind."""
    from robonav.body import ideal, randomised, train_in

    draw = dict(zip(TRAININGS, (ideal, randomised), strict=True))
    policy = train_in(
        draw[training](TRAINING["robots"][scale]),
        TRAINING["updates"][scale],
        reflex=REFLEX_OF_BODIES,
        seed=seed,
    )
    return replace(policy, temperature=TRAINING["temperature"])


def train_for_body(case: Case, seed: int, scale: str) -> Numbers:
    """Test one training of a case in the robots of the case."""
    policy = trained_policy(str(case["trained in"]), seed, scale)
    worlds = board_worlds(BODY["setting"], seed, TRAINING["tests"][scale])
    return rates_of(policy, str(case["body"]), worlds, seed)


ABOUT = {name: value for name, value in BODY.items() if name != "seeds"}

EXPERIMENTS = (
    Experiment(
        name="body",
        title="The policies of the book in the simulator, and in a robot with a body",
        cases=[
            {"method": method, "body": body} for method in METHODS for body in BODIES
        ],
        run=run_body,
        seeds=BODY["seeds"],
        settings=ABOUT | {"bodies": BODIES},
        note="No policy was trained or tuned for a body. It needs the extra body.",
        plot=SUCCESS_BARS,
    ),
    Experiment(
        name="body-training",
        title="A robot with a body: PPO trained in the simulator, and in randomised ones",
        cases=[
            {"trained in": training, "body": body}
            for training in TRAININGS
            for body in ("none", "usual", "everything worse")
        ],
        run=train_for_body,
        seeds=TRAINING["seeds"],
        settings=ABOUT
        | {name: value for name, value in TRAINING.items() if name != "seeds"},
        shortened="A quick run has one update.",
        note="All trainings have as many episodes. Each run is one training. It needs the extra body.",
        plot=SUCCESS_BARS,
    ),
)
