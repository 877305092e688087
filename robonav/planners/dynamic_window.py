"""A look-ahead over the six actions, after the dynamic window (Fox, Burgard and Thrun 1997)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robonav.robot import SENSOR_RANGE, Action, Sensing
from robonav.validation import check_positive, check_real

from .sectors import WAYS, Floats, free_way, target_bearing, turned

BACKWARDS = np.arange(6) == Action.B


def dynamic_window(
    sensing: Sensing,
    *,
    speed: float,
    clearance: float,
    half_width: float,
    heading: float,
    distance: float,
) -> Floats:
    """Scores of the six actions by a dynamic window (Fox, Burgard and Thrun 1997).

    The robot looks one step ahead. An action is admissible if its step keeps the clearance from all that is sensed. The
    score of an admissible action adds up how well the robot then faces its target, how far it could go on in this
    direction, and its velocity, which is 1 forwards and 0 backwards. The original has these three terms too, and a
    window of velocities that the motors can reach within one step. Here the six actions are that window.

    Parameters
    ----------
    sensing : Sensing
        What N robots sense.
    speed : float
        Length of a step in metres.
    clearance, half_width : float
        As in :func:`free_way`.
    heading, distance : float
        Weights of the first two terms; that of the velocity is 1.

    Returns
    -------
    (N, 6) array
        Scores of F, L30, L60, R30, R60 and B. Those of actions that are not admissible are negative, and the larger the
        farther the robot can go.

    Examples
    --------
    >>> from robonav.planners import dynamic_window
    >>> from robonav.robot import make_world, sense
    >>> sensing = sense(make_world(circles=[(53.5, 50, 1)], target=(90, 50)), [(50, 50, 0)])
    >>> weights = {"heading": 0.5, "distance": 0.5}
    >>> dynamic_window(sensing, speed=2.0, clearance=1.0, half_width=0.0, **weights).round(2)
    array([[-8.5 ,  1.92,  1.83,  1.92,  1.83,  1.  ]])
    """
    target = target_bearing(sensing)[:, None]
    facing = np.where(BACKWARDS, 0.0, WAYS)  # B does not turn the robot
    towards = 1 - np.abs(turned(target - facing)) / np.pi
    way = free_way(sensing.ranges, WAYS, clearance=clearance, half_width=half_width)
    velocity = np.where(BACKWARDS, 0.0, 1.0)
    score = heading * towards + distance * way / SENSOR_RANGE + velocity
    return np.where(way >= speed, score, way - SENSOR_RANGE)


@dataclass(frozen=True)
class DynamicWindow:
    """A policy that takes the action with the best score of :func:`dynamic_window`.

    It knows the nine ranges, the sector of the target and its own speed, and remembers nothing. Of equal scores the
    first in F, L30, L60, R30, R60, B wins.

    Parameters
    ----------
    speed, clearance, half_width, heading, distance : float
        As in :func:`dynamic_window`.

    Raises
    ------
    ValueError
        If a number is out of bounds.

    Examples
    --------
    >>> from robonav.planners import DynamicWindow
    >>> from robonav.robot import navigate, random_worlds
    >>> float(navigate(DynamicWindow(), random_worlds(100, obstacles=10, seed=1)).success.mean())
    0.97
    """

    speed: float = 2.0
    clearance: float = 2.0
    half_width: float = 0.17
    heading: float = 0.3
    distance: float = 1.0

    def __post_init__(self) -> None:
        check_positive("speed", self.speed)
        for name in ("clearance", "half_width", "heading", "distance"):
            check_real(name, getattr(self, name), at_least=0)

    def __call__(self, sensing: Sensing, rng: np.random.Generator) -> NDArray[np.int64]:
        """Return the actions (N,) of N robots."""
        scores = dynamic_window(
            sensing,
            speed=self.speed,
            clearance=self.clearance,
            half_width=self.half_width,
            heading=self.heading,
            distance=self.distance,
        )
        best: NDArray[np.int64] = scores.round(9).argmax(axis=1)
        return best
