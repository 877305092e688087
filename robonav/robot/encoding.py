"""From what the robot senses to the numbers a network reads: Table 3.1, Eq. (3.17) and (4.5)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_instance, check_integer, check_one_of

from ._fast import SECTOR, SENSOR_RANGE, SENSORS
from .simulator import Sensing

DANGER_BORDERS = np.array([3, 7, 11, 15, 20, 25, 30]) * SENSOR_RANGE / 30
"""Table 3.1 in metres: its sensor sees 30 cm, ours 10 m. Below the first border, degree 7: collision."""

LFD_SENSORS = (1, 2, 3, 4, 5, 6, 7, 8, 9)
NNQL_SENSORS = (
    1,
    2,
    3,
    4,
    7,
    8,
    9,
)  # section 4.4.1: action B makes up for 5 and 6, which look back

Floats = NDArray[np.float64]


def degree_of_danger(ranges: ArrayLike) -> NDArray[np.int64]:
    """Degrees of danger 0 (nothing near) to 7 (collision) of ranges in metres, any shape (Table 3.1).

    Raises
    ------
    ValueError : if a range is negative or not a number.
    """
    if not (np.asarray(ranges) >= 0).all():
        raise ValueError(
            f"ranges must be numbers from 0 on, in metres, got {np.min(ranges)}"
        )
    degrees: NDArray[np.int64] = len(DANGER_BORDERS) - np.searchsorted(
        DANGER_BORDERS, ranges, side="right"
    )
    return degrees


def as_number(region: ArrayLike) -> Floats:
    """The sector as the thesis has it, 1 to 9, over 9: (N, 1). Sector 9 lies next to 1 and far from it in number."""
    return np.asarray(region, dtype=float)[:, None] / SENSORS


def as_signed(region: ArrayLike) -> Floats:
    """The sector counted from ahead, left positive, -4 to 4, over 4: (N, 1). The break lies behind the robot."""
    turn = np.asarray(region, dtype=float)[:, None] - 1
    return np.where(turn > SENSORS // 2, turn - SENSORS, turn) / (SENSORS // 2)


def as_one_hot(region: ArrayLike) -> Floats:
    """One input a sector: (N, 9)."""
    rows: Floats = np.eye(SENSORS)[np.asarray(region) - 1]
    return rows


def as_sine_cosine(region: ArrayLike) -> Floats:
    """Sine and cosine of the sector's centre against the heading: (N, 2). Nowhere a break."""
    angle = (np.asarray(region, dtype=float) - 1) * SECTOR
    return np.column_stack([np.sin(angle), np.cos(angle)])


TARGET_ENCODINGS: dict[str, Callable[[ArrayLike], Floats]] = {
    "number": as_number,
    "signed": as_signed,
    "one-hot": as_one_hot,
    "sine-cosine": as_sine_cosine,
}
TARGET_WIDTHS = {"number": 1, "signed": 1, "one-hot": SENSORS, "sine-cosine": 2}


def _columns(sensors: tuple[int, ...]) -> list[int]:
    return [
        check_integer("sensors", sensor, at_least=1, at_most=SENSORS) - 1
        for sensor in sensors
    ]


def lfd_state(sensing: Sensing) -> NDArray[np.int64]:
    """The state of 11 numbers, Eq. (3.17): 9 degrees of danger, target region 1..9, target seen 0/1."""
    return np.column_stack(
        [degree_of_danger(sensing.ranges), sensing.target_region, sensing.target_seen]
    )


def nnql_state(sensing: Sensing) -> NDArray[np.int64]:
    """The state of 16 numbers, Eq. (4.5): 7 degrees of danger, target region 1..9, target seen 0/1, 7 wall flags."""
    columns = _columns(NNQL_SENSORS)
    degrees = degree_of_danger(sensing.ranges[:, columns])
    return np.column_stack(
        [degrees, sensing.target_region, sensing.target_seen, sensing.walls[:, columns]]
    )


@dataclass(frozen=True)
class Encoder:
    """What a network reads: degrees of danger over 7, target sector, target seen, and perhaps wall flags.

    Parameters
    ----------
    sensors : which of the sensors 1 to 9.
    walls : whether the wall flags of these sensors follow.
    target : how the target's sector is written: "number", "signed", "one-hot" or "sine-cosine".

    Raises
    ------
    ValueError : for a sensor that is not there or another target encoding.
    """

    sensors: tuple[int, ...] = LFD_SENSORS
    walls: bool = False
    target: str = "sine-cosine"

    def __post_init__(self) -> None:
        _columns(check_instance("sensors", self.sensors, tuple))
        check_instance("walls", self.walls, bool)
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
        """Inputs (N, size) of N robots."""
        columns = _columns(self.sensors)
        parts: list[NDArray] = [
            degree_of_danger(sensing.ranges[:, columns]) / len(DANGER_BORDERS),
            TARGET_ENCODINGS[self.target](sensing.target_region),
            sensing.target_seen[:, None],
        ]
        if self.walls:
            parts.append(sensing.walls[:, columns])
        return np.concatenate(parts, axis=1).astype(float)
