"""The environment in plain NumPy is the compiled one: in whole episodes, and for robots anywhere in a map."""

from __future__ import annotations

import math

import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from robonav.robot import (
    Action,
    Outcome,
    Reflex,
    make_world,
    plain_environment,
    random_worlds,
    sense,
)
from robonav.robot._fast import constants, micrometres, swept_clearance
from robonav.robot.environments import NavigationEnv
from robonav.robot.plain_environment import PlainNavigationEnv, border, sector


def equal(one, other):
    """Hold two observations equal, to the last bit and to the type."""
    assert one.keys() == other.keys()
    for key in one:
        np.testing.assert_array_equal(one[key], other[key], err_msg=key)
        assert np.asarray(one[key]).dtype == np.asarray(other[key]).dtype, key


@pytest.mark.parametrize(
    ("obstacles", "speed", "direction"),
    [
        (0, 2.0, "exact"),
        (10, 1.3, "exact"),
        (20, 2.0, "exact"),
        (20, 4.0, "exact"),
        (30, 2.5, "exact"),
        (0, 2.0, "sector"),
        (10, 1.3, "sector"),
    ],
)
def test_episodes_are_those_of_the_compiled_environment(obstacles, speed, direction):
    """Wherever the sensors round a distance alike, which is everywhere in these episodes."""
    plain = PlainNavigationEnv(obstacles, speed, direction)
    fast = NavigationEnv(obstacles=obstacles, speed=speed, reflex=direction)
    assert plain.observation_space == fast.observation_space
    assert plain.action_space == fast.action_space
    rng, outcomes = np.random.default_rng(0), set()
    for seed in range(12):
        (one, _), (other, info) = plain.reset(seed=seed), fast.reset(seed=seed)
        equal(one, other)
        ended, steps = False, 0
        while not ended and steps < 100:
            action = int(rng.choice(6, p=[0.5, 0.12, 0.12, 0.12, 0.12, 0.02]))
            one, *rest = plain.step(action)
            other, *expected, info = fast.step(action)
            equal(one, other)
            assert rest[:-1] == expected
            np.testing.assert_array_equal([*plain.position, plain.heading], info["pose"])  # fmt: skip
            ended, steps = rest[1], steps + 1
        outcomes.add(info["outcome"])
    assert (Outcome.COLLIDED if obstacles else Outcome.ARRIVED) in outcomes


def anywhere():
    """Worlds with circles and rectangles, and in each a pose: some beside obstacles and borders, some within them."""
    worlds = random_worlds(600, obstacles=16, seed=5)
    rng = np.random.default_rng(6)
    poses = rng.uniform([0, 0, -np.pi], [worlds.size, worlds.size, np.pi], (600, 3))
    poses[::5, rng.integers(2)] = rng.uniform(0, 3, 120)  # near a border
    beside = worlds.centres[1::5, 0] + rng.uniform(-6, 6, (120, 2))
    poses[1::5, :2] = np.clip(beside, 0, worlds.size)
    return worlds, poses


def test_sensing_anywhere():
    worlds, poses = anywhere()
    expected = sense(worlds, poses)
    assert expected.walls.any(), "no border in range"
    assert (expected.ranges == 0).any(), "no robot in an obstacle"
    env = PlainNavigationEnv()
    for i, (x, y, heading) in enumerate(poses):
        env.enter(worlds[i])
        env.position, env.heading = np.array([x, y]), heading
        observation = env.sense()
        np.testing.assert_allclose(
            observation["ranges"], expected.ranges[i], rtol=0, atol=1.1e-6
        )
        np.testing.assert_array_equal(observation["walls"], expected.walls[i])
        assert observation["target_region"] + 1 == expected.target_region[i]
        assert observation["target_seen"] == expected.target_seen[i]


def test_clearance_anywhere():
    worlds, poses = anywhere()
    ends = poses[:, :2] + np.random.default_rng(7).uniform(-4, 4, (len(poses), 2))
    env, collisions = PlainNavigationEnv(), 0
    for i, (start, end) in enumerate(zip(poses[:, :2], ends, strict=True)):
        env.enter(worlds[i])
        centres = worlds.centres[i]
        expected = swept_clearance(
            worlds.kinds[i], worlds.shapes[i], centres, centres, worlds.size, *start, *end, 50.0
        )  # fmt: skip
        assert abs(env.clearance(start, end) - micrometres(expected)) < 1.1e-6
        collisions += expected < 1
    assert 50 < collisions < 500


def test_the_constants_are_those_of_the_twin():
    for name in ("SENSOR_RANGE", "COLLISION_DISTANCE", "ARRIVAL_DISTANCE", "SECTOR"):
        assert getattr(plain_environment, name) == getattr(constants, name)
    np.testing.assert_array_equal(plain_environment.TURNS, constants.TURNS)
    assert plain_environment.BACK == Action.B
    assert PlainNavigationEnv().direction == Reflex().direction


def test_a_map_by_hand_is_the_one_that_is_made():
    env, other = PlainNavigationEnv(), PlainNavigationEnv()
    made = make_world(
        circles=[(53, 50, 2)], rectangles=[(30, 40, 3, 1, 0)], start=(50, 45)
    )
    circles, rectangles = [(53, 50, 2)], [(30, 40, 1.5, 0.5, 0)]
    pose, target = made.start_poses[0], made.targets[0]
    equal(env.place(pose, target, circles, rectangles), other.enter(made))
    for action in (0, 4, 1, 5):
        equal(env.step(action)[0], other.step(action)[0])


def test_a_way_through_a_thin_wall_is_a_collision():
    env = PlainNavigationEnv()
    env.enter(make_world(rectangles=[(50, 50, 0.5, 30, 0)]))
    assert env.clearance(np.array([48.0, 50.0]), np.array([52.0, 50.0])) == 0.0
    assert env.clearance(np.array([48.0, 50.0]), np.array([48.0, 52.0])) == 1.75


def test_a_robot_that_is_blocked_steps_back():
    env = PlainNavigationEnv()
    walls = [(50 + 2.5 + 1, 50, 2, 30, 0), (50, 52.6, 8, 1, 0), (50, 47.4, 8, 1, 0)]
    env.enter(make_world(rectangles=walls))
    env.position, env.heading = np.array([50.0, 50.0]), 0.0
    env.sense()
    assert env.heading_and_distance(Action.L60) == (0.0, -2.0)


def test_sectors_are_counted_counter_clockwise_from_the_one_ahead():
    bearings = np.radians([0, 19, 21, 59, 61, 179, -179, -61, -21, -19])
    assert sector(bearings).tolist() == [0, 0, 1, 1, 2, 4, 5, 7, 8, 0]
    assert sector(math.radians(30)) == 1


def test_the_border_is_four_rectangles_around_the_map():
    left, right, below, above = border(100.0)
    assert left[0] + left[2] == below[1] + below[3] == 0.0
    assert right[0] - right[2] == above[1] - above[3] == 100.0


def test_checker_has_nothing_to_say():
    check_env(PlainNavigationEnv(), skip_render_check=True)


def test_what_a_reader_does_to_an_observation_changes_nothing():
    env, other = PlainNavigationEnv(20), PlainNavigationEnv(20)
    observation, _ = env.reset(seed=3)
    other.reset(seed=3)
    observation["ranges"] *= 0
    equal(env.step(1)[0], other.step(1)[0])
