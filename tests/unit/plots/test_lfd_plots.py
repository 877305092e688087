"""Chapter 3's pictures show the numbers that they are given."""

import numpy as np
import pytest
from matplotlib import pyplot as plt

from robonav.experiments.chapter3.tables import (
    EXPERIMENTS,
    FIGURE_3_5,
    FIGURE_3_8,
    TABLE_3_2,
    TABLE_3_3,
)
from robonav.experiments.runner.experiment import Experiment, Results
from robonav.lfd import demonstrate, plan
from robonav.plots import lfd as draw
from robonav.robot import random_worlds


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def made_up(experiment: Experiment, metrics: list[str], steps: int = 1) -> Results:
    """Results whose value is 10 times the case, plus the seed, plus the step."""
    rows = [
        (case, seed, metric, step, 10.0 * case + seed + step)
        for case in range(len(experiment.cases))
        for seed in range(3)
        for metric in metrics
        for step in range(steps)
    ]
    return Results.from_rows(experiment, "quick", rows)


def test_demonstrations_and_the_thesis():
    figure = draw.plot_demonstrations(made_up(TABLE_3_2, ["success"]))
    lines = figure.axes[0].get_lines()
    assert any(np.array_equal(line.get_ydata(), [1, 11, 21, 31, 41]) for line in lines)
    assert any(np.array_equal(line.get_ydata(), [89, 92, 92, 93, 94]) for line in lines)


def test_iterations():
    figure = draw.plot_iterations(made_up(TABLE_3_3, ["accuracy", "success"]))
    assert len(figure.axes) == 2
    assert any(
        np.array_equal(line.get_ydata(), np.arange(7) * 10 + 71)
        for line in figure.axes[0].get_lines()
    )


def test_planners():
    metrics = [
        f"{metric}, {name} A*"
        for metric in ("length", "expanded")
        for name in ("modified", "grid")
    ]
    figure = draw.plot_planners(made_up(FIGURE_3_5, metrics))
    left, right = figure.axes
    assert left.patches[0].get_width() == pytest.approx(1 - np.hypot(80, 80))
    assert right.patches[3].get_width() == 31


def test_methods_rounds_and_margins():
    results = made_up(FIGURE_3_8, ["success", "success by round"], steps=4)
    figure, axes = plt.subplots()
    draw.draw_rounds(axes, results)
    assert [line.get_ydata()[0] for line in axes.get_lines()] == [61, 131, 201]
    figure = draw.plot_methods(made_up(FIGURE_3_8, ["success"]))
    assert {text.get_text() for text in figure.axes[0].get_legend().get_texts()} >= {
        "straight",
        "cloning",
        "DAgger",
    }
    by_name = {experiment.name: experiment for experiment in EXPERIMENTS}
    figure = draw.plot_margins(made_up(by_name["lfd-margins"], ["success"]))
    assert len(figure.axes[0].get_legend().get_texts()) == 4
    figure = draw.plot_cost(made_up(by_name["figure-3.7"], ["cost"], steps=301))
    assert figure.axes[0].get_lines()[0].get_ydata()[-1] == 301


def test_maps():
    demonstrations = demonstrate(random_worlds(3, 5, seed=1))
    figure = plt.figure()
    draw.draw_demonstrations(figure, demonstrations, range(3))
    assert [axes.get_title() for axes in figure.axes] == ["arrived"] * 3
    figure, axes = plt.subplots()
    made = plan(demonstrations.worlds[0], record=True)
    draw.draw_search(axes, demonstrations.worlds[0], made)
    assert len(axes.collections[-1].get_offsets()) == made.expanded
