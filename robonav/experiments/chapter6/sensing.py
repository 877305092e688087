"""Success against the number of sensors and the kind of network, and of training in randomised worlds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from robonav.benchmark import outcome_rates
from robonav.lfd import ComputerExpert
from robonav.robot import Simulator, Worlds, navigate, neighbour_slip
from robonav.sensing import (
    Picture,
    Ring,
    SensorPolicy,
    dagger_with_sensor,
    fully_connected,
    labelled_examples,
    picture_network,
    randomised_simulators,
    ring_network,
)

from ..runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers
from ..runner.setup import Setup
from .setup import CONDITIONS

SETUP = Setup(**CONDITIONS["sensing"])
TRAINING: Mapping[str, Any] = CONDITIONS["sensing-training"]
SETTINGS = {"10 obstacles": (10, 0), "30 obstacles": (30, 0), "10 and 10 moving": (10, 10)}  # fmt: skip
MILD, STRONG = (
    TRAINING["mild"],
    TRAINING["strong"],
)  # noise in metres, probability of a slip
PROBED = 20  # worlds in which the learner's actions are compared with the expert's


def new_policy(case: Case, seed: int) -> SensorPolicy:
    """Return the policy of a case before its training."""
    number, convolutional = int(case["number"]), case["network"] == "convolutional"
    sensor: Ring | Picture = Ring(number) if case["sensor"] == "sectors" else Picture(number)  # fmt: skip
    if not convolutional:
        network = fully_connected(sensor, seed=seed)
    elif isinstance(sensor, Ring):
        network = ring_network(sensor, seed=seed)
    else:
        network = picture_network(sensor, seed=seed)
    return SensorPolicy(sensor, network, TRAINING["temperature"])


def training_worlds(seed: int, scale: str) -> list[Worlds]:
    """Return the worlds of each round of a training, which are used for nothing else."""
    first = TRAINING["seed"] + 100 * seed
    rounds = range(TRAINING["rounds"][scale])
    return [SETUP.worlds(TRAINING["worlds"][scale], first + r) for r in rounds]


def trained_policy(
    case: Case, seed: int, scale: str, *, noise: float = 0.0, slip: float = 0.0
) -> SensorPolicy:
    """Train the policy of a case, in simulators whose uncertainties are at most these."""
    simulators = randomised_simulators(
        training_worlds(seed, scale),
        noise=noise,
        slip=slip,
        speed=SETUP.speed,
        max_steps=TRAINING["max_steps"],
        seed=seed,
    )
    return dagger_with_sensor(
        new_policy(case, seed),
        simulators,
        reflex=SETUP.reflex,
        steps=TRAINING["steps"],
        batch=TRAINING["batch"],
        gradient_step=TRAINING["gradient_step"],
        seed=seed,
    )


def train_and_test(case: Case, seed: int, scale: str) -> Numbers:
    """One training and its tests."""
    policy = trained_policy(case, seed, scale)
    others = {
        name: SETUP.evaluate(policy, SETUP.test_worlds(seed, scale, *numbers))
        for name, numbers in SETTINGS.items()
    }
    return SETUP.evaluate(policy, SETUP.test_worlds(seed, scale)) | {
        "noisy and slipping": success(policy, seed, scale, *MILD),
        "expert's action": agreement(policy, seed),
        "weights": policy.network.size,
        **{name: rates["success"] for name, rates in others.items()},
    }


def success(
    policy: SensorPolicy, seed: int, scale: str, noise: float, slip: float
) -> float:
    """Return how often (per cent) a policy arrives in the test worlds with these uncertainties."""
    ends = navigate(
        policy,
        SETUP.test_worlds(seed, scale),
        SETUP.speed,
        SETUP.max_steps,
        reflex=SETUP.reflex,
        noise=noise,
        slip=neighbour_slip(slip),
    )
    return outcome_rates(ends)["success"]


def train_randomised(case: Case, seed: int, scale: str) -> Numbers:
    """Train one policy in exact or in randomised worlds, and test it in three worlds."""
    noise, slip = STRONG if case["worlds in training"] == "randomised" else (0.0, 0.0)
    ring: Case = {
        "sensor": "sectors",
        "number": case["sectors"],
        "network": "fully connected",
    }
    policy = trained_policy(ring, seed, scale, noise=noise, slip=slip)
    return SETUP.evaluate(policy, SETUP.test_worlds(seed, scale)) | {
        "1 m, 0.4": success(policy, seed, scale, *MILD),
        "3 m, 0.8": success(policy, seed, scale, *STRONG),
    }


def agreement(policy: SensorPolicy, seed: int) -> float:
    """Return in what share (per cent) of the states that it visits a policy prefers the expert's action."""
    worlds = SETUP.tuning_worlds(seed, PROBED)
    simulator = Simulator(worlds, SETUP.speed, max_steps=TRAINING["max_steps"])
    rng = np.random.default_rng(seed)
    seen = labelled_examples(simulator, policy, ComputerExpert(), False, rng, SETUP.reflex)  # fmt: skip
    logits = policy.network(seen.readings, seen.targets)
    return 100 * float((logits.argmax(dim=1) == seen.labels).double().mean())


CASES: list[Case] = [
    {"sensor": sensor, "number": number, "network": network}
    for sensor, number, network in (
        *(("sectors", n, "fully connected") for n in (9, 18, 36, 72)),
        *(("sectors", n, "convolutional") for n in (36, 72)),
        *(("picture", 32, network) for network in ("fully connected", "convolutional")),
    )
]

RANDOMISED: list[Case] = [
    {"sectors": 9, "worlds in training": worlds} for worlds in ("exact", "randomised")
]

SHARED: Mapping[str, Any] = {
    "navigations a run": SETUP.navigations,
    "obstacles": SETUP.obstacles,
    "training": {name: value for name, value in TRAINING.items() if name != "seeds"},
}

EXPERIMENTS = (
    Experiment(
        name="sensing",
        title="Success with rings of sectors and with a picture",
        cases=CASES,
        run=train_and_test,
        seeds=TRAINING["seeds"],
        settings=SHARED,
        shortened="A quick run trains in two rounds of four worlds.",
        note="The noisy, slipping world has 20 obstacles. Each range has an error with a standard deviation of 1 m, "
        "and a turn comes out 30 degrees off with the probability 0.4. A picture has no ranges, so its robot only "
        "slips.",
        plot=SUCCESS_BARS,
    ),
    Experiment(
        name="sensing-randomised",
        title="Success of nine sectors after training in exact and in randomised worlds",
        cases=RANDOMISED,
        run=train_randomised,
        seeds=TRAINING["seeds"],
        settings=SHARED,
        shortened="A quick run trains in two rounds of four worlds.",
        note="The last two columns are for worlds whose ranges have an error with this standard deviation and whose "
        "turns slip with this probability. In randomised training each round draws its error up to 3 m and its "
        "probability up to 0.8.",
        plot=SUCCESS_BARS,
    ),
)
