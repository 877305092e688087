"""The artificial potential field against the gradient of its potential, and its local minimum."""

from __future__ import annotations

import numpy as np
import pytest

from robonav.planners import PotentialField, potential_field
from robonav.planners.sectors import CENTRES
from robonav.robot import make_world, navigate, sense


def potential(x, y, obstacles, repulsion, influence):
    """Attraction by a target far ahead, and repulsion by points; written from the paper."""
    value = -x
    for px, py in obstacles:
        rho = np.hypot(x - px, y - py)
        if rho < influence:
            value += repulsion / 2 * (1 / rho - 1 / influence) ** 2
    return value


def test_forces_are_the_negative_gradient_of_the_potential(readings):
    sensing = readings(s1=5.0, s2=3.0, s7=7.0)
    points = [(d * np.cos(CENTRES[k]), d * np.sin(CENTRES[k])) for k, d in ((0, 5.0), (1, 3.0), (6, 7.0))]  # fmt: skip
    attraction, repulsions = potential_field(sensing, repulsion=30.0, influence=8.0)
    force = (attraction + repulsions.sum(axis=1))[0]
    h = 1e-5
    slope_x = potential(h, 0, points, 30.0, 8.0) - potential(-h, 0, points, 30.0, 8.0)
    slope_y = potential(0, h, points, 30.0, 8.0) - potential(0, -h, points, 30.0, 8.0)
    np.testing.assert_allclose(force, [-slope_x / 2 / h, -slope_y / 2 / h], atol=1e-6)


def test_beyond_its_influence_nothing_repels(readings):
    _, repulsions = potential_field(readings(s1=6.0, s4=9.0), repulsion=30.0, influence=6.0)  # fmt: skip
    assert not repulsions.any()


@pytest.mark.parametrize("repulsion", [8.0, 30.0])
def test_forces_cancel_in_front_of_an_obstacle_on_the_way(readings, repulsion):
    """Where repulsion (1/rho - 1/rho_0) / rho^2 = 1 the robot without inertia has nowhere to go: a local minimum."""
    roots = np.roots([1.0, 0.0, repulsion / 6.0, -repulsion])  # rho^3 + ... = 0
    rho = float(roots[np.isreal(roots)].real[0])
    attraction, repulsions = potential_field(readings(s1=rho), repulsion=repulsion, influence=6.0)  # fmt: skip
    np.testing.assert_allclose(attraction + repulsions.sum(axis=1), 0.0, atol=1e-9)


def test_pocket_is_a_local_minimum():
    """In a deep pocket that opens towards it the robot runs out of steps, or collides."""
    walls = [(60, 50, 2, 16, 0), (53, 57, 14, 2, 0), (53, 43, 14, 2, 0)]
    world = make_world(rectangles=walls, start=(20, 50), target=(90, 50))
    assert not navigate(PotentialField(), world).success[0]


def test_without_obstacles_no_force_but_the_target_s():
    sensing = sense(make_world(), [(50, 50, 0)])
    attraction, repulsions = potential_field(sensing, repulsion=1.0, influence=10.0)
    assert np.hypot(*attraction[0]) == pytest.approx(1.0)
    assert not repulsions.any()
