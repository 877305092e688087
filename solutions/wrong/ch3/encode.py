"""Known mistakes in 3.2; a function's docstring is its hint."""

import numpy as np


def _encoded(
    ranges,
    bearing,
    distance,
    reach,
    *,
    scale=None,
    strict=True,
    shift=0.5,
    turn=1,
    first=1,
    over=False,
):
    borders = np.array([3, 7, 11, 15, 20, 25, 30]) * (
        (reach if scale is None else scale) / 30
    )
    below = ranges[:, :, None] < borders if strict else ranges[:, :, None] <= borders
    region = np.floor(turn * bearing / np.radians(40) + shift).astype(int) % 9 + first
    return np.column_stack(
        [below.sum(axis=2), region, distance < reach if over else distance <= reach]
    ).astype(int)


def in_centimetres(ranges, bearing, distance, reach):
    """The borders of Table 3.1 are for a range of 30 cm: scale them to the range of this sensor."""
    return _encoded(ranges, bearing, distance, reach, scale=0.3)


def on_the_border(ranges, bearing, distance, reach):
    """A reading on a border has the lesser danger: the table has r < 3, then 3 <= r < 7."""
    return _encoded(ranges, bearing, distance, reach, strict=False)


def from_the_edge(ranges, bearing, distance, reach):
    """Region 1 is centred straight ahead: it extends 20 degrees to either side."""
    return _encoded(ranges, bearing, distance, reach, shift=0.0)


def clockwise(ranges, bearing, distance, reach):
    """The regions are numbered counter-clockwise, in the direction in which the bearing is measured."""
    return _encoded(ranges, bearing, distance, reach, turn=-1)


def from_zero(ranges, bearing, distance, reach):
    """The regions are numbered from 1 to 9."""
    return _encoded(ranges, bearing, distance, reach, first=0)


def just_out_of_reach(ranges, bearing, distance, reach):
    """A target whose distance equals the range of the sensors is still in range."""
    return _encoded(ranges, bearing, distance, reach, over=True)
