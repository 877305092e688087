"""Runs with their band, trajectories on a grid, estimates beside the truth."""

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

from robonav.mdp import Tiles
from robonav.plots.learning import (
    COLOURS,
    draw_tiles,
    draw_trajectories,
    plot_estimates,
    plot_runs,
)


@pytest.fixture
def axes():
    mpl.use("agg")
    return Figure().add_subplot()


def test_runs_are_drawn_as_mean_and_band(axes):
    runs = np.array([[0.0, 2.0, 4.0, 6.0], [2.0, 4.0, 6.0, 8.0], [4.0, 6.0, 8.0, 10.0]])
    plot_runs(axes, {"SARSA": runs}, band=100)
    (line,) = axes.lines
    np.testing.assert_allclose(line.get_xydata(), [[1, 2], [2, 4], [3, 6], [4, 8]])
    assert line.get_color() == COLOURS["SARSA"]
    edge = axes.collections[0].get_paths()[0].vertices
    assert (edge[:, 1].min(), edge[:, 1].max()) == (0, 10)
    axes.figure.canvas.draw()


def test_a_window_averages_and_stands_at_its_end(axes):
    plot_runs(axes, {"one": [0.0, 2.0, 4.0, 6.0]}, x=[10, 20, 30, 40], window=2)
    np.testing.assert_allclose(axes.lines[0].get_xydata(), [[20, 1], [30, 3], [40, 5]])


def test_trajectories_pass_through_their_cells(axes):
    draw_trajectories(
        axes,
        (2, 3),
        {"bold": [3, 0, 1, 2, 5], "safe": [3, 4, 5]},
        forbidden=[4],
        start=3,
        goal=5,
    )
    bold, safe = axes.lines
    np.testing.assert_array_equal(
        np.floor(bold.get_xydata()), [[0, 1], [0, 0], [1, 0], [2, 0], [2, 1]]
    )
    np.testing.assert_array_equal(np.floor(safe.get_xydata()), [[0, 1], [1, 1], [2, 1]])
    assert bold.get_color() != safe.get_color()
    assert [text.get_text() for text in axes.texts] == ["S", "G"]
    assert len(axes.patches) == 6
    axes.figure.canvas.draw()


def test_estimates_stand_beside_the_truth(axes):
    plot_estimates(axes, "AB", [0.2, 0.8], {"after 1": [0.5, 0.6]})
    assert [line.get_label() for line in axes.lines] == ["true", "after 1"]
    np.testing.assert_allclose(axes.lines[1].get_ydata(), [0.5, 0.6])
    assert [tick.get_text() for tick in axes.get_xticklabels()] == ["A", "B"]


def test_tiles_that_hold_the_first_state_are_filled(axes):
    tiles = Tiles(low=(0, 0), high=(4, 4), tiles=(4, 4), tilings=2, n_actions=1)
    draw_tiles(axes, tiles, [(1.3, 2.2), (1.7, 2.6)])
    filled = [patch for patch in axes.patches if patch.get_facecolor()[3] > 0]
    assert len(axes.patches) == 2 * 5 * 5
    assert [patch.get_xy() for patch in filled] == [(1.0, 2.0), (0.5, 1.5)]
