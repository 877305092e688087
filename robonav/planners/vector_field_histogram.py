"""The vector field histogram VFH+ (Ulrich and Borenstein 1998)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.robot import SENSOR_RANGE, Sensing
from robonav.validation import check_integer, check_positive, check_real

from .sectors import CENTRES, Floats, action_towards, target_bearing, turned

BINS = 72  # of 5 degrees each, as in the paper
DIRECTIONS: Floats = turned(np.arange(BINS) * 2 * np.pi / BINS)
"""Bearings (72,) of the bins in radians, counter-clockwise from 0, which is ahead."""

OFF: Floats = np.abs(turned(DIRECTIONS - CENTRES[:, None]))
"""Angles (9, 72) between the middles of the sectors and the bins."""

FARTHEST = np.radians(90) + 1e-9
"""A robot that turns by at most 60 degrees in a step does not go in directions beyond this one; they are masked."""


def polar_histogram(
    ranges: ArrayLike, *, clearance: float, half_width: float
) -> Floats:
    """Primary polar histogram of VFH+: how much obstacle lies in each direction (Ulrich and Borenstein 1998).

    A reading d has the magnitude 1 - (d / 10)^2. It counts in all bins within the half width of the obstacle, enlarged
    by the angle arcsin(clearance / d) that the robot's own size takes.

    Parameters
    ----------
    ranges : (N, 9) array
        What the sectors read, in metres.
    clearance : float
        Radius of the robot and its safety distance, in metres.
    half_width : float
        Radians by which the obstacle reaches to either side of the middle of its sector.

    Returns
    -------
    (N, 72) array
        Bin b is the direction of 5 b degrees, counter-clockwise, 0 ahead.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.planners import polar_histogram
    >>> ranges = np.full((1, 9), 10.0)
    >>> ranges[0, 0] = 5.0
    >>> polar_histogram(ranges, clearance=1.0, half_width=0.0)[0, :4]
    array([0.75, 0.75, 0.75, 0.  ])
    """
    distance = np.maximum(ranges, 1e-9)
    magnitude = 1 - (distance / SENSOR_RANGE) ** 2
    reach = half_width + np.arcsin(np.minimum(clearance / distance, 1.0))
    covered = reach[:, :, None] + 1e-9 >= OFF
    histogram: Floats = np.einsum("nk,nkb->nb", magnitude, covered)
    return histogram


def vector_field_histogram(
    histogram: ArrayLike, target: ArrayLike, *, threshold: float, wide: int, keep: float
) -> Floats:
    """Directions that VFH+ chooses in polar histograms (Ulrich and Borenstein 1998).

    Bins below the threshold are free, unless they are masked. A candidate is the middle of a narrow opening, or a
    direction in a wide one that is half a width away from both its edges. The candidate of least cost wins. The cost is
    the angle to the target, plus ``keep`` times the angle to the heading.

    The paper's second threshold, for bins that were free before, and its term for the direction chosen before are left
    out: the first needs a memory, and the second is the heading here.

    Parameters
    ----------
    histogram : (N, 72) array
        As :func:`polar_histogram` returns it.
    target : (N,) array
        Bearings of the targets in radians.
    threshold : float
        Bins with at least this much obstacle are blocked.
    wide : int
        An opening of more bins than this is wide.
    keep : float
        Weight of the angle to the heading; the weight of the angle to the target is 1.

    Returns
    -------
    (N,) array
        Bearings in radians; pi, backwards, where nothing is free.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.planners import vector_field_histogram
    >>> histogram = np.zeros((1, 72))
    >>> histogram[0, :4] = 1.0  # blocked from 0 to 15 degrees to the left
    >>> best = vector_field_histogram(histogram, [0.1], threshold=0.5, wide=8, keep=0.0)
    >>> np.degrees(best).round()
    array([-25.])
    """
    free = np.less(histogram, threshold) & (np.abs(DIRECTIONS) <= FARTHEST)
    beside = range(1, wide + 1)
    left, right = (
        np.logical_and.accumulate([np.roll(free, b, axis=1) for b in bins]).sum(axis=0)
        for bins in ([-b for b in beside], beside)
    )
    half = wide // 2
    inside = free & (np.minimum(left, right) >= half)
    narrow = free & (left + right < wide) & (np.abs(left - right) <= 1)
    candidate = inside | narrow
    to_target = np.abs(turned(DIRECTIONS - np.reshape(target, (-1, 1))))
    cost = np.where(candidate, to_target + keep * np.abs(DIRECTIONS), np.inf)
    best = DIRECTIONS[cost.round(9).argmin(axis=1)]
    return np.where(candidate.any(axis=1), best, np.pi)


@dataclass(frozen=True)
class VectorFieldHistogram:
    """A policy that goes where VFH+ finds an opening.

    It knows the nine ranges and the sector of the target, and remembers nothing. Where nothing is free it steps back.

    Parameters
    ----------
    clearance, half_width : float
        As in :func:`polar_histogram`.
    threshold : float
        As in :func:`vector_field_histogram`.
    wide : int
        As in :func:`vector_field_histogram`.
    keep : float
        As in :func:`vector_field_histogram`.

    Raises
    ------
    ValueError
        If a number is out of bounds.

    Examples
    --------
    >>> from robonav.planners import VectorFieldHistogram
    >>> from robonav.robot import navigate, random_worlds
    >>> policy = VectorFieldHistogram()
    >>> float(navigate(policy, random_worlds(100, obstacles=10, seed=1)).success.mean())
    1.0
    """

    clearance: float = 1.5
    half_width: float = 0.0
    threshold: float = 0.3
    wide: int = 16
    keep: float = 0.5

    def __post_init__(self) -> None:
        check_real("clearance", self.clearance, at_least=0)
        check_real("half_width", self.half_width, at_least=0)
        check_positive("threshold", self.threshold)
        check_integer("wide", self.wide, at_least=2, at_most=BINS // 2)
        check_real("keep", self.keep, at_least=0)

    def __call__(self, sensing: Sensing, rng: np.random.Generator) -> NDArray[np.int64]:
        """Return the actions (N,) of N robots."""
        histogram = polar_histogram(
            sensing.ranges, clearance=self.clearance, half_width=self.half_width
        )
        bearing = vector_field_histogram(
            histogram,
            target_bearing(sensing),
            threshold=self.threshold,
            wide=self.wide,
            keep=self.keep,
        )
        return action_towards(bearing, back=True)
