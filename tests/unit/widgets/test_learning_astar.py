"""The computer expert in the page: modified A* expands the same nodes as Python's, and drives the same way."""

import numpy as np
import pytest

from robonav.lfd import demonstrate, plan
from robonav.robot import random_worlds
from robonav.widgets.simulator import page_world

FILES = ("simulator", "learning/astar")
PLAN = """return data.worlds.map((world) => {
  const { poses, ...plan } = page.modifiedAstar(world, page.startPose(world), data.settings);
  return { ...plan, points: poses.map(({ x, y }) => [x, y]), headings: poses.map(({ heading }) => heading) };
});"""


@pytest.mark.parametrize(
    "settings",
    [
        {"speed": 2.0, "margin": 2.0},
        {"speed": 2.0, "margin": 3.0, "caution": 2.0, "cell": 2.0},
        pytest.param(
            {"speed": 1.5, "margin": 1.0, "cell": 1.0, "limit": 500},
            marks=pytest.mark.slow,
        ),
        pytest.param({"speed": 0.5, "margin": 2.0}, marks=pytest.mark.slow),
        pytest.param(
            {"speed": 0.3, "margin": 2.0, "caution": 2.0, "cell": 1.0},
            marks=pytest.mark.slow,
        ),
    ],
)
@pytest.mark.slow
def test_plans_are_pythons_node_for_node(node, settings):
    """Of two paths that are equally long, rounding may choose another; the nodes are as many all the same.

    A slow robot's moves are a metre, as long as a cell: there rounding may also decide which cell a point is in.
    """
    worlds = random_worlds(50, 20, seed=12)
    given = {"worlds": [page_world(w) for w in worlds], "settings": settings}
    others = 0
    for world, got in zip(worlds, node(FILES, PLAN, given), strict=True):
        expected = plan(world, **settings)
        assert got["found"] == expected.found
        apart = abs(got["expanded"] - expected.expanded)
        assert apart == 0 if settings["speed"] >= 1 else apart <= 2
        assert len(got["actions"]) == len(expected.actions)
        if got["actions"] != expected.actions.tolist():
            others += 1
            continue
        np.testing.assert_allclose(got["points"], expected.points, atol=1e-9)
        turned = np.array(got["headings"]) - expected.headings
        np.testing.assert_allclose(np.sin(turned / 2), 0, atol=1e-9)
    assert others <= (1 if settings["speed"] >= 1 else 3)


@pytest.mark.parametrize(
    ("obstacles", "speed"),
    [
        (10, 2.0),
        pytest.param(20, 2.0, marks=pytest.mark.slow),
        pytest.param(10, 0.5, marks=pytest.mark.slow),
    ],
)
def test_the_expert_demonstrates_as_in_python(node, obstacles, speed):
    worlds = random_worlds(25 if speed > 1 else 5, obstacles, seed=7)
    demonstrations = demonstrate(worlds, speed=speed)
    body = """return data.worlds.map((world) => {
      const { steps, outcome } = page.expertDemonstration(world, data.speed);
      return { actions: steps.map(({ action }) => action), outcome };
    });"""
    given = {"worlds": [page_world(w) for w in worlds], "speed": speed}
    got = node(FILES, body, given)
    for i, each in enumerate(got):
        assert (
            each["actions"]
            == demonstrations.actions[demonstrations.trajectory == i].tolist()
        ), i
        assert each["outcome"] == demonstrations.outcome[i]
