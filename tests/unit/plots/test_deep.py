"""What the pictures of PPO show."""

import numpy as np
import pytest
from matplotlib import pyplot as plt

from robonav.experiments import bootstrap_interval, read_results
from robonav.plots import deep as draw


@pytest.fixture
def axes():
    figure, axes = plt.subplots()
    yield axes
    plt.close(figure)


@pytest.mark.parametrize("advantage", [-1.5, 1.0])
def test_the_clipped_surrogate_by_cases(axes, advantage):
    draw.draw_clipped_surrogate(axes, advantage, clip=0.3)
    lines = {line.get_label(): line for line in axes.lines}
    ratio, gain = lines["clipped"].get_data()
    limited = np.minimum(ratio, 1.3) if advantage > 0 else np.maximum(ratio, 0.7)
    assert gain == pytest.approx(limited * advantage)
    assert lines["not clipped"].get_ydata() == pytest.approx(ratio * advantage)


def test_arrivals_have_the_mean_and_its_interval(axes):
    runs = np.random.default_rng(0).uniform(0, 100, (5, 3))
    draw.draw_arrivals(axes, {"one": runs, "other": runs / 2}, steps=500)
    assert axes.lines[0].get_xdata() == pytest.approx([0.5, 1.0, 1.5])
    assert axes.lines[1].get_ydata() == pytest.approx(runs.mean(axis=0) / 2)
    band = axes.collections[0].get_paths()[0].vertices
    for k in range(3):
        at = band[np.isclose(band[:, 0], 0.5 * (k + 1)), 1]
        assert (at.min(), at.max()) == pytest.approx(bootstrap_interval(runs[:, k]))


def test_failures_are_what_success_leaves(axes):
    results = read_results("ppo-curriculum")
    draw.draw_failures(axes, results, steps="stage", lines="setting")
    drawn = {one.get_label(): one for one in axes.containers}
    for place, case in enumerate(results.experiment.cases):
        data, _, (bars,) = drawn[case["setting"]].lines
        summary, at = results.summary("success", place), int(case["stage"][0]) - 1
        assert data.get_ydata()[at] == pytest.approx(100 - summary.mean)
        ends = bars.get_segments()[at][:, 1]
        assert sorted(ends) == pytest.approx([100 - summary.high, 100 - summary.low])
