"""Chapter 4's drawings show the numbers they were given."""

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot as plt

from robonav import style
from robonav.experiments import Experiment, Results
from robonav.plots import nnql as draw
from robonav.robot import random_worlds

mpl.use("Agg")


@pytest.fixture
def axes():
    with mpl.rc_context(style.STYLE):
        figure, axes = plt.subplots()
        yield axes
        figure.canvas.draw()
        plt.close(figure)


def test_rewards_by_distance_before_and_after(axes):
    draw.draw_rewards(axes)
    shown = axes.images[0].get_array()
    at = {
        (b, a): shown[int(a / 11 * 400), int(b / 11 * 400)]
        for b, a in ((7, 7), (3, 3), (4.5, 1.2), (3, 6), (7, 3))
    }
    assert at == {(7, 7): 0.6, (3, 3): 0.4, (4.5, 1.2): -1.0, (3, 6): 0.5, (7, 3): 0.0}


def test_boltzmann_curves_start_greedy_and_end_even(axes):
    draw.draw_softmax_policy(axes, [0.9, 0.8, 0.5, 0.3, 0.1], coldest=1e-4, hottest=1e4)
    ends = np.array([line.get_ydata()[[0, -1]] for line in axes.lines])
    np.testing.assert_allclose(ends[:, 0], [1, 0, 0, 0, 0], atol=1e-9)
    np.testing.assert_allclose(ends[:, 1], 0.2, atol=1e-4)


def test_learning_curves_have_mean_and_band(axes):
    draw.draw_learning(axes, {"nnql": [[10, 20], [20, 30]], "online": [[1, 2]]})
    np.testing.assert_array_equal(axes.lines[0].get_xdata(), [30, 60])
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), [15, 25])
    assert axes.lines[0].get_color() == style.METHOD_COLOURS["nnql"]


def test_rates_show_every_seed_their_mean_and_the_thesis(axes):
    draw.draw_rates(axes, {"nnql": [90, 100], "online": [50, 60]}, thesis={"nnql": 98})
    dots, mean, diamond = axes.lines[:3]
    np.testing.assert_array_equal(dots.get_xdata(), [90, 100])
    np.testing.assert_array_equal(mean.get_xdata(), [95, 95])
    np.testing.assert_array_equal(diamond.get_xdata(), [98])


def test_trials_are_sorted_and_the_first_is_marked(axes):
    draw.draw_trials(axes, {"nnql": [50.0, 90.0, 20.0]})
    dots, cross = axes.lines
    np.testing.assert_array_equal(dots.get_ydata(), [20, 50, 90])
    assert cross.get_ydata() == [50.0]
    np.testing.assert_allclose(cross.get_xdata(), dots.get_xdata()[1])


def test_endings_fill_their_bars(axes):
    draw.draw_endings(axes, {"a": (90.0, 7.0, 3.0), "b": (50.0, 0.0, 50.0)})
    widths = np.array([[bar.get_width() for bar in group] for group in axes.containers])
    np.testing.assert_array_equal(widths.sum(axis=0), 100)
    assert [text.get_text() for text in axes.texts] == ["90.0 %", "50.0 %"]


def test_weight_changes(axes):
    draw.draw_weight_changes(axes, {"signed": [1.0, -2.0], "absolute": [1.0, 2.0]})
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), [1, -2])
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [
        "signed",
        "absolute",
    ]


def results_of(cases, numbers, **more):
    """Results of two seeds a case; ``numbers`` gives the values of a metric (steps,) by case and seed."""
    experiment = Experiment(
        "toy", "toy", cases, lambda *_: {}, {"quick": 2, "thesis": 2}, **more
    )
    rows = [
        (case, seed, metric, step, float(value))
        for case in range(len(cases))
        for seed in range(2)
        for metric, values in sorted(numbers(case, seed).items())
        for step, value in enumerate(np.atleast_1d(values))
    ]
    return Results.from_rows(experiment, "quick", rows)


@pytest.fixture
def closing():
    with mpl.rc_context(style.STYLE):
        yield
    plt.close("all")


@pytest.mark.usefixtures("closing")
def test_learning_from_results():
    cases = [{"method": "nnql"}, {"method": "dqn"}]
    figure = draw.plot_learning(
        results_of(cases, lambda case, seed: {"successes": [case, seed]})
    )
    lines = figure.axes[0].lines
    assert [line.get_label() for line in lines] == ["NNQL", "DQN"]
    np.testing.assert_array_equal(lines[1].get_ydata(), [1, 0.5])


@pytest.mark.usefixtures("closing")
def test_weight_changes_of_several_seeds_are_averaged():
    cases = [{"sum": "signed"}, {"sum": "absolute"}]
    layers = {"first layer": [1, 2], "second layer": [3, 4]}
    results = results_of(
        cases,
        lambda case, seed: {
            k: (np.array(v) + seed) * (case + 1) for k, v in layers.items()
        },
    )
    first, second = draw.plot_weight_changes(results).axes
    np.testing.assert_array_equal(first.lines[0].get_ydata(), [1.5, 2.5])
    np.testing.assert_array_equal(second.lines[1].get_ydata(), [7, 9])


@pytest.mark.usefixtures("closing")
def test_rates_from_results_have_the_thesiss_diamond():
    cases = [{"method": "nnql"}, {"method": "straight"}]
    results = results_of(
        cases, lambda case, seed: {"success": 90 + seed}, thesis={"success": [98, None]}
    )
    diamonds = [
        line
        for line in draw.plot_rates(results).axes[0].lines
        if line.get_marker() == "D"
    ]
    assert [line.get_xdata() for line in diamonds] == [[98]]


@pytest.mark.usefixtures("closing")
def test_speeds_have_a_curve_a_robot_and_a_band_from_worst_to_best():
    cases = [
        {"method": method, "speed": speed}
        for method in ("nnql", "straight")
        for speed in (2.0, 4.0)
    ]
    results = results_of(cases, lambda case, seed: {"success": 10 * case + seed})
    axes = draw.plot_speeds(results).axes[0]
    np.testing.assert_array_equal(axes.lines[1].get_xdata(), [2, 4])
    np.testing.assert_array_equal(axes.lines[1].get_ydata(), [20.5, 30.5])
    assert axes.collections[1].get_paths()[0].get_extents().ymax == 31


@pytest.mark.usefixtures("closing")
def test_trials_are_grouped_by_method():
    cases = [
        {"method": method, "trial": trial}
        for method in ("nnql", "online")
        for trial in range(3)
    ]
    results = results_of(
        cases, lambda case, seed: {"success": [60, 80, 70, 10, 30, 20][case] + seed}
    )
    dots = draw.plot_trials(results).axes[0].lines[2]
    np.testing.assert_array_equal(dots.get_ydata(), [10.5, 20.5, 30.5])


@pytest.mark.usefixtures("closing")
def test_endings_and_variations_of_what_was_varied():
    cases = [
        {"factor": factor, "level": level}
        for factor in ("reward", "inputs")
        for level in ("a", "b")
    ]
    ends = {"success": 70.0, "out of steps": 20.0, "collision": 10.0}
    results = results_of(
        cases,
        lambda case, seed: {
            k: v + (case + seed) * (k == "success") for k, v in ends.items()
        },
    )
    bars = draw.plot_endings(results, "inputs").axes[0]
    assert [text.get_text() for text in bars.texts] == ["72.5 %", "73.5 %"]
    axes = draw.plot_variations(results).axes[0]
    assert [tick.get_text() for tick in axes.get_yticklabels()] == [
        "reward: a",
        "reward: b",
        "inputs: a",
        "inputs: b",
    ]
    assert [line.get_xdata() for line in axes.lines if line.get_marker() == "o"] == [
        [70.5],
        [71.5],
        [72.5],
        [73.5],
    ]


def test_animations_have_a_frame_for_each():
    world = random_worlds(1, 3, seed=1)
    paths = [np.zeros((2, 3)) + 10, np.zeros((4, 3)) + 20]
    for film, frames in (
        (draw.animate_softmax_policy(np.arange(5) / 5, [0.9, 0.5, 0.1]), 3),
        (draw.animate_learning(world, paths, ["one", "two"]), 2),
    ):
        assert len(list(film.new_saved_frame_seq())) == frames
        film._func(frames - 1)
        film._draw_was_started = True  # else matplotlib warns that nobody watched it
    plt.close("all")
