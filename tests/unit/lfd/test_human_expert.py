"""The human expert: key points, smooth paths, robots that follow them."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree
from shapely import LineString, Point

from robonav.lfd import (
    PathFollower,
    demonstrate_by_hand,
    path_clearance,
    record_demonstrations,
    sketch,
    smooth_path,
)
from robonav.robot import make_world, neighbour_slip, random_worlds

places = st.tuples(st.floats(5, 95), st.floats(5, 95))


@settings(max_examples=50, deadline=None)
@given(
    st.lists(
        places, min_size=2, max_size=8, unique_by=lambda p: (round(p[0]), round(p[1]))
    )
)
def test_a_path_goes_through_its_key_points(points):
    path = smooth_path(points)
    assert path[0] == pytest.approx(points[0])
    assert path[-1] == pytest.approx(points[-1])
    assert cKDTree(path).query(points)[0].max() < 1e-9
    assert np.linalg.norm(np.diff(path, axis=0), axis=1).max() < 1.5


def test_a_path_is_smooth():
    path = smooth_path([(10, 10), (40, 20), (50, 60), (90, 90)], spacing=0.1)
    way = np.diff(path, axis=0)
    bends = np.abs(np.diff(np.unwrap(np.arctan2(way[:, 1], way[:, 0]))))
    assert bends.max() < 0.03


def test_two_points_make_a_straight_line():
    path = smooth_path([(10, 10), (20, 30)])
    assert np.allclose(
        (path[:, 1] - 10) / (path[:, 0] - 10 + 1e-300), 2, atol=1e-9
    ) or np.allclose(path[:, 1] - 10, 2 * (path[:, 0] - 10))


@pytest.mark.parametrize(
    "points", [[], [(1, 1)], [(1, 1), (1, 1)], [(1, 1), (2, 2), (2, 2)]]
)
def test_too_few_key_points(points):
    with pytest.raises(ValueError, match="key_points must"):
        smooth_path(np.reshape(points, (-1, 2)))


def test_clearance_of_a_path():
    world = make_world(circles=[(50, 50, 5)])
    path = smooth_path([(10, 10), (40, 60), (90, 90)])
    circle = Point(50, 50).buffer(5, quad_segs=256)
    wanted = [min(Point(p).distance(circle), *p, *(100 - p)) for p in path]
    assert path_clearance(world, path) == pytest.approx(np.array(wanted), abs=1e-3)
    assert path_clearance(world, [(-5.0, 3.0), (50.0, 50.0)]).tolist() == [0, 0]


def test_a_robot_stays_on_its_path():
    worlds = random_worlds(1, 0, seed=1)
    path = smooth_path([(10, 10), (30, 60), (60, 40), (90, 90)])
    demonstrations = record_demonstrations(PathFollower([path]), worlds, reflex=None)
    assert demonstrations.outcome[0] == "arrived"
    line = LineString(path)
    assert max(line.distance(Point(p)) for p in demonstrations.poses[:, :2]) < 2.0
    assert len(demonstrations) == pytest.approx(line.length / 2, rel=0.1)


def test_demonstrations_by_hand():
    worlds = random_worlds(6, 12, seed=3)
    points = sketch(worlds, seed=5)
    demonstrations = demonstrate_by_hand(worlds, points)
    assert (demonstrations.outcome == "arrived").mean() > 0.8
    assert len(demonstrations.effective) > 20
    assert set(np.unique(demonstrations.effective.actions)) <= set(range(5))
    slipping = demonstrate_by_hand(worlds, points, slip=neighbour_slip(0.3))
    assert not np.array_equal(
        slipping.actions[: len(demonstrations)], demonstrations.actions[: len(slipping)]
    )


def test_errors_of_sketches_shrink_until_the_path_is_clear():
    """With errors of six metres, most first attempts lead through something."""
    worlds = random_worlds(12, 20, seed=3)
    for world, points in zip(worlds, sketch(worlds, seed=5, noise=6.0), strict=True):
        path = smooth_path([world.starts[0], *points, world.targets[0]])
        assert path_clearance(world, path).min() > 1.5


def test_sketches_depend_on_seed_and_world_alone():
    worlds = random_worlds(4, 12, seed=3)
    some, same, others = (
        sketch(worlds, seed=5),
        sketch(worlds[:2], seed=5),
        sketch(worlds, seed=6),
    )
    assert np.array_equal(some[1], same[1])
    assert any(not np.array_equal(a, b) for a, b in zip(some, others, strict=True))
    assert max(map(len, some)) < 20


def test_key_points_through_an_obstacle_are_an_error():
    world = make_world(circles=[(50, 50, 5)])
    with pytest.raises(
        ValueError,
        match=r"key_points\[0\] must lead clear of obstacles: near \(4[56]\.\d, 4[56]",
    ):
        demonstrate_by_hand(world, [np.empty((0, 2))])
    assert demonstrate_by_hand(world, [[(40, 65)]]).outcome[0] == "arrived"
    with pytest.raises(
        ValueError, match="key_points must be one set for each world, 1, got 2"
    ):
        demonstrate_by_hand(world, [[(40, 65)], [(40, 65)]])
    with pytest.raises(ValueError, match="must lead clear"):
        demonstrate_by_hand(world, [[(40, 120)]])


def test_a_follower_takes_the_action_that_ends_nearest_to_the_point_ahead():
    """The question on the page: from (30, 30) towards (33, 31), L30 ends nearest."""
    follower = PathFollower([[(x, 31) for x in np.arange(20, 60, 0.25)]])
    pose = np.array([30.0, 30.0, 0.0])
    assert follower.lookahead_point(0, pose, 2.0) == pytest.approx((33, 31))
    simulator = SimpleNamespace(poses=pose[None], speed=2.0)
    assert follower(simulator, np.array([0])).tolist() == [1]
    turns = np.radians([0, 30, 60, -30, -60])
    ends = pose[:2] + 2 * np.column_stack([np.cos(turns), np.sin(turns)])
    left = np.linalg.norm(ends - (33, 31), axis=1)
    assert left.round(2).tolist()[:3] == [1.41, 1.27, 2.13]
