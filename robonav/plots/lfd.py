"""Plans, demonstrations and learned drives over their maps (Fig. 3.4-3.6, 3.9, 3.10)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, to_rgba
from numpy.typing import ArrayLike, NDArray

from robonav import look
from robonav.lfd import Demonstrations, GridPlan, Plan
from robonav.robot import Worlds, obstacle_tracks
from robonav.robot.drawing import draw_robot, draw_world

if TYPE_CHECKING:
    from matplotlib.figure import Figure

VISITED = LinearSegmentedColormap.from_list("visited", [to_rgba(look.SKY, 0.75), to_rgba(look.PURPLE, 0.75)])


def draw_search(axes: Axes, world: Worlds, made: Plan | GridPlan, *, colour: str = look.METHODS["A*"]) -> None:
    """A plan as stars and what its search visited as dots, light for early and dark for late (Fig. 3.4)."""
    draw_world(axes, world)
    if made.visited is not None:
        x, y = made.visited[:, 0], made.visited[:, 1]
        axes.scatter(x, y, c=np.arange(len(x)), cmap=VISITED, s=1.5, linewidths=0, rasterized=True)
    axes.plot(*made.points.T, marker="*", markersize=4, linewidth=0.8, color=colour)


def draw_ways(
    axes: Axes, world: Worlds, ways: Mapping[str, ArrayLike], *, colours: Mapping[str, str] = look.METHODS
) -> None:
    """Several ways (steps + 1, 2 or 3) over one map, named as in ``look.METHODS`` (Fig. 3.5, 3.9)."""
    draw_world(axes, world)
    for name, way in ways.items():
        x, y = np.asarray(way)[:, :2].T
        axes.plot(x, y, color=colours.get(name, look.BLUE), linewidth=1.6, label=name)


def draw_demonstrations(
    figure: Figure, demonstrations: Demonstrations, drives: Sequence[int], *, columns: int = 4
) -> None:
    """Some drives over their maps; steps that are learned from stand out (Fig. 3.6)."""
    rows = -(-len(drives) // columns)
    for place, drive in enumerate(drives, start=1):
        axes = figure.add_subplot(rows, columns, place)
        draw_world(axes, demonstrations.worlds[drive])
        shown = demonstrations.drives([drive])
        axes.plot(*shown.poses[:, :2].T, color=look.GREY, linewidth=1)
        axes.plot(*shown.effective.poses[:, :2].T, color=look.METHODS["A*"], linestyle="none", marker=".", markersize=4)
        axes.set(xticks=[], yticks=[], xlabel="", ylabel="", title=str(demonstrations.outcome[drive]))


def draw_moments(
    figure: Figure, world: Worlds, path: NDArray[np.float64], moments: Sequence[int], *, colour: str = look.ROBOT
) -> None:
    """A drive among moving obstacles at some moments: the robot, its way so far, the obstacles then (Fig. 3.10)."""
    tracks = obstacle_tracks(world, len(path) - 1)[0]
    for place, moment in enumerate(moments, start=1):
        axes = figure.add_subplot(1, len(moments), place)
        draw_world(axes, world, tracks[moment])
        axes.plot(*path[: moment + 1, :2].T, color=colour, linewidth=1.4)
        draw_robot(axes, path[moment], colour)
        axes.set(xticks=[], yticks=[], xlabel="", ylabel="", title=f"{moment} s")
