"""Robots, readings and mirrors for the tests of the planners."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from robonav.planners import DynamicWindow, PotentialField, VectorFieldHistogram
from robonav.robot import Policy, Sensing

MEMORYLESS: dict[str, Policy] = {
    "potential field": PotentialField(),
    "vfh": VectorFieldHistogram(),
    "dynamic window": DynamicWindow(),
}


@pytest.fixture(params=MEMORYLESS)
def policy(request: pytest.FixtureRequest) -> Policy:
    """Each planner that remembers nothing."""
    return MEMORYLESS[request.param]


@pytest.fixture
def readings() -> Callable[..., Sensing]:
    """Make what one robot senses: 10 m in all sectors that are not given, by number."""

    def read(region: int = 1, **sectors: float) -> Sensing:
        ranges = np.full((1, 9), 10.0)
        for name, metres in sectors.items():
            ranges[0, int(name[1:]) - 1] = metres
        none = np.zeros((1, 9), dtype=bool)
        return Sensing(ranges, none, np.array([region]), np.array([False]))

    return read


@pytest.fixture
def random_sensing() -> Sensing:
    """2,000 robots with random readings, of which some see nothing in a sector."""
    rng = np.random.default_rng(0)
    ranges = rng.uniform(1.0, 14.0, size=(2000, 9)).clip(max=10.0)
    regions = rng.integers(1, 10, size=2000)
    none = np.zeros((2000, 9), dtype=bool)
    return Sensing(ranges, none, regions, np.zeros(2000, dtype=bool))


MIRRORED_ACTION = np.array([0, 3, 4, 1, 2, 5])  # F, R30, R60, L30, L60, B
MIRRORED_SECTOR = np.array([0, 8, 7, 6, 5, 4, 3, 2, 1])


@pytest.fixture
def mirrored() -> Callable[[Sensing], Sensing]:
    """What the robots would sense if left and right were exchanged."""

    def mirror(sensing: Sensing) -> Sensing:
        return Sensing(
            sensing.ranges[:, MIRRORED_SECTOR],
            sensing.walls[:, MIRRORED_SECTOR],
            MIRRORED_SECTOR[sensing.target_region - 1] + 1,
            sensing.target_seen,
        )

    return mirror


@pytest.fixture
def mirrored_actions() -> Callable[[ArrayLike], NDArray[np.int64]]:
    """The actions with left and right exchanged."""
    return lambda actions: MIRRORED_ACTION[np.asarray(actions)]
