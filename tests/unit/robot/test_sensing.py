"""What the sensors read, against shapely and against properties that hold in any world."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from robonav.robot import SENSOR_RANGE, Simulator, make_world, random_worlds, sense
from robonav.robot._fast import CIRCLE, SECTOR, SENSORS
from robonav.robot._fast.sensing import sector_of, within

SEGMENTS = (
    512  # a quarter circle; inscribed and circumscribed polygons bound the true circle
)
MICROMETRE = 1.0e-6


def sector_polygons(pose):
    """Nine triangles, long enough to leave any map: the sectors."""
    x, y, heading = pose
    corner = (
        np.arange(SENSORS)[:, None] * SECTOR + heading + np.array([-0.5, 0.5]) * SECTOR
    )
    far = np.stack([x + 400 * np.cos(corner), y + 400 * np.sin(corner)], axis=-1)
    apex = np.broadcast_to([x, y], (SENSORS, 1, 2))
    return shapely.polygons(np.concatenate([apex, far, apex], axis=1))


def obstacle_polygons(worlds, scale, near=(50, 50)):
    """Obstacles of one world near a point; circles become polygons with vertices at ``scale`` times the radius."""
    polygons = []
    for kind, (x, y), (a, b, turned) in zip(
        worlds.kinds[0], worlds.centres[0], worlds.shapes[0], strict=True
    ):
        if math.dist((x, y), near) > SENSOR_RANGE + 16:
            continue
        if kind == CIRCLE:
            angles = np.linspace(0, 2 * np.pi, 4 * SEGMENTS, endpoint=False)
            points = np.stack([np.cos(angles), np.sin(angles)], axis=1) * a * scale
        else:
            c, s = math.cos(turned), math.sin(turned)
            points = np.array([[a, b], [-a, b], [-a, -b], [a, -b]]) @ np.array(
                [[c, s], [-s, c]]
            )
        polygons.append(shapely.polygons(points + [x, y]))
    return polygons


def least_distances(pose, sectors, things):
    """Least distance (9,) to any of the things inside each sector, by shapely; infinite for none."""
    here = shapely.points(pose[0], pose[1])
    met = shapely.intersection(
        sectors[:, None], np.array(things, dtype=object)[None, :]
    )
    distance = shapely.distance(here, met)
    return np.nan_to_num(distance, nan=np.inf).min(axis=1, initial=np.inf)


@pytest.mark.slow
def test_ranges_and_walls_agree_with_shapely_in_hundreds_of_worlds():
    n = 500
    worlds = random_worlds(n, obstacles=12, seed=101)
    rng = np.random.default_rng(7)
    poses = np.column_stack(
        [rng.uniform(0.5, 99.5, (n, 2)), rng.uniform(-np.pi, np.pi, n)]
    )
    near = rng.integers(
        12, size=n
    )  # half of them close to an obstacle, where there is something to see
    beside = worlds.centres[np.arange(n), near] + rng.uniform(-9, 9, (n, 2))
    poses[::2, :2] = np.clip(beside[::2], 0.5, 99.5)
    read = sense(worlds, poses)
    border = shapely.box(0, 0, 100, 100).exterior
    outward = 1 / math.cos(math.pi / (4 * SEGMENTS))
    for i in range(n):
        sectors = sector_polygons(poses[i])
        wall = least_distances(poses[i], sectors, [border])
        shortest = least_distances(
            poses[i], sectors, obstacle_polygons(worlds[i], outward, poses[i, :2])
        )
        longest = least_distances(
            poses[i], sectors, obstacle_polygons(worlds[i], 1.0, poses[i, :2])
        )
        low = np.minimum(np.minimum(shortest, wall), SENSOR_RANGE)
        high = np.minimum(np.minimum(longest, wall), SENSOR_RANGE)
        assert (read.ranges[i] >= low - MICROMETRE).all(), (
            i,
            poses[i],
            read.ranges[i],
            low,
        )
        assert (read.ranges[i] <= high + MICROMETRE).all(), (
            i,
            poses[i],
            read.ranges[i],
            high,
        )
        surely = (wall < shortest - MICROMETRE) & (wall < SENSOR_RANGE - MICROMETRE)
        surely_not = (wall > longest + MICROMETRE) | (wall > SENSOR_RANGE + MICROMETRE)
        assert read.walls[i][surely].all()
        assert not read.walls[i][surely_not].any()


def test_rectangles_agree_with_shapely_exactly():
    rng = np.random.default_rng(8)
    for _ in range(300):
        a, b = rng.uniform(1, 8, 2)
        world = make_world(rectangles=[(50, 50, a, b, rng.uniform(0, 360))])
        bearing, distance = rng.uniform(0, 2 * np.pi), rng.uniform(0, 16)
        pose = [
            50 + distance * np.cos(bearing),
            50 + distance * np.sin(bearing),
            rng.uniform(-np.pi, np.pi),
        ]
        expected = np.minimum(
            least_distances(pose, sector_polygons(pose), obstacle_polygons(world, 1.0)),
            SENSOR_RANGE,
        )
        np.testing.assert_allclose(
            sense(world, [pose]).ranges[0], expected, rtol=0, atol=MICROMETRE
        )


def test_sensor_one_looks_ahead_and_numbers_go_counter_clockwise():
    for sensor in range(SENSORS):
        angle = sensor * SECTOR
        world = make_world(
            circles=[(50 + 6 * math.cos(angle), 50 + 6 * math.sin(angle), 1.5)]
        )
        ranges = sense(world, [[50, 50, 0]]).ranges[0]
        assert ranges[sensor] == 4.5
        assert ranges.argmin() == sensor


def test_a_circle_across_two_sectors_is_seen_by_both():
    world = make_world(
        circles=[(50 + 5 * math.cos(SECTOR / 2), 50 + 5 * math.sin(SECTOR / 2), 1.0)]
    )
    ranges = sense(world, [[50, 50, 0]]).ranges[0]
    np.testing.assert_array_equal(ranges, [4, 4, *[SENSOR_RANGE] * 7])


def test_inside_an_obstacle_every_range_is_zero():
    world = make_world(circles=[(40, 40, 3)], rectangles=[(60, 60, 4, 6, 30)])
    assert (sense(world, [[41, 41, 0.3]]).ranges == 0).all()
    assert (sense(world, [[60.5, 61, 0.3]]).ranges == 0).all()


def test_exactly_at_range_is_out_of_range():
    read = sense(
        make_world(), [[10, 10, np.pi / 4]]
    )  # every start lies exactly 10 m from two borders
    assert (read.ranges == SENSOR_RANGE).all()
    assert read.safe.all()
    assert not read.walls.any()


def test_target_region_and_seen():
    world = make_world(target=(60, 50))
    degrees = np.array([0, 19, 21, 59, 61, 179, -179, -61, -21, -19])
    read = [sense(world, [[40, 50, -math.radians(d)]]) for d in degrees]
    assert [int(r.target_region[0]) for r in read] == [1, 1, 2, 2, 3, 5, 6, 8, 9, 1]
    assert not any(r.target_seen[0] for r in read)
    assert sense(world, [[50, 50, 0]]).target_seen[0]
    assert not sense(world, [[49.9, 50, 0]]).target_seen[0]


@settings(max_examples=200, deadline=None)
@given(
    turn=st.floats(-math.pi, math.pi),
    seed=st.integers(0, 2**32),
    heading=st.floats(-math.pi, math.pi),
)
def test_turning_the_whole_world_changes_nothing(turn, seed, heading):
    """A world turned about its middle, with the robot in it, looks the same (obstacles only: the map is a square)."""
    rng = np.random.default_rng(seed)
    c, s = math.cos(turn), math.sin(turn)

    def turned(x, y):
        return 50 + c * (x - 50) - s * (y - 50), 50 + s * (x - 50) + c * (y - 50)

    x, y = 50 + rng.uniform(-8, 8, 2)
    circles = [(*(50 + rng.uniform(-14, 14, 2)), rng.uniform(1, 3)) for _ in range(3)]
    boxes = [
        (*(50 + rng.uniform(-14, 14, 2)), *rng.uniform(2, 6, 2), rng.uniform(0, 180))
        for _ in range(3)
    ]
    target = tuple(50 + rng.uniform(-20, 20, 2))
    ends = {"start": (5, 5), "target": target}
    try:
        world = make_world(circles, boxes, **ends)
    except ValueError:
        return  # the target stands in an obstacle
    after = make_world(
        [(*turned(px, py), r) for px, py, r in circles],
        [
            (*turned(px, py), a, b, angle + math.degrees(turn))
            for px, py, a, b, angle in boxes
        ],
        start=(5, 5),
        target=turned(*target),
    )
    first, second = (
        sense(world, [[x, y, heading]]),
        sense(after, [[*turned(x, y), heading + turn]]),
    )
    np.testing.assert_allclose(first.ranges, second.ranges, rtol=0, atol=2 * MICROMETRE)
    bearing = math.atan2(target[1] - y, target[0] - x) - heading
    if abs((bearing / SECTOR + 0.5) % 1) > 1e-6:  # not on the ray between two sectors
        assert first.target_region == second.target_region


@settings(max_examples=100, deadline=None)
@given(seed=st.integers(0, 2**32), sector=st.integers(0, 8))
def test_turning_the_robot_by_a_sector_shifts_the_ranges(seed, sector):
    rng = np.random.default_rng(seed)
    worlds = random_worlds(1, obstacles=15, seed=seed)
    pose = np.array([*rng.uniform(1, 99, 2), rng.uniform(-3, 3)])
    before, after = (
        sense(worlds, [pose]),
        sense(worlds, [pose + [0, 0, sector * SECTOR]]),
    )
    np.testing.assert_allclose(
        np.roll(before.ranges, -sector, axis=1),
        after.ranges,
        rtol=0,
        atol=2 * MICROMETRE,
    )


def test_noise_is_centred_bounded_and_only_where_something_is_seen():
    n = 4000
    worlds = random_worlds(n, obstacles=0, seed=5)
    simulator = Simulator(worlds, noise=0.5)
    simulator.poses[:] = [5, 50, 0]  # the wall is 5 m behind
    clean, noisy = sense(worlds, simulator.poses).ranges, simulator.sense().ranges
    seen = clean < SENSOR_RANGE
    assert seen.any()
    assert not seen.all()
    assert (noisy[~seen] == SENSOR_RANGE).all()
    assert noisy.min() >= 0
    assert noisy.max() <= SENSOR_RANGE
    straight_back = (noisy - clean)[:, 4]
    assert abs(straight_back.mean()) < 4 * 0.5 / math.sqrt(n)
    assert abs(straight_back.std() / 0.5 - 1) < 0.05
    np.testing.assert_array_equal(
        noisy, simulator.sense().ranges
    )  # the same step reads the same


@pytest.mark.parametrize(
    ("poses", "message"),
    [
        ([[np.nan, 5, 0]], "poses must hold finite numbers"),
        ([[5, 5]], "poses must have shape"),
        ([[-1, 5, 0]], "poses must lie in the map"),
    ],
)
def test_bad_poses_are_refused_with_a_sentence(poses, message):
    with pytest.raises(ValueError, match=message):
        sense(make_world(), poses)


@pytest.mark.slow
def test_circles_agree_with_shapely_to_the_micrometre():
    """A polygon of 131,072 corners lies within 2 nanometres of its circle."""
    rng = np.random.default_rng(9)
    corner = np.linspace(0, 2 * np.pi, 131_072, endpoint=False)
    unit = np.stack([np.cos(corner), np.sin(corner)], axis=1)
    for _ in range(20):
        radius, bearing, distance = (
            rng.uniform(1.5, 4),
            rng.uniform(0, 2 * np.pi),
            rng.uniform(4.5, 13),
        )
        pose = [
            50 + distance * np.cos(bearing),
            50 + distance * np.sin(bearing),
            rng.uniform(-np.pi, np.pi),
        ]
        ranges = sense(make_world(circles=[(50, 50, radius)]), [pose]).ranges[0]
        circle = shapely.polygons(unit * radius + [50, 50])
        expected = np.minimum(
            least_distances(pose, sector_polygons(pose), [circle]), SENSOR_RANGE
        )
        grazing = np.abs(ranges - expected) > MICROMETRE
        if grazing.any():  # a ray that all but misses: the polygon's corner decides
            wider = shapely.polygons(unit * radius * (1 + 1e-9) + [50, 50])
            bound = np.minimum(
                least_distances(pose, sector_polygons(pose), [wider]), SENSOR_RANGE
            )
            assert (bound[grazing] - MICROMETRE <= ranges[grazing]).all()
            assert (ranges[grazing] <= expected[grazing] + MICROMETRE).all()


def test_a_sector_by_cross_products_is_that_of_the_angle():
    angles = np.random.default_rng(0).uniform(-np.pi, np.pi, 20_000)
    rays = (np.arange(9) + 0.5) * SECTOR
    near_rays = (rays[:, None] + np.array([-1e-3, -2e-9, 2e-9, 1e-3])).ravel()
    for angle in [*angles, *near_rays]:
        x, y = 7.0 * math.cos(angle), 7.0 * math.sin(angle)
        expected = math.floor(math.atan2(y, x) / SECTOR + 0.5) % SENSORS
        assert sector_of(x, y, 1e-10) == expected


def test_the_sector_of_a_point_on_a_ray_is_left_to_its_angle():
    for ray in (np.arange(9) + 0.5) * SECTOR:
        for angle in (ray - 1e-8, ray, ray + 1e-8):
            assert sector_of(5.0 * math.cos(angle), 5.0 * math.sin(angle), 1e-7) == -1


def test_within_decides_to_the_micrometre():
    for bearing in np.linspace(-3, 3, 50):
        dx, dy = math.cos(bearing), math.sin(bearing)
        for beyond, expected in (
            (-1.0, True),
            (4e-7, True),
            (6e-7, False),
            (1.0, False),
        ):
            assert within(10.0, (10.0 + beyond) * dx, (10.0 + beyond) * dy) == expected
