"""The reward of a step: the properties of states, Eq. (4.6), and Table 4.1, made exclusive and total."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robonav.robot import Sensing
from robonav.robot._fast import ARRIVED, COLLIDED, SENSOR_RANGE

COZY_DISTANCE = 5.0
"""d_cozy of Eq. (4.6) in metres, and d_warn of Table 4.1: where the degree of danger becomes 4."""


class Property(IntEnum):
    """What a state is to the robot, see :func:`state_property`.

    Examples
    --------
    >>> from robonav.nnql import Property
    >>> Property(1).name
    'COZY'
    """

    SAFE = 0  # nothing in sensor range
    COZY = 1  # something in range, none of it closer than d_cozy
    DANGEROUS = 2  # something closer than d_cozy
    WINNING = 3  # arrived
    FAILURE = 4  # collided


# As integers, because members of an enumeration are slow to look up.
SAFE, COZY, DANGEROUS, WINNING, FAILURE = map(int, Property)


def property_at(
    nearest: NDArray[np.float64], outcome: NDArray[np.int8] | None = None
) -> NDArray[np.int64]:
    """The property of states by the distance of the nearest thing around the robot, Eq. (4.6).

    Each border belongs to one side: a distance of d_cozy is cozy, and one of d_bou is safe. The simulator says whether
    a robot has arrived or collided, because it also sees collisions in the course of a step.

    Parameters
    ----------
    nearest : (N,) array
        Distances in metres.
    outcome : (N,) array of int, optional
        Outcome codes of the simulator; by default all robots are running.

    Returns
    -------
    (N,) array of int
        Codes of :class:`Property`.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nnql import property_at
    >>> property_at(np.array([10.0, 7.5, 5.0, 2.0]))  # safe, cozy, cozy, dangerous
    array([0, 1, 1, 2])
    """
    cozy_or_safe = np.where(nearest < SENSOR_RANGE, COZY, SAFE)
    properties = np.where(nearest < COZY_DISTANCE, DANGEROUS, cozy_or_safe)  # Eq. (4.6)
    if outcome is not None:
        properties[outcome == ARRIVED] = WINNING
        properties[outcome == COLLIDED] = FAILURE
    return properties


def state_property(
    sensing: Sensing, outcome: NDArray[np.int8] | None = None
) -> NDArray[np.int64]:
    """The property of the states that N robots sense.

    Uses Eq. (4.6), see :func:`property_at`.

    Parameters
    ----------
    sensing : Sensing
        N rows.
    outcome : (N,) array of int, optional
        Outcome codes of the simulator; by default all robots are running.

    Returns
    -------
    (N,) array of int
        Codes of :class:`Property`.

    Examples
    --------
    >>> from robonav.nnql import Property, state_property
    >>> from robonav.robot import Simulator, random_worlds
    >>> sensing = Simulator(random_worlds(1, seed=0), 2.0).sense()
    >>> Property(state_property(sensing)[0]).name
    'SAFE'
    """
    return property_at(sensing.ranges.min(axis=1), outcome)


class Row(NamedTuple):
    """One row of the reward table.

    Attributes
    ----------
    before, after : str
        From which states to which: names of properties, or "any".
    condition : str
        How much nearer the nearest thing is after the step, in the words of ``NEARER``.
    reward : float
        The reward.
    thesis : str
        What the thesis has in its place.
    """

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
"""Table 4.1 as we read it. Exactly one of these rows holds for any step."""

NEARER = {
    "": [0, 1, 2, 3],
    "not a metre nearer": [0],
    "1 m nearer": [1],
    "2 m nearer": [2],
    "2 m nearer or more": [2, 3],
    "3 m nearer or more": [3],
}
"""By how many whole metres the least range shrank, up to 3, for each condition of ``TABLE``."""

REWARDS = np.array([row.reward for row in TABLE])


def _properties(words: str) -> list[int]:
    """The properties that a row names."""
    named = [name.upper() for name in words.split(" or ")]
    return [int(p) for p in Property if words == "any" or p.name in named]


def _row_numbers() -> NDArray[np.int64]:
    """Which row of ``TABLE`` holds: (5, 5, 4) by property before, property after, whole metres nearer."""
    numbers = np.full((5, 5, 4), -1)
    for number, row in enumerate(TABLE):
        before, after = _properties(row.before), _properties(row.after)
        numbers[np.ix_(before, after, NEARER[row.condition])] = number
    return numbers


ROW_NUMBERS = _row_numbers()


def reward_row(
    before: Sensing, after: Sensing, outcome: NDArray[np.int8]
) -> NDArray[np.int64]:
    """Which row of Table 4.1 holds for a step.

    Parameters
    ----------
    before, after : Sensing
        What N robots sensed before and after the step.
    outcome : (N,) array of int
        Outcome codes of the simulator after the step.

    Returns
    -------
    (N,) array of int
        Indices into ``TABLE``.

    Examples
    --------
    >>> from robonav.nnql import reward_row
    >>> from robonav.robot import Simulator, random_worlds
    >>> simulator = Simulator(random_worlds(2, seed=0))
    >>> sensing = simulator.sense()
    >>> reward_row(sensing, sensing, simulator.outcome)  # safe before and after
    array([2, 2])
    """
    distance_before = before.ranges.min(axis=1)  # d_min at t - 1
    distance_after = after.ranges.min(axis=1)  # d_min at t
    nearer = np.floor(distance_before - distance_after).astype(np.int64).clip(0, 3)
    was, now = property_at(distance_before), property_at(distance_after, outcome)
    return ROW_NUMBERS[was, now, nearer]


def reward(
    before: Sensing, after: Sensing, outcome: NDArray[np.int8]
) -> NDArray[np.float64]:
    """The reward r of Table 4.1, as the environments take it for their ``reward`` (section 4.4.2).

    Parameters
    ----------
    before, after : Sensing
        What N robots sensed before and after the step.
    outcome : (N,) array of int
        Outcome codes of the simulator after the step: running, arrived, collided, out of steps.

    Returns
    -------
    (N,) array
        Rewards from -1 to 1.

    Examples
    --------
    >>> import gymnasium
    >>> import robonav
    >>> from robonav.nnql import reward
    >>> env = gymnasium.make("robonav/Navigation-v0", reward=reward)
    >>> _ = env.reset(seed=0)
    >>> env.step(0)[1]
    0.0
    """
    return REWARDS[reward_row(before, after, outcome)]
