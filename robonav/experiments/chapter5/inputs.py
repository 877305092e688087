"""What NIRL and cloning read, and what NIRL visits: sensors, the encoding of the target, states and updates."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.nirl import Decisions, RobotTask
from robonav.nirl.policy import ActionProbabilities
from robonav.robot import LFD_SENSORS, NNQL_SENSORS, Sensing

from ..runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers
from .setup import (
    EPISODES_PER_ITERATION,
    ITERATIONS,
    SETUP,
    cloned_policy,
    demonstrations,
    encoder,
    task,
    train_irl,
    tuned,
)

SENSORS = {7: NNQL_SENSORS, 9: LFD_SENSORS}


def with_sensors(case: Case, seed: int, scale: str) -> Numbers:
    """NIRL or cloning with seven sensors or all nine, and with one of two encodings of the target's sector."""
    method, target = str(case["method"]), str(case["target"])
    settings, inputs = tuned(method), encoder(target, SENSORS[int(case["sensors"])])
    expert = demonstrations(seed)
    policy = (
        cloned_policy(seed, settings, inputs=inputs)
        if method == "lfd"
        else train_irl("nirl", expert, seed, settings, task=task(encoder=inputs)).policy
    )
    return SETUP.evaluate(policy, SETUP.test_worlds(seed, scale))


@dataclass(frozen=True, eq=False)
class CountedTask(RobotTask):
    """The task of a training, which also keeps the states (M, k) of each iteration's decisions."""

    states: list[NDArray[np.float64]] = field(default_factory=list)

    def rollout(
        self, policy: ActionProbabilities, rng: np.random.Generator
    ) -> Decisions:
        """Episodes as in :class:`RobotTask`."""
        episodes = super().rollout(policy, rng)
        self.states.append(episodes.inputs)
        return episodes


def by_updates(case: Case, seed: int, scale: str) -> Numbers:
    """NIRL with some number of updates: the states that it visits in training, and those of the tests."""
    settings = tuned("nirl", n_samples=int(case["updates an iteration"]))
    there = CountedTask(
        EPISODES_PER_ITERATION,
        encoder=encoder(settings["target"]),
        reflex=SETUP.reflex,
    )
    learned = train_irl("nirl", demonstrations(seed), seed, settings, task=there)
    visited = _as_bytes(np.concatenate(there.states))
    tested: list[NDArray[np.bytes_]] = []

    def policy(sensing: Sensing, rng: np.random.Generator) -> ArrayLike:
        tested.append(_as_bytes(there.encoder(sensing)))
        return learned.policy(sensing, rng)

    rates = SETUP.evaluate(policy, SETUP.test_worlds(seed, scale))
    known = np.isin(np.concatenate(tested), visited)
    return rates | {
        "decisions in training": len(visited),
        "states in training": len(np.unique(visited)),
        "test decisions in other states": 100 * (1 - known.mean()),
    }


def _as_bytes(states: NDArray[np.float64]) -> NDArray[np.bytes_]:
    """Return one value for each of N states (N, k), equal for equal states."""
    whole = np.ascontiguousarray(np.rint(1e6 * states).astype(np.int32))
    return whole.view(f"V{whole.shape[1] * whole.itemsize}").ravel()


SENSORS_AND_TARGET = Experiment(
    name="nirl-sensors",
    title="Success of NIRL and cloning with seven sensors or nine, and with two encodings of the target's sector",
    cases=[
        {"method": method, "target": target, "sensors": sensors}
        for method in ("nirl", "lfd")
        for target in ("signed", "sine-cosine")
        for sensors in SENSORS
    ],
    run=with_sensors,
    seeds={"quick": 1, "thesis": 10},
    settings={
        "navigations a run": SETUP.navigations,
        "settings": {method: dict(tuned(method)) for method in ("nirl", "lfd")},
    },
    plot=SUCCESS_BARS,
)
UPDATES = Experiment(
    name="nirl-updates",
    title="Success of NIRL by the number of updates in an iteration, and the states that it visits",
    cases=[{"updates an iteration": updates} for updates in (96, 960, 9600)],
    run=by_updates,
    seeds={"quick": 1, "thesis": 10},
    settings={
        "iterations": ITERATIONS,
        "navigations a run": SETUP.navigations,
        "settings": dict(tuned("nirl")),
    },
    plot=SUCCESS_BARS,
)

EXPERIMENTS = (SENSORS_AND_TARGET, UPDATES)
