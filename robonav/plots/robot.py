"""The robot, its worlds and its paths: Fig. 2.6, Fig. 2.7, paths over maps, animations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

from robonav import style
from robonav.robot import SENSOR_RANGE, Simulator, Worlds, obstacle_tracks, sense
from robonav.robot.drawing import draw_robot, draw_sensors, draw_world

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.figure import Figure


def draw_sectors(axes: Axes) -> None:
    """Draw the robot from above with its nine sectors, numbered (Fig. 2.6); it heads to the right.

    Parameters
    ----------
    axes : Axes
        The axes to draw on. Their frame and ticks are removed.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_sectors(axes)
    >>> len(axes.texts) >= 9
    True
    """
    draw_sensors(axes, (0.0, 0.0, 0.0), [SENSOR_RANGE] * 9, numbered=True)
    draw_robot(axes, (0.0, 0.0, 0.0))
    axes.set(
        xlim=(-11, 11),
        ylim=(-11, 11),
        aspect="equal",
        xlabel="ahead (m)",
        ylabel="left (m)",
    )
    axes.grid(False)


def draw_sensing(
    axes: Axes, worlds: Worlds, pose: ArrayLike, *, around: float | None = None
) -> None:
    """Draw what a robot at ``pose`` senses in the first world, with the distances of Fig. 2.7.

    Parameters
    ----------
    axes : Axes
        To draw on.
    worlds : Worlds
        The first of them is drawn.
    pose : (3,) array
        x and y in metres and heading in radians.
    around : float, optional
        Show this many metres around the robot instead of the whole map.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.robot import make_world
    >>> axes = Figure().add_subplot()
    >>> draw_sensing(axes, make_world(circles=[(58, 50, 2)]), (50, 50, 0))
    >>> len(axes.patches) > 0
    True
    """
    x, y, _ = placed = np.asarray(pose, dtype=float)
    ranges = sense(worlds[0], [placed]).ranges[0]
    draw_world(axes, worlds)
    draw_sensors(axes, placed, ranges, numbered=around is not None)
    draw_robot(axes, placed)
    if around is None:
        target = worlds.targets[0]
        axes.plot(
            [x, target[0]],
            [y, target[1]],
            color=style.TARGET,
            linestyle=":",
            linewidth=1.2,
        )
        axes.annotate("$d_{r-t}$", ((x + target[0]) / 2, (y + target[1]) / 2), xytext=(6, -12),
                      textcoords="offset points", color=style.TARGET)  # fmt: skip
    else:
        axes.set(xlim=(x - around, x + around), ylim=(y - around, y + around))


def draw_paths(
    axes: Axes,
    worlds: Worlds,
    paths: Sequence[ArrayLike],
    *,
    colour: str = style.ROBOT,
    labels: Sequence[str] = (),
) -> None:
    """Draw paths over the first world's map, each from its start, with a dot for each step.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    worlds : Worlds
        The map of the first one is drawn.
    paths : sequence of (steps + 1, 3) arrays
        The poses of each path.
    colour : str
        The colour of the paths.
    labels : sequence of str
        Their names in the legend.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.robot import navigate, random_worlds, straight
    >>> worlds = random_worlds(1, obstacles=0, seed=1)
    >>> axes = Figure().add_subplot()
    >>> draw_paths(axes, worlds, navigate(straight, worlds, record_paths=True).paths)
    >>> len(axes.lines) > 0
    True
    """
    draw_world(axes, worlds)
    for k, path in enumerate(paths):
        x, y = np.asarray(path)[:, :2].T
        axes.plot(
            x,
            y,
            color=colour,
            linewidth=1.2,
            marker=".",
            markersize=3,
            label=labels[k] if labels else None,
        )


def draw_maps(
    figure: Figure, worlds: Worlds, paths: Sequence[ArrayLike] = (), titles: Sequence[str] = (), *, columns: int = 4,
    colour: str = style.ROBOT,
) -> None:  # fmt: skip
    """Draw a grid of maps, one for each world, with the robot's path in each.

    Parameters
    ----------
    figure : Figure
        Gets a panel for each world.
    worlds : Worlds
        The maps.
    paths : sequence of (steps + 1, 3) arrays
        A path for each map, if any.
    titles : sequence of str
        A title for each map, if any.
    columns : int
        Panels in a row.
    colour : str
        The colour of the paths.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.robot import random_worlds
    >>> figure = Figure()
    >>> draw_maps(figure, random_worlds(2, seed=1), titles=["one", "two"])
    >>> [axes.get_title() for axes in figure.axes]
    ['one', 'two']
    """
    rows = -(-len(worlds) // columns)
    for i, world in enumerate(worlds):
        axes = figure.add_subplot(rows, columns, i + 1)
        draw_paths(axes, world, [paths[i]] if len(paths) else [], colour=colour)
        axes.set(
            xticks=[],
            yticks=[],
            xlabel="",
            ylabel="",
            title=titles[i] if len(titles) else "",
        )


def animate_episode(
    world: Worlds,
    path: NDArray[np.float64],
    *,
    every: int = 1,
    colour: str = style.ROBOT,
    size: float = 4.6,
) -> FuncAnimation:
    """Animate an episode of a robot in the first world, with its sensors and the moving obstacles.

    Parameters
    ----------
    world : Worlds
        A batch, of which the first world is drawn.
    path : (steps + 1, 3) array
        Poses, as ``navigate(..., record_paths=True)`` returns them.
    every : int
        Draw every step whose number is a multiple of this; the last step is always drawn.
    colour : str
        The colour of the robot and its path.
    size : float
        The side of the square picture in inches.

    Returns
    -------
    FuncAnimation

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> from robonav.plots.player import player
    >>> from robonav.robot import make_world, navigate, straight
    >>> world = make_world(start=(86, 90), target=(90, 90))
    >>> path = navigate(straight, world, record_paths=True).paths[0]
    >>> "It arrives" in player(animate_episode(world, path), description="It arrives").data
    True
    >>> plt.close()
    """
    from matplotlib import pyplot as plt
    from matplotlib.animation import FuncAnimation

    tracks = obstacle_tracks(world[0], len(path) - 1)[0]
    frames = sorted({*range(0, len(path), every), len(path) - 1})
    figure, axes = plt.subplots(figsize=(size, size))
    eyes = Simulator(world[0])

    def draw(step: int) -> list:
        axes.clear()
        draw_world(axes, world, tracks[step])
        axes.plot(path[: step + 1, 0], path[: step + 1, 1], color=colour, linewidth=1.4)
        eyes.poses, eyes.centres = path[step : step + 1], tracks[step][None]
        draw_sensors(axes, path[step], eyes.sense().ranges[0])
        draw_robot(axes, path[step], colour)
        axes.set(title=f"{step} s", xlabel="", ylabel="")
        return []

    return FuncAnimation(figure, draw, frames=frames, interval=120)


def draw_outcomes(axes: Axes, rates: dict[str, tuple[float, float, float]]) -> None:
    """Draw success rates with their intervals: the value of each label is (rate, low, high), all in [0, 1].

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    rates : dict
        Rate, low and high of each label, all in [0, 1].

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_outcomes(axes, {"straight": (0.5, 0.4, 0.6)})
    >>> [label.get_text() for label in axes.get_yticklabels()]
    ['straight']
    """
    for row, (label, (rate, low, high)) in enumerate(rates.items()):
        colour = style.METHOD_COLOURS.get(label, style.BLUE)
        axes.barh(row, 100 * rate, color=colour, height=0.6)
        axes.plot([100 * low, 100 * high], [row, row], color=style.INK, linewidth=2)
        axes.annotate(
            f"{100 * rate:.1f} %",
            (100 * high, row),
            xytext=(6, 0),
            textcoords="offset points",
            va="center",
        )
    axes.set(
        yticks=range(len(rates)),
        yticklabels=list(rates),
        xlim=(0, 112),
        xlabel="episodes that arrive (%)",
    )
    axes.set_xticks(range(0, 101, 20))
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
