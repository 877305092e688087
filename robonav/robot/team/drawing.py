"""Several robots on one map as matplotlib artists."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from numpy.typing import ArrayLike, NDArray

from robonav import style

from .._fast import ARRIVAL_DISTANCE
from ..drawing import draw_robot, obstacle_patches, prepare
from .teams import Teams

COLOURS = (
    style.BLUE,
    style.ORANGE,
    style.GREEN,
    style.PURPLE,
    style.SKY,
    style.VERMILION,
)
"""Of the robots, in turn."""


def colour_of(robot: int) -> str:
    """Return the colour of a robot by its number.

    Examples
    --------
    >>> colour_of(0) == colour_of(len(COLOURS))
    True
    """
    return COLOURS[robot % len(COLOURS)]


def draw_team_map(axes: Axes, teams: Teams, centres: ArrayLike | None = None) -> None:
    """The first map: borders, obstacles, and start (a square) and target (a ring) of each robot, in its colour.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.robot.team import random_teams
    >>> axes = Figure().add_subplot()
    >>> draw_team_map(axes, random_teams(1, robots=4, obstacles=10, seed=1))
    >>> len(axes.patches)  # the border, ten obstacles and four targets
    15
    """
    prepare(axes, teams.worlds.size)
    for patch in obstacle_patches(teams.worlds, centres):
        axes.add_patch(patch)
    for robot in range(teams.robots):
        colour, place = colour_of(robot), tuple(teams.targets[0, robot])
        axes.plot(
            *teams.starts[0, robot], marker="s", color=colour, markersize=4, ls="none"
        )
        axes.add_patch(
            Circle(place, ARRIVAL_DISTANCE, fill=False, edgecolor=colour, linewidth=1.5)
        )


def draw_team(
    axes: Axes,
    teams: Teams,
    centres: ArrayLike,
    poses: NDArray[np.float64],
    running: NDArray[np.bool_],
) -> None:
    """The first map now: the obstacles at ``centres`` (M, 2), and at ``poses`` (R, 3) the robots that are running.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.robot.team import random_teams
    >>> teams = random_teams(1, robots=4, obstacles=10, seed=1)
    >>> axes = Figure().add_subplot()
    >>> draw_team(axes, teams, teams.worlds.centres[0], teams.start_poses, np.array([True, True, False, False]))
    >>> len(axes.patches)  # fifteen, and two robots
    17
    """
    draw_team_map(axes, teams, centres)
    for robot in np.flatnonzero(running).tolist():
        draw_robot(axes, poses[robot], colour_of(robot))


def draw_team_paths(
    axes: Axes, teams: Teams, paths: Sequence[NDArray[np.float64]], met: ArrayLike
) -> None:
    """The first map and the way (steps + 1, 3) of each robot on it; a cross where it met another robot.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.robot import straight
    >>> from robonav.robot.team import navigate_team, random_teams
    >>> teams = random_teams(1, robots=4, obstacles=10, seed=1)
    >>> result = navigate_team(straight, teams, record_paths=True)
    >>> axes = Figure().add_subplot()
    >>> draw_team_paths(axes, teams, result.paths, result.met[0])
    >>> len(axes.lines)  # a start and a way each, and two crosses
    10
    """
    draw_team_map(axes, teams)
    for robot, hit in enumerate(np.asarray(met)):
        path, colour = paths[robot], colour_of(robot)
        axes.plot(path[:, 0], path[:, 1], color=colour, linewidth=1.2)
        if hit:
            axes.plot(*path[-1, :2], marker="x", color=style.INK, markersize=8)
