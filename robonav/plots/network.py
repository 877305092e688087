"""Figures of networks: their layers, their training, and their outputs (Fig. 3.1 to 3.3 and 3.7)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap, to_rgba
from numpy.typing import ArrayLike, NDArray

from robonav import style
from robonav.networks.multilayer_perceptron import Network
from robonav.networks.toy_datasets import EXTENT
from robonav.networks.training_history import TrainingHistory

NO, YES = style.BLUE, style.ORANGE
NEGATIVE, POSITIVE = style.VERMILION, style.BLUE
ANSWERS = LinearSegmentedColormap.from_list(
    "answers",
    list(
        zip(
            (0, 0.5, 0.5, 1),
            (to_rgba(NO, 0.45), to_rgba(NO, 0), to_rgba(YES, 0), to_rgba(YES, 0.5)),
            strict=True,
        )
    ),
)


def unit_positions(sizes: Sequence[int]) -> list[NDArray[np.float64]]:
    """Return the positions of each layer's units, (s[l] + 1, 2): the bias unit on top; the output layer has none.

    Parameters
    ----------
    sizes : sequence of int
        Units of each layer.

    Returns
    -------
    list of (s[l] + 1, 2) arrays

    Examples
    --------
    >>> [len(layer) for layer in unit_positions((2, 3, 1))]
    [3, 4, 1]
    """
    last = len(sizes) - 1
    layers = []
    for layer, size in enumerate(sizes):
        count = size + (layer < last)
        layers.append(
            np.column_stack(
                [np.full(count, float(layer)), (count - 1) / 2 - np.arange(count)]
            )
        )
    return layers


def draw_network(
    axes: Axes,
    sizes: Sequence[int],
    *,
    network: Network | None = None,
    inputs: Sequence[str] | None = None,
    outputs: Sequence[str] | None = None,
) -> None:
    """Draw a network: units as circles, weights as lines, bias units marked +1 (Figs. 3.1 to 3.3, 4.1, 5.1).

    Parameters
    ----------
    axes : Axes
        Where to draw.
    sizes : sequence of int
        Number of units in each layer, without bias units.
    network : Network, optional
        A network of these sizes. The lines are then as thick as the weights are large, blue for positive weights and
        red for negative ones.
    inputs, outputs : sequence of str, optional
        Names of the units in the first and the last layer; by default x and h with an index.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_network(axes, (2, 3, 1), inputs=["$x_1$", "$x_2$"], outputs=["$h$"])
    >>> axes.texts[0].get_text() != ""
    True
    """
    layers = unit_positions(sizes)
    for layer, (here, there) in enumerate(pairwise(layers)):
        ends = there[1:] if layer + 2 < len(layers) else there
        lines = [[start, end] for end in ends for start in here]
        axes.add_collection(
            LineCollection(lines, zorder=1, **_line_style(network, layer))
        )
    tallest = max(map(len, layers)) / 2
    for layer, positions in enumerate(layers):
        bias = layer + 1 < len(layers)
        axes.scatter(
            positions[bias:, 0],
            positions[bias:, 1],
            210,
            facecolor=style.SKY,
            edgecolor=style.INK,
            zorder=2,
        )
        if bias:
            axes.scatter(
                positions[0, 0],
                positions[0, 1],
                210,
                facecolor=style.OBSTACLE,
                edgecolor=style.INK,
                zorder=2,
            )
            axes.annotate(
                "+1",
                positions[0],
                ha="center",
                va="center",
                fontsize=8,
                color="white",
                zorder=3,
            )
        axes.annotate(
            f"$L_{layer + 1}$", (layer, -tallest - 0.3), ha="center", va="top"
        )
    first = inputs or [f"$x_{{{unit + 1}}}$" for unit in range(sizes[0])]
    last = outputs or [f"$h_{{{unit + 1}}}$" for unit in range(sizes[-1])]
    for name, position in zip(first, layers[0][1:], strict=True):
        axes.annotate(
            name,
            position,
            (-11, 0),
            textcoords="offset points",
            ha="right",
            va="center",
        )
    for name, position in zip(last, layers[-1], strict=True):
        axes.annotate(
            name, position, (11, 0), textcoords="offset points", ha="left", va="center"
        )
    axes.set(xlim=(-0.7, len(sizes) - 0.3), ylim=(-tallest - 1, tallest + 0.1))
    axes.axis("off")


def _line_style(network: Network | None, layer: int) -> dict[str, Any]:
    """Return the style of a layer's lines: grey without a network, else by the sizes and signs of its weights."""
    if network is None:
        return {"colors": style.INK, "linewidths": 0.7}
    values = np.column_stack([network.biases[layer], network.weights[layer]]).ravel()
    strength = np.abs(values) / max(np.abs(values).max(), 1e-12)
    return {
        "colors": np.where(values >= 0, POSITIVE, NEGATIVE),
        "linewidths": 0.2 + 2.8 * strength,
        "alpha": 0.15 + 0.85 * strength,
    }


def plot_costs(
    axes: Axes,
    trainings: Mapping[str, TrainingHistory],
    *,
    colours: Mapping[str, str] | None = None,
) -> None:
    """Plot cost against iterations, with one curve for each training (Fig. 3.7).

    Parameters
    ----------
    axes : Axes
        Where to draw.
    trainings : mapping of str to TrainingHistory
        Trainings by name.
    colours : mapping of str to str, optional
        Colours by name.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.networks import lbfgs, random_network
    >>> from robonav.networks.toy_datasets import disc
    >>> x, y = disc(30, seed=0)
    >>> training = lbfgs(random_network((2, 3, 1), seed=0), x, y, iterations=5)
    >>> axes = Figure().add_subplot()
    >>> plot_costs(axes, {"L-BFGS": training})
    >>> len(axes.lines[0].get_ydata()) == len(training.costs)
    True
    """
    for name, training in trainings.items():
        axes.plot(training.costs, label=name, color=(colours or {}).get(name))
    axes.set(xlabel="iteration", ylabel="cost $J$")
    if len(trainings) > 1:
        axes.legend()


def plot_accuracies(
    axes: Axes,
    trainings: Mapping[str, TrainingHistory],
    *,
    colours: Mapping[str, str] | None = None,
) -> None:
    """Plot accuracy, the percentage of examples classified as labelled, against iterations (Table 3.3).

    Parameters
    ----------
    axes : Axes
        Where to draw.
    trainings : mapping of str to TrainingHistory
        Trainings by name.
    colours : mapping of str to str, optional
        Colours by name.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from robonav.networks import lbfgs, random_network
    >>> from robonav.networks.toy_datasets import disc
    >>> x, y = disc(30, seed=0)
    >>> training = lbfgs(random_network((2, 3, 1), seed=0), x, y, iterations=5)
    >>> axes = Figure().add_subplot()
    >>> plot_accuracies(axes, {"L-BFGS": training})
    >>> len(axes.lines)
    1
    """
    for name, training in trainings.items():
        axes.plot(
            100 * training.accuracies, label=name, color=(colours or {}).get(name)
        )
    axes.set(xlabel="iteration", ylabel="accuracy (%)")
    if len(trainings) > 1:
        axes.legend()


def draw_answers(axes: Axes, field: ArrayLike, x: ArrayLike, y: ArrayLike) -> None:
    """Draw a network's output over the plane of its two inputs, its boundary at 1/2, and the examples.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    field : (R, R) array
        Outputs on a grid, from :func:`robonav.networks.toy_datasets.field`.
    x : (m, 2) array
        Inputs of the examples.
    y : (m, 1) array
        Their labels, 0 or 1.

    Examples
    --------
    >>> import numpy as np
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_answers(axes, np.linspace(0, 1, 16).reshape(4, 4), [[0.2, 0.3], [0.8, 0.9]], [[0], [1]])
    >>> len(axes.images) + len(axes.collections) > 0
    True
    """
    square = (-EXTENT, EXTENT, -EXTENT, EXTENT)
    values, points, yes = np.asarray(field), np.asarray(x), np.asarray(y)[:, 0] > 0.5
    axes.imshow(
        values, origin="lower", extent=square, cmap=ANSWERS, vmin=0, vmax=1, zorder=0
    )
    if values.min() < 0.5 < values.max():
        axes.contour(
            values,
            [0.5],
            origin="lower",
            extent=square,
            colors=style.INK,
            linewidths=1.8,
        )
    axes.scatter(
        points[~yes, 0], points[~yes, 1], 16, marker="o", color=NO, linewidths=0
    )
    axes.scatter(
        points[yes, 0], points[yes, 1], 22, marker="x", color=YES, linewidths=1.4
    )
    axes.set(xlabel="$x_1$", ylabel="$x_2$", aspect="equal")
    axes.grid(False)
