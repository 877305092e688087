"""What a step was worth: state properties, Eq. (4.6), and the reward of Table 4.1, made exclusive and total."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robonav.robot import Sensing
from robonav.robot._fast import ARRIVED, COLLIDED, SENSOR_RANGE

COZY_DISTANCE = 5.0
"""d_cozy of Eq. (4.6) in metres, and d_warn of Table 4.1 with it: the border of degree of danger 4."""


class Property(IntEnum):
    """What a state is to the robot, Eq. (4.6)."""

    SAFE = 0  # nothing in sensor range
    COZY = 1  # something in range, none of it closer than d_cozy
    DANGEROUS = 2  # something closer than d_cozy
    WINNING = 3  # arrived
    FAILURE = 4  # collided


SAFE, COZY, DANGEROUS, WINNING, FAILURE = map(
    int, Property
)  # members of an enumeration are slow to look up


def state_property(
    sensing: Sensing, outcome: NDArray[np.int8] | None = None
) -> NDArray[np.int64]:
    """The property of N states, Eq. (4.6), its borders made exclusive: a distance of d_cozy is cozy, d_bou safe.

    Parameters
    ----------
    sensing : N rows.
    outcome : codes (N,) of the simulator, which sees collisions along the way; by default all are running.

    Returns
    -------
    Codes (N,) of :class:`Property`.
    """
    return _property(sensing.ranges.min(axis=1), outcome)


def _property(
    nearest: NDArray[np.float64], outcome: NDArray[np.int8] | None
) -> NDArray[np.int64]:
    properties = np.where(
        nearest < COZY_DISTANCE, DANGEROUS, np.where(nearest < SENSOR_RANGE, COZY, SAFE)
    )
    if outcome is not None:
        properties[outcome == ARRIVED] = WINNING
        properties[outcome == COLLIDED] = FAILURE
    return properties


class Row(NamedTuple):
    """One row of the reward table: from which states, to which, on what condition, how much; what the thesis has."""

    before: str
    after: str
    condition: str
    reward: float
    thesis: str


TABLE = (
    Row("any", "winning", "", 1.0, "1"),
    Row("any", "failure", "", -1.0, "−1, from dangerous"),
    Row("any", "safe", "", 0.0, "0, from cozy"),
    Row("safe", "cozy or dangerous", "", 0.0, "0, to cozy"),
    Row("dangerous", "cozy", "", 0.5, "0.5, and 0.6"),
    Row("cozy", "dangerous", "", 0.0, "0"),
    Row("cozy", "cozy", "not a metre nearer", 0.6, "0.6"),
    Row("cozy", "cozy", "1 m nearer", 0.0, "none"),
    Row("cozy", "cozy", "2 m nearer or more", -0.2, "−0.2, as dangerous → dangerous"),
    Row("dangerous", "dangerous", "not a metre nearer", 0.4, "0.4"),
    Row("dangerous", "dangerous", "1 m nearer", -0.2, "−0.2"),
    Row("dangerous", "dangerous", "2 m nearer", -0.5, "−0.5"),
    Row("dangerous", "dangerous", "3 m nearer or more", -1.0, "−1"),
)
"""Table 4.1 as we read it: of these rows exactly one holds for any step. "Nearer" is by how many whole metres the
least range shrank."""

REWARDS = np.array([row.reward for row in TABLE])


def _rows() -> NDArray[np.int64]:
    """Which row of ``TABLE`` holds (3, 5, 4): by property before, property after, whole metres nearer up to 3."""
    rows = np.empty((3, 5, 4), dtype=np.int64)
    rows[COZY, COZY] = [6, 7, 8, 8]
    rows[DANGEROUS, DANGEROUS] = [9, 10, 11, 12]
    rows[COZY, DANGEROUS] = 5
    rows[DANGEROUS, COZY] = 4
    rows[SAFE] = 3
    rows[:, SAFE] = 2
    rows[:, FAILURE] = 1
    rows[:, WINNING] = 0
    return rows


ROWS = _rows()


def reward_row(
    before: Sensing, after: Sensing, outcome: NDArray[np.int8]
) -> NDArray[np.int64]:
    """Which row (N,) of ``TABLE`` holds for a step; parameters as in :func:`reward`."""
    was, now = (
        before.ranges.min(axis=1),
        after.ranges.min(axis=1),
    )  # d_min of t - 1 and of t
    nearer = np.floor(was - now).astype(np.int64).clip(0, 3)
    return ROWS[_property(was, None), _property(now, outcome), nearer]


def reward(
    before: Sensing, after: Sensing, outcome: NDArray[np.int8]
) -> NDArray[np.float64]:
    """The reward r (N,) of Table 4.1: what :class:`robonav.robot.environments.NavigationEnv` takes as ``reward``.

    Parameters
    ----------
    before, after : what N robots sensed before and after the step.
    outcome : codes (N,) of the simulator after the step: running, arrived, collided, out of steps.

    Returns
    -------
    Rewards (N,) in -1..1, one of ``TABLE`` each.
    """
    return REWARDS[reward_row(before, after, outcome)]
