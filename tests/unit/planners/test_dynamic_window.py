"""The look-ahead over six actions by hand."""

from __future__ import annotations

import numpy as np
import pytest

from robonav.planners import DynamicWindow, dynamic_window
from robonav.robot import Action

LENGTHS = {"speed": 2.0, "clearance": 1.0, "half_width": 0.0}


def test_scores_of_an_empty_place_by_hand(readings):
    scores = dynamic_window(readings(2), **LENGTHS, heading=0.9, distance=0.5)[0]
    off = np.array(
        [40, 10, 20, 70, 100, 40]
    )  # from the direction that each action faces
    expected = 0.9 * (1 - off / 180) + 0.5 + np.array([1, 1, 1, 1, 1, 0])
    np.testing.assert_allclose(scores, expected)


def test_distance_is_the_way_to_the_clearance_circle(readings):
    scores = dynamic_window(readings(s1=6.0), **LENGTHS, heading=0.0, distance=1.0)[0]
    assert scores[Action.F] == pytest.approx(1 + (6 - 1) / 10)
    way = 6 * np.cos(np.radians(30))  # passes the point at 3 m: farther than 1 m
    assert way < 6
    assert scores[Action.L30] == pytest.approx(2.0)


def test_no_step_is_taken_into_an_obstacle(random_sensing):
    policy = DynamicWindow()
    actions = policy(random_sensing, np.random.default_rng(0))
    scores = dynamic_window(
        random_sensing, speed=2.0, clearance=policy.clearance, half_width=policy.half_width,
        heading=policy.heading, distance=policy.distance,
    )  # fmt: skip
    some = (scores >= 0).any(axis=1)
    assert (scores[np.arange(len(actions)), actions] >= 0)[some].all()
    assert not some.all()  # and where none is admissible, the longest way is taken


def test_with_all_ways_blocked_it_takes_the_longest(readings):
    sensing = readings(s1=2.0, s2=2.0, s3=2.0, s4=3.5, s5=2.5, s6=2.5, s7=3.5, s8=2.0, s9=2.0)  # fmt: skip
    assert DynamicWindow()(sensing, np.random.default_rng(0)) == [Action.B]


def test_own_speed_decides_what_is_admissible(readings):
    sensing = readings(s1=4.5)
    assert DynamicWindow(1.0, clearance=1.0, distance=0.0)(sensing, None) == [Action.F]
    assert DynamicWindow(4.0, clearance=1.0, distance=0.0)(sensing, None) != [Action.F]


def test_mirrored_readings_give_mirrored_scores(
    random_sensing, mirrored, mirrored_actions
):
    weights = {"heading": 0.3, "distance": 0.8}
    scores, other = (
        dynamic_window(sensing, speed=2.0, clearance=1.5, half_width=0.2, **weights)
        for sensing in (random_sensing, mirrored(random_sensing))
    )
    np.testing.assert_allclose(other, scores[:, mirrored_actions(range(6))], atol=1e-9)
