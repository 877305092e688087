"""The drawings of decision processes show what they are given."""

import math

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, Rectangle

from robonav import mdp, style
from robonav.plots import mdp as draw


@pytest.fixture
def axes():
    mpl.use("agg")
    return Figure().add_subplot()


def words(axes):
    return [text.get_text() for text in axes.texts]


def arrows(axes):
    return [patch for patch in axes.patches if isinstance(patch, FancyArrowPatch)]


def test_a_grid_shows_walls_values_and_arrows(axes):
    grid = mdp.four_by_three()
    solution = mdp.value_iteration(grid.mdp(0.95))
    draw.draw_grid(axes, grid, solution.values, policy=solution.policy)
    shown = words(axes)
    assert shown.count("+1") == shown.count("-1") == shown.count("S") == 1
    for value in solution.values[~grid.terminal]:
        assert f"{value:.2f}" in shown
    assert len(arrows(axes)) == 9
    wall = [
        patch
        for patch in axes.patches
        if isinstance(patch, Rectangle) and patch.get_xy() == (1, 1)
    ]
    assert wall[0].get_facecolor() == mpl.colors.to_rgba(style.OBSTACLE)
    axes.figure.canvas.draw()


def test_arrows_point_where_the_actions_lead(axes):
    grid = mdp.GridWorld("....G")
    draw.draw_grid(axes, grid, policy=[0, 1, 2, 3, 0])
    directions = []
    for arrow in arrows(axes):
        (x0, y0), (x1, y1) = arrow._posA_posB
        directions.append((round(y1 - y0, 2), round(x1 - x0, 2)))
    assert directions == [(-0.48, 0), (0, 0.48), (0.48, 0), (0, -0.48)]


def test_a_stochastic_policy_has_an_arrow_for_each_likely_action(axes):
    grid = mdp.GridWorld(".G")
    draw.draw_grid(axes, grid, policy=[[0.5, 0.495, 0.005, 0], [1, 0, 0, 0]])
    assert len(arrows(axes)) == 2
    assert words(axes) == ["+1"]


def test_colours_tell_sign_and_size():
    assert draw.colour_of_value(0) == pytest.approx(mpl.colors.to_rgb(draw.ZERO))
    assert draw.colour_of_value(1) == draw.colour_of_value(3)
    red, _, blue = draw.colour_of_value(-1)
    assert red > blue
    red, _, blue = draw.colour_of_value(1)
    assert blue > red


@pytest.mark.parametrize(
    ("scheme", "named"),
    [
        (draw.draw_interaction, ["agent", "environment"]),
        (draw.draw_decision_network, ["$S_0$", "$A_2$", "$R_3$"]),
        (draw.draw_evaluation_and_improvement, [r"policy $\pi$", "values $V$"]),
        (draw.draw_two_lines, [r"$V^*, \pi^*$"]),
    ],
)
def test_schemes_name_their_parts(axes, scheme, named):
    scheme(axes)
    assert set(named) <= set(words(axes))
    axes.figure.canvas.draw()


def test_a_trace_is_drawn_as_it_is(axes):
    trace = mdp.generalized_policy_iteration(
        mdp.four_by_three().mdp(0.9), sweeps=math.inf
    )
    draw.plot_trace(axes, trace, least=1e-8)
    evaluation, greedy = (line.get_ydata() for line in axes.lines)
    np.testing.assert_allclose(evaluation, np.maximum(trace.evaluation_gap, 1e-8))
    np.testing.assert_allclose(greedy, np.maximum(trace.greedy_gap, 1e-8))


def test_the_value_plane_holds_cloud_paths_and_best(axes):
    paths = {"value iteration": [[0, 0], [1, 1]]}
    draw.draw_value_plane(axes, [[0, 1], [1, 0]], paths, corners=[[2, 2]], best=[2, 2])
    assert axes.lines[2].get_color() == draw.PLANNERS["value iteration"]
    np.testing.assert_array_equal(axes.lines[2].get_xydata(), [[0, 0], [1, 1]])
    axes.figure.canvas.draw()
