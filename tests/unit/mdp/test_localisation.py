"""Localisation on a grid of poses, against sums written out and against the robot's own simulator."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import norm

from robonav import robot
from robonav.mdp import (
    FiniteMDP,
    Localiser,
    PoseGrid,
    RangeSensor,
    entropy,
    pose_transitions,
)

MOVES = [(0.0, 1.0), (np.pi / 6, 1.0), (-np.pi / 6, 1.0), (0.0, -1.0)]
ROOM = PoseGrid(np.ones((6, 8), dtype=bool), cell=0.5, headings=12)


def test_poses_are_numbered_by_row_column_and_heading():
    grid = PoseGrid(np.ones((2, 3), dtype=bool), cell=2.0, headings=4)
    assert grid.n_states == 24
    np.testing.assert_allclose(
        grid.poses[(1 * 3 + 2) * 4 + 3], [5.0, 3.0, 3 * np.pi / 2]
    )


def test_knowing_only_the_map_is_uniform_over_free_cells():
    grid = PoseGrid([[True, False], [True, True]], headings=2)
    np.testing.assert_allclose(grid.uniform(), np.array([1, 1, 0, 0, 1, 1, 1, 1]) / 6)


@settings(deadline=None)
@given(st.floats(0.3, 3.7), st.floats(0.3, 2.7), st.floats(-7, 7))
def test_a_pose_between_grid_poses_is_a_mixture_that_keeps_its_place(x, y, heading):
    weights = ROOM.around([[x, y, heading]]).toarray()[0]
    assert weights.sum() == pytest.approx(1)
    np.testing.assert_allclose(weights @ ROOM.poses[:, :2], [x, y], atol=1e-8)
    mean = weights @ np.exp(1j * ROOM.poses[:, 2])
    assert np.angle(mean / np.exp(1j * heading)) == pytest.approx(0, abs=np.radians(1))
    far = np.hypot(*(ROOM.poses[weights > 0, :2] - [x, y]).T)
    assert far.max() < 0.5 * np.sqrt(2) + 1e-6


def test_a_pose_on_the_grid_is_itself():
    np.testing.assert_allclose(
        ROOM.around(ROOM.poses).toarray(), np.eye(ROOM.n_states), atol=1e-8
    )


def test_no_weight_goes_into_a_wall():
    grid = PoseGrid([[True, False, True]], headings=1)
    np.testing.assert_allclose(grid.around([[0.9, 0.5, 0.0]]).toarray(), [[1, 0, 0]])
    np.testing.assert_allclose(grid.around([[1.5, 0.5, 0.0]]).toarray(), [[0, 0, 0]])


@pytest.mark.parametrize(
    "free", [np.ones((5, 5), dtype=bool), np.random.default_rng(0).random((6, 5)) < 0.7]
)
def test_moves_are_distributions_that_stay_on_free_cells(free):
    grid = PoseGrid(free, headings=12)
    slip = np.full((4, 4), 0.05) + 0.8 * np.eye(4)
    for matrix in pose_transitions(grid, MOVES, slip=slip):
        np.testing.assert_allclose(matrix.sum(axis=1), 1)
        assert matrix[grid.possible][:, ~grid.possible].sum() == 0
    FiniteMDP(
        list(pose_transitions(grid, MOVES)), np.zeros((grid.n_states, 4)), 0.9
    )  # fits an MDP


def test_moves_by_hand():
    grid = PoseGrid(
        np.ones((1, 4), dtype=bool), headings=4
    )  # a corridor; headings east, north, west, south
    forward, turn = (
        m.toarray() for m in pose_transitions(grid, [(0.0, 1.0), (np.pi / 2, 0.0)])
    )
    east = [0, 4, 8, 12]
    for here, there in [
        (0, 4),
        (4, 8),
        (8, 12),
        (12, 12),
    ]:  # the last one is stopped by the wall
        assert forward[here, there] == pytest.approx(1)
    assert forward[east[0] + 1, east[0] + 1] == pytest.approx(1)  # north is a wall
    assert forward[east[2] + 2, east[1] + 2] == pytest.approx(1)  # west goes back
    assert turn[0, 1] == pytest.approx(1)
    assert turn[3, 0] == pytest.approx(1)


def test_slipping_mixes_the_moves():
    plain = pose_transitions(ROOM, MOVES)
    slip = np.eye(4)
    slip[0] = [0.7, 0.2, 0.1, 0.0]
    mixed = pose_transitions(ROOM, MOVES, slip=slip)
    expected = 0.7 * plain[0] + 0.2 * plain[1] + 0.1 * plain[2]
    np.testing.assert_allclose(mixed[0].toarray(), expected.toarray(), atol=1e-12)
    np.testing.assert_allclose(mixed[1].toarray(), plain[1].toarray())


@settings(deadline=None)
@given(st.floats(0, 10), st.floats(0.05, 3), st.floats(0, 1))
def test_the_density_of_a_reading_is_a_density(predicted, deviation, outliers):
    sensor = RangeSensor(deviation, outliers=outliers)
    short = np.linspace(0, 10, 20_001)[:-1]
    density = np.exp(
        sensor.log_likelihood(np.full((len(short), 1), predicted), short[:, None])
    )
    nothing = np.exp(sensor.log_likelihood([predicted], [10.0]))
    below = (1 - outliers) * norm.cdf(
        0, predicted, deviation
    )  # the tail no sensor reads
    assert density.sum() * 10 / 20_000 + nothing + below == pytest.approx(1, abs=2e-3)


def test_sensors_err_independently():
    sensor = RangeSensor()
    parts = [
        sensor.log_likelihood([p], [m])
        for p, m in ((3.0, 3.5), (10.0, 10.0), (6.0, 2.0))
    ]
    assert sensor.log_likelihood([3.0, 10.0, 6.0], [3.5, 10.0, 2.0]) == pytest.approx(
        sum(parts)
    )


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6))
def test_the_update_is_bayes_written_out(seed):
    rng = np.random.default_rng(seed)
    grid = (
        PoseGrid(rng.random((3, 3)) < 0.8, headings=4)
        if seed % 2
        else PoseGrid(np.ones((2, 3), bool), headings=4)
    )
    predicted, measured = rng.uniform(1, 10, (grid.n_states, 9)), rng.uniform(1, 10, 9)
    measured[:3] = predicted[:, :3].max(initial=10.0)
    localiser = Localiser(pose_transitions(grid, MOVES), predicted, RangeSensor(2.0))
    belief = grid.uniform()
    action = int(rng.integers(4))
    matrix = localiser.transitions[action].toarray()
    joint = [
        sum(belief[s] * matrix[s, t] for s in range(grid.n_states))
        * np.exp(localiser.sensor.log_likelihood(predicted[t], measured))
        for t in range(grid.n_states)
    ]
    np.testing.assert_allclose(
        localiser.update(belief, action, measured),
        np.array(joint) / sum(joint),
        atol=1e-9,
    )


def test_readings_that_fit_nowhere_are_an_error_that_says_so():
    grid = PoseGrid([[True, True]], headings=1)
    localiser = Localiser(
        pose_transitions(grid, MOVES),
        np.array([[1.0], [2.0]]),
        RangeSensor(1e-3, outliers=0.0),
    )
    with pytest.raises(ValueError, match="the ranges have probability zero"):
        localiser.correct(np.array([1.0, 0.0]), [9.0])
    with pytest.raises(ValueError, match=r"ranges must have shape \(1,\)"):
        localiser.correct(np.array([1.0, 0.0]), [9.0, 9.0])


SMALL = PoseGrid([[True, True]], headings=1)
STAY = pose_transitions(SMALL, [(0.0, 0.0)])


@pytest.mark.parametrize(
    ("options", "error", "sentence"),
    [
        ({"transitions": STAY[0]}, TypeError, "transitions must be tuple"),
        (
            {"transitions": (np.eye(2),)},
            ValueError,
            r"transitions must be sparse matrices \(2, 2\)",
        ),
        (
            {"transitions": (0.5 * STAY[0],)},
            ValueError,
            "transitions must hold one distribution a row",
        ),
        (
            {"predicted": np.ones((3, 1))},
            ValueError,
            r"matrices \(3, 3\), but that of action 0 is not",
        ),
        ({"predicted": [[1.0], [np.nan]]}, ValueError, "predicted must hold finite"),
        ({"sensor": 0.5}, TypeError, "sensor must be RangeSensor, got float"),
    ],
)
def test_a_localiser_checks_its_parts(options, error, sentence):
    with pytest.raises(error, match=sentence):
        Localiser(**{"transitions": STAY, "predicted": np.ones((2, 1)), **options})


@pytest.mark.parametrize(
    ("belief", "action", "ranges", "sentence"),
    [
        (
            [1.0, 1.0],
            0,
            [1.0],
            "belief must be a distribution over the 2 states, got sum 2",
        ),
        ([1.5, -0.5], 0, [1.0], "got a probability of -0.5"),
        ([1.0], 0, [1.0], r"belief must have shape \(2,\)"),
        ([1.0, 0.0], 1, [1.0], "action must be at most 0, got 1"),
        ([1.0, 0.0], -1, [1.0], "action must be at least 0"),
        ([1.0, 0.0], 0, [np.nan], "ranges must hold finite"),
    ],
)
def test_a_localiser_checks_what_it_is_told(belief, action, ranges, sentence):
    with pytest.raises(ValueError, match=sentence):
        Localiser(STAY, np.ones((2, 1))).update(belief, action, ranges)


def test_a_reading_that_is_no_number_has_no_likelihood():
    with pytest.raises(ValueError, match="measured must hold finite"):
        RangeSensor().log_likelihood([3.0], [np.nan])


def test_a_robot_that_is_stopped_turns_all_the_same():
    """Facing east beside the wall, a quarter turn left with a step leads into the wall: it stays, and faces north."""
    grid = PoseGrid(np.ones((1, 3), dtype=bool), headings=4)
    (left,) = pose_transitions(grid, [(np.pi / 2, 1.0)])
    np.testing.assert_allclose(left.toarray()[4], np.eye(12)[5], atol=1e-12)


@pytest.mark.parametrize(
    "wrong", [{"free": [[False]]}, {"free": [True]}, {"cell": 0.0}, {"headings": 0}]
)
def test_a_grid_checks_its_numbers(wrong):
    with pytest.raises(ValueError, match="must"):
        PoseGrid(**{"free": [[True]], **wrong})


# -- our robot ---------------------------------------------------------------------------------------------------------

HOUSE = robot.make_world(
    rectangles=[
        (20, 12, 24, 1.5, 0),
        (12, 26, 1.5, 16, 0),
        (28, 28, 16, 1.5, 0),
        (31, 20, 1.5, 8, 0),
    ],
    start=(5, 5),
    target=(35, 35),
    size=40.0,
)
DRIVE = [
    (0.0, 2.0),
    *((np.radians(turn), 2.0) for turn in (30, 60, -30, -60)),
    (0.0, -2.0),
]  # F, L30, ..., B
SLIP = robot.neighbour_slip(0.1)


@pytest.fixture(scope="module")
def house():
    """Grid and localiser of a house of 40 m by 40 m, in cells of 1 m."""
    centres = np.stack(
        np.meshgrid(np.arange(40) + 0.5, np.arange(40) + 0.5), axis=-1
    ).reshape(-1, 2)
    clear = robot.clearance(HOUSE[np.zeros(len(centres), int)], centres) >= 0.5
    grid = PoseGrid(clear.reshape(40, 40), headings=24)
    predicted = robot.sense(HOUSE[np.zeros(grid.n_states, int)], grid.poses).ranges
    return grid, Localiser(
        pose_transitions(grid, DRIVE, slip=SLIP), predicted, RangeSensor(0.9)
    )


def drive(grid, localiser, start, steps, seed, sensing=True):
    """Where there is room the robot goes, with half a metre of noise; the share of its belief that is near the truth.

    Near is within 2 m and 31 degrees; also the belief itself.
    """
    simulator = robot.Simulator(
        replace(HOUSE, keys=robot.world_keys(1, seed)), noise=0.5, slip=SLIP
    )
    simulator.poses = np.array([start])
    pose = start
    belief = (
        localiser.correct(grid.uniform(), simulator.sense().ranges[0])
        if sensing
        else grid.uniform()
    )
    for _ in range(steps):
        ranges = simulator.sense().ranges[0]
        room = [
            min(ranges[[0, 1, 8]] + [0, 1, 1]),
            min(ranges[:2] + [1, 0]),
            min(ranges[1:3]),
        ]
        room += [min(ranges[[0, 8]] + [1, 0]), min(ranges[7:9])]
        action = (
            int(np.argmax(np.minimum(room, 6))) if max(room) > 3.2 else robot.Action.B
        )
        simulator.step(np.array([action]))
        if simulator.outcome[0] != 0:
            break
        pose = simulator.poses[0].copy()
        belief = localiser.predict(belief, action)
        if sensing:
            belief = localiser.correct(belief, simulator.sense().ranges[0])
    x, y, heading = pose
    turned = np.angle(np.exp(1j * (grid.poses[:, 2] - heading)))
    near = (np.hypot(grid.poses[:, 0] - x, grid.poses[:, 1] - y) < 2) & (
        abs(turned) < np.radians(31)
    )
    return belief[near].sum(), belief


@pytest.mark.slow
def test_the_robot_finds_out_where_it_stands(house):
    rng = np.random.default_rng(0)
    places = [(*rng.uniform(3, 37, 2), rng.uniform(0, 2 * np.pi)) for _ in range(40)]
    starts = [place for place in places if robot.clearance(HOUSE, [place[:2]])[0] > 3]
    found = [
        drive(*house, start, 10, seed)[0] for seed, start in enumerate(starts[:14])
    ]
    assert len(found) == 14
    assert np.mean(found) > 0.75
    assert np.median(found) > 0.95


def test_without_sensing_it_knows_far_less(house):
    near, belief = drive(*house, (5.0, 5.0, 0.5), 8, 0, sensing=False)
    assert near < 0.1
    assert entropy(belief) > 10
