"""Demonstrations by the computer expert: what is recorded."""

import numpy as np
import pytest

from robonav.lfd import (
    ComputerExpert,
    Demonstrations,
    demonstrate,
    demonstrate_by_hand,
    record_demonstrations,
    sketch,
)
from robonav.lfd.dagger import labelled_rollout
from robonav.lfd.demonstrations import actions_from_poses
from robonav.robot import (
    REFLEX,
    Action,
    Reflex,
    Simulator,
    concatenate_worlds,
    make_world,
    neighbour_slip,
    random_worlds,
    sense,
    straight,
)


@pytest.fixture(scope="module")
def demonstrations():
    return demonstrate(random_worlds(8, 20, seed=11))


def test_recorded_actions_lead_through_the_recorded_poses(demonstrations):
    robots = Simulator(demonstrations.worlds, demonstrations.speed)
    for step in range(demonstrations.lengths.max()):
        now = np.flatnonzero(step < demonstrations.lengths)
        rows = np.concatenate([[0], np.cumsum(demonstrations.lengths)])[now] + step
        assert np.allclose(robots.poses[now], demonstrations.poses[rows])
        assert np.array_equal(
            robots.sense().ranges[now], demonstrations.sensing.ranges[rows]
        )
        commands = np.zeros(len(demonstrations.worlds), dtype=np.int64)
        commands[now] = demonstrations.actions[rows]
        robots.step(commands)
    assert (robots.outcome == 1).all()
    assert (demonstrations.outcome == "arrived").all()


def test_the_reflex_acts_before_the_expert(demonstrations):
    commands = REFLEX(demonstrations.sensing, demonstrations.speed)
    decided = commands >= 0
    assert np.array_equal(demonstrations.actions[decided], commands[decided])
    assert (demonstrations.actions[~decided] < 5).all()


def test_effective_pairs(demonstrations):
    pairs = demonstrations.effective
    assert 0 < len(pairs) < len(demonstrations)
    assert (pairs.sensing.ranges.min(axis=1) < 10).all()
    assert (pairs.actions < 5).all()
    assert len(pairs) == int(
        (
            (demonstrations.sensing.ranges.min(axis=1) < 10)
            & (demonstrations.actions < 5)
        ).sum()
    )
    assert len(pairs.effective) == len(pairs)


def test_the_expert_keeps_clear(demonstrations):
    assert demonstrations.sensing.ranges.min() >= 2 - 1e-6


def test_each_trajectory_depends_on_its_own_world_alone(demonstrations):
    alone = demonstrate(demonstrations.worlds[3])
    of_the_batch = demonstrations.select_trajectories([3])
    assert np.array_equal(alone.actions, of_the_batch.actions)
    assert np.array_equal(alone.poses, of_the_batch.poses)
    assert (of_the_batch.trajectory == 0).all()
    picked = demonstrations.select_trajectories([5, 3])
    assert picked.lengths.tolist() == demonstrations.lengths[[5, 3]].tolist()
    assert picked.worlds.digest() == demonstrations.worlds[[5, 3]].digest()


class Counting(ComputerExpert):
    """Counts its plans."""

    plans = 0

    def plan_from(self, simulator, robot):
        self.plans += 1
        return super().plan_from(simulator, robot)


def test_a_plan_is_made_where_the_last_was_left():
    """Without slipping there are few plans; with it the robot leaves them."""

    worlds = random_worlds(4, 10, seed=5)
    steady, slipping = Counting(), Counting()
    asked = (record_demonstrations(steady, worlds).actions < 5).sum()
    demonstrations = record_demonstrations(slipping, worlds, slip=neighbour_slip(0.4))
    assert steady.plans < asked / 2
    assert slipping.plans > 1.5 * steady.plans
    assert np.array_equal(
        demonstrations.actions,
        record_demonstrations(Counting(), worlds, slip=neighbour_slip(0.4)).actions,
    )


def test_a_slipping_expert_shows_what_was_executed():
    worlds = random_worlds(10, 20, seed=2)
    demonstrations = demonstrate(worlds, slip=neighbour_slip(0.3))
    same = demonstrations.trajectory[1:] == demonstrations.trajectory[:-1]
    decided = (
        same & (demonstrations.actions[:-1] < 5) & ~demonstrations.sensing.safe[:-1]
    )
    assert np.array_equal(
        actions_from_poses(demonstrations.poses[:-1], demonstrations.poses[1:])[
            decided
        ],
        demonstrations.actions[:-1][decided],
    )
    commands = REFLEX(demonstrations.sensing, demonstrations.speed)
    assert np.array_equal(
        demonstrations.actions[commands >= 0], commands[commands >= 0]
    )


def test_intended_actions_are_recorded_on_request():
    worlds, slip = random_worlds(6, 20, seed=2), neighbour_slip(0.3)
    executed = record_demonstrations(ComputerExpert(), worlds, slip=slip)
    intended = record_demonstrations(ComputerExpert(), worlds, slip=slip, intended=True)
    assert np.array_equal(executed.poses, intended.poses)
    chosen = REFLEX(executed.sensing, executed.speed) < 0
    slipped = executed.actions != intended.actions
    assert not slipped[~chosen].any()
    assert 0.2 < slipped[chosen].mean() < 0.4


@pytest.mark.parametrize("action", list(Action)[:6])
@pytest.mark.parametrize("heading", [-3.0, 0.0, 1.0, 3.1])
def test_executed_actions_are_read_off_the_poses(action, heading):
    robot = Simulator(random_worlds(1, 0, seed=1))
    robot.poses[0] = 50, 50, heading
    robot.step(np.array([action]))
    assert actions_from_poses(np.array([[50, 50, heading]]), robot.poses) == [action]


def test_moving_obstacles_are_planned_around():
    """The expert plans again in each step, because the obstacles of its last plan have moved."""

    expert = Counting()
    demonstrations = record_demonstrations(expert, random_worlds(6, 5, 5, seed=6))
    assert (demonstrations.outcome == "arrived").mean() > 0.6
    assert (
        expert.plans == (REFLEX(demonstrations.sensing, demonstrations.speed) < 0).sum()
    )


def test_steps_in_safe_states_are_not_learned_from():
    """Not even where, without a reflex, one of the five actions was taken."""
    demonstrations = record_demonstrations(
        ComputerExpert(), random_worlds(3, 10, seed=7), reflex=None
    )
    assert (demonstrations.actions < 5).all()
    assert demonstrations.sensing.safe.sum() > 30
    assert not demonstrations.effective.sensing.safe.any()
    assert len(demonstrations.effective) == (~demonstrations.sensing.safe).sum()


def test_out_of_steps():
    demonstrations = record_demonstrations(
        lambda simulator, asked: np.full(len(asked), Action.R60),
        random_worlds(2, 0, seed=1),
        reflex=None,
        max_steps=7,
    )
    assert demonstrations.outcome.tolist() == ["out of steps"] * 2
    assert demonstrations.lengths.tolist() == [7, 7]


def test_no_worlds_no_steps():
    demonstrations = demonstrate(random_worlds(0, 5, seed=1))
    assert len(demonstrations) == 0
    assert len(demonstrations.effective) == 0


def broken(demonstrations, **changed):
    values = {
        name: getattr(demonstrations, name)
        for name in Demonstrations.__dataclass_fields__
    }
    return Demonstrations(**(values | changed))


def test_inconsistent_demonstrations_are_errors(demonstrations):
    for changed, message in [
        (
            {"actions": demonstrations.actions[1:]},
            "demonstrations: actions must have shape",
        ),
        (
            {"actions": demonstrations.actions + 5},
            "demonstrations: actions must lie in 0..7, got",
        ),
        (
            {"trajectory": demonstrations.trajectory[::-1]},
            "demonstrations: trajectory must ascend",
        ),
        (
            {"trajectory": demonstrations.trajectory + 1},
            "demonstrations: trajectory must lie in 0..7",
        ),
        ({"speed": 0}, "demonstrations: speed must be greater than 0"),
        (
            {"outcome": np.full(8, "lost")},
            "demonstrations: outcome must be one of arrived",
        ),
        (
            {"poses": np.full_like(demonstrations.poses, np.nan)},
            "demonstrations: poses must hold finite numbers",
        ),
    ]:
        with pytest.raises(ValueError, match=message):
            broken(demonstrations, **changed)
    with pytest.raises(ValueError, match="margin must be at least 1"):
        demonstrate(demonstrations.worlds, margin=0.5)
    with pytest.raises(ValueError, match="speed must be greater than 0"):
        demonstrate(demonstrations.worlds, speed=0)


def test_sensing_is_raw(demonstrations):
    rows = np.flatnonzero(demonstrations.trajectory == 2)
    worlds = concatenate_worlds([demonstrations.worlds[2]] * len(rows))
    assert np.array_equal(
        sense(worlds, demonstrations.poses[rows]).ranges,
        demonstrations.sensing.ranges[rows],
    )


def test_a_world_without_a_way_is_named():
    walled = make_world(rectangles=[(50, 50, 6, 96, 0)])
    with pytest.raises(
        ValueError,
        match=r"worlds\[1\] must have a path from start to target at 2 m/s, and has none",
    ):
        demonstrate(concatenate_worlds([make_world(), walled]))


@pytest.mark.parametrize(
    ("worlds", "options", "error", "message"),
    [
        ("x", {}, TypeError, "worlds must be Worlds, got str"),
        (make_world(), {"margin": 51}, ValueError, "margin must be at most 50, got 51"),
        (make_world(), {"margin": 0.5}, ValueError, "margin must be at least 1"),
        (
            make_world(),
            {"margin": "wide"},
            TypeError,
            "margin must be a number, got 'wide'",
        ),
        (
            make_world(),
            {"speed": "fast"},
            TypeError,
            "speed must be a number, got 'fast'",
        ),
    ],
)
def test_wrong_arguments_get_a_sentence(worlds, options, error, message):
    with pytest.raises(error, match=message):
        demonstrate(worlds, **options)


def test_demonstrations_of_a_slow_robot():
    """Its steps are shorter than the cells that tell poses apart."""
    worlds = random_worlds(2, 6, seed=1, size=40, starts=((5, 5),), targets=((35, 35),))
    slow = record_demonstrations(ComputerExpert(), worlds, speed=0.1, max_steps=2000)
    assert slow.outcome.tolist() == ["arrived", "arrived"]
    assert (
        demonstrate(random_worlds(1, 5, seed=1), speed=0.1).outcome[0] == "out of steps"
    )


def test_demonstrations_are_recorded_with_the_reflex_that_is_given():
    worlds = random_worlds(3, 10, seed=7)
    for direction, to_target in (
        ("exact", Action.TO_TARGET),
        ("sector", Action.TO_SECTOR),
    ):
        reflex = Reflex(direction)
        by_hand = demonstrate_by_hand(worlds, sketch(worlds, seed=1), reflex=reflex)
        computer = demonstrate(worlds, reflex=reflex)
        labelled = labelled_rollout(
            Simulator(worlds, max_steps=100),
            straight,
            ComputerExpert(),
            0.0,
            np.random.default_rng(0),
            reflex=reflex,
        )
        for recorded in (by_hand, computer, labelled):
            in_safe_states = np.unique(recorded.actions[recorded.sensing.safe])
            np.testing.assert_array_equal(in_safe_states, [to_target])


def test_steps_are_selected_by_several_and_trajectories_by_one(demonstrations):
    with pytest.raises(TypeError, match="steps are selected by a slice, a list or a"):
        demonstrations[0]
    assert len(demonstrations[[0, 2]]) == 2
    one, several = (demonstrations.select_trajectories(i) for i in (1, [1]))
    assert len(one.worlds) == 1
    assert np.array_equal(one.poses, several.poses)
