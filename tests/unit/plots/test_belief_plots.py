"""Beliefs over cells and poses, their values, their uncertainty, and the scheme of Fig. 2.3."""

import re
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch

from robonav import style
from robonav.mdp import AlphaVectors, PoseGrid, qmdp, tiger
from robonav.plots.belief import (
    draw_belief,
    draw_plan,
    draw_pomdp,
    draw_pose_belief,
    draw_values_of_beliefs,
    plot_uncertainty,
)
from robonav.widgets import explorables


@pytest.fixture
def axes():
    mpl.use("agg")
    return Figure().add_subplot()


def test_a_bar_a_cell_a_filled_box_a_door(axes):
    draw_belief(axes, [0.2, 0.5, 0.3], ".D.", state=2)
    bars, boxes = axes.patches[:3], axes.patches[3:]
    np.testing.assert_allclose([bar.get_height() for bar in bars], [0.2, 0.5, 0.3])
    filled = [
        mpl.colors.to_hex(box.get_facecolor()) == style.ORANGE.lower() for box in boxes
    ]
    assert filled == [False, True, False]
    assert axes.lines[0].get_xdata()[0] == 2
    axes.figure.canvas.draw()


def test_the_thick_line_is_the_upper_edge(axes):
    values = AlphaVectors(
        np.array([[4.0, 0.0], [0.0, 4.0], [3.0, 3.0]]), np.array([1, 2, 0])
    )
    draw_values_of_beliefs(axes, values, ["wait", "left", "right"])
    thick = [line for line in axes.lines if line.get_linewidth() > 2]
    edge = np.nanmax([line.get_ydata() for line in thick], axis=0)
    belief = thick[0].get_xdata()
    np.testing.assert_allclose(
        edge, values.value(np.stack([belief, 1 - belief], axis=1))
    )
    assert {text.get_text() for text in axes.get_legend().get_texts()} == {
        "wait",
        "left",
        "right",
    }


def test_a_door_has_the_same_colour_in_the_figure_and_in_the_explorable(axes):
    script = Path(explorables.__file__).with_name("tiger_vectors.js").read_text("utf-8")
    (shown,) = re.findall(r"const colours = \[(PALETTE.*)\];", script)
    named = [getattr(style, name) for name in re.findall(r"PALETTE\.(\w+)", shown)]
    draw_values_of_beliefs(axes, qmdp(tiger()), ["listen", "open left", "open right"])
    drawn = {line.get_label(): line.get_color() for line in axes.lines}
    assert [drawn[door] for door in ("open left", "open right")] == named[1:]


def test_a_plan_is_a_tree_of_actions_and_observations(axes):
    further = {"left": ("open", {}), "right": ("listen", {"either": ("open", {})})}
    draw_plan(axes, ("listen", further))
    places = {text.get_position(): text.get_text() for text in axes.texts}
    assert places[1.0, 0.0] == "listen"
    assert [places[0.5, -1.0], places[1.5, -1.0]] == ["open", "listen"]
    assert places[1.5, -2.0] == "open"
    assert places[0.75, -0.5] == "left"
    assert len(axes.lines) == 3
    axes.figure.canvas.draw()


def test_poses_are_summed_over_headings_and_pointed_out(axes):
    grid = PoseGrid([[True, True], [True, False]], cell=2.0, headings=4)
    belief = np.zeros(grid.n_states)
    belief[[0, 1, 9]] = 0.3, 0.2, 0.5  # the first cell twice, the one above it once
    draw_pose_belief(axes, grid, belief, pose=(1.0, 3.0, 0.0))
    shares = axes.images[0].get_array()
    np.testing.assert_allclose(shares, [[1, 0], [1, 0]])
    assert axes.images[0].get_extent() == [0, 4, 0, 4]
    arrows = [patch for patch in axes.patches if isinstance(patch, FancyArrowPatch)]
    assert len(arrows) == 3
    axes.figure.canvas.draw()


def test_uncertainty_starts_at_step_zero(axes):
    plot_uncertainty(axes, {"good": [3.0, 1.0], "none": [3.0, 3.0, 3.0]})
    np.testing.assert_allclose(axes.lines[0].get_xydata(), [[0, 3], [1, 1]])
    assert len(axes.lines) == 2


def test_the_scheme_shows_every_node_and_arrow(axes):
    draw_pomdp(axes)
    assert len(axes.lines) == 15  # five kinds at three times
    arrows = [patch for patch in axes.patches if isinstance(patch, FancyArrowPatch)]
    assert len(arrows) == 3 * 5 + 2 * 5
    axes.figure.canvas.draw()
