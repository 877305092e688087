"""Encodings: what the robot senses as the numbers that a network reads (Table 3.1, state vectors)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_integer, check_one_of

from ._fast import SECTOR, SENSOR_RANGE, SENSORS
from .simulator import Sensing

DANGER_BORDERS = np.array([3, 7, 11, 15, 20, 25, 30]) * SENSOR_RANGE / 30
"""Borders between the degrees of Table 3.1, in metres. The table's sensor sees 30 cm, this one sees 10 m."""

LFD_SENSORS = (1, 2, 3, 4, 5, 6, 7, 8, 9)
NNQL_SENSORS = (1, 2, 3, 4, 7, 8, 9)
"""Section 4.4.1: sensors 5 and 6 look back, and action B makes up for them."""

Floats = NDArray[np.float64]


def with_ranges_from_zero(
    encode: Callable[[ArrayLike], NDArray[np.int64]],
) -> Callable[[ArrayLike], NDArray[np.int64]]:
    """Decorate an encoding so that it raises ValueError for ranges below 0."""

    @wraps(encode)
    def checked(ranges: ArrayLike) -> NDArray[np.int64]:
        if not (np.asarray(ranges) >= 0).all():
            raise ValueError(
                f"ranges must be numbers from 0 on, in metres, got {np.min(ranges)}"
            )
        return encode(ranges)

    return checked


@with_ranges_from_zero
def degree_of_danger(ranges: ArrayLike) -> NDArray[np.int64]:
    """Return the degrees of danger of ranges, 0 (nothing near) to 7 (collision): Table 3.1.

    Parameters
    ----------
    ranges : array
        Distances in metres, of any shape.

    Returns
    -------
    array of int
        Of the same shape.

    Raises
    ------
    ValueError
        If a range is negative or not a number.

    Examples
    --------
    >>> from robonav.robot import degree_of_danger
    >>> degree_of_danger([0.5, 1.0, 4.0, 9.9, 10.0])
    array([7, 6, 4, 1, 0])
    """
    degrees: NDArray[np.int64] = len(DANGER_BORDERS) - np.searchsorted(
        DANGER_BORDERS, ranges, side="right"
    )
    return degrees


def as_number(region: ArrayLike) -> Floats:
    """Encode the target's sector as the thesis does: its number 1 to 9, divided by 9; (N, 1).

    Sectors 9 and 1 are neighbours, but their numbers are far apart.

    Examples
    --------
    >>> from robonav.robot.encoding import as_number
    >>> as_number([1, 5, 6, 9]).round(2).ravel()
    array([0.11, 0.56, 0.67, 1.  ])
    """
    return np.asarray(region, dtype=float)[:, None] / SENSORS


def as_signed(region: ArrayLike) -> Floats:
    """Encode the target's sector by counting from ahead, left positive: -4 to 4, divided by 4; (N, 1).

    The jump from 4 to -4 lies behind the robot.

    Examples
    --------
    >>> from robonav.robot.encoding import as_signed
    >>> as_signed([1, 5, 6, 9]).ravel()
    array([ 0.  ,  1.  , -1.  , -0.25])
    """
    turn = np.asarray(region, dtype=float)[:, None] - 1
    return np.where(turn > SENSORS // 2, turn - SENSORS, turn) / (SENSORS // 2)


def as_one_hot(region: ArrayLike) -> Floats:
    """Encode the target's sector with one input for each sector: (N, 9).

    Examples
    --------
    >>> from robonav.robot.encoding import as_one_hot
    >>> as_one_hot([1, 5, 6, 9]).argmax(axis=1)
    array([0, 4, 5, 8])
    """
    rows: Floats = np.eye(SENSORS)[np.asarray(region) - 1]
    return rows


def as_sine_cosine(region: ArrayLike) -> Floats:
    """Encode the target's sector by the sine and cosine of its centre's angle to the heading: (N, 2).

    This encoding has no jump.

    Examples
    --------
    >>> from robonav.robot.encoding import as_sine_cosine
    >>> as_sine_cosine([1, 2]).round(2)
    array([[0.  , 1.  ],
           [0.64, 0.77]])
    """
    angle = (np.asarray(region, dtype=float) - 1) * SECTOR
    return np.column_stack([np.sin(angle), np.cos(angle)])


TARGET_ENCODINGS: dict[str, Callable[[ArrayLike], Floats]] = {
    "number": as_number,
    "signed": as_signed,
    "one-hot": as_one_hot,
    "sine-cosine": as_sine_cosine,
}
TARGET_WIDTHS = {"number": 1, "signed": 1, "one-hot": SENSORS, "sine-cosine": 2}


def lfd_state(sensing: Sensing) -> NDArray[np.int64]:
    """State vector of chapter 3, Eq. (3.17): 9 degrees of danger, target region, target seen.

    Parameters
    ----------
    sensing : Sensing
        What N robots sense.

    Returns
    -------
    (N, 11) int array
        Degrees of danger 0 to 7 of sensors 1 to 9, target region 1 to 9, target seen 0 or 1.

    Examples
    --------
    >>> from robonav.robot import lfd_state, make_world, sense
    >>> world = make_world(circles=[(20, 10, 2)])
    >>> lfd_state(sense(world, [(10, 10, 0)]))
    array([[2, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0]])
    """
    danger = degree_of_danger(sensing.ranges)
    parts = [danger, sensing.target_region, sensing.target_seen]
    return np.column_stack(parts)  # Eq. (3.17)


def nnql_state(sensing: Sensing) -> NDArray[np.int64]:
    """State vector of chapter 4, Eq. (4.5): 7 degrees of danger, target region, target seen, 7 wall flags.

    Parameters
    ----------
    sensing : Sensing
        What N robots sense.

    Returns
    -------
    (N, 16) int array
        Degrees of danger 0 to 7 of sensors 1 to 4 and 7 to 9, target region 1 to 9, target seen 0 or 1, and whether
        each of these sensors sees the map's border.

    Examples
    --------
    >>> from robonav.robot import make_world, nnql_state, sense
    >>> nnql_state(sense(make_world(), [(95, 50, 0)]))
    array([[3, 3, 0, 0, 0, 0, 3, 3, 0, 1, 1, 0, 0, 0, 0, 1]])
    """
    columns = [sensor - 1 for sensor in NNQL_SENSORS]
    danger, walls = (
        degree_of_danger(sensing.ranges[:, columns]),
        sensing.walls[:, columns],
    )
    target = np.column_stack([sensing.target_region, sensing.target_seen])
    return np.column_stack([danger, target, walls])  # Eq. (4.5)


@dataclass(frozen=True)
class Encoder:
    """A network's inputs: degrees of danger over 7, target sector, target seen, and optionally wall flags.

    All inputs lie between -1 and 1.

    Parameters
    ----------
    sensors : sequence of int
        Which of the sensors 1 to 9. Kept as a tuple.
    walls : bool
        Whether the wall flags of these sensors follow.
    target : {"number", "signed", "one-hot", "sine-cosine"}
        How the target's sector is encoded.

    Raises
    ------
    TypeError, ValueError
        For a sensor that does not exist, or another encoding of the target.

    Examples
    --------
    >>> from robonav.robot import Encoder, make_world, sense
    >>> encoder = Encoder(sensors=(1, 2, 9), target="signed")
    >>> encoder.size
    5
    >>> encoder(sense(make_world(), [(50, 50, 0)]))
    array([[0.  , 0.  , 0.  , 0.25, 0.  ]])
    """

    sensors: tuple[int, ...] = LFD_SENSORS
    walls: bool = False
    target: str = "sine-cosine"

    def __post_init__(self) -> None:
        sensors, walls = self.sensors, self.walls
        listed = sensors.tolist() if isinstance(sensors, np.ndarray) else sensors
        if not isinstance(listed, tuple | list):
            raise TypeError(f"sensors must be a sequence of numbers, got {sensors!r}")
        if not isinstance(walls, bool | np.bool_):
            raise TypeError(f"walls must be True or False, got {walls!r}")
        chosen = tuple(
            check_integer("sensors", sensor, at_least=1, at_most=SENSORS)
            for sensor in listed
        )
        object.__setattr__(self, "sensors", chosen)
        object.__setattr__(self, "walls", bool(walls))
        check_one_of("target", self.target, TARGET_ENCODINGS)

    @property
    def size(self) -> int:
        """Number of inputs."""
        return (
            len(self.sensors) * (2 if self.walls else 1)
            + TARGET_WIDTHS[self.target]
            + 1
        )

    def __call__(self, sensing: Sensing) -> Floats:
        """Encode what N robots sense as inputs (N, size)."""
        columns = [sensor - 1 for sensor in self.sensors]
        parts: list[NDArray] = [
            degree_of_danger(sensing.ranges[:, columns]) / len(DANGER_BORDERS),
            TARGET_ENCODINGS[self.target](sensing.target_region),
            sensing.target_seen[:, None],
        ]
        if self.walls:
            parts.append(sensing.walls[:, columns])
        return np.concatenate(parts, axis=1).astype(float)
