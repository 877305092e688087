"""What the planners of chapter 6 compute from one sensing: forces, a polar histogram, and ways of six actions."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from robonav import style
from robonav.planners import (
    DynamicWindow,
    PotentialField,
    VectorFieldHistogram,
    dynamic_window,
    free_way,
    polar_histogram,
    potential_field,
    target_bearing,
    vector_field_histogram,
)
from robonav.planners.sectors import WAYS
from robonav.planners.vector_field_histogram import DIRECTIONS
from robonav.robot import Action, Sensing
from robonav.robot.drawing import draw_robot, draw_sensors

LONGEST = 9.0  # metres that the longest force takes in the picture


def _stage(axes: Axes, sensing: Sensing) -> None:
    """Draw the first robot with what it senses; it heads to the right."""
    draw_sensors(axes, (0.0, 0.0, 0.0), sensing.ranges[0])
    draw_robot(axes, (0.0, 0.0, 0.0))
    axes.set(
        xlim=(-11, 11),
        ylim=(-11, 11),
        aspect="equal",
        xlabel="ahead (m)",
        ylabel="left (m)",
    )
    axes.grid(False)


def draw_forces(axes: Axes, sensing: Sensing, policy: PotentialField) -> None:
    """Draw the forces of a potential field on the first robot, and their sum.

    Parameters
    ----------
    axes : Axes
        To draw on.
    sensing : Sensing
        What robots sense.
    policy : PotentialField
        Its settings.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.planners import PotentialField
    >>> from robonav.robot import make_world, sense
    >>> sensing = sense(make_world(circles=[(56, 50, 2)]), [(50, 50, 0)])
    >>> axes = Figure().add_subplot()
    >>> draw_forces(axes, sensing, PotentialField())
    >>> len(axes.get_legend().get_texts()) > 1
    True
    """
    attraction, repulsions = potential_field(
        sensing, repulsion=policy.repulsion, influence=policy.influence
    )
    total = attraction[0] + repulsions[0].sum(axis=0)
    forces = [(attraction[0], style.TARGET, "of the target")]
    pushing = [force for force in repulsions[0] if np.hypot(*force) > 1e-9]
    forces += [
        (force, style.ORANGE, "" if k else "of obstacles")
        for k, force in enumerate(pushing)
    ]
    forces.append((total, style.BLUE, "sum"))
    scale = LONGEST / max(np.hypot(*force) for force, _, _ in forces)
    _stage(axes, sensing)
    for force, colour, label in forces:
        x, y = scale * force
        axes.annotate(
            "", (x, y), (0, 0),
            arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 2},
        )  # fmt: skip
        if label:
            axes.plot([], [], color=colour, linewidth=2, label=label)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, fontsize=9)


def draw_histogram(axes: Axes, sensing: Sensing, policy: VectorFieldHistogram) -> None:
    """Draw the polar histogram of VFH+ of the first robot, the target, and the direction chosen.

    Parameters
    ----------
    axes : Axes
        To draw on.
    sensing : Sensing
        What robots sense.
    policy : VectorFieldHistogram
        Its settings.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.planners import VectorFieldHistogram
    >>> from robonav.robot import make_world, sense
    >>> sensing = sense(make_world(circles=[(56, 50, 2)]), [(50, 50, 0)])
    >>> axes = Figure().add_subplot()
    >>> draw_histogram(axes, sensing, VectorFieldHistogram())
    >>> len(axes.lines) > 0
    True
    """
    histogram = polar_histogram(
        sensing.ranges, clearance=policy.clearance, half_width=policy.half_width
    )
    target = target_bearing(sensing)
    chosen = vector_field_histogram(
        histogram, target, threshold=policy.threshold, wide=policy.wide, keep=policy.keep
    )  # fmt: skip
    degrees = np.degrees(DIRECTIONS)
    masked = np.abs(degrees) > 90.5
    free = histogram[0] < policy.threshold
    for which, colour, label in (
        (masked, style.GREY, "masked"),
        (~masked & ~free, style.ORANGE, "blocked"),
    ):
        shown = which & (histogram[0] > 0)
        if shown.any():
            axes.bar(degrees[shown], histogram[0, shown], 5, color=colour, label=label)
    axes.axhline(
        policy.threshold, color=style.INK, linestyle=":", linewidth=1.2, label="threshold"
    )  # fmt: skip
    for bearing, colour, label in (
        (target[0], style.TARGET, "target"),
        (chosen[0], style.BLUE, "chosen"),
    ):
        axes.axvline(np.degrees(bearing), color=colour, linewidth=2, label=label)
    axes.set(
        xlim=(180, -180),
        ylim=(0, 1.6 * max(histogram[0].max(), policy.threshold)),
        xticks=[180, 90, 0, -90, -180],
        xlabel="direction (degrees, left is positive)",
        ylabel="obstacle",
    )
    axes.legend(fontsize=9, ncols=2, loc="upper right")


def draw_ways(axes: Axes, sensing: Sensing, policy: DynamicWindow) -> None:
    """Draw how far the first robot could go with each action, and the scores of the admissible ones.

    Parameters
    ----------
    axes : Axes
        To draw on.
    sensing : Sensing
        What robots sense.
    policy : DynamicWindow
        Its settings.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.planners import DynamicWindow
    >>> from robonav.robot import make_world, sense
    >>> sensing = sense(make_world(circles=[(56, 50, 2)]), [(50, 50, 0)])
    >>> axes = Figure().add_subplot()
    >>> draw_ways(axes, sensing, DynamicWindow())
    >>> len(axes.texts) > 0  # the scores
    True
    """
    room = {"clearance": policy.clearance, "half_width": policy.half_width}
    ways = free_way(sensing.ranges, WAYS, **room)[0]
    scores = dynamic_window(
        sensing, speed=policy.speed, heading=policy.heading, distance=policy.distance, **room
    )[0]  # fmt: skip
    _stage(axes, sensing)
    for action, way, score in zip(Action, ways, scores, strict=False):
        admissible = way >= policy.speed
        colour = style.GREY
        if admissible:
            colour = style.BLUE if score == scores.max() else style.GREEN
        x, y = np.cos(WAYS[action]), np.sin(WAYS[action])
        axes.plot([0, way * x], [0, way * y], color=colour, linewidth=2.5)
        said = f"{action.name} {score:.2f}" if admissible else f"{action.name} no"
        axes.annotate(
            said, (max(way, 2.5) * x, max(way, 2.5) * y),
            ha="left" if x > 0 else "right", va="bottom", fontsize=9, color=style.INK,
        )  # fmt: skip
