"""Chapter 5's drawings show the numbers they were given."""

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.colors import to_rgb

from robonav import lfd, nirl, style
from robonav.experiments import Results
from robonav.experiments.chapter5.ablations import (
    GRADIENT_STEPS,
    GRADIENT_STEPS_OF_ALGORITHM_10,
)
from robonav.experiments.chapter5.tables import (
    FIGURE_5_4,
    FIGURE_5_7,
    FIGURE_5_10,
    TABLE_5_2,
)
from robonav.plots import nirl as draw
from robonav.robot import Encoder, neighbour_slip, random_worlds

mpl.use("Agg")


@pytest.fixture
def axes():
    with mpl.rc_context(style.STYLE):
        figure, axes = plt.subplots()
        yield axes
        figure.canvas.draw()
        plt.close(figure)


def made_up(experiment, metrics, steps=1, seeds=3):
    """Results whose numbers say where they are from: 100 times the case, 10 times the seed, and the step."""
    rows = [
        (case, seed, metric, step, 100.0 * case + 10 * seed + step)
        for case in range(len(experiment.cases))
        for seed in range(seeds)
        for metric in metrics
        for step in range(steps)
    ]
    return Results.from_rows(experiment, "thesis", rows)


def test_the_margin_lies_between_the_expert_and_the_nearest_other(axes):
    draw.draw_margin(axes, [2.0, 0.0], [[0.5, 1.0], [-1.0, 0.0]], [1.0, 0.0])
    places = sorted(line.get_xy1()[0] for line in axes.lines[:2])
    assert places == [0.5, 2.0]


def test_projection_moves_a_policy_a_frame():
    corners = np.array([[0.0, 0], [1, 0], [0, 1]])
    moving = draw.animate_projection(corners, [0.2, 0.2], corners, corners / 2)
    assert len(list(moving.new_frame_seq())) == 3
    moving._draw_frame(2)
    assert "0.361 from the expert" in moving._fig.axes[0].get_title()
    moving._draw_was_started = True  # else matplotlib warns that nobody watched it
    plt.close(moving._fig)


def test_key_points_and_what_was_driven(axes):
    world = random_worlds(1, 3, seed=0)
    draw.draw_key_points(
        axes,
        world,
        [[30.0, 40.0]],
        np.array([[10.0, 10], [90, 90]]),
        np.array([[11.0, 12, 0]]),
    )
    assert [30.0] in [list(line.get_xdata()) for line in axes.lines]
    assert [11.0] in [list(line.get_xdata()) for line in axes.lines]


def test_slips_are_ringed(axes):
    demonstrations = lfd.record_demonstrations(
        lfd.ComputerExpert(), random_worlds(1, 20, seed=4), slip=neighbour_slip(0.3)
    )
    meant = demonstrations.actions.copy()
    meant[3] = (meant[3] + 1) % 5
    draw.draw_slips(axes, demonstrations, meant)
    assert axes.get_title().startswith("1 of")
    np.testing.assert_array_equal(
        axes.lines[-1].get_xdata(), demonstrations.poses[3:4, 0]
    )


def test_names_fit_the_inputs():
    for target in ("number", "signed", "one-hot", "sine-cosine"):
        for walls in (False, True):
            encoder = Encoder(walls=walls, target=target)
            assert len(draw.names_of(encoder)) == encoder.size + 1


def test_likes_are_blue_and_fears_are_red():
    weights = np.zeros((5, nirl.ENCODER.size + 1))
    weights[0, 0], weights[0, 1] = -1.0, 0.5
    figure = plt.figure()
    draw.draw_likes(figure, weights, nirl.ENCODER)
    ahead, _, left, _ = figure.axes[0].patches[:4]
    assert ahead.get_facecolor() == (*to_rgb(style.VERMILION), 1.0)
    assert left.get_facecolor() == (*to_rgb(style.BLUE), 0.5)
    assert len(figure.axes) == 5
    plt.close(figure)


def test_weights_are_shown_on_a_scale_around_zero(axes):
    weights = np.arange(5.0 * (nirl.ENCODER.size + 1)).reshape(5, -1)
    draw.draw_weights(axes, weights, nirl.ENCODER)
    image = axes.images[0]
    np.testing.assert_array_equal(image.get_array(), weights.T)
    assert image.get_clim() == (-weights.max(), weights.max())


def test_the_map_of_a_reward_is_blank_where_nothing_is_decided(axes):
    weights = np.zeros((5, nirl.ENCODER.size + 1))
    weights[0, -1] = 1.0  # a constant reward of going on
    world = random_worlds(1, 3, seed=0)
    draw.draw_reward_map(axes, world, weights, nirl.ENCODER, spacing=5.0)
    drawn = np.ma.masked_invalid(axes.images[0].get_array())
    assert 0 < drawn.mask.mean() < 1
    assert (drawn.compressed() == 1).all()


def test_the_choice_rings_the_best_of_each_score(axes):
    draw.draw_choice(axes, {"accuracy": [0.2, 0.7], "balanced": [0.9, 0.1]}, [10, 20])
    rings = [(line.get_xdata()[0], line.get_ydata()[0]) for line in axes.lines[1::2]]
    assert rings == [(70.0, 20.0), (90.0, 10.0)]


def test_a_course_is_the_mean_of_its_runs(axes):
    draw.draw_iterations(
        axes, {"0.65": [[1.0, 3, 5], [3.0, 3, 3]], "0.9": [[0.0, 0, 0]]}, "margin"
    )
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), [2, 3, 4])
    np.testing.assert_array_equal(axes.lines[0].get_xdata(), [1, 2, 3])
    assert axes.get_legend() is not None


def test_results_find_their_panels():
    counts = draw.plot_counts(made_up(FIGURE_5_4, ("samples", "states")))
    own = [line for line in counts.axes[0].lines if line.get_label() == "human"]
    np.testing.assert_array_equal(own[0].get_ydata(), 100 * np.arange(6, 12) + 10)
    course = draw.plot_iterations(
        made_up(FIGURE_5_7, ("margin",), steps=4), "margin", "margin"
    )
    np.testing.assert_array_equal(
        course.axes[0].lines[0].get_ydata(), 10 + np.arange(4)
    )
    densities = draw.plot_densities(made_up(FIGURE_5_10, ("success",)))
    assert [axes.get_title() for axes in densities.axes] == ["1 m/s", "2 m/s", "3 m/s"]
    np.testing.assert_array_equal(
        densities.axes[1].lines[0].get_ydata(), 100 * np.arange(6, 12) + 10
    )
    comparison = draw.plot_comparison(made_up(TABLE_5_2, ("success",)), 0.9)
    labels = [label.get_text() for label in comparison.axes[0].get_yticklabels()]
    assert labels[:4] == ["NIRL", "apprenticeship", "relative entropy", "SCIRL"]
    assert "zero reward" in labels
    for figure in (counts, course, densities, comparison):
        figure.canvas.draw()
        plt.close(figure)


def test_gradient_steps_have_a_line_for_each_reward():
    results = made_up(GRADIENT_STEPS_OF_ALGORITHM_10, ("success",))
    (axes,) = draw.plot_gradient_steps(results).axes
    first, second = (line for line in axes.lines if line.get_label()[0] != "_")
    assert first.get_label() == "reward: least squares, (5.14)"
    for line, cases in ((first, np.arange(6)), (second, np.arange(6, 12))):
        np.testing.assert_array_equal(line.get_xdata(), GRADIENT_STEPS)
        np.testing.assert_array_equal(line.get_ydata(), 100 * cases + 10)


def test_steps_are_rows_with_dots_means_and_names(axes):
    draw.draw_steps(axes, {"as printed": [1.0, 3.0], "changed": [90.0, 98.0]})
    texts = [text.get_text() for text in axes.texts]
    assert texts == ["2 %", "1. as printed", "94 %", "2. changed"]
    np.testing.assert_array_equal(axes.lines[1].get_xdata(), [2.0, 2.0])
