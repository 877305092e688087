"""A robot with a body: it goes where the simulator says, and its range finders read what the simulator's sectors do."""

import time

import mujoco
import numpy as np
import pytest

from robonav.body import (
    Body,
    BodySimulator,
    build,
    follow,
    limited_reference,
    model_file,
    odometry,
    reference,
    wheel_speeds,
)
from robonav.body.control import ARM, BASE, WHEEL_ANGLES, WHEEL_RADIUS
from robonav.planners import Bug
from robonav.robot import (
    Action,
    Outcome,
    Reflex,
    Simulator,
    concatenate_worlds,
    make_world,
    navigate_in,
    obstacle_tracks,
    random_worlds,
    sense,
)

FIELD = make_world(start=(10, 10), target=(10, 90))


def both(actions, worlds=FIELD, speed=2.0, body=None):
    """A robot with a body and a robot of section 2.5 after the same actions."""
    pair = BodySimulator(worlds, speed, body=body), Simulator(worlds, speed)
    for action in actions:
        for simulator in pair:
            simulator.step(np.full(len(worlds), action))
    return pair


def test_straight_on_it_goes_where_the_simulator_says_to_five_centimetres():
    for speed, seconds in ((1.0, 20), (2.0, 10), (2.0, 20)):
        body, simulator = both([Action.F] * seconds, speed=speed)
        far = np.hypot(*(body.poses - simulator.poses)[0, :2])
        assert far < 0.05, (speed, seconds, far)
        assert abs(body.poses[0, 2] - simulator.poses[0, 2]) < 0.005


@pytest.mark.parametrize("action", [Action.L30, Action.L60, Action.R30, Action.R60])
def test_after_a_turn_it_looks_and_goes_where_the_simulator_does(action):
    middle = make_world(start=(50, 50), target=(50, 90))
    actions = [Action.F] * 4 + [action] + [Action.F] * 4
    body, simulator = both(actions, middle)
    gap = (body.poses - simulator.poses)[0]
    assert np.hypot(*gap[:2]) < 0.5
    assert abs(gap[2]) < 0.06


def test_it_needs_time_to_go_back_which_the_simulator_does_not():
    body, simulator = both([Action.F] * 4 + [Action.B])
    assert body.poses[0, 1] > simulator.poses[0, 1] + 0.5
    body, simulator = both([Action.B] * 4, make_world(start=(50, 50), target=(50, 90)))
    assert abs(body.poses[0, 1] - simulator.poses[0, 1]) < 0.1


def test_less_friction_less_torque_and_more_delay_leave_it_farther_behind():
    behind = {}
    bodies = {"usual": Body(), "wet": Body(friction=0.2), "weak": Body(torque=5.0), "late": Body(delay=6)}  # fmt: skip
    for name, body in bodies.items():
        made, simulator = both([Action.F] * 2, body=body)
        behind[name] = float((simulator.poses - made.poses)[0, 1])
    assert min(behind["wet"], behind["weak"], behind["late"]) > behind["usual"] + 0.15


def test_on_a_wet_floor_odometry_believes_in_ways_that_were_not_driven():
    wrong = []
    for friction in (0.9, 0.2):
        body, _ = both([Action.F, Action.L60, Action.R60] * 2, body=Body(friction))
        wrong.append(np.hypot(*(body.estimates - body.poses)[0, :2]))
    assert wrong[0] < 0.1
    assert wrong[1] > 3 * wrong[0]


@pytest.fixture(scope="module")
def thousand_poses():
    """What both read in 1,000 places of 50 worlds, clear of obstacles, near borders and in the middle."""
    rng, worlds = np.random.default_rng(5), random_worlds(50, obstacles=20, seed=6)
    readings = []
    simulator = BodySimulator(worlds)
    for _ in range(20):
        poses = np.column_stack([rng.uniform(1, 99, (50, 2)), rng.uniform(-3, 3, 50)])
        simulator.poses[:] = poses
        readings.append((simulator.sense(), sense(worlds, poses)))
    return readings


def test_range_finders_read_the_sectors_of_the_simulator_in_a_thousand_poses(
    thousand_poses,
):
    found = np.concatenate([body.ranges for body, _ in thousand_poses])
    wanted = np.concatenate([sectors.ranges for _, sectors in thousand_poses])
    outside = wanted.min(axis=1) > 0  # a robot within an obstacle has collided
    assert outside.sum() > 800
    error = (found - wanted)[outside]
    assert error.min() > -1e-6  # no ray is shorter than the least distance
    assert np.quantile(error, 0.99) < 0.05
    assert np.median(error[wanted[outside] < 10]) < 0.001
    assert error.max() < 0.15  # the rays are a degree apart


def test_range_finders_tell_borders_from_obstacles_and_directions_are_exact(
    thousand_poses,
):
    for body, sectors in thousand_poses:
        near = sectors.ranges > 0
        assert (body.walls == sectors.walls)[near].mean() > 0.99
        np.testing.assert_array_equal(body.target_region, sectors.target_region)
        np.testing.assert_array_equal(body.target_seen, sectors.target_seen)


def test_noise_moves_what_is_seen_and_nothing_else():
    worlds = random_worlds(30, obstacles=20, seed=8)
    worlds = concatenate_worlds([worlds, worlds])
    quiet, noisy = BodySimulator(worlds), BodySimulator(worlds, body=Body(noise=0.3))
    for simulator in (quiet, noisy):
        simulator.poses[:, :2] = 40.0
    first, second = quiet.sense().ranges, noisy.sense().ranges
    seen = first < 10
    assert ((second == first) == ~seen).all()
    assert 0.2 < (second - first)[seen & (first > 1) & (first < 9)].std() < 0.4
    np.testing.assert_array_equal(second[:30], second[30:])


def test_moving_obstacles_move_as_in_the_simulator_and_the_range_finders_see_them():
    worlds = random_worlds(3, obstacles=3, moving=5, seed=9)
    simulator = BodySimulator(worlds)
    tracks = obstacle_tracks(worlds, 4)
    for k in range(1, 5):
        simulator.step(np.zeros(3, dtype=np.int64))
        np.testing.assert_array_equal(simulator.centres, tracks[:, k])
    simulator.poses[:, :2] = simulator.centres[:, 4] + [5.0, 0.0]
    now = worlds[:]
    now.centres[:] = simulator.centres
    error = simulator.sense().ranges - sense(now, simulator.poses).ranges
    assert np.abs(error).max() < 0.2


def test_an_episode_ends_as_in_the_simulator():
    wall = make_world(circles=[(50, 60, 3)], start=(50, 50), target=(50, 90))
    near = make_world(start=(50, 50), target=(50, 57))
    simulator = BodySimulator(
        concatenate_worlds([wall, near.with_slots(1)]), max_steps=9
    )
    while (simulator.outcome == Outcome.RUNNING).any():
        simulator.step(np.zeros(2, dtype=np.int64))
    assert simulator.outcome.tolist() == [Outcome.COLLIDED, Outcome.ARRIVED]
    still = simulator.poses.copy()
    simulator.step(np.zeros(2, dtype=np.int64))
    np.testing.assert_array_equal(simulator.poses, still)
    alone = BodySimulator(FIELD, max_steps=2)
    for _ in range(2):
        alone.step(np.array([0]))
    assert alone.outcome == [Outcome.OUT_OF_STEPS]


def test_a_robot_begins_anew_in_another_world():
    first, second = (random_worlds(1, obstacles=5, seed=seed) for seed in (12, 13))
    again, fresh = BodySimulator(first), BodySimulator(second)
    again.step(np.array([1]))
    again.restart(np.array([0]), second)
    np.testing.assert_array_equal(again.sense().ranges, fresh.sense().ranges)
    for simulator in (again, fresh):
        simulator.step(np.array([2]))
    np.testing.assert_array_equal(again.poses, fresh.poses)


def test_a_robot_alone_drives_as_among_others():
    worlds = random_worlds(4, obstacles=10, seed=10)
    actions = np.array([0, 1, 2, 5])
    together, alone = BodySimulator(worlds), BodySimulator(worlds[[2]])
    for _ in range(3):
        together.step(actions)
        alone.step(actions[[2]])
    np.testing.assert_array_equal(together.poses[[2]], alone.poses)


@pytest.mark.slow
def test_a_planner_with_a_memory_arrives_with_a_body():
    simulator = BodySimulator(random_worlds(4, obstacles=5, seed=11), max_steps=120)
    ends = navigate_in(Bug(), simulator, True, reflex=Reflex("exact"))
    assert ends.success.sum() >= 3
    assert len(ends.paths[0]) == ends.steps[0] + 1


def test_bodies_may_differ():
    worlds = random_worlds(2, obstacles=0, seed=1)
    simulator = BodySimulator(worlds, body=[Body(), Body(friction=0.2)])
    for _ in range(3):
        simulator.step(np.zeros(2, dtype=np.int64))
    driven = np.hypot(*(simulator.poses - worlds.start_poses)[:, :2].T)
    assert driven[0] > driven[1] + 0.2
    with pytest.raises(ValueError, match="body must be one Body or 2 of them, got 3"):
        BodySimulator(worlds, body=[Body()] * 3)


def test_the_control_knows_the_wheels_of_the_model():
    model = mujoco.MjModel.from_xml_string(model_file())
    for k, angle in enumerate(WHEEL_ANGLES):
        wheel = model.body(f"wheel{k + 1}")
        hub = ARM * np.array([np.cos(angle), np.sin(angle)])
        np.testing.assert_allclose(wheel.pos[:2], hub, atol=1e-3)
        assert model.geom(f"wheel{k + 1}").size[0] == WHEEL_RADIUS
    np.testing.assert_allclose(model.pair_friction[:, 1], Body().friction)
    assert model.actuator_forcerange[0, 1] == Body().torque


def test_a_model_has_the_friction_and_the_torque_of_its_body():
    model = build(FIELD, Body(friction=0.4, torque=7.0))
    np.testing.assert_array_equal(model.pair_friction[:, 1], [0.4] * 3)
    np.testing.assert_array_equal(model.actuator_forcerange, [[-7.0, 7.0]] * 3)


def test_odometry_undoes_the_wheels():
    rng = np.random.default_rng(3)
    for velocity in rng.normal(size=(20, 3)):
        np.testing.assert_allclose(BASE @ wheel_speeds(velocity), velocity)
    there = np.zeros(3)
    for _ in range(1000):  # a circle with a radius of 2 m
        there = odometry(there, wheel_speeds(np.array([2.0, 0.0, 1.0]) * 2 * np.pi / 1000))  # fmt: skip
    np.testing.assert_allclose(there, [0, 0, 2 * np.pi], atol=1e-6)


def test_the_reference_ends_where_the_simulator_puts_its_robot():
    start = np.array([50.0, 50.0, 0.7])
    world = make_world(start=(50, 50), target=(50, 90))
    for action, turn in ((Action.F, 0), (Action.L60, 60), (Action.R30, -30)):
        simulator = Simulator(world)
        simulator.poses[:] = start
        simulator.step(np.array([action]))
        pose, _ = reference(start, np.radians(turn), 2.0, 1.0)
        np.testing.assert_allclose(pose, simulator.poses[0])


def test_the_velocity_of_the_reference_is_its_slope():
    start, h = np.array([1.0, 2.0, 0.3]), 1e-6
    for t in (0.1, 0.5, 0.79, 0.9):
        before, after = (reference(start, -1.0, 2.0, t + d)[0] for d in (-h, h))
        velocity = reference(start, -1.0, 2.0, t)[1]
        np.testing.assert_allclose((after - before) / (2 * h), velocity, atol=1e-6)


def test_who_is_where_the_reference_is_goes_as_fast_as_it():
    pose, velocity = np.array([1.0, 2.0, np.pi / 2]), np.array([0.0, 2.0, 0.0])
    np.testing.assert_allclose(follow(pose, pose, velocity, 3.0), [2, 0, 0], atol=1e-12)
    far = follow(np.zeros(3), np.array([9.0, 9.0, 0.0]), np.zeros(3), 3.0)
    assert np.hypot(far[0], far[1]) == pytest.approx(3.0)
    turned = follow(np.zeros(3), np.array([0, 0, 2 * np.pi + 0.1]), np.zeros(3), 3.0)
    assert 0 < turned[2] < 1  # the short way round


def test_the_reference_stays_near_the_base():
    kept = limited_reference(np.array([5.0, 0.0, 1.0]), np.array([4.8, 0.1, 0.9]))
    np.testing.assert_array_equal(kept, [5.0, 0.0, 0.9])
    assert np.hypot(*limited_reference(np.array([5.0, 5.0, 0.0]), np.zeros(3))[:2]) == (
        pytest.approx(0.6)
    )


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"friction": 0.0}, "friction must be greater than 0"),
        ({"torque": -1.0}, "torque must be greater than 0"),
        ({"delay": -1}, "delay must be at least 0"),
        ({"noise": -0.1}, "noise must be at least 0"),
    ],
)
def test_a_wrong_body_gets_one_clear_sentence(settings, message):
    with pytest.raises(ValueError, match=message):
        Body(**settings)


def test_a_core_drives_twenty_times_as_fast_as_real_time():
    simulator = BodySimulator(random_worlds(2, obstacles=20, seed=14))
    before = time.process_time()
    for _ in range(10):
        simulator.sense()
        simulator.step(np.zeros(2, dtype=np.int64))
    assert simulator.steps.sum() > 20 * (time.process_time() - before)
