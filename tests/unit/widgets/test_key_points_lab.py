"""Key points in the page: path, clearance and robot are those of the human expert in Python."""

import numpy as np
import pytest

from robonav.lfd import demonstrate_by_hand, path_clearance, sketch, smooth_path
from robonav.robot import make_world, random_worlds
from robonav.widgets.key_points_lab import FIRST_MAP, key_points_lab
from robonav.widgets.simulator import page_world

FILES = (
    "simulator", "maps", "episode", "files", "learning/random", "learning/worlds",
    "kept_demonstrations", "key_points_lab",
)  # fmt: skip
WORLDS = random_worlds(12, obstacles=15, seed=3)


@pytest.mark.parametrize(
    "points",
    [
        [(0, 0), (2, 0)],
        [(10, 10), (40, 20), (90, 90)],
        [(10, 10), (12, 70), (13, 70.5), (60, 5), (90, 90)],
        [(10, 10), (50, 50), (49.9, 50), (50, 50), (90, 90)],
    ],
)
def test_the_path_is_the_cubic_spline_of_python(node, points):
    got = node(FILES, "return page.smoothPath(data);", points)
    path = smooth_path(points)
    np.testing.assert_allclose(got["path"], path, atol=1e-9)
    at_knots = np.array(got["path"])[got["knots"]]
    np.testing.assert_allclose(at_knots, points, atol=1e-9)


def test_clearance_of_a_path(node):
    world = make_world(circles=[(50, 50, 5)], rectangles=[(30, 70, 8, 4, 30)])
    path = [(50, 60), (50, 53), (30, 70), (33, 74), (3, 80), (60, 100)]
    got = node(
        FILES,
        "return page.pathClearance(data.world, data.path);",
        {"world": page_world(world), "path": path},
    )
    np.testing.assert_allclose(got, path_clearance(world, path), atol=1e-6)


def test_the_robot_takes_the_actions_that_it_takes_in_python(node):
    points = [each.round(1) for each in sketch(WORLDS, seed=1)]
    expected = demonstrate_by_hand(WORLDS, points)
    body = """
      return data.map(({ world, points }) => {
        const { path } = page.smoothPath([world.start, ...points, world.target]);
        const followed = page.followedEpisode(world, path);
        while (followed.running()) followed.go();
        return { actions: followed.episode.steps.map(({ action }) => action), outcome: followed.episode.outcome };
      });
    """
    data = [
        {"world": page_world(world), "points": each.tolist()}
        for world, each in zip(WORLDS, points, strict=True)
    ]
    got = node(FILES, body, data)
    for i, each in enumerate(got):
        actions = expected.actions[expected.trajectory == i]
        assert each["actions"] == actions.tolist()
        assert each["outcome"] == expected.outcome[i]
    assert len({action for each in got for action in each["actions"]}) > 4


def test_the_readers_map_is_the_world_of_its_seed(node):
    got = node(FILES, "return page.ownMap(data);", 7)
    assert got["key"] == page_world(random_worlds(1, 10, seed=FIRST_MAP + 7))["key"]


@pytest.mark.parametrize("obstacles", [-1, 2.5])
def test_a_wrong_number_of_obstacles_gets_one_sentence(obstacles):
    with pytest.raises((TypeError, ValueError), match="obstacles must"):
        key_points_lab(obstacles=obstacles)
