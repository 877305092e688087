"""What is recorded of an expert's drives."""

import numpy as np
import pytest

from robonav.lfd import ComputerExpert, Demonstrations, demonstrate, record
from robonav.lfd.demonstrations import actions_from_poses
from robonav.robot import (
    REFLEX,
    Action,
    Simulator,
    concatenate,
    make_world,
    neighbour_slip,
    random_worlds,
    sense,
)


@pytest.fixture(scope="module")
def shown():
    return demonstrate(random_worlds(8, 20, seed=11))


def test_what_is_recorded_can_be_driven_again(shown):
    robots = Simulator(shown.worlds, shown.speed)
    for step in range(shown.lengths.max()):
        now = np.flatnonzero(step < shown.lengths)
        rows = np.concatenate([[0], np.cumsum(shown.lengths)])[now] + step
        assert np.allclose(robots.poses[now], shown.poses[rows])
        assert np.array_equal(robots.sense().ranges[now], shown.sensing.ranges[rows])
        commands = np.zeros(len(shown.worlds), dtype=np.int64)
        commands[now] = shown.actions[rows]
        robots.step(commands)
    assert (robots.outcome == 1).all()
    assert (shown.outcome == "arrived").all()


def test_the_reflex_acts_before_the_expert(shown):
    commands = REFLEX(shown.sensing, shown.speed)
    decided = commands >= 0
    assert np.array_equal(shown.actions[decided], commands[decided])
    assert (shown.actions[~decided] < 5).all()


def test_effective_pairs(shown):
    pairs = shown.effective
    assert 0 < len(pairs) < len(shown)
    assert (pairs.sensing.ranges.min(axis=1) < 10).all()
    assert (pairs.actions < 5).all()
    assert len(pairs) == int(
        ((shown.sensing.ranges.min(axis=1) < 10) & (shown.actions < 5)).sum()
    )
    assert len(pairs.effective) == len(pairs)


def test_the_expert_keeps_clear(shown):
    assert shown.sensing.ranges.min() >= 2 - 1e-6


def test_each_drive_is_its_worlds_alone(shown):
    alone = demonstrate(shown.worlds[3])
    of_the_batch = shown.select_trajectories([3])
    assert np.array_equal(alone.actions, of_the_batch.actions)
    assert np.array_equal(alone.poses, of_the_batch.poses)
    assert (of_the_batch.trajectory == 0).all()
    picked = shown.select_trajectories([5, 3])
    assert picked.lengths.tolist() == shown.lengths[[5, 3]].tolist()
    assert picked.worlds.digest() == shown.worlds[[5, 3]].digest()


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
    asked = (record(steady, worlds).actions < 5).sum()
    shown = record(slipping, worlds, slip=neighbour_slip(0.4))
    assert steady.plans < asked / 2
    assert slipping.plans > 1.5 * steady.plans
    assert np.array_equal(
        shown.actions, record(Counting(), worlds, slip=neighbour_slip(0.4)).actions
    )


def test_a_slipping_expert_shows_what_was_executed():
    worlds = random_worlds(10, 20, seed=2)
    shown = demonstrate(worlds, slip=neighbour_slip(0.3))
    same = shown.trajectory[1:] == shown.trajectory[:-1]
    decided = same & (shown.actions[:-1] < 5) & ~shown.sensing.safe[:-1]
    assert np.array_equal(
        actions_from_poses(shown.poses[:-1], shown.poses[1:])[decided],
        shown.actions[:-1][decided],
    )
    commands = REFLEX(shown.sensing, shown.speed)
    assert np.array_equal(shown.actions[commands >= 0], commands[commands >= 0])


def test_intended_actions_are_recorded_on_request():
    worlds, slip = random_worlds(6, 20, seed=2), neighbour_slip(0.3)
    executed = record(ComputerExpert(), worlds, slip=slip)
    intended = record(ComputerExpert(), worlds, slip=slip, intended=True)
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
    """Anew in every moment: where they stood when a plan was made says little."""

    expert = Counting()
    shown = record(expert, random_worlds(6, 5, 5, seed=6))
    assert (shown.outcome == "arrived").mean() > 0.6
    assert expert.plans == (REFLEX(shown.sensing, shown.speed) < 0).sum()


def test_steps_in_safe_states_are_not_learned_from():
    """Not even where, without a reflex, one of the five actions was taken."""
    shown = record(ComputerExpert(), random_worlds(3, 10, seed=7), reflex=None)
    assert (shown.actions < 5).all()
    assert shown.sensing.safe.sum() > 30
    assert not shown.effective.sensing.safe.any()
    assert len(shown.effective) == (~shown.sensing.safe).sum()


def test_out_of_steps():
    shown = record(
        lambda simulator, asked: np.full(len(asked), Action.R60),
        random_worlds(2, 0, seed=1),
        reflex=None,
        max_steps=7,
    )
    assert shown.outcome.tolist() == ["out of steps"] * 2
    assert shown.lengths.tolist() == [7, 7]


def test_no_worlds_no_steps():
    shown = demonstrate(random_worlds(0, 5, seed=1))
    assert len(shown) == 0
    assert len(shown.effective) == 0


def broken(shown, **changed):
    values = {
        name: getattr(shown, name) for name in Demonstrations.__dataclass_fields__
    }
    return Demonstrations(**(values | changed))


def test_what_does_not_fit_is_refused(shown):
    for changed, message in [
        ({"actions": shown.actions[1:]}, "demonstrations: actions must have shape"),
        (
            {"actions": shown.actions + 5},
            "demonstrations: actions must lie in 0..6, got",
        ),
        (
            {"trajectory": shown.trajectory[::-1]},
            "demonstrations: trajectory must ascend",
        ),
        (
            {"trajectory": shown.trajectory + 1},
            "demonstrations: trajectory must lie in 0..7",
        ),
        ({"speed": 0}, "demonstrations: speed must be greater than 0"),
        (
            {"outcome": np.full(8, "lost")},
            "demonstrations: outcome must be one of arrived",
        ),
        (
            {"poses": np.full_like(shown.poses, np.nan)},
            "demonstrations: poses must hold finite numbers",
        ),
    ]:
        with pytest.raises(ValueError, match=message):
            broken(shown, **changed)
    with pytest.raises(ValueError, match="margin must be at least 1"):
        demonstrate(shown.worlds, margin=0.5)
    with pytest.raises(ValueError, match="speed must be greater than 0"):
        demonstrate(shown.worlds, speed=0)


def test_sensing_is_raw(shown):
    rows = np.flatnonzero(shown.trajectory == 2)
    worlds = concatenate([shown.worlds[2]] * len(rows))
    assert np.array_equal(
        sense(worlds, shown.poses[rows]).ranges, shown.sensing.ranges[rows]
    )


def test_a_world_without_a_way_is_named():
    walled = make_world(rectangles=[(50, 50, 6, 96, 0)])
    with pytest.raises(
        ValueError,
        match=r"worlds\[1\] must have a path from start to target at 2 m/s, and has none",
    ):
        demonstrate(concatenate([make_world(), walled]))


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
