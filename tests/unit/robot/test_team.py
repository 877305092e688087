"""Several robots: the compiled simulator is the plain one, a robot alone is that of one robot, and cases by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robonav.robot import (
    Action,
    Outcome,
    Reflex,
    Simulator,
    make_world,
    navigate,
    neighbour_slip,
    random_worlds,
    straight,
    turn_to_clearer_side,
)
from robonav.robot.team import (
    ROBOT_RADIUS,
    Teams,
    TeamSimulator,
    crossing,
    navigate_team,
    random_teams,
    team_selector,
)
from robonav.robot.team.plain import PlainTeam, least_distance


def on_empty_map(*robots):
    """One map without obstacles; each robot is (x, y, target x, target y)."""
    ends = np.array(robots, dtype=float)
    return Teams(make_world(), ends[None, :, :2], ends[None, :, 2:])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("robots", "obstacles", "speed", "direction"),
    [(2, 0, 2.0, "exact"), (5, 10, 1.3, "exact"), (16, 10, 2.0, "sector")],
)
def test_episodes_are_those_of_the_plain_simulator(robots, obstacles, speed, direction):
    teams = random_teams(32 // robots, robots, obstacles, seed=3)
    fast, reflex = TeamSimulator(teams, speed), Reflex(direction)
    plain = [PlainTeam(teams[i], speed, direction) for i in range(len(teams))]
    rng, seen = np.random.default_rng(0), 0
    for _ in range(45):
        sensing = fast.sense()
        actions = rng.choice(6, len(fast), p=[0.6, 0.12, 0.08, 0.12, 0.08, 0.0])
        commands = reflex(sensing, speed)
        running = np.flatnonzero(fast.outcome == Outcome.RUNNING)
        assert running.tolist() == [
            i * robots + r for i, team in enumerate(plain) for r in team.robots
        ]
        for i, team in enumerate(plain):
            for r, observation in team.sense().items():
                row = i * robots + r
                np.testing.assert_allclose(
                    sensing.ranges[row], observation["ranges"], rtol=0, atol=2e-6
                )
                assert sensing.walls[row].tolist() == observation["walls"].tolist()
                assert sensing.target_region[row] == observation["target_region"] + 1
                assert sensing.target_seen[row] == observation["target_seen"]
        fast.step(np.where(commands < 0, actions, commands))
        for i, team in enumerate(plain):
            rows = {r: i * robots + r for r in team.robots}
            kept = dict(team.robots)
            outcomes = team.step({r: int(actions[row]) for r, row in rows.items()})
            for r, row in rows.items():
                assert outcomes[r] == fast.outcome[row]
                x, y, heading = fast.poses[row]
                np.testing.assert_allclose([x, y], kept[r].position, rtol=0, atol=1e-9)
                turned = math.remainder(heading - kept[r].heading, math.tau)
                assert abs(turned) < 1e-9  # pi and -pi are one heading
                seen += 1
    assert fast.met.any()
    assert seen > 100


@pytest.mark.parametrize("moving", [0, 5])
def test_a_robot_alone_is_the_robot_of_the_simulator(moving):
    """The same maps, outcomes, steps and positions, to the last bit; noise and slips too."""
    worlds = random_worlds(300, 15, moving, seed=8)
    teams = random_teams(300, 1, 15, moving, seed=8)
    assert teams.worlds.digest() == worlds.digest()
    about = {"noise": 0.2, "slip": neighbour_slip(0.2), "max_steps": 60, "speed": 4.0}
    one, team = Simulator(worlds, **about), TeamSimulator(teams, **about)
    rng = np.random.default_rng(1)
    for _ in range(70):
        commands = rng.choice(8, len(one), p=[0.2, 0.05, 0.0, 0.05, 0.0, 0, 0.5, 0.2])
        running = np.flatnonzero(one.outcome == Outcome.RUNNING)
        for name, value in vars(one.sense(running)).items():
            np.testing.assert_array_equal(value, getattr(team.sense(running), name))
        executed = one.step(commands[running], running)
        np.testing.assert_array_equal(executed, team.step(commands[running], running))
        for name in ("poses", "steps", "outcome", "centres", "headings"):
            np.testing.assert_array_equal(getattr(one, name), getattr(team, name))
    assert {Outcome.COLLIDED, Outcome.ARRIVED} <= set(one.outcome)
    assert not team.met.any()


def test_navigation_alone_is_that_of_one_robot():
    worlds, teams = random_worlds(200, 20, seed=4), random_teams(200, 1, 20, seed=4)
    one = navigate(turn_to_clearer_side, worlds, record_paths=True)
    team = navigate_team(turn_to_clearer_side, teams, record_paths=True)
    np.testing.assert_array_equal(one.outcome, team.outcome[:, 0])
    np.testing.assert_array_equal(one.steps, team.steps[:, 0])
    for path, other in zip(one.paths, team.paths, strict=True):
        np.testing.assert_array_equal(path, other)


def test_a_robot_that_nobody_meets_goes_as_if_alone():
    """Among moving obstacles too: they go their way whoever is on the map."""
    teams = random_teams(100, 2, 5, 5, seed=5)
    starts = teams.starts.copy()
    starts[:, 1], targets = (90, 50), teams.targets.copy()
    targets[:, 1] = (95, 5)
    both = navigate_team(straight, Teams(teams.worlds, starts, targets), record_paths=True)  # fmt: skip
    alone = navigate_team(straight, teams.first(1), record_paths=True)
    same = [
        np.array_equal(both.paths[2 * i], alone.paths[i]) for i in range(len(teams))
    ]
    assert np.mean(same) > 0.9


def test_the_other_is_a_circle_on_the_sensors():
    teams = on_empty_map((50, 50, 90, 50), (57, 50, 90, 50), (50, 44, 10, 44))
    sensing = TeamSimulator(teams).sense()
    assert sensing.ranges[0, 0] == 7 - ROBOT_RADIUS
    assert sensing.ranges[0, 7] == 6 - ROBOT_RADIUS  # to the right
    as_obstacles = make_world(circles=[(57, 50, 1), (50, 44, 1)], start=(50, 50), target=(90, 50))  # fmt: skip
    np.testing.assert_array_equal(
        sensing.ranges[0], Simulator(as_obstacles).sense().ranges[0]
    )
    assert not sensing.walls.any()
    assert TeamSimulator(teams).sense(np.array([2])).ranges[0, 2] == sensing.ranges[2, 2]  # fmt: skip


@pytest.mark.parametrize(
    ("gap", "collide"),
    # after a step of 2 m each, the centres are 4 m nearer
    [(6.0, False), (5.999, True), (3.0, True)],
)
def test_robots_towards_each_other(gap, collide):
    teams = on_empty_map((40, 50, 90, 50), (40 + gap, 50, 10, 50))
    simulator = TeamSimulator(teams)
    simulator.step(np.array([Action.F, Action.F]))
    assert simulator.met.tolist() == [collide, collide]
    wanted = Outcome.COLLIDED if collide else Outcome.RUNNING
    assert simulator.outcome.tolist() == [wanted, wanted]


def test_robots_that_cross_hit_each_other_between_the_ends_of_their_ways():
    """Both ends are far enough apart; in the middle of the second both are at the same place."""
    teams = on_empty_map((50, 50, 90, 50), (52, 52, 52, 10))
    simulator = TeamSimulator(teams, speed=4.0)
    before = simulator.poses[:, :2].copy()
    simulator.step(np.array([Action.F, Action.F]))
    after = simulator.poses[:, :2]
    ends = [np.linalg.norm(places[0] - places[1]) for places in (before, after)]
    assert min(ends) > 2 * ROBOT_RADIUS
    assert simulator.met.all()


def test_robots_side_by_side_never_come_nearer():
    teams = on_empty_map((20, 50, 90, 50), (20, 52, 90, 52))
    simulator = TeamSimulator(teams)
    for _ in range(33):
        simulator.step(np.array([Action.F, Action.F]))
    assert simulator.outcome.tolist() == [Outcome.RUNNING, Outcome.RUNNING]
    assert least_distance(np.array([0.0, 2.0]), np.array([0.0, 2.0])) == 2.0


def test_who_has_ended_leaves_the_map():
    """The first arrives at once; the second then sees nobody, and goes through where the first stood."""
    teams = on_empty_map((50, 50, 53, 50), (44, 50, 90, 50))
    simulator = TeamSimulator(teams)
    assert simulator.sense().ranges[1, 0] == 5
    simulator.step(np.array([Action.F, Action.F]))
    assert simulator.outcome.tolist() == [Outcome.ARRIVED, Outcome.RUNNING]
    assert simulator.sense().ranges[1].min() == 10
    pose = simulator.poses[0].copy()
    for _ in range(10):
        simulator.step(np.array([Action.F]), np.array([1]))
    assert simulator.outcome[1] == Outcome.RUNNING
    assert simulator.steps.tolist() == [1, 11]
    np.testing.assert_array_equal(simulator.poses[0], pose)


def test_a_robot_hits_an_obstacle_without_meeting_anybody():
    world = make_world(circles=[(50, 50, 3)])
    teams = Teams(world, [[(42, 50), (42, 70)]], [[(90, 50), (90, 70)]])
    result = navigate_team(straight, teams, reflex=None)
    assert result.outcome.tolist() == [["collided", "arrived"]]
    assert not result.met.any()
    assert result.collision.tolist() == [[True, False]]


def test_results_do_not_depend_on_the_batch():
    """A map alone gives the bits of the same map among many; so threads change nothing."""
    teams = random_teams(600, 4, 8, 2, seed=6)
    whole = navigate_team(turn_to_clearer_side, teams, max_steps=40, record_paths=True)
    for i in (0, 137, 599):
        one = navigate_team(turn_to_clearer_side, teams[i], max_steps=40, record_paths=True)  # fmt: skip
        np.testing.assert_array_equal(one.outcome[0], whole.outcome[i])
        for r in range(4):
            np.testing.assert_array_equal(one.paths[r], whole.paths[4 * i + r])


def test_each_robot_with_its_own_policy():
    teams = random_teams(30, 3, seed=7)
    simulator, asked = TeamSimulator(teams), []

    def noting(number):
        def policy(sensing, rng):
            asked.append((number, len(sensing)))
            return np.full(len(sensing), number)

        return policy

    select = team_selector([noting(0), noting(1), noting(2)], simulator, np.random.default_rng(0))  # fmt: skip
    robots = np.array([0, 2, 4, 5, 8])
    actions = select(simulator, simulator.sense(robots), robots)
    assert actions.tolist() == [0, 2, 1, 2, 2]
    assert asked == [(0, 1), (1, 1), (2, 3)]
    with pytest.raises(ValueError, match="one for each of 3 robots, got 2"):
        navigate_team([straight, straight], teams)


def test_robots_draw_their_own_noise():
    """Two robots at the same distance from the same circle read different errors; the first reads the world's."""
    world = make_world(circles=[(50, 50, 2)], start=(44, 50), target=(90, 50))
    teams = Teams(world, [[(44, 50), (56, 50)]], [[(90, 50), (10, 50)]])
    ranges = TeamSimulator(teams, noise=0.5).sense().ranges[:, 0]
    assert ranges[0] == Simulator(world, noise=0.5).sense().ranges[0, 0]
    assert abs(ranges[0] - ranges[1]) > 1e-3


def test_crossing_spreads_the_first_robots_evenly():
    starts, targets = crossing(16)
    np.testing.assert_array_equal(starts + targets, np.full((16, 2), 100))
    assert set(map(tuple, starts[:4])) == {(10, 10), (90, 90), (90, 10), (10, 90)}
    apart = np.linalg.norm(starts[:, None] - starts[None], axis=2) + 1e9 * np.eye(16)
    assert apart.min() == pytest.approx(20)
    np.testing.assert_array_equal(starts[:8], crossing(8)[0])
    assert math.dist(*crossing(64)[0][[0, 32]]) == pytest.approx(5)


def test_random_teams_keep_clear_of_every_start_and_target():
    teams = random_teams(50, 8, 12, seed=9)
    for name in ("starts", "targets"):
        for r in range(8):
            x, y = getattr(teams, name)[:, r].T
            centres = np.linalg.norm(teams.worlds.centres - np.stack([x, y], 1)[:, None], axis=2)  # fmt: skip
            circles = teams.worlds.kinds == 1
            assert (centres - teams.worlds.shapes[..., 0])[circles].min() >= 6
    assert teams[3].worlds.digest() == teams.worlds[3].digest()
    assert len(teams[[1, 2]]) == 2
    assert teams.first(2).robots == 2
    again = random_teams(50, 8, 12, seed=np.random.default_rng(1))
    assert again.worlds.digest() != teams.worlds.digest()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: on_empty_map((50, 50, 9, 9), (51, 50, 9, 9)), "2 m apart"),
        (lambda: on_empty_map((50, 50, 101, 9)), "targets must lie in the map"),
        (
            lambda: Teams(make_world(), [[(1, 1)]], [[(1, 1), (5, 5)]]),
            "one point for each robot",
        ),
        (lambda: Teams(make_world(), [[1, 1]], [[1, 1]]), "shape"),
        (lambda: crossing(65), "at most 64"),
        (lambda: random_teams(2, 3, seed=0, starts=[(1, 1)]), "shape"),
        (
            lambda: random_teams(
                1,
                2,
                90,
                seed=0,
                starts=[(5, 5), (9, 5)],
                targets=[(25, 25), (20, 25)],
                size=30,
            ),
            "a way to each target",
        ),
        (lambda: random_teams(2, 2, seed=0).first(3), "at most 2"),
    ],
)
def test_a_wrong_team_gets_one_clear_sentence(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_a_wrong_step_gets_one_clear_sentence():
    simulator = TeamSimulator(random_teams(2, 3, seed=0))
    with pytest.raises(ValueError, match="all 6 that are running"):
        simulator.step(np.array([0]), np.array([1]))
    with pytest.raises(ValueError, match="6 whole numbers 0 to 7"):
        simulator.step(np.full(6, 8))
    with pytest.raises(TypeError, match="begin together"):
        simulator.restart(np.array([0]), simulator.worlds[0])
    simulator.stop(np.array([0]))
    assert simulator.outcome.tolist() == [Outcome.OUT_OF_STEPS, 0, 0, 0, 0, 0]
