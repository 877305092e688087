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


def _with_borders(borders, ranges, bearing, distance, reach):
    right = _encoded(ranges, bearing, distance, reach)
    right[:, :9] = (ranges[:, :, None] < borders).sum(axis=2)
    return right


def of_the_books_robot(ranges, bearing, distance, reach):
    """These are the borders for sensors that reach 10 m: scale them to ``reach``."""
    borders = np.array([3, 7, 11, 15, 20, 25, 30]) / 3
    return _with_borders(borders, ranges, bearing, distance, reach)


def rounded_borders(ranges, bearing, distance, reach):
    """Compute the borders from those of Table 3.1, 3 to 30 cm: those for 10 m are rounded on the page."""
    borders = np.array([1, 2.33, 3.67, 5, 6.67, 8.33, 10]) * reach / 10
    return _with_borders(borders, ranges, bearing, distance, reach)


def safe_is_seven(ranges, bearing, distance, reach):
    """The degree of danger is 7 for the nearest readings, and 0 where nothing is in range."""
    right = _encoded(ranges, bearing, distance, reach)
    right[:, :9] = 7 - right[:, :9]
    return right


def _with_region(region, ranges, bearing, distance, reach):
    right = _encoded(ranges, bearing, distance, reach)
    right[:, 9] = region
    return right


def not_around(ranges, bearing, distance, reach):
    """A bearing may be negative or more than a full turn: take the number of sectors modulo 9."""
    region = np.floor(bearing / np.radians(40) + 0.5).astype(int) + 1
    return _with_region(region, ranges, bearing, distance, reach)


def towards_zero(ranges, bearing, distance, reach):
    """Conversion to a whole number rounds towards zero, also below it: round down with ``numpy.floor``."""
    region = (bearing / np.radians(40) + 0.5).astype(int) % 9 + 1
    return _with_region(region, ranges, bearing, distance, reach)


def in_degrees(ranges, bearing, distance, reach):
    """The bearing is in radians: 40 degrees are 2 pi / 9."""
    region = np.floor(bearing / 40 + 0.5).astype(int) % 9 + 1
    return _with_region(region, ranges, bearing, distance, reach)


def seen_if_sensed(ranges, bearing, distance, reach):
    """The last number tells whether the target is in range, not whether an obstacle is."""
    right = _encoded(ranges, bearing, distance, reach)
    right[:, 10] = (ranges < reach).any(axis=1)
    return right
