"""Several robots on one map in plain NumPy: the simulator to read.

Each robot is a :class:`~robonav.robot.plain_environment.PlainNavigationEnv`, which knows how one robot moves and senses
among obstacles that stand still. This file adds what several have to do with each other. ``simulator.py`` is its
compiled twin, for N maps at once; tests hold the two equal.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..plain_environment import (
    ARRIVAL_DISTANCE,
    COLLISION_DISTANCE,
    Observation,
    PlainNavigationEnv,
)
from ..simulator import Outcome
from .teams import Teams

ROBOT_RADIUS = 1.0  # metres, as all distances

Array = NDArray[np.float64]


class PlainTeam:
    """R robots cross one map at once.

    In each second all robots choose their actions by what they sensed, then all move, then all sense. The others are
    circles of 1 m on a robot's sensors. Robots collide when their centres come nearer than 2 m, anywhere on their way.
    A robot that has arrived or collided leaves the map.

    Parameters
    ----------
    team : Teams
        One map, whose obstacles stand still.
    speed : float
        Of the robots, in m/s.
    direction : {"exact", "sector"}
        What the reflex knows of the direction of the target.

    Attributes
    ----------
    robots : dict of int to PlainNavigationEnv
        The robots that are on the map, by number.

    Examples
    --------
    Robots that only go forward meet in the middle:

    >>> from robonav.robot.team import random_teams
    >>> from robonav.robot.team.plain import PlainTeam
    >>> team = PlainTeam(random_teams(1, robots=4, obstacles=0, seed=0))
    >>> seconds = 0
    >>> while team.robots:
    ...     outcomes, seconds = team.step(dict.fromkeys(team.robots, 0)), seconds + 1
    >>> seconds, {robot: outcome.name for robot, outcome in outcomes.items()}
    (28, {0: 'COLLIDED', 1: 'COLLIDED', 2: 'COLLIDED', 3: 'COLLIDED'})
    """

    def __init__(
        self, team: Teams, speed: float = 2.0, direction: str = "exact"
    ) -> None:
        self.robots: dict[int, PlainNavigationEnv] = {}
        for number, pose in enumerate(team.start_poses):
            robot = PlainNavigationEnv(speed=speed, direction=direction)
            robot.enter(team.worlds)
            robot.position, robot.heading = pose[:2], pose[2]
            robot.target = team.targets[0, number]
            self.robots[number] = robot
        self.sense()

    def step(self, actions: Mapping[int, int]) -> dict[int, Outcome]:
        """Simulate one second, and return how the episodes of the robots stand then, by number."""
        before = {number: robot.position for number, robot in self.robots.items()}
        for number, robot in self.robots.items():
            robot.heading, distance = robot.heading_and_distance(actions[number])
            ahead = np.array([math.cos(robot.heading), math.sin(robot.heading)])
            robot.position = before[number] + distance * ahead

        outcomes = {}
        for number, robot in self.robots.items():
            clearance = robot.clearance(before[number], robot.position)
            for other, met in self.robots.items():
                if other != number:
                    apart = least_distance(
                        before[number] - before[other], robot.position - met.position
                    )
                    clearance = min(clearance, round(apart - ROBOT_RADIUS, 6))
            outcomes[number] = outcome_of(robot, clearance)

        for number, outcome in outcomes.items():
            if outcome != Outcome.RUNNING:
                del self.robots[number]
        self.sense()
        return outcomes

    def sense(self) -> dict[int, Observation]:
        """Let each robot sense the obstacles, the borders and the other robots; return the observations by number."""
        observations = {}
        for number, robot in self.robots.items():
            others = [
                [*other.position, ROBOT_RADIUS]
                for other in self.robots.values()
                if other is not robot
            ]
            standing = robot.circles
            robot.circles = np.array([*standing, *others]).reshape(-1, 3)
            observations[number] = robot.sense()
            robot.circles = standing
        return observations


def outcome_of(robot: PlainNavigationEnv, clearance: float) -> Outcome:
    """Return how a robot's episode stands after a second with this clearance."""
    if clearance < COLLISION_DISTANCE:
        return Outcome.COLLIDED
    if robot.target_distance() <= ARRIVAL_DISTANCE:
        return Outcome.ARRIVED
    return Outcome.RUNNING


def least_distance(before: Array, after: Array) -> float:
    """Return the least distance of two robots that go straight, from where one is seen from the other (2,).

    Seen from the one, the other goes along a segment too, from ``before`` to ``after``. The nearest point of that
    segment is where its way stands at a right angle to the line of sight, or an end.

    Examples
    --------
    >>> import numpy as np
    >>> least_distance(np.array([3.0, 1.0]), np.array([-1.0, 1.0]))  # it passes by, one metre away
    1.0
    """
    way = after - before
    length2 = way @ way
    part = 0.0 if length2 == 0.0 else np.clip(-(before @ way) / length2, 0.0, 1.0)
    return float(np.hypot(*(before + part * way)))
