"""The bug algorithm and its memory."""

from __future__ import annotations

import numpy as np
import pytest

from robonav.planners import Bug, BugMemory, PotentialField, bug
from robonav.robot import (
    Action,
    Simulator,
    follow_policy,
    make_world,
    navigate,
    random_worlds,
    run_episodes,
    straight,
)

LENGTHS = {"speed": 2.0, "clearance": 1.0, "half_width": 0.3, "sight": 4.0}


def pocket(depth, width=12.0):
    """A pocket that opens towards the start, as the explorable of the robot's page has it."""
    side = width / 2 + 1
    arms = [(60 - depth / 2, 50 + side, depth, 2, 0), (60 - depth / 2, 50 - side, depth, 2, 0)]  # fmt: skip
    walls = [(60, 50, 2, width + 4, 0), *arms]
    return make_world(rectangles=walls, start=(20, 50), target=(90, 50))


@pytest.mark.parametrize("depth", [4.0, 8.0, 12.0, 16.0])
def test_memory_leads_out_of_pockets(depth):
    result = navigate(Bug(), pocket(depth))
    assert result.outcome.tolist() == ["arrived"]


def test_the_same_pockets_hold_a_planner_without_memory():
    arrived = [navigate(PotentialField(), pocket(d)).success[0] for d in (8.0, 12.0)]
    assert not any(arrived)


def test_going_to_the_target_nothing_is_remembered(readings):
    actions, memory = bug(
        BugMemory.empty(1), readings(), np.array([0.5]), np.array([30.0]), **LENGTHS
    )
    assert actions == [Action.L30]
    assert memory.side == [0]
    assert np.isinf(memory.least[0])


@pytest.mark.parametrize(("sector", "side"), [("s2", 1), ("s9", -1)])
def test_meets_a_wall_and_passes_it_on_the_nearer_side(readings, sector, side):
    sensing = readings(s1=3.5, **{sector: 3.5})
    _, memory = bug(BugMemory.empty(1), sensing, np.zeros(1), np.array([30.0]), **LENGTHS)  # fmt: skip
    assert memory.side == [side]
    assert memory.least == [30.0]


def test_leaves_only_where_a_point_nearer_to_the_target_is_free(readings):
    """At 36 m it sees 10 m of free way, to a point at 26 m: nearer than 30 m, but not nearer than 25 m."""
    sensing = readings(s4=3.0)
    for least, side in ((30.0, 0), (25.0, 1)):
        before = BugMemory(np.array([1]), np.array([least]))
        _, after = bug(before, sensing, np.zeros(1), np.array([36.0]), **LENGTHS)
        assert after.side == [side]


def test_least_distance_is_remembered(readings):
    before = BugMemory(np.array([1]), np.array([20.0]))
    sensing = readings(s1=3.0, s2=3.0)
    for distance, least in ((22.0, 20.0), (19.0, 19.0)):
        _, after = bug(before, sensing, np.zeros(1), np.array([distance]), **LENGTHS)
        assert after.least == [least]


def test_keeps_along_a_wall_on_the_left(readings):
    before = BugMemory(np.array([1]), np.array([20.0]))
    sensing = readings(s2=3.1, s3=2.1, s4=2.6)
    actions, _ = bug(before, sensing, np.array([1.2]), np.array([30.0]), **LENGTHS)
    assert actions == [Action.F]


def test_every_episode_starts_without_memories():
    """A robot that restarts in the same simulator does what it did the first time."""
    world = pocket(8.0)
    fresh = navigate(Bug(), world, record_paths=True).paths[0]
    simulator = Simulator(world)
    choose = Bug().begin(simulator, np.random.default_rng(0))
    seconds = run_episodes(simulator, choose)
    for _ in range(25):
        next(seconds)  # into the pocket
    simulator.restart(np.array([0]), world)
    poses = [second.poses[0] for second in seconds]
    np.testing.assert_array_equal(poses[: len(fresh) - 1], fresh[:-1])


def test_memories_of_robots_are_their_own():
    """Alone or among others, a robot takes the same path."""
    worlds = random_worlds(30, 20, seed=4)
    together = navigate(Bug(), worlds, record_paths=True).paths
    for i in (0, 7, 29):
        alone = navigate(Bug(), worlds[i], record_paths=True).paths[0]
        np.testing.assert_array_equal(alone, together[i])


def test_a_policy_with_begin_is_asked_like_any_other():
    class Straight:
        def begin(self, simulator, rng):
            return follow_policy(lambda sensing, rng: np.zeros(len(sensing), int), rng)

    worlds = random_worlds(20, 10, seed=2)
    np.testing.assert_array_equal(
        navigate(Straight(), worlds).steps, navigate(straight, worlds).steps
    )
