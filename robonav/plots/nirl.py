"""Experts and learned rewards: Figs. 5.3 to 5.5, 5.7, 5.8, 5.10 and 5.11, and the weights of a reward."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import FancyBboxPatch, Wedge
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import ConvexHull

from robonav import style
from robonav.benchmark import display_name
from robonav.experiments import Results
from robonav.lfd import Demonstrations
from robonav.nirl.tasks import reward_map
from robonav.robot import SENSOR_RANGE, Encoder, Worlds
from robonav.robot._fast import SECTOR
from robonav.robot.drawing import draw_robot, draw_world
from robonav.robot.encoding import TARGET_WIDTHS

from .nnql import ACTIONS, GOOD_AND_BAD, draw_rates

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

_ARROW = {"arrowstyle": "-|>", "color": style.INK, "linewidth": 1.2}


def draw_key_points(
    axes: Axes,
    world: Worlds,
    key_points: ArrayLike,
    path: ArrayLike,
    driven: ArrayLike | None = None,
) -> None:
    """Draw a person's key points, the smooth path through them, and the robot's path (Fig. 5.3).

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    world : Worlds
        Batch of one: the map.
    key_points : (K, 2) array
        The points that the person set.
    path : (P, 2) array
        The smooth path through them.
    driven : (steps + 1, 3) array, optional
        The robot's poses.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.lfd import smooth_path
    >>> from robonav.robot import make_world
    >>> points = [(10, 10), (40, 60), (90, 90)]
    >>> axes = Figure().add_subplot()
    >>> draw_key_points(axes, make_world(), points, smooth_path(points))
    >>> len(axes.lines) >= 2
    True
    """
    draw_world(axes, world)
    axes.plot(
        *np.asarray(path)[:, :2].T, color=style.SKY, linewidth=1.6, label="smooth path"
    )
    axes.plot(
        *np.asarray(key_points).T,
        "o",
        color=style.ORANGE,
        markersize=7,
        label="key points",
    )
    if driven is not None:
        x, y = np.asarray(driven)[:, :2].T
        axes.plot(
            x, y, ".", color=style.BLUE, markersize=5, label="robot, a dot a second"
        )
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3)


def draw_slips(axes: Axes, demonstrations: Demonstrations, meant: ArrayLike) -> None:
    """Draw the first episode of a slipping expert and mark the steps that differ from the action meant (Fig. 5.5).

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    demonstrations : Demonstrations
        The first of them is drawn.
    meant : (steps,) array of int
        The action that the expert meant in each step.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.lfd import demonstrate
    >>> from robonav.robot import random_worlds
    >>> demonstrations = demonstrate(random_worlds(1, obstacles=20, seed=3))
    >>> axes = Figure().add_subplot()
    >>> draw_slips(axes, demonstrations, demonstrations.actions)  # no step slipped
    >>> axes.get_title()
    '0 of 64 actions slipped'
    """
    own = demonstrations.trajectory == 0
    slipped = (np.asarray(meant) != demonstrations.actions)[own]
    draw_world(axes, demonstrations.worlds[0])
    x, y = demonstrations.poses[own, :2].T
    axes.plot(x, y, color=style.BLUE, linewidth=1.4, marker=".", markersize=4)
    axes.plot(
        x[slipped],
        y[slipped],
        "o",
        color=style.VERMILION,
        markersize=8,
        fillstyle="none",
        linestyle="none",
    )
    axes.set(
        title=f"{slipped.sum()} of {len(slipped)} actions slipped", xlabel="", ylabel=""
    )


def draw_margin(
    axes: Axes, expert: ArrayLike, others: ArrayLike, weights: ArrayLike
) -> None:
    """Draw the feature expectations of an expert and of other policies, and the margin of a reward.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    expert : (2,) array
        The expert's feature expectations.
    others : (n, 2) array
        Those of the other policies.
    weights : (2,) array
        theta of the reward.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_margin(axes, [2.0, 0.0], [[0.5, 1.0], [-1.0, 0.0]], [1.0, 0.0])
    >>> len(axes.lines) >= 2
    True
    """
    mu, rivals, theta = (
        np.asarray(part, dtype=float) for part in (expert, others, weights)
    )
    if np.linalg.matrix_rank(rivals - rivals[0]) == 2:  # not all on a line
        hull = rivals[ConvexHull(rivals).vertices]
        axes.fill(*hull.T, color=style.GREY, alpha=0.2, linewidth=0)
    nearest = rivals[(rivals @ theta).argmax()]
    foot = mu - ((mu - nearest) @ theta) * theta
    for x, y in (mu, foot):
        axes.axline(
            (x, y),
            (x - theta[1], y + theta[0]),
            color=style.INK,
            linestyle="--",
            linewidth=1,
        )
    arrow = {"arrowstyle": "-|>", "color": style.BLUE, "linewidth": 2}
    axes.annotate("", (mu[0], mu[1]), (foot[0], foot[1]), arrowprops=arrow)
    axes.plot(*rivals.T, "o", color=style.GREY, label="other policies")
    axes.plot(*mu, "*", color=style.METHOD_COLOURS["A*"], markersize=15, label="expert")
    axes.legend(loc="lower right")


def animate_projection(
    corners: ArrayLike, expert: ArrayLike, found: ArrayLike, means: ArrayLike
) -> FuncAnimation:
    """Animate the projection method in a plane, with one policy in each frame.

    Parameters
    ----------
    corners : (m, 2) array
        The corners of the polygon that contains the feature expectations of all policies.
    expert : (2,) array
        The feature expectations of the expert.
    found, means : (n, 2) array
        The feature expectations of each policy, and the projected point after it.

    Returns
    -------
    FuncAnimation

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> from robonav.plots.player import player
    >>> corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]
    >>> animation = animate_projection(corners, [0.2, 0.2], corners[:1], corners[:1])
    >>> "It comes near" in player(animation, description="It comes near").data
    True
    >>> plt.close()
    """
    from matplotlib.animation import FuncAnimation

    hull, mu, policies, points = (
        np.asarray(part, dtype=float) for part in (corners, expert, found, means)
    )
    figure, axes = plt.subplots(figsize=(4.8, 3.2))

    def draw(frame: int) -> list:
        axes.clear()
        axes.fill(*hull.T, facecolor=style.GREY, alpha=0.15, edgecolor=style.INK)
        if frame > 0:
            axes.plot(
                *np.stack([points[frame - 1], policies[frame]]).T,
                color=style.SKY,
                linewidth=1,
            )
        axes.plot(*points[: frame + 1].T, ".-", color=style.BLUE, linewidth=1)
        axes.plot(*policies[frame], "o", color=style.ORANGE, markersize=9)
        axes.plot(*mu, "*", color=style.METHOD_COLOURS["A*"], markersize=14)
        axes.set(
            aspect="equal",
            title=f"policy {frame + 1}: {np.linalg.norm(mu - points[frame]):.3f} from the expert",
        )
        return []

    return FuncAnimation(figure, draw, frames=len(points), interval=700)


def draw_counts(
    axes: Axes,
    numbers: ArrayLike,
    counts: Mapping[str, ArrayLike],
    thesis: tuple[float, float],
) -> None:
    """Draw counts for each trajectory by expert: mean and range over runs, the thesis's in grey (Fig. 5.4).

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    numbers : (n,) array
        Numbers of trajectories.
    counts : mapping of str to (R, n) array
        Counts of R runs, by expert.
    thesis : (float, float)
        The thesis's counts for the least and the largest number.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_counts(axes, [10, 20], {"human": [[4.0, 8.0], [6.0, 10.0]]}, thesis=(5.0, 9.0))
    >>> len(axes.lines) > 0
    True
    """
    x = np.asarray(numbers, dtype=float)
    axes.axhspan(*thesis, color=style.GREY, alpha=0.25, linewidth=0, label="thesis")
    colours = (style.METHOD_COLOURS["A*"], style.PURPLE, style.SKY, style.VERMILION)
    for (name, runs), colour in zip(counts.items(), colours, strict=False):
        rows = np.asarray(runs, dtype=float)
        axes.fill_between(
            x, rows.min(axis=0), rows.max(axis=0), color=colour, alpha=0.2, linewidth=0
        )
        axes.plot(x, rows.mean(axis=0), "o-", color=colour, label=name, markersize=4)
    axes.set(xlabel="demonstrations", ylim=(0, None))


def draw_iterations(axes: Axes, series: Mapping[str, ArrayLike], label: str) -> None:
    """Draw series by name over the iterations: mean and range over runs.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    series : mapping of str to (runs, n) array
        One number for each of n iterations, by name.
    label : str
        What the numbers are.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_iterations(axes, {"nirl": [[1.0, 2.0], [3.0, 4.0]]}, "margin")
    >>> axes.lines[0].get_ydata()
    array([2., 3.])
    """
    colours = (style.VERMILION, style.BLUE, style.GREEN, style.ORANGE)
    for (name, given), colour in zip(series.items(), colours, strict=False):
        runs = np.atleast_2d(np.asarray(given, dtype=float))
        x = np.arange(1, runs.shape[1] + 1)
        axes.fill_between(
            x, runs.min(axis=0), runs.max(axis=0), color=colour, alpha=0.2, linewidth=0
        )
        axes.plot(x, runs.mean(axis=0), color=colour, label=name)
    axes.set(xlabel="iteration", ylabel=label)
    if len(series) > 1:
        axes.legend()


def draw_densities(
    axes: Axes, obstacles: Sequence[int], rates: Mapping[str, ArrayLike], title: str
) -> None:
    """Draw success by method over the number of obstacles: mean and range over runs (Fig. 5.10).

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    obstacles : sequence of int
        n numbers of obstacles.
    rates : mapping of str to (S, n) array
        Success in per cent of S runs, by method.
    title : str
        The title of the panel.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_densities(axes, [10, 20], {"nirl": [[90.0, 80.0], [98.0, 84.0]]}, "2 m/s")
    >>> axes.get_title()
    '2 m/s'
    """
    for name, given in rates.items():
        runs = np.asarray(given, dtype=float)
        colour = style.METHOD_COLOURS.get(name, style.BLUE)
        axes.fill_between(
            obstacles,
            runs.min(axis=0),
            runs.max(axis=0),
            color=colour,
            alpha=0.18,
            linewidth=0,
        )
        axes.plot(
            obstacles,
            runs.mean(axis=0),
            "o-",
            color=colour,
            label=display_name(name),
            markersize=4,
        )
    axes.set(xlabel="obstacles", xticks=list(obstacles), ylim=(50, 101), title=title)


def draw_steps(axes: Axes, rates: Mapping[str, ArrayLike]) -> None:
    """Draw the success of every run as a dot, and their mean, with one row for each change from the top down.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    rates : mapping of str to (S,) array
        Success in per cent of S runs, by the change.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_steps(axes, {"as printed": [1.0, 3.0], "changed": [90.0, 98.0]})
    >>> len(axes.lines) >= 2
    True
    """
    for row, (name, values) in enumerate(rates.items()):
        dots = np.sort(np.asarray(values, dtype=float))
        axes.plot(
            dots,
            row + 0.12 * np.sin(2.4 * np.arange(len(dots))),
            ".",
            color=style.BLUE,
            alpha=0.6,
            markersize=6,
        )
        axes.plot(
            [dots.mean()] * 2, [row - 0.2, row + 0.2], color=style.BLUE, linewidth=2.5
        )
        axes.annotate(
            f"{dots.mean():.0f} %", (103, row), va="center", annotation_clip=False
        )
        axes.annotate(f"{row + 1}. {name}", (-2, row - 0.3), va="bottom")
    axes.set(
        yticks=[],
        xlim=(-2, 102),
        ylim=(len(rates) - 0.6, -0.9),
        xlabel="episodes that arrive (%)",
    )


def draw_gradient_steps(
    axes: Axes, steps: Sequence[int], rates: Mapping[str, ArrayLike]
) -> None:
    """Draw success by reward over the number of gradient steps: every run a dot, means joined by lines.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    steps : sequence of int
        n numbers of gradient steps.
    rates : mapping of str to (S, n) array
        Success in per cent of S runs, by reward.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_gradient_steps(axes, [1, 10], {"reward: learned": [[5.0, 50.0], [9.0, 60.0]]})
    >>> len(axes.lines) > 0
    True
    """
    marks = (("o", style.VERMILION), ("s", style.BLUE))
    for (name, given), (mark, colour) in zip(rates.items(), marks, strict=False):
        runs = np.asarray(given, dtype=float)
        axes.plot(steps, runs.T, ".", color=colour, alpha=0.35, markersize=6)
        axes.plot(steps, runs.mean(axis=0), mark + "-", color=colour, label=name)
    axes.set(
        xscale="log",
        xticks=list(steps),
        xticklabels=[f"{n}" for n in steps],
        ylim=(-2, 102),
        xlabel="gradient steps an iteration",
        ylabel="episodes that arrive (%)",
    )
    axes.minorticks_off()
    axes.legend(loc="upper left")


def draw_choice(axes: Axes, scores: Mapping[str, ArrayLike], driven: ArrayLike) -> None:
    """Draw each policy of a run as a dot: accuracy of its predictions and success, with one colour for each score.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    scores : mapping of str to (n,) array
        Scores in [0, 1] by name. A ring marks the policy with the highest score, which this score would choose.
    driven : (n,) array
        Success in per cent.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_choice(axes, {"accuracy": [0.2, 0.7], "balanced": [0.9, 0.1]}, [10, 20])
    >>> len(axes.get_legend().get_texts()) > 1
    True
    """
    success = np.asarray(driven, dtype=float)
    for (name, given), colour in zip(
        scores.items(), (style.ORANGE, style.BLUE), strict=False
    ):
        score = np.asarray(given, dtype=float)
        best = int(score.argmax())
        axes.plot(100 * score, success, ".", color=colour, label=name, markersize=7)
        axes.plot(
            100 * score[best],
            success[best],
            "o",
            color=colour,
            markersize=14,
            fillstyle="none",
        )
    axes.set(
        xlabel="decisions of the expert that are predicted (%)",
        ylabel="episodes that arrive (%)",
        ylim=(-2, 102),
    )
    axes.legend()


def draw_black_boxes(axes: Axes) -> None:
    """Draw two networks as black boxes: one returns five values, the other also chooses the action (Fig. 5.2).

    Parameters
    ----------
    axes : Axes
        The axes to draw on. Their frame and ticks are removed.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_black_boxes(axes)
    >>> len(axes.texts) > 2
    True
    """
    for row, (inside, out) in enumerate(
        (
            ("network", [f"$Q(s, {a})$" for a in ACTIONS]),
            ("network,\nbest value", ["$a$"]),
        )
    ):
        axes.add_patch(
            FancyBboxPatch(
                (0.9, 0.15 - row),
                0.8,
                0.5,
                boxstyle="round,pad=0.05",
                facecolor=style.INK,
                alpha=0.3,
            )
        )
        axes.text(1.3, 0.4 - row, inside, ha="center", va="center")
        axes.text(0.15, 0.4 - row, "$s$", ha="center", va="center")
        axes.annotate("", (0.85, 0.4 - row), (0.25, 0.4 - row), arrowprops=_ARROW)
        for place, text in zip(
            np.linspace(0.65, 0.15, len(out)) if len(out) > 1 else [0.4],
            out,
            strict=True,
        ):
            axes.annotate(
                "", (2.3, place - row), (1.75, place - row), arrowprops=_ARROW
            )
            axes.text(2.38, place - row, text, va="center")
    axes.set(xlim=(0, 3), ylim=(-1.0, 0.85))
    axes.axis("off")


def names_of(encoder: Encoder) -> list[str]:
    """Return the names of a reward's inputs. The last one is the constant.

    Parameters
    ----------
    encoder : Encoder
        Turns what the robot senses into inputs.

    Returns
    -------
    list of str

    Examples
    --------
    >>> from robonav.robot import Encoder
    >>> names_of(Encoder())[-1]
    'constant'
    """
    sensors = [f"S{sensor}" for sensor in encoder.sensors]
    sector = {
        "number": ["sector"],
        "signed": ["sector"],
        "sine-cosine": ["left", "ahead"],
    }
    width = TARGET_WIDTHS[encoder.target]
    target = sector.get(encoder.target, [f"sector {k + 1}" for k in range(width)])
    walls = [f"wall {sensor}" for sensor in encoder.sensors] if encoder.walls else []
    return [*sensors, *target, "seen", *walls, "constant"]


def draw_weights(axes: Axes, weights: ArrayLike, encoder: Encoder) -> None:
    """Draw a reward's weights, inputs as rows and actions as columns; blue is positive, orange negative.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    weights : (5, k + 1) array
        theta, a row for each action.
    encoder : Encoder
        Names the inputs.

    Examples
    --------
    >>> import numpy as np
    >>> from matplotlib.figure import Figure
    >>> from robonav.robot import Encoder
    >>> encoder = Encoder()
    >>> axes = Figure().add_subplot()
    >>> draw_weights(axes, np.eye(5, encoder.size + 1), encoder)
    >>> axes.images[0].get_array().shape
    (13, 5)
    """
    theta = np.asarray(weights, dtype=float)
    most = abs(theta).max() or 1.0
    image = axes.imshow(
        theta.T, cmap=GOOD_AND_BAD, vmin=-most, vmax=most, aspect="auto"
    )
    names = names_of(encoder)
    axes.set(
        yticks=range(len(names)),
        yticklabels=names,
        xticks=range(len(ACTIONS)),
        xticklabels=ACTIONS[: len(theta)],
    )
    axes.grid(False)
    axes.figure.colorbar(image, ax=axes, label="weight", pad=0.02)


def draw_likes(figure: Figure, weights: ArrayLike, encoder: Encoder) -> None:
    """Draw one robot for each action; a sector shows its weight of danger (blue positive, orange negative).

    Parameters
    ----------
    figure : Figure
        Gets a panel for each action.
    weights : (5, k + 1) array
        theta, a row for each action.
    encoder : Encoder
        Says which inputs are sectors.

    Examples
    --------
    >>> import numpy as np
    >>> from matplotlib.figure import Figure
    >>> from robonav.nirl import ENCODER
    >>> figure = Figure()
    >>> draw_likes(figure, np.eye(5, ENCODER.size + 1), ENCODER)
    >>> len(figure.axes) >= 5
    True
    """
    theta = np.asarray(weights, dtype=float)[:, : len(encoder.sensors)]
    most = abs(theta).max() or 1.0
    half = np.degrees(SECTOR) / 2
    for place, (name, row) in enumerate(zip(ACTIONS, theta, strict=True), start=1):
        axes = figure.add_subplot(2, 3, place)
        for sensor, weight in zip(encoder.sensors, row, strict=True):
            middle = 90 + 2 * half * (sensor - 1)
            face = style.BLUE if weight > 0 else style.VERMILION
            wedge = Wedge(
                (0, 0),
                SENSOR_RANGE,
                middle - half,
                middle + half,
                facecolor=face,
                alpha=abs(weight) / most,
            )
            axes.add_patch(wedge)
            rim = Wedge(
                (0, 0),
                SENSOR_RANGE,
                middle - half,
                middle + half,
                fill=False,
                edgecolor=style.INK,
                linewidth=0.6,
            )
            axes.add_patch(rim)
        draw_robot(axes, (0.0, 0.0, np.pi / 2), style.INK)
        axes.set(
            xlim=(-10.5, 10.5),
            ylim=(-10.5, 10.5),
            aspect="equal",
            xticks=[],
            yticks=[],
            title=name,
        )
        axes.grid(False)
        axes.spines[:].set_visible(False)


def draw_reward_map(
    axes: Axes,
    world: Worlds,
    weights: ArrayLike,
    encoder: Encoder,
    *,
    spacing: float = 1.0,
) -> None:
    """Draw the reward of going straight on over a world, if the robot faces the target: blue is high, orange low.

    The map is blank within a metre of an obstacle, and where nothing is in range: there the policy decides nothing.

    Parameters
    ----------
    axes : Axes
        The axes to draw on.
    world : Worlds
        Batch of one: the map.
    weights : (5, k + 1) array
        theta, a row for each action.
    encoder : Encoder
        Turns what the robot senses into inputs.
    spacing : float
        Metres between two points of the map.

    Examples
    --------
    >>> import numpy as np
    >>> from matplotlib.figure import Figure
    >>> from robonav.nirl import ENCODER
    >>> from robonav.robot import make_world
    >>> world, weights = make_world(circles=[(50, 50, 3)]), np.eye(5, ENCODER.size + 1)
    >>> axes = Figure().add_subplot()
    >>> draw_reward_map(axes, world, weights, ENCODER, spacing=5.0)
    >>> len(axes.images) + len(axes.collections) > 0
    True
    """
    reward = reward_map(world, weights, encoder, spacing=spacing)
    most = np.nanmax(abs(reward))
    image = axes.imshow(
        reward,
        extent=(0, world.size, 0, world.size),
        origin="lower",
        cmap=GOOD_AND_BAD,
        vmin=-most,
        vmax=most,
    )
    draw_world(axes, world)
    axes.figure.colorbar(
        image, ax=axes, label="reward of going straight on", pad=0.02, shrink=0.8
    )


def of_runs(results: Results, metric: str, **wanted: object) -> Floats:
    """Return a metric of all cases that have the ``wanted`` values: (S, n), or (S, T) for a single series."""
    cases = results.experiment.cases
    own = [
        k
        for k, case in enumerate(cases)
        if all(case[key] == value for key, value in wanted.items())
    ]
    runs = [results.values(metric, k) for k in own]
    return runs[0] if runs[0].ndim == 2 else np.stack(runs, axis=1)


def plot_counts(results: Results) -> Figure:
    """Plot Fig. 5.4 from its results."""
    figure, panels = plt.subplots(2, figsize=(style.FIGURE_WIDTH, 5), sharex=True)
    cases = results.experiment.cases
    experts, numbers = (
        list(dict.fromkeys(case[key] for case in cases))
        for key in ("expert", "demonstrations")
    )
    for axes, metric, thesis in zip(
        panels, ("samples", "states"), ((52, 55), (13, 19)), strict=True
    ):
        draw_counts(
            axes,
            numbers,
            {str(e): of_runs(results, metric, expert=e) for e in experts},
            thesis,
        )
    panels[0].set(xlabel="", ylabel="samples a trajectory")
    panels[1].set(ylabel="different states a trajectory")
    panels[0].legend()
    return figure


def plot_iterations(results: Results, metric: str, label: str) -> Figure:
    """Plot Fig. 5.7 or 5.8 from its results."""
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, 2.8))
    cases = results.experiment.cases
    series = {
        f"discount {case['discount']}": results.values(metric, k)
        for k, case in enumerate(cases)
    }
    draw_iterations(axes, series, label)
    return figure


def plot_changes(results: Results) -> Figure:
    """Plot Fig. 5.11 from its results, with one panel for each layer."""
    figure, panels = plt.subplots(2, figsize=(style.FIGURE_WIDTH, 4.8), sharex=True)
    cases = results.experiment.cases
    for axes, layer in zip(panels, ("first layer", "second layer"), strict=True):
        series = {
            f"discount {case['discount']}": results.values(layer, k)
            for k, case in enumerate(cases)
        }
        draw_iterations(axes, series, "sum of absolute changes")
        axes.set(title=layer, ylim=(0, None))
    panels[0].set(xlabel="")
    return figure


def plot_densities(results: Results) -> Figure:
    """Plot Fig. 5.10 from its results, with one panel for each speed."""
    cases = results.experiment.cases
    speeds, methods = (
        list(dict.fromkeys(case[key] for case in cases)) for key in ("speed", "method")
    )
    obstacles = list(dict.fromkeys(int(case["obstacles"]) for case in cases))
    size = style.FIGURE_WIDTH, 2.5 * len(speeds)
    figure, panels = plt.subplots(len(speeds), figsize=size, sharex=True, sharey=True)
    for axes, speed in zip(panels, speeds, strict=True):
        rates = {
            str(m): of_runs(results, "success", method=m, speed=speed) for m in methods
        }
        draw_densities(axes, obstacles, rates, f"{speed:g} m/s")
    for axes in panels:
        axes.set(ylabel="arrive (%)", xlabel="obstacles" if axes is panels[-1] else "")
    panels[0].legend(loc="lower left")
    return figure


def plot_steps(results: Results) -> Figure:
    """Plot the changes from one reading of Algorithm 10 to an algorithm that works, from their results."""
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, 6.4))
    cases = results.experiment.cases
    draw_steps(
        axes,
        {
            str(case["change"]): results.values("success", k)
            for k, case in enumerate(cases)
        },
    )
    return figure


def plot_gradient_steps(results: Results) -> Figure:
    """Plot the success of Algorithm 10 over its number of gradient steps an iteration, from its results."""
    cases = results.experiment.cases
    rewards, steps = (
        list(dict.fromkeys(case[key] for case in cases))
        for key in ("reward", "gradient steps")
    )
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, 3.2))
    draw_gradient_steps(
        axes,
        [int(n) for n in steps],
        {f"reward: {r}": of_runs(results, "success", reward=r) for r in rewards},
    )
    return figure


def plot_comparison(results: Results, discount: float) -> Figure:
    """Plot Table 5.2 for one discount from its results, with controls and baselines below the methods."""
    cases, thesis = results.experiment.cases, results.experiment.thesis["success"]
    own = [
        k
        for k, case in enumerate(cases)
        if case["discount"] in (discount, "none") or "reward" in str(case["method"])
    ]
    rates = {str(cases[k]["method"]): results.values("success", k) for k in own}
    known = {
        str(case["method"]): rate
        for case, rate in zip(cases, thesis, strict=True)
        if rate is not None
    }
    figure, axes = plt.subplots(figsize=(style.FIGURE_WIDTH, 4))
    draw_rates(axes, rates, thesis=known)
    return figure
