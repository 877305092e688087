"""Worlds and robots as matplotlib artists: the environments and plots use them, and the pages draw the same shapes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch, Polygon, Rectangle, Wedge
from numpy.typing import ArrayLike, NDArray

from robonav import style

from . import _fast
from .worlds import Worlds

ROBOT_LENGTH = 4.0  # metres; the robot is a point, its picture is not


def prepare(axes: Axes, size: float) -> None:
    """A square map with its borders as walls and metres on both axes."""
    axes.set(
        xlim=(-1, size + 1),
        ylim=(-1, size + 1),
        aspect="equal",
        xlabel="x (m)",
        ylabel="y (m)",
    )
    axes.grid(False)
    axes.add_patch(
        Rectangle(
            (0, 0), size, size, fill=False, edgecolor=style.OBSTACLE, linewidth=1.5
        )
    )


def obstacle_patches(worlds: Worlds, centres: ArrayLike | None = None) -> list[Patch]:
    """The obstacles of the first world, at ``centres`` (M, 2) or where they start.

    Examples
    --------
    >>> from robonav.robot import make_world
    >>> [type(patch).__name__ for patch in obstacle_patches(make_world(circles=[(50, 50, 2)]))]
    ['Circle']
    """
    placed = worlds.centres[0] if centres is None else np.asarray(centres)
    patches: list[Patch] = []
    for m in np.flatnonzero(worlds.kinds[0]):
        a, b, turned = worlds.shapes[0, m]
        colour = style.MOVING if worlds.speeds[0, m] > 0 else style.OBSTACLE
        if worlds.kinds[0, m] == _fast.CIRCLE:
            patches.append(Circle(tuple(placed[m]), a, color=colour))
        else:
            corner = placed[m] - [a, b]
            patches.append(
                Rectangle(
                    tuple(corner),
                    2 * a,
                    2 * b,
                    angle=np.degrees(turned),
                    rotation_point="center",
                    color=colour,
                )
            )
    return patches


def draw_world(axes: Axes, worlds: Worlds, centres: ArrayLike | None = None) -> None:
    """The first world of a batch: borders, obstacles, start (a square) and target (a ring as wide as arrival).

    Examples
    --------
    >>> from robonav.robot import random_worlds
    >>> axes = Figure().add_subplot()
    >>> draw_world(axes, random_worlds(1, obstacles=10, seed=1))
    >>> len(axes.patches)  # ten obstacles, the border and the target
    12
    """
    prepare(axes, worlds.size)
    for patch in obstacle_patches(worlds, centres):
        axes.add_patch(patch)
    axes.plot(
        *worlds.starts[0], marker="s", color=style.ROBOT, markersize=6, linestyle="none"
    )
    axes.add_patch(
        Circle(
            tuple(worlds.targets[0]),
            _fast.ARRIVAL_DISTANCE,
            fill=False,
            edgecolor=style.TARGET,
            linewidth=2,
        )
    )


def robot_outline(pose: ArrayLike) -> NDArray[np.float64]:
    """Corners (3, 2) of the triangle that stands for the robot at ``pose``; its tip looks ahead.

    Examples
    --------
    >>> robot_outline([10.0, 10.0, 0.0])[0]  # the tip
    array([12., 10.])
    """
    x, y, heading = np.asarray(pose, dtype=float)
    angles = heading + np.array([0.0, 2.5, -2.5])
    corners: NDArray[np.float64] = np.column_stack([np.cos(angles), np.sin(angles)])
    return np.array([x, y]) + ROBOT_LENGTH / 2 * corners


def draw_robot(axes: Axes, pose: ArrayLike, colour: str = style.ROBOT) -> Polygon:
    """The robot at ``pose`` (x, y, heading).

    Examples
    --------
    >>> axes = Figure().add_subplot()
    >>> type(draw_robot(axes, [10.0, 10.0, 0.0])).__name__
    'Polygon'
    """
    artist = Polygon(robot_outline(pose), closed=True, color=colour, zorder=5)
    axes.add_patch(artist)
    return artist


def draw_sensors(
    axes: Axes, pose: ArrayLike, ranges: Iterable[float], *, numbered: bool = False
) -> list[Wedge]:
    """The nine sectors, each as far as it reads (Fig. 2.6); warm where something is near.

    Examples
    --------
    >>> axes = Figure().add_subplot()
    >>> len(draw_sensors(axes, [10.0, 10.0, 0.0], [10.0] * 9))
    9
    """
    x, y, heading = np.asarray(pose, dtype=float)
    half = np.degrees(_fast.SECTOR) / 2
    wedges = []
    for k, distance in enumerate(ranges):
        middle = np.degrees(heading) + 2 * half * k
        near = distance < _fast.SENSOR_RANGE
        wedge = Wedge(
            (x, y), distance, middle - half, middle + half, linewidth=0.6, edgecolor=style.ROBOT,
            facecolor=style.ORANGE if near else style.SKY, alpha=0.35 if near else 0.15,
        )  # fmt: skip
        axes.add_patch(wedge)
        wedges.append(wedge)
        if numbered:
            angle = np.radians(middle)
            axes.annotate(
                str(k + 1), (x + 0.7 * distance * np.cos(angle), y + 0.7 * distance * np.sin(angle)),
                ha="center", va="center", fontsize=9, color=style.INK,
            )  # fmt: skip
    return wedges


def draw_moment(
    axes: Axes, worlds: Worlds, centres: ArrayLike, pose: ArrayLike, ranges: ArrayLike
) -> None:
    """A robot now: the first world, its obstacles at ``centres`` (M, 2), the robot and its nine ranges."""
    draw_world(axes, worlds, centres)
    draw_sensors(axes, pose, np.asarray(ranges))
    draw_robot(axes, pose)


def picture(
    worlds: Worlds,
    centres: ArrayLike,
    pose: ArrayLike,
    ranges: ArrayLike,
    *,
    pixels: int = 480,
) -> NDArray[np.uint8]:
    """Return what :func:`draw_moment` draws as an image (pixels, pixels, 3).

    Examples
    --------
    >>> from robonav.robot import random_worlds, sense
    >>> world = random_worlds(1, obstacles=10, seed=1)
    >>> pose = world.start_poses[0]
    >>> picture(world, world.centres[0], pose, sense(world, [pose]).ranges[0]).shape
    (480, 480, 3)
    """
    return image(
        lambda axes: draw_moment(axes, worlds, centres, pose, ranges), pixels=pixels
    )


def image(draw: Callable[[Axes], None], *, pixels: int = 480) -> NDArray[np.uint8]:
    """Return what a function draws on axes as an image (pixels, pixels, 3).

    Examples
    --------
    >>> image(lambda axes: prepare(axes, 100.0)).shape
    (480, 480, 3)
    """
    figure = Figure(
        figsize=(4.8, 4.8), dpi=pixels / 4.8, facecolor="white", layout="constrained"
    )
    canvas = FigureCanvasAgg(figure)
    draw(figure.add_subplot())
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()


class Window:
    """A window that shows a robot on its way, for ``render_mode="human"``."""

    def __init__(self) -> None:
        import matplotlib.pyplot as plt

        self._plt: Any = plt
        plt.ion()
        self._figure, self._axes = plt.subplots(figsize=(6, 6))

    def show(
        self, worlds: Worlds, centres: ArrayLike, pose: ArrayLike, ranges: ArrayLike
    ) -> None:
        """Show what :func:`draw_moment` draws."""
        self._axes.clear()
        draw_moment(self._axes, worlds, centres, pose, ranges)
        self._figure.canvas.draw_idle()
        self._figure.canvas.flush_events()

    def close(self) -> None:
        """Close the window."""
        self._plt.close(self._figure)
