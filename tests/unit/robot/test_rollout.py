"""The loop that all robots act in: who is asked, what is recorded, who may come and go."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from robonav.robot import (
    OUTCOMES,
    REFLEX,
    Action,
    Simulator,
    follow_policy,
    navigate,
    neighbour_slip,
    random_worlds,
    run_episodes,
    turn_to_clearer_side,
)

SLIP = neighbour_slip(0.3)


def at_random(sensing, rng):
    return rng.integers(0, 6, len(sensing))


def by_hand(worlds, seed, **settings):
    """One robot, driven by the plainest loop: rows (sensing, action, reflex, pose, outcome)."""
    simulator, rng, rows = (
        Simulator(worlds, **settings),
        np.random.default_rng(seed),
        [],
    )
    while simulator.outcome[0] == 0:
        sensing, pose = simulator.sense(), simulator.poses[0].copy()
        action = REFLEX(sensing, simulator.speed)
        reflex = action[0] >= 0
        if not reflex:
            action = at_random(sensing, rng)
        simulator.step(action)
        rows.append((sensing, action[0], reflex, pose, simulator.outcome[0]))
    return rows


@pytest.mark.parametrize("settings", [{}, {"slip": SLIP, "noise": 0.2}])
def test_transitions_against_a_plain_loop(settings):
    worlds = random_worlds(1, 20, 5, seed=3)
    plain = by_hand(worlds, 7, max_steps=60, **settings)
    simulator = Simulator(worlds, max_steps=60, **settings)
    found = list(run_episodes(simulator, follow_policy(at_random, 7)))
    assert len(found) == len(plain)
    for second, (sensing, action, reflex, pose, outcome) in zip(
        found, plain, strict=True
    ):
        np.testing.assert_array_equal(second.sensing.ranges, sensing.ranges)
        np.testing.assert_array_equal(second.poses, [pose])
        assert (second.actions[0], not second.asked[0], second.outcome[0]) == (
            action,
            reflex,
            outcome,
        )
    for second, following in pairwise(found):
        np.testing.assert_array_equal(
            second.next_sensing.ranges, following.sensing.ranges
        )


def test_robots_leave_when_their_episodes_end():
    simulator = Simulator(random_worlds(50, 20, seed=1), max_steps=80)
    left = np.arange(50)
    for second in run_episodes(simulator, follow_policy(turn_to_clearer_side, 0)):
        np.testing.assert_array_equal(second.robots, left)
        left = left[second.outcome == 0]
    assert len(left) == 0
    assert (simulator.outcome > 0).all()
    result = navigate(turn_to_clearer_side, random_worlds(50, 20, seed=1), max_steps=80)
    np.testing.assert_array_equal(result.outcome, OUTCOMES[simulator.outcome])
    np.testing.assert_array_equal(result.steps, simulator.steps)


def test_selectors_are_asked_about_robots_without_a_reflex():
    simulator = Simulator(random_worlds(30, 20, seed=2), max_steps=60)
    asked = []

    def choose(simulator, sensing, robots):
        asked.append(robots)
        np.testing.assert_array_equal(sensing.ranges, simulator.sense(robots).ranges)
        return np.zeros(len(robots), int)

    seconds = list(run_episodes(simulator, choose))
    expected = [s.robots[s.asked] for s in seconds if s.asked.any()]
    assert len(asked) == len(expected)
    for ours, theirs in zip(asked, expected, strict=True):
        np.testing.assert_array_equal(ours, theirs)
    assert all((second.actions[~second.asked] >= Action.B).all() for second in seconds)


def test_executed_actions_are_those_after_slips():
    simulator = Simulator(random_worlds(200, 20, seed=4), slip=SLIP, max_steps=40)
    commanded, done = [], []
    for second in run_episodes(simulator, follow_policy(at_random, 1), reflex=None):
        turned = simulator.poses[second.robots, 2] - second.poses[:, 2]
        degrees = np.rint(np.degrees(turned)).astype(int) % 360
        np.testing.assert_array_equal(
            degrees, np.array([0, 30, 60, 330, 300, 0])[second.executed]
        )
        commanded.append(second.actions)
        done.append(second.executed)
    share = (np.concatenate(commanded) != np.concatenate(done)).mean()
    assert 0.2 < share < 0.3  # five actions of six slip with 0.3


def test_episodes_may_be_stopped_and_begun_between_seconds():
    worlds = random_worlds(6, 20, seed=5)
    simulator = Simulator(worlds[:3], max_steps=500)
    restarted, paths = False, {}
    for second in run_episodes(simulator, follow_policy(turn_to_clearer_side, 0)):
        for robot, pose in zip(second.robots, second.poses, strict=True):
            paths.setdefault((int(robot), restarted), []).append(pose)
        if not restarted and simulator.steps[0] == 5:
            simulator.stop(np.array([0]))
            simulator.restart(np.array([0, 1]), worlds[3:5])
            restarted = True
        if simulator.steps[2] == 9:
            simulator.stop(np.array([2]))
    assert OUTCOMES[simulator.outcome[2]] == "out of steps"
    assert simulator.steps[2] == 9
    for robot, world in ((0, 3), (1, 4)):
        alone = navigate(turn_to_clearer_side, worlds[world], record_paths=True)
        np.testing.assert_array_equal(paths[robot, True], alone.paths[0][:-1])


def test_stopping_an_episode_that_has_ended_changes_nothing():
    simulator = Simulator(random_worlds(20, 20, seed=1), max_steps=80)
    for _ in run_episodes(simulator, follow_policy(turn_to_clearer_side, 0)):
        pass
    before = simulator.outcome.copy()
    simulator.stop(np.arange(20))
    np.testing.assert_array_equal(simulator.outcome, before)


@pytest.mark.parametrize("robots", [[3], [-1], [[0]], [0.5]])
def test_robots_that_do_not_exist_are_refused(robots):
    simulator = Simulator(random_worlds(3, seed=0))
    with pytest.raises((TypeError, ValueError), match="robots must"):
        simulator.sense(robots)


def test_a_part_of_the_robots_senses_and_steps_as_among_all():
    worlds, some = random_worlds(8, 10, 5, seed=6), np.array([1, 4, 6])
    whole, part = Simulator(worlds, noise=0.1), Simulator(worlds, noise=0.1)
    for _ in range(5):
        whole.step(np.zeros(8, np.int64))
        part.step(np.zeros(3, np.int64), some)
        np.testing.assert_array_equal(
            part.sense(some).ranges, whole.sense()[some].ranges
        )
    np.testing.assert_array_equal(part.poses[some], whole.poses[some])
    others = [0, 2, 3, 5, 7]
    np.testing.assert_array_equal(part.poses[others], worlds.start_poses[others])
    assert (part.steps[others] == 0).all()


def test_no_worlds_have_no_paths():
    driven = navigate(
        turn_to_clearer_side, random_worlds(0, 3, seed=1), record_paths=True
    )
    assert driven.paths == ()
    assert len(driven.steps) == 0
