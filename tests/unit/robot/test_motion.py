"""Motion, collisions, moving obstacles, reflexes, uncertainty."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from robonav.robot import (
    OUTCOMES,
    Action,
    Reflex,
    Sensing,
    Simulator,
    make_world,
    navigate,
    neighbour_slip,
    obstacle_tracks,
    random_worlds,
    sense,
    straight,
)
from robonav.robot._fast import RUNNING, swept_clearance

TURNS = {
    Action.F: 0,
    Action.L30: 30,
    Action.L60: 60,
    Action.R30: -30,
    Action.R60: -60,
    Action.B: 0,
}


def shape_polygon(worlds, m, centre):
    if worlds.kinds[0, m] == 1:
        return shapely.Point(centre).buffer(worlds.shapes[0, m, 0], quad_segs=256)
    a, b, turned = worlds.shapes[0, m]
    box = shapely.box(centre[0] - a, centre[1] - b, centre[0] + a, centre[1] + b)
    return shapely.affinity.rotate(box, turned, origin=tuple(centre), use_radians=True)


@settings(max_examples=100, deadline=None)
@given(
    action=st.sampled_from(list(TURNS)),
    heading=st.floats(-math.pi, math.pi),
    speed=st.floats(0.5, 4),
    x=st.floats(20, 80),
    y=st.floats(20, 80),
)
def test_a_step_turns_then_goes_one_second(action, heading, speed, x, y):
    simulator = Simulator(make_world(), speed)
    simulator.poses[0] = [x, y, heading]
    simulator.step(np.array([action]))
    after = heading + math.radians(TURNS[action])
    length = -speed if action == Action.B else speed
    expected = [x + length * math.cos(after), y + length * math.sin(after)]
    np.testing.assert_allclose(simulator.poses[0, :2], expected, atol=1e-12)
    assert -math.pi <= simulator.poses[0, 2] <= math.pi
    assert math.isclose(math.cos(simulator.poses[0, 2] - after), 1, abs_tol=1e-12)


def test_to_the_target_turns_to_it_first():
    simulator = Simulator(make_world(), 2.0)
    simulator.poses[0] = [50, 20, 1.0]
    simulator.step(np.array([Action.TO_TARGET]))
    before, after = math.hypot(40, 70), math.hypot(*(simulator.poses[0, :2] - [90, 90]))
    assert math.isclose(before - after, 2.0)


@settings(max_examples=200, deadline=None)
@given(
    heading=st.floats(-math.pi, math.pi),
    bearing=st.floats(-math.pi, math.pi),
    speed=st.floats(0.5, 4),
)
def test_to_the_sector_turns_by_whole_sectors_so_that_the_target_lies_ahead(
    heading, bearing, speed
):
    target = 50 + 40 * np.array([math.cos(bearing), math.sin(bearing)])
    simulator = Simulator(make_world(target=tuple(target)), speed)
    simulator.poses[0] = [50, 50, heading]
    region = simulator.sense().target_region[0]
    simulator.step(np.array([Action.TO_SECTOR]))
    x, y, after = simulator.poses[0]
    sectors = math.degrees(after - heading) / 40
    assert math.isclose((sectors - region + 1 + 0.5) % 9, 0.5, abs_tol=1e-9)
    apart = (bearing - after + math.pi) % (2 * math.pi) - math.pi
    assert abs(apart) <= math.radians(20) + 2e-6
    moved = 50 + speed * np.array([math.cos(after), math.sin(after)])
    np.testing.assert_allclose([x, y], moved, atol=1e-12)


def test_a_robot_that_knows_the_sector_goes_straight_on_until_the_target_leaves_it():
    world = make_world(start=(10, 50), target=(90, 60))
    simulator = Simulator(world, 1.0)
    simulator.poses[0, 2] = 0.0  # the target lies 7 degrees to the left
    regions, headings = [], []
    for _ in range(75):
        regions.append(simulator.sense().target_region[0])
        simulator.step(Reflex("sector")(simulator.sense(), 1.0))
        headings.append(math.degrees(simulator.poses[0, 2]))
    turns = np.flatnonzero(np.diff(headings, prepend=0.0))
    np.testing.assert_array_equal(turns, np.flatnonzero(np.array(regions) != 1))
    assert regions[turns[0]] == 2
    assert headings[turns[0]] == pytest.approx(40)
    assert simulator.outcome[0] == RUNNING


def test_clearance_of_a_step_agrees_with_shapely():
    rng = np.random.default_rng(3)
    for i, world in enumerate(random_worlds(400, obstacles=12, seed=12)):
        m = i % 12
        x0, y0 = np.clip(world.centres[0, m] + rng.uniform(-8, 8, 2), 1, 99)
        length, angle = rng.uniform(0, 4), rng.uniform(0, 2 * np.pi)
        x1, y1 = np.clip(
            [x0 + length * np.cos(angle), y0 + length * np.sin(angle)], 1, 99
        )
        line = shapely.LineString([(x0, y0), (x1, y1)])
        expected = shapely.box(0, 0, 100, 100).exterior.distance(line)
        for k in range(12):
            expected = min(
                expected, line.distance(shape_polygon(world, k, world.centres[0, k]))
            )
        got = swept_clearance(
            world.kinds[0],
            world.shapes[0],
            world.centres[0],
            world.centres[0],
            100.0,
            x0,
            y0,
            x1,
            y1,
            np.inf,
        )
        assert (
            abs(got - expected) < 1e-4
        )  # shapely's circle is a polygon of 1024 corners


@pytest.mark.slow
def test_clearance_against_a_moving_obstacle_agrees_with_many_moments():
    rng = np.random.default_rng(4)
    for _ in range(200):
        world = make_world(
            rectangles=[(50, 50, *rng.uniform(3, 8, 2), rng.uniform(0, 180))]
        )
        start, end = 50 + rng.uniform(-6, 6, 2), 50 + rng.uniform(-6, 6, 2)
        drift = rng.uniform(-1, 1, 2)
        got = swept_clearance(
            world.kinds[0],
            world.shapes[0],
            world.centres[0],
            world.centres[0] + drift,
            100.0,
            *start,
            *end,
            np.inf,
        )
        moments = np.linspace(0, 1, 400)
        seen = [
            shape_polygon(world, 0, world.centres[0, 0] + t * drift).distance(
                shapely.Point(start + t * (end - start))
            )
            for t in moments
        ]
        assert got <= min(seen) + 1e-9
        assert got >= min(seen) - 0.05  # the moments lie at most 0.05 m apart


def test_a_fast_step_does_not_jump_a_thin_obstacle():
    world = make_world(
        rectangles=[(12, 50, 0.5, 20, 0)], start=(9, 50), target=(90, 50)
    )
    result = navigate(straight, world, speed=6.0, reflex=None)
    assert result.outcome[0] == "collided"
    assert result.steps[0] == 1


@pytest.mark.parametrize(("gap", "outcome"), [(0.999, "collided"), (1.0, "running")])
def test_collision_is_nearer_than_a_metre(gap, outcome):
    simulator = Simulator(
        make_world(circles=[(50, 50 + 3 + gap, 3)], start=(40, 50)), 2.0
    )
    simulator.poses[0] = [49, 50, 0]
    simulator.step(np.array([Action.F]))
    assert OUTCOMES[simulator.outcome[0]] == outcome


def test_borders_are_walls():
    world = make_world(start=(10, 50), target=(90, 50))
    simulator = Simulator(world, 2.0)
    simulator.poses[0] = [97.5, 50, 0]
    simulator.step(np.array([Action.F]))
    assert OUTCOMES[simulator.outcome[0]] == "collided"


def test_arrival_is_within_three_metres():
    world = make_world(start=(10, 50), target=(90, 50))
    for x, outcome in ((85.0, "arrived"), (84.99, "running")):
        simulator = Simulator(world, 2.0)
        simulator.poses[0] = [x, 50, 0]
        simulator.step(np.array([Action.F]))
        assert OUTCOMES[simulator.outcome[0]] == outcome


def test_after_the_end_a_robot_stands_still():
    simulator = Simulator(make_world(start=(10, 50), target=(90, 50)), 2.0)
    simulator.poses[0] = [86, 50, 0]
    simulator.step(np.array([Action.F]))
    pose = simulator.poses.copy()
    simulator.step(np.array([Action.F]))
    np.testing.assert_array_equal(simulator.poses, pose)
    assert simulator.steps[0] == 1


# Moving obstacles


def test_moving_obstacles_never_leave_and_go_at_their_speed():
    worlds = random_worlds(50, obstacles=3, moving=10, seed=9)
    tracks = obstacle_tracks(worlds, 1000)
    reach = np.where(
        worlds.kinds == 1,
        worlds.shapes[..., 0],
        np.hypot(worlds.shapes[..., 0], worlds.shapes[..., 1]),
    )
    assert (tracks >= reach[:, None, :, None] - 1e-9).all()
    assert (tracks <= 100 - reach[:, None, :, None] + 1e-9).all()
    steps = np.linalg.norm(np.diff(tracks, axis=1), axis=-1)
    assert (steps <= worlds.speeds[:, None] + 1e-9).all()
    assert (steps[..., :3] == 0).all()
    assert (steps.max(axis=1)[:, 3:] > 0.3).all()


def test_moving_obstacles_keep_a_heading_until_they_draw_another():
    worlds = random_worlds(40, obstacles=0, moving=10, seed=14)
    moves = np.diff(obstacle_tracks(worlds, 200), axis=1)
    headings = np.arctan2(moves[..., 1], moves[..., 0])
    turned = np.abs(np.exp(1j * np.diff(headings, axis=1)) - 1) > 1e-6
    assert 0.09 < turned.mean() < 0.14  # a tenth draw a new heading, and some bounce
    kept = np.abs(np.exp(1j * (headings[:, -1] - headings[:, 0])) - 1) < 1e-6
    assert kept.mean() < 0.02


def test_the_simulator_moves_obstacles_as_their_tracks_say_and_resets_them():
    worlds = random_worlds(5, obstacles=2, moving=4, seed=10)
    tracks = obstacle_tracks(worlds, 30)
    first = Simulator(worlds, 2.0)
    for t in range(30):
        running = first.outcome == RUNNING
        np.testing.assert_array_equal(first.centres[running], tracks[running, t])
        first.step(np.full(5, Action.TO_TARGET))
    again = Simulator(worlds, 2.0)
    np.testing.assert_array_equal(again.centres, worlds.centres)
    first.restart(np.arange(5), worlds)
    np.testing.assert_array_equal(first.centres, worlds.centres)
    assert (first.steps == 0).all()


# Reflexes


def sensing(ranges):
    ranges = np.atleast_2d(np.asarray(ranges, dtype=float))
    n = len(ranges)
    return Sensing(ranges, np.zeros((n, 9), bool), np.ones(n, int), np.zeros(n, bool))


def test_reflexes():
    free, near = np.full(9, 10.0), np.full(9, 10.0)
    near[4] = 9.9
    blocked = np.full(9, 10.0)
    blocked[[0, 1, 2, 7, 8]] = 2.9
    nearly = blocked.copy()
    nearly[8] = 3.0
    commands = Reflex("exact")(sensing([free, near, blocked, nearly]), 2.0)
    np.testing.assert_array_equal(commands, [Action.TO_TARGET, -1, Action.B, -1])
    commands = Reflex("sector")(sensing([free, near, blocked, nearly]), 2.0)
    np.testing.assert_array_equal(commands, [Action.TO_SECTOR, -1, Action.B, -1])


def test_an_unknown_direction_is_refused_with_a_sentence():
    with pytest.raises(ValueError, match="direction must be one of exact, sector, got"):
        Reflex("bearing")


def test_without_reflexes_the_policy_decides_every_step():
    calls = []

    def policy(read, rng):
        calls.append(len(read))
        return np.zeros(len(read), dtype=int)

    worlds = random_worlds(3, obstacles=0, seed=0)
    navigate(policy, worlds, reflex=None)
    assert calls[0] == 3
    calls.clear()
    navigate(policy, worlds)
    assert (
        sum(calls) < 5 * 3
    )  # in an empty map it is asked near the target's corner only, if at all


# Uncertainty of motion


def test_slips_come_as_often_as_the_matrix_says():
    n = 6000
    slip = neighbour_slip(0.3)
    simulator = Simulator(random_worlds(n, obstacles=0, seed=3), 2.0, slip=slip)
    simulator.poses[:] = [50, 50, 0]
    simulator.step(np.full(n, Action.F))
    turned = np.round(np.degrees(simulator.poses[:, 2])).astype(int)
    share = {angle: (turned == angle).mean() for angle in (-30, 0, 30)}
    for angle, expected in ((-30, 0.15), (0, 0.7), (30, 0.15)):
        assert abs(share[angle] - expected) < 4 * math.sqrt(
            expected * (1 - expected) / n
        )
    assert sum(share.values()) == 1


def test_backing_never_slips_to_a_neighbour():
    assert neighbour_slip(0.5)[Action.B, Action.B] == 1
    np.testing.assert_allclose(neighbour_slip(0.5).sum(axis=1), 1)


def test_noise_and_slips_do_not_depend_on_the_batch():
    worlds = random_worlds(40, obstacles=10, moving=2, seed=21)
    together = navigate(
        straight, worlds, noise=0.3, slip=neighbour_slip(0.2), record_paths=True
    )
    for i in (0, 17, 39):
        alone = navigate(
            straight, worlds[i], noise=0.3, slip=neighbour_slip(0.2), record_paths=True
        )
        assert alone.outcome[0] == together.outcome[i]
        np.testing.assert_array_equal(alone.paths[0], together.paths[i])


# One of a batch is one alone, whatever the threads


@pytest.mark.parametrize("speed", [2.0, 25.0])
def test_a_second_is_a_step_and_then_a_look(speed):
    worlds = random_worlds(600, obstacles=20, moving=4, seed=8)
    rng = np.random.default_rng(8)
    together, apart = (
        Simulator(worlds, speed=speed, noise=0.2, slip=neighbour_slip(0.2))
        for _ in range(2)
    )
    for _ in range(30):
        actions = rng.integers(0, 6, 600)
        apart.step(actions.copy())
        expected, got = apart.sense(), together.second(actions.copy())
        for name, values in vars(expected).items():
            np.testing.assert_array_equal(getattr(got, name), values)
    for name in ("poses", "centres", "headings", "steps", "outcome"):
        np.testing.assert_array_equal(getattr(together, name), getattr(apart, name))


@pytest.mark.parametrize("speed", [2.0, 25.0])
def test_a_step_collides_where_its_clearance_is_less_than_a_metre(speed):
    worlds = random_worlds(600, obstacles=30, seed=9)
    simulator = Simulator(worlds, speed=speed)
    rng = np.random.default_rng(9)
    collided = 0
    for _ in range(10):
        before, running = simulator.poses.copy(), simulator.outcome == RUNNING
        simulator.step(rng.integers(0, 6, 600))
        for i in np.flatnonzero(running):
            clearance = swept_clearance(
                worlds.kinds[i], worlds.shapes[i], worlds.centres[i], worlds.centres[i], worlds.size,
                *before[i, :2], *simulator.poses[i, :2], 10.0,
            )  # fmt: skip
            hit = OUTCOMES[simulator.outcome[i]] == "collided"
            assert hit == (round(clearance, 6) < 1.0)
            collided += hit
    assert collided > 50


def test_batch_of_one_is_single_bit_for_bit():
    n = 1500  # enough for the work to be shared among threads
    worlds = random_worlds(n, obstacles=12, moving=4, seed=77)
    together = navigate(straight, worlds, record_paths=True)
    for i in range(0, n, 50):
        alone = navigate(straight, worlds[i], record_paths=True)
        np.testing.assert_array_equal(alone.paths[0], together.paths[i])
        assert alone.outcome[0] == together.outcome[i]
    read = sense(worlds, worlds.start_poses + [3, 2, 0.5])
    for i in range(0, n, 50):
        one = sense(worlds[i], worlds.start_poses[i : i + 1] + [3, 2, 0.5])
        np.testing.assert_array_equal(one.ranges[0], read.ranges[i])
        np.testing.assert_array_equal(one.walls[0], read.walls[i])


def test_same_seed_same_run_other_seed_other_run():
    def dice(read, rng):
        return rng.integers(5, size=len(read))

    worlds = random_worlds(30, obstacles=15, seed=1)
    first, again, other = (
        navigate(dice, worlds, seed=s, record_paths=True) for s in (5, 5, 6)
    )
    for a, b in zip(first.paths, again.paths, strict=True):
        np.testing.assert_array_equal(a, b)
    assert any(
        a.shape != b.shape or (a != b).any()
        for a, b in zip(first.paths, other.paths, strict=True)
    )


# Bad input


@pytest.mark.parametrize(
    ("settings", "error", "message"),
    [
        ({"speed": 0}, ValueError, "speed must be greater than 0"),
        ({"speed": float("nan")}, ValueError, "speed must be finite"),
        ({"speed": "fast"}, TypeError, "speed must be a number"),
        ({"max_steps": 0}, ValueError, "max_steps must be at least 1"),
        ({"noise": -1}, ValueError, "noise must be at least 0"),
        ({"slip": np.ones((6, 6))}, ValueError, "slip must have rows of probabilities"),
        ({"slip": np.eye(5)}, ValueError, r"slip must have shape \(6, 6\)"),
    ],
)
def test_bad_settings_are_refused_with_a_sentence(settings, error, message):
    with pytest.raises(error, match=message):
        navigate(straight, make_world(), **settings)


@pytest.mark.parametrize(
    ("policy", "error", "message"),
    [
        (
            lambda read, rng: np.full(len(read), 7),
            ValueError,
            "action must be one of F, L30",
        ),
        (
            lambda read, rng: np.zeros(len(read)),
            TypeError,
            "action must be whole numbers",
        ),
        (
            lambda read, rng: np.zeros(len(read) + 1, int),
            ValueError,
            r"action must have shape \(1,\)",
        ),
        ("straight", TypeError, "policy must be callable"),
    ],
)
def test_bad_policies_are_refused_with_a_sentence(policy, error, message):
    with pytest.raises(error, match=message):
        navigate(policy, make_world(circles=[(50, 50, 3)]))


@pytest.mark.parametrize(
    "commands",
    [
        np.array([99, 99]),
        np.array([-7, 0]),
        np.array([0]),
        np.array([0.0, 0.0]),
        [0, 0],
    ],
)
def test_the_simulator_refuses_commands_it_does_not_know(commands):
    with pytest.raises(
        ValueError, match="commands must be an array of 2 whole numbers 0 to 7"
    ):
        Simulator(random_worlds(2, seed=0)).step(commands)


def test_a_simulator_that_restarts_leaves_the_worlds_it_was_given():
    worlds = random_worlds(3, 5, seed=0)
    before = worlds.digest()
    Simulator(worlds).restart(np.arange(2), random_worlds(2, 5, seed=1))
    assert worlds.digest() == before


@pytest.mark.parametrize("dtype", [np.int32, np.uint8, np.int8, np.uint64])
def test_the_simulator_takes_whole_numbers_of_any_type(dtype):
    worlds = random_worlds(3, 5, seed=2)
    ours, theirs = Simulator(worlds), Simulator(worlds)
    executed = ours.step(np.array([0, 2, 5]))
    assert np.array_equal(theirs.step(np.array([0, 2, 5], dtype=dtype)), executed)
    assert np.array_equal(theirs.poses, ours.poses)
