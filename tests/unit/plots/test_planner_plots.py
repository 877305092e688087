"""What the pictures of the planners show."""

import numpy as np
import pytest
from matplotlib import pyplot as plt

from robonav.planners import DynamicWindow, PotentialField, VectorFieldHistogram
from robonav.plots import planners as draw
from robonav.robot import make_world, sense


@pytest.fixture
def sensing():
    world = make_world(circles=[(57, 51, 2), (54, 58, 2)], target=(90, 50))
    return sense(world, [(50, 50, 0)])


@pytest.fixture
def axes():
    figure, axes = plt.subplots()
    yield axes
    plt.close(figure)


def test_longest_force_fills_the_picture(axes, sensing):
    draw.draw_forces(axes, sensing, PotentialField())
    tips = [np.hypot(*note.xy) for note in axes.texts if note.arrow_patch]
    assert max(tips) == pytest.approx(draw.LONGEST)
    seeing = (sensing.ranges[0] < 10).sum()
    assert len(tips) == 2 + seeing


@pytest.mark.parametrize("behind", [True, False])
def test_bars_are_blocked_or_masked(axes, behind):
    """The legend has no entry for bars that are not there."""
    circles = [(54, 50, 2), (46, 50, 2)] if behind else [(54, 50, 2)]
    sensing = sense(make_world(circles=circles), [(50, 50, 0)])
    draw.draw_histogram(axes, sensing, VectorFieldHistogram())
    labels = axes.get_legend_handles_labels()[1]
    masked = {"masked"} if behind else set()
    assert {"blocked", "threshold", "target", "chosen"} | masked == set(labels)
    blocked = next(c for c in axes.containers if c.get_label() == "blocked")
    assert all(bar.get_height() >= VectorFieldHistogram().threshold for bar in blocked)


def test_each_action_has_its_way_and_one_is_chosen(axes, sensing):
    policy = DynamicWindow(clearance=1.0)
    draw.draw_ways(axes, sensing, policy)
    words = [text.get_text() for text in axes.texts]
    said = [word.split()[0] for word in words if word.split()[0] in ("F", "L30", "L60", "R30", "R60", "B")]  # fmt: skip
    assert said == ["F", "L30", "L60", "R30", "R60", "B"]
