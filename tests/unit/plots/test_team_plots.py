"""The figure of several robots: one line a method, at the means of the results."""

import numpy as np
import pytest
from matplotlib import pyplot as plt

from robonav.experiments import read_results
from robonav.plots import team as draw


@pytest.mark.parametrize("name", ["team", "team-learning"])
def test_a_line_goes_through_the_means(name):
    results = read_results(name)
    cases = list(results.experiment.cases)
    figure = draw.draw_against_robots(results)
    first = next(iter(cases[0]))
    lines = list(dict.fromkeys(case[first] for case in cases))
    for axes, metric in zip(figure.axes, draw.PANELS, strict=True):
        assert [line.get_label() for line in axes.lines] == [
            draw.line_style(line)[0] for line in lines
        ]
        means = [results.summary(metric, k).mean for k in range(len(cases))]
        drawn = np.concatenate([line.get_ydata() for line in axes.lines])
        np.testing.assert_allclose(drawn, means)
        assert len(axes.collections) == len(lines)
    assert [tick.get_text() for tick in figure.axes[1].get_xticklabels()] == [
        "1", "2", "4", "8", "16"
    ]  # fmt: skip
    plt.close(figure)
