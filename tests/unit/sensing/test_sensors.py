"""Rings of sectors and pictures: against the simulator, the readable functions, and an independent geometry."""

from __future__ import annotations

import numpy as np
import pytest
from shapely import Point, Polygon, affinity, box

from robonav.robot import Simulator, make_world, navigate, random_worlds, straight
from robonav.sensing import Picture, Ring, picture_around, sector_ranges, shapes_of

RINGS = [9, 18, 36, 72, 7]
EVERYONE = np.arange(40)


def somewhere(seed, n=40, **uncertainty):
    """Robots at random places and headings of random maps, some of them near a border."""
    simulator = Simulator(random_worlds(n, 20, 5, seed=seed), **uncertainty)
    rng = np.random.default_rng(seed)
    simulator.poses[:, :2] = rng.uniform(0.5, 99.5, (n, 2))
    simulator.poses[:, 2] = rng.uniform(-np.pi, np.pi, n)
    return simulator


@pytest.mark.parametrize("noise", [0.0, 0.5])
def test_nine_sectors_are_those_of_the_simulator(noise):
    simulator = Simulator(random_worlds(40, 20, 5, seed=1), noise=noise)
    for _ in range(8):
        simulator.step(np.zeros(40, dtype=np.int64))
        found = Ring(9).ranges(simulator, EVERYONE)
        np.testing.assert_array_equal(found, simulator.sense().ranges)
        assert (found < 10).any()


@pytest.mark.parametrize("sectors", RINGS)
def test_ring_as_the_readable_function(sectors):
    simulator = somewhere(seed=2)
    found = Ring(sectors).ranges(simulator, EVERYONE)
    for robot in EVERYONE:
        expected = sector_ranges(*shapes_of(simulator, robot), simulator.poses[robot], sectors)  # fmt: skip
        np.testing.assert_allclose(found[robot], expected, atol=1.1e-6)


def as_polygons(circles, rectangles):
    """The shapes as shapely knows them; a circle has a polygon of 4096 corners."""
    for x, y, radius in circles:
        yield Point(x, y).buffer(radius, quad_segs=1024)
    for x, y, half_length, half_width, angle in rectangles:
        upright = box(x - half_length, y - half_width, x + half_length, y + half_width)
        yield affinity.rotate(upright, angle, use_radians=True)


@pytest.mark.parametrize("sectors", [18, 36, 72])
def test_ring_against_shapely(sectors):
    simulator = somewhere(seed=3, n=6)
    found = Ring(sectors).ranges(simulator, np.arange(6))
    for robot in range(6):
        shapes = list(as_polygons(*shapes_of(simulator, robot)))
        x, y, heading = simulator.poses[robot]
        for k in range(sectors):
            middle, half = heading + 2 * np.pi * k / sectors, np.pi / sectors
            ends = [middle - half, middle + half]
            corners = [(x + 11 * np.cos(a), y + 11 * np.sin(a)) for a in ends]
            sector = Polygon([(x, y), *corners])
            parts = [sector.intersection(shape) for shape in shapes]
            seen = [part.distance(Point(x, y)) for part in parts if not part.is_empty]
            expected = min([*seen, 10.0])
            assert found[robot, k] == pytest.approx(expected, abs=1e-4)


@pytest.mark.parametrize("sectors", RINGS)
def test_the_nearest_thing_is_the_same_for_every_ring(sectors):
    simulator = somewhere(seed=4)
    found = Ring(sectors).ranges(simulator, EVERYONE)
    nine = Ring(9).ranges(simulator, EVERYONE)
    np.testing.assert_array_equal(found.min(axis=1), nine.min(axis=1))


def test_nearness():
    simulator = somewhere(seed=5)
    read = Ring(36)(simulator, EVERYONE[:3])
    np.testing.assert_allclose(read, 1 - Ring(36).ranges(simulator, EVERYONE[:3]) / 10)
    assert read.shape == (3, 36)
    assert read.min() == 0
    assert read.max() <= 1


@pytest.mark.parametrize("cells", [8, 32, 33])
def test_picture_as_the_readable_function(cells):
    simulator = somewhere(seed=6)
    found = Picture(cells)(simulator, EVERYONE)
    for robot in EVERYONE:
        expected = picture_around(*shapes_of(simulator, robot), simulator.poses[robot], cells)  # fmt: skip
        np.testing.assert_array_equal(found[robot], expected)
    assert 0.01 < found.mean() < 0.5


def test_where_things_are_in_a_picture():
    """Ahead is up, left is left; the border to the right of the robot fills the right of the picture."""
    world = make_world(circles=[(95, 58, 2)], start=(95, 50), target=(95, 90))
    (picture,) = Picture(32)(Simulator(world), np.array([0]))
    assert picture[3, 15:17].tolist() == [1, 1]  # ahead
    assert picture[28, 15:17].tolist() == [0, 0]
    assert picture[16, :23].sum() == 0
    assert picture[16, 25:31].all()
    assert picture[0, 31] == 0  # farther than 10 m


def test_a_robot_in_an_obstacle_or_beyond_the_border_reads_nothing_but_zeros():
    world = make_world(circles=[(30, 30, 3)], rectangles=[(60, 60, 6, 4, 20)])
    for place in ((30, 30.5), (60, 60.5), (100.2, 50)):
        simulator = Simulator(world)
        simulator.poses[0, :2] = place
        assert (Ring(18).ranges(simulator, np.array([0])) == 0).all()


@pytest.mark.parametrize("make", [Ring, Picture])
@pytest.mark.parametrize("number", [2, 1000, 3.5, "9"])
def test_wrong_numbers_are_named(make, number):
    name = "sectors" if make is Ring else "cells"
    with pytest.raises((TypeError, ValueError), match=name):
        make(number)


def test_sensing_changes_nothing():
    worlds = random_worlds(20, 10, 5, seed=7)

    class Looking:
        def begin(self, simulator, rng):
            def select_actions(simulator, sensing, robots):
                Ring(72)(simulator, robots)
                Picture()(simulator, robots)
                return straight(sensing, rng)

            return select_actions

    looking, plain = (navigate(policy, worlds, noise=0.2) for policy in (Looking(), straight))  # fmt: skip
    assert (looking.outcome == plain.outcome).all()
    assert (looking.steps == plain.steps).all()
