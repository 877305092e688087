"""How learning goes wrong, one choice at a time: reward, temperature, encoding, scaling (not in the thesis)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.nnql import reward
from robonav.nnql.reward import REWARDS, reward_row
from robonav.robot import NNQL_SENSORS, Encoder, Sensing, nnql_state
from robonav.robot.environments import Reward, arrival_or_collision

from ..runner.experiment import Case, Experiment
from .setup import COLD, EPISODES, NAVIGATIONS, TEST_WORLDS, Numbers, judged, new_worlds
from .tables import settings
from .tuning import trained

Array = NDArray[np.float64]


def only_moving_away(
    before: Sensing, after: Sensing, outcome: NDArray[np.int8]
) -> Array:
    """Table 4.1, but evading pays only where the nearest thing is farther than before."""
    farther = after.ranges.min(axis=1) > before.ranges.min(axis=1)
    evading = np.isin(reward_row(before, after, outcome), (6, 9))
    return np.where(evading & ~farther, 0.0, reward(before, after, outcome))


def _rows_changed(changes: Mapping[int, float]) -> Reward:
    """Table 4.1 with other numbers in some rows."""
    rewards = REWARDS.copy()
    rewards[list(changes)] = list(changes.values())
    return lambda before, after, outcome: rewards[reward_row(before, after, outcome)]


REWARDS_TRIED: dict[str, Reward] = {
    "Table 4.1": reward,
    "half as much for evading": _rows_changed({6: 0.3, 9: 0.2}),
    "evading is moving away": only_moving_away,
    "0.6 for getting safe, too": _rows_changed({2: 0.6}),
    "nothing for staying cozy": _rows_changed({6: 0.0}),
    "arrival and collision alone": arrival_or_collision,
}


@dataclass(frozen=True)
class RawNumbers(Encoder):
    """The 16 numbers of Eq. (4.5) as they are, up to 7 and 9, where the others bring all within 1."""

    walls: bool = True
    target: str = "number"
    sensors: tuple[int, ...] = NNQL_SENSORS

    def __call__(self, sensing: Sensing) -> Array:
        """Inputs (N, 16) of N robots."""
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
        f"{rescale}, discount {gamma}": {"rescale": rescale, "gamma": gamma}
        for rescale in ("clip", "shift")
        for gamma in (0.6, 0.7, 0.9)
    },
    "learning rate": {
        "0.8 throughout": {"alpha": 0.8},
        "0.8 to 0.1": {"alpha": (0.8, 0.1)},
    },
}
"""What is varied, one at a time, from the settings chosen for NNQL."""


def vary(case: Case, seed: int, scale: str) -> Numbers:
    """One seed of one variation: how drives end, greedily and cold, and how the last 100 episodes went."""
    options = settings("nnql") | VARIATIONS[str(case["what"])][str(case["choice"])]
    of_course = {
        name: options.pop(name) for name in ("reward", "encoder") if name in options
    }
    training = trained("nnql", seed, scale, options, **of_course)
    driven = judged(
        training.policies[0], new_worlds(NAVIGATIONS[scale], TEST_WORLDS + seed)
    )
    return driven | {"last episodes": 100 * training.successes[0, -100:].mean()}


CIRCLES = Experiment(
    name="nnql-circles",
    title="What makes a robot circle: one choice at a time",
    cases=[
        {"what": what, "choice": choice}
        for what, choices in VARIATIONS.items()
        for choice in choices
    ],
    run=vary,
    seeds={"quick": 1, "thesis": 8},
    settings={
        "episodes": EPISODES,
        "drives a run": NAVIGATIONS,
        "first seed of the worlds": TEST_WORLDS,
        "temperature of a cold policy": COLD,
        "otherwise": settings("nnql"),
    },
)

EXPERIMENTS = (CIRCLES,)
