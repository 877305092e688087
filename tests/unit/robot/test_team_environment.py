"""The PettingZoo environment: PettingZoo's own tests, one robot alone, and the simulator behind it."""

from __future__ import annotations

import subprocess
import sys
import warnings

import numpy as np
import pytest
from pettingzoo.test import api_test, parallel_api_test, parallel_seed_test, seed_test
from pettingzoo.utils.conversions import parallel_to_aec

from robonav.robot import Action, Outcome, make_world
from robonav.robot.environments import NavigationEnv
from robonav.robot.team import (
    TeamEnv,
    Teams,
    TeamSimulator,
    parallel_env,
    random_teams,
)


@pytest.fixture
def two() -> Teams:
    """Two robots that go towards each other on a map without obstacles."""
    return Teams(make_world(), [[(47, 50), (53, 50)]], [[(80, 50), (20, 50)]])


@pytest.mark.parametrize("settings", [{}, {"robots": 16, "moving": 2}, {"robots": 1}])
def test_pettingzoo_finds_no_fault(settings):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parallel_api_test(TeamEnv(**settings), num_cycles=300)


def test_pettingzoo_finds_no_fault_one_agent_after_another():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for dictionary in ("Observation is not a NumPy", "Observation space for each"):
            warnings.filterwarnings("ignore", dictionary)  # it is one, as alone
        api_test(parallel_to_aec(TeamEnv(robots=3)), num_cycles=300)


def test_equal_seeds_give_equal_episodes():
    parallel_seed_test(lambda: parallel_env(robots=5, noise=0.1, moving=2), 100)
    seed_test(lambda: parallel_to_aec(TeamEnv(robots=3)), 60)


def same(one, other):
    assert one.keys() == other.keys()
    for key in one:
        np.testing.assert_array_equal(one[key], other[key], err_msg=key)
        assert np.asarray(one[key]).dtype == np.asarray(other[key]).dtype, key


@pytest.mark.parametrize("reflex", ["exact", None])
def test_one_robot_is_the_environment_of_one_robot(reflex):
    """Observations, rewards, ends and infos of whole episodes, to the last bit, for the same seeds."""
    settings = {"obstacles": 15, "moving": 3, "noise": 0.1, "reflex": reflex}
    team, alone = TeamEnv(robots=1, **settings), NavigationEnv(max_episode_steps=500, **settings)  # fmt: skip
    assert team.observation_space("robot_0") == alone.observation_space
    assert team.action_space("robot_0") == alone.action_space
    rng, outcomes = np.random.default_rng(0), set()
    for seed in [3, None, None, 4]:  # without a seed, the next map of the same stream
        observations, infos = team.reset(seed=seed)
        observation, info = alone.reset(seed=seed)
        while team.agents:
            same(observations["robot_0"], observation)
            assert not infos["robot_0"].pop("met")
            same(infos["robot_0"], info)
            ahead = observation["ranges"][0] > 5
            action = 0 if ahead else int(rng.choice([Action.L60, Action.R60]))
            observations, *ours, infos = team.step({"robot_0": action})
            observation, *rest, info = alone.step(action)
            assert [each["robot_0"] for each in ours] == rest
        outcomes.add(info["outcome"])
    assert Outcome.RUNNING not in outcomes


def test_robots_that_meet_are_told_so(two):
    env = TeamEnv(robots=2)
    observations, infos = env.reset(options={"teams": two})
    assert observations["robot_0"]["ranges"][0] == 5  # 6 m less the other's radius
    assert infos["robot_1"]["pose"].tolist() == [53, 50, np.pi]
    _, rewards, *_ = env.step({"robot_0": 0, "robot_1": 0})
    assert rewards == {"robot_0": 0, "robot_1": 0}
    _, rewards, terminations, truncations, infos = env.step({"robot_0": 0, "robot_1": 0})  # fmt: skip
    assert rewards == {"robot_0": -1, "robot_1": -1}
    assert terminations == {"robot_0": True, "robot_1": True}
    assert truncations == {"robot_0": False, "robot_1": False}
    assert [info["met"] for info in infos.values()] == [True, True]
    assert env.agents == []


def test_who_has_ended_is_no_agent_any_more_and_the_others_go_on():
    """The first arrives in its first second; the second is told what the simulator says."""
    teams = Teams(make_world(), [[(20, 20), (20, 80)]], [[(24, 20), (80, 80)]])
    env, simulator = TeamEnv(robots=2), TeamSimulator(teams)
    env.reset(options={"teams": teams})
    _, rewards, terminations, _, infos = env.step({"robot_0": 0, "robot_1": 0})
    assert rewards == {"robot_0": 1, "robot_1": 0}
    assert terminations == {"robot_0": True, "robot_1": False}
    assert infos["robot_0"]["outcome"] == Outcome.ARRIVED
    assert env.agents == ["robot_1"]
    observations, *_, infos = env.step({"robot_1": 0, "robot_0": 3})
    assert list(observations) == list(infos) == ["robot_1"]
    simulator.step(np.array([7, 7]))
    simulator.step(np.array([7]), np.array([1]))
    np.testing.assert_array_equal(infos["robot_1"]["pose"], simulator.poses[1])
    assert infos["robot_1"]["reflex"] == Action.TO_SECTOR


def test_the_limit_of_steps_truncates():
    env = TeamEnv(robots=2, obstacles=0, max_episode_steps=3)
    env.reset(seed=0)
    for _ in range(3):
        *_, terminations, truncations, infos = env.step(dict.fromkeys(env.agents, 0))
    assert truncations == {"robot_0": True, "robot_1": True}
    assert terminations == {"robot_0": False, "robot_1": False}
    assert infos["robot_0"]["outcome"] == Outcome.OUT_OF_STEPS
    assert env.agents == []


def test_a_reward_is_each_robots_own(two):
    def nearer(before, after, outcome):
        assert len(before) == len(after) == len(outcome)
        return before.ranges[:, 0] - after.ranges[:, 0]

    env = TeamEnv(robots=2, reward=nearer, reflex=None)
    env.reset(options={"teams": two})
    _, rewards, *_ = env.step({"robot_0": Action.F, "robot_1": Action.F})
    assert rewards == {"robot_0": 4, "robot_1": 4}


def test_a_picture_has_every_robot_that_is_running(two):
    env = TeamEnv(robots=2, render_mode="rgb_array")
    env.reset(options={"teams": two})
    both = env.render()
    assert both.shape == (480, 480, 3)
    assert both.dtype == np.uint8
    for _ in range(2):
        env.step({"robot_0": 0, "robot_1": 0})
    assert (both != env.render()).any()
    assert TeamEnv(robots=2).render() is None
    env.close()


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: TeamEnv(robots=0), ValueError, "robots must be at least 1"),
        (lambda: TeamEnv(speed=-1), ValueError, "speed must be greater than 0"),
        (lambda: TeamEnv(render_mode="human"), ValueError, "render_mode"),
        (lambda: TeamEnv(robots=2, starts=[(10, 10)]).reset(), ValueError, "one point for each robot"),
        (
            lambda: TeamEnv(robots=2).reset(options={"teams": random_teams(2, 2, seed=0)}),
            ValueError,
            "one map with 2 robots, got 2 with 2",
        ),
    ],
)  # fmt: skip
def test_a_wrong_setting_gets_one_clear_sentence(call, error, message):
    with pytest.raises(error, match=message):
        call()


def test_a_wrong_action_gets_one_clear_sentence():
    env = TeamEnv(robots=2)
    env.reset(seed=0)
    with pytest.raises(ValueError, match="robot_1 missing"):
        env.step({"robot_0": 0})
    with pytest.raises(ValueError, match="0 to 5"):
        env.step({"robot_0": 0, "robot_1": 6})


@pytest.mark.slow
def test_teams_load_without_pettingzoo():
    """It is an extra. The simulator does not need it, and says so where something does."""
    code = (
        "import sys; sys.modules['pettingzoo'] = None\n"
        "from robonav.robot import team\n"
        "team.random_teams(1, 2, seed=0)\n"
        "try: team.TeamEnv\n"
        "except ImportError as error: print(error.name)\n"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)  # fmt: skip
    assert run.stdout == "pettingzoo\n"
