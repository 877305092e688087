"""Failures of learning, one choice changed at a time; NFQ that fits late; NNQL that trains in few maps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.nnql import reward
from robonav.nnql.reward import REWARDS, TABLE, reward_row
from robonav.robot import NNQL_SENSORS, Encoder, Sensing, nnql_state
from robonav.robot.environment_settings import Reward, arrival_or_collision

from ..runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers, Plot
from .setup import (
    ABOUT,
    EPISODES,
    EVALUATION_TEMPERATURE,
    SETUP,
    evaluate,
    training,
    tuned,
)

Array = NDArray[np.float64]


def _row(before: str, after: str, condition: str = "") -> int:
    """The number of a row of Table 4.1, by the words that it has there."""
    return [row[:3] for row in TABLE].index((before, after, condition))


GETTING_SAFE = _row("any", "safe")
STAYING_COZY = _row("cozy", "cozy", "not a metre nearer")
STAYING_DANGEROUS = _row("dangerous", "dangerous", "not a metre nearer")
EVADING = (STAYING_COZY, STAYING_DANGEROUS)
"""The rows that reward a robot for keeping its distance from the nearest object."""


def only_moving_away(
    before: Sensing, after: Sensing, outcome: NDArray[np.int8]
) -> Array:
    """Table 4.1, except that the rows ``EVADING`` count only if the nearest object is farther away than before."""
    farther = after.ranges.min(axis=1) > before.ranges.min(axis=1)
    evading = np.isin(reward_row(before, after, outcome), EVADING)
    return np.where(evading & ~farther, 0.0, reward(before, after, outcome))


def _rows_changed(changes: Mapping[int, float]) -> Reward:
    """Return Table 4.1 with other rewards in some rows."""
    rewards = REWARDS.copy()
    rewards[list(changes)] = list(changes.values())
    return lambda before, after, outcome: rewards[reward_row(before, after, outcome)]


REWARDS_TRIED: dict[str, Reward] = {
    "Table 4.1": reward,
    "half as much for evading": _rows_changed(
        {STAYING_COZY: 0.3, STAYING_DANGEROUS: 0.2}
    ),
    "evading is moving away": only_moving_away,
    "0.6 for getting safe, too": _rows_changed({GETTING_SAFE: 0.6}),
    "nothing for staying cozy": _rows_changed({STAYING_COZY: 0.0}),
    "arrival and collision alone": arrival_or_collision,
}


@dataclass(frozen=True)
class RawNumbers(Encoder):
    """The 16 numbers of Eq. (4.5) without scaling, up to 7 and 9. The other encoders scale them to at most 1."""

    walls: bool = True
    target: str = "number"
    sensors: tuple[int, ...] = NNQL_SENSORS

    def __call__(self, sensing: Sensing) -> Array:
        """Return the inputs (N, 16) of N robots."""
        return nnql_state(sensing).astype(float)


VARIATIONS: dict[str, dict[str, dict[str, Any]]] = {
    "reward": {name: {"reward": tried} for name, tried in REWARDS_TRIED.items()},
    "temperature": {
        "0.9 throughout": {"temperature": 0.9},
        "0.9 to 0.3": {"temperature": (0.9, 0.3)},
        "0.9 to 0.1": {"temperature": (0.9, 0.1)},
        "0.9 to 0.03": {"temperature": (0.9, 0.03)},
        "0.03 throughout": {"temperature": 0.03},
    },
    "target's sector": {
        name: {"target": name}
        for name in ("number", "signed", "one-hot", "sine-cosine")
    },
    "inputs": {
        "brought within 1": {"target": "number"},
        "raw numbers": {"encoder": RawNumbers()},
    },
    "Q into [0, 1]": {
        f"{rescale}, discount {discount}": {"rescale": rescale, "discount": discount}
        for rescale in ("clip", "shift")
        for discount in (0.6, 0.7, 0.9)
    },
    "learning rate": {
        "0.8 throughout": {"learning_rate": 0.8},
        "0.8 to 0.1": {"learning_rate": (0.8, 0.1)},
    },
}
"""The variations of the tuned hyperparameters of NNQL, one at a time."""


def vary(case: Case, seed: int, scale: str) -> Numbers:
    """Return the outcome rates of one seed of one variation, and the success in the last 100 episodes of training."""
    changes = VARIATIONS[str(case["factor"])][str(case["level"])]
    of_task = {k: v for k, v in changes.items() if k in ("reward", "encoder")}
    settings = tuned()["nnql"] | {k: v for k, v in changes.items() if k not in of_task}
    trained = training("nnql", seed, scale, settings, **of_task)
    rates = evaluate(trained.policies[0], SETUP.test_worlds(seed, scale))
    return rates | {
        "success, last 100 episodes": 100 * trained.successes[0, -100:].mean()
    }


FIT_ONCE = "once, after all episodes"
FITS: dict[str, dict[str, Any]] = {
    "every 20 episodes, 20 sweeps": {},
    f"{FIT_ONCE}, 20 sweeps": {"episodes_per_fit": EPISODES},
    f"{FIT_ONCE}, 300 sweeps": {"episodes_per_fit": EPISODES, "sweeps": 300},
}
"""When NFQ fits its network. The last has as many sweeps in all as the first."""


def fit_later(case: Case, seed: int, scale: str) -> Numbers:
    """NFQ as tuned, or as in section 4.5.3: its training begins when all data have been collected."""
    changes = FITS[str(case["fits"])]
    trained = training("nfq", seed, scale, tuned()["nfq"] | changes)
    rates = evaluate(trained.policies[0], SETUP.test_worlds(seed, scale))
    return rates | {"success in training": 100 * trained.successes.mean()}


def in_few_maps(case: Case, seed: int, scale: str) -> Numbers:
    """NNQL trained in a new map in each episode, or again and again in a few maps; tested in new maps."""
    n_worlds = None if case["worlds"] == "new" else int(case["worlds"])
    trained = training("nnql", seed, scale, tuned()["nnql"], n_worlds=n_worlds)
    rates = evaluate(trained.policies[0], SETUP.test_worlds(seed, scale))
    return rates | {
        "success, last 100 episodes": 100 * trained.successes[0, -100:].mean()
    }


CIRCLES = Experiment(
    name="nnql-circles",
    title="Outcomes of NNQL with one choice changed at a time: reward, temperature, encoding, rescaling, discount",
    cases=[
        {"factor": factor, "level": level}
        for factor, levels in VARIATIONS.items()
        for level in levels
    ],
    run=vary,
    seeds={"quick": 1, "thesis": 8},
    settings={
        **ABOUT,
        "evaluation temperature": EVALUATION_TEMPERATURE["nnql"],
        "otherwise": dict(tuned()["nnql"]),
    },
    plot=Plot("nnql.plot_variations"),
)

LATE_FITS = Experiment(
    name="nfq-late",
    title="Success of NFQ that fits its network now and then, or once, when all data have been collected",
    cases=[{"fits": fits} for fits in FITS],
    run=fit_later,
    seeds={"quick": 1, "thesis": 24},
    settings={**ABOUT, "otherwise": dict(tuned()["nfq"])},
    plot=SUCCESS_BARS,
)
FEW_MAPS = Experiment(
    name="nnql-maps",
    title="Success in new maps of NNQL by the number of maps in which it trains",
    cases=[{"worlds": worlds} for worlds in ("new", 30, 10, 3, 1)],
    run=in_few_maps,
    seeds={"quick": 1, "thesis": 24},
    settings={**ABOUT, "settings": dict(tuned()["nnql"])},
    plot=SUCCESS_BARS,
)

EXPERIMENTS = (CIRCLES, FEW_MAPS, LATE_FITS)
