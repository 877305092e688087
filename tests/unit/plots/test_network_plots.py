"""The drawings show what they are given: every unit, every weight, every iteration."""

from itertools import pairwise

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

from robonav.networks import toy_datasets
from robonav.networks.multilayer_perceptron import Network, random_network
from robonav.networks.optimisers import fit
from robonav.plots.network import (
    NEGATIVE,
    POSITIVE,
    draw_answers,
    draw_network,
    plot_accuracies,
    plot_costs,
)


@pytest.fixture
def axes():
    mpl.use("agg")
    return Figure().add_subplot()


@pytest.mark.parametrize("sizes", [(3, 3, 1), (3, 3, 2, 2), (11, 8, 5)])
def test_every_unit_and_every_weight_is_drawn(axes, sizes):
    draw_network(axes, sizes)
    lines, units = [], 0
    for collection in axes.collections:
        if hasattr(collection, "get_segments"):
            lines.append(len(collection.get_segments()))
        else:
            units += len(collection.get_offsets())
    assert lines == [(before + 1) * after for before, after in pairwise(sizes)]
    assert units == sum(sizes) + len(sizes) - 1
    axes.figure.canvas.draw()


def test_lines_show_sign_and_size_of_weights_and_bias(axes):
    network = Network((np.array([[-2.0, 1.0]]),), (np.array([0.5]),))
    draw_network(axes, (2, 1), network=network, inputs=["a", "b"], outputs=["c"])
    lines = axes.collections[0]
    signs = [POSITIVE, NEGATIVE, POSITIVE]  # the bias comes first
    np.testing.assert_allclose(
        lines.get_colors()[:, :3], [mpl.colors.to_rgb(colour) for colour in signs]
    )
    assert np.argsort(lines.get_linewidths()).tolist() == [0, 2, 1]
    assert {"a", "b", "c", "+1"} <= {text.get_text() for text in axes.texts}


def test_curves_are_the_history(axes):
    x, y = toy_datasets.xor(30, seed=0)
    trainings = {
        f"seed {seed}": fit(x, y, hidden=2, iterations=10, seed=seed) for seed in (0, 1)
    }
    plot_costs(axes, trainings, colours={"seed 0": "red"})
    np.testing.assert_array_equal(axes.lines[1].get_ydata(), trainings["seed 1"].costs)
    assert axes.lines[0].get_color() == "red"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == list(
        trainings
    )
    plot_accuracies(axes, {"one": trainings["seed 0"]})
    np.testing.assert_array_equal(
        axes.lines[-1].get_ydata(), 100 * trainings["seed 0"].accuracies
    )


def test_answers_are_drawn_with_their_boundary_and_examples(axes):
    x, y = toy_datasets.xor(30, seed=0)
    network = random_network((2, 3, 1), seed=0, spread=3)
    draw_answers(axes, toy_datasets.field(network, resolution=20), x, y)
    np.testing.assert_allclose(
        axes.images[0].get_array(), toy_datasets.field(network, resolution=20)
    )
    shown = [
        collection.get_offsets()
        for collection in axes.collections
        if len(collection.get_offsets()) > 1
    ]
    assert sorted(map(len, shown)) == sorted([int(y.sum()), int(30 - y.sum())])
    axes.figure.canvas.draw()
