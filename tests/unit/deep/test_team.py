"""Robots that learn together: what each robot learns from, and a short training."""

import numpy as np
import pytest

from robonav.deep import train_team
from robonav.deep.episodes import act_together
from robonav.networks import NetworkPolicy, random_network
from robonav.robot import REFLEX, Encoder, Outcome
from robonav.robot.team import TeamSimulator, random_teams

ENCODER = Encoder()


@pytest.fixture(scope="module")
def acted():
    """A simulator of three teams of five after their episodes, and the rollouts of their robots."""
    policy = NetworkPolicy(
        random_network((ENCODER.size, 8, 5), seed=1), temperature=1.0
    )
    simulator = TeamSimulator(random_teams(3, 5, 8, seed=2), max_steps=40)
    rng = np.random.default_rng(3)
    return simulator, act_together(simulator, policy, REFLEX, rng)


def test_each_robot_is_an_actor_with_all_its_steps(acted):
    simulator, rollouts = acted
    assert [len(own.rewards) for own in rollouts] == simulator.steps.tolist()
    for own in rollouts:
        np.testing.assert_array_equal(own.next_states[:-1], own.states[1:])


def test_episodes_end_as_the_simulator_says(acted):
    simulator, rollouts = acted
    found = set()
    for outcome, own in zip(simulator.outcome, rollouts, strict=True):
        found.add(int(outcome))
        assert own.ended.tolist() == [False] * (len(own.ended) - 1) + [True]
        assert not own.terminal[:-1].any()
        assert bool(own.terminal[-1]) == (outcome != Outcome.OUT_OF_STEPS)
        wanted = {Outcome.ARRIVED: 1, Outcome.COLLIDED: -1}.get(outcome, 0)
        assert own.rewards.sum() == own.rewards[-1] == wanted
    assert {Outcome.COLLIDED, Outcome.OUT_OF_STEPS} <= found


def test_where_the_reflex_acted_the_policy_did_not_decide(acted):
    """Nothing is in range at the start of these maps, so that the reflex makes the first step."""
    simulator, rollouts = acted
    first = TeamSimulator(simulator.teams).sense()
    for safe, own in zip(first.safe, rollouts, strict=True):
        assert bool(own.decided[0]) == (not safe)
        assert own.decided.any()
        assert own.actions.min() >= 0
        assert own.actions.max() <= 4


def test_a_seed_gives_a_training():
    one, again, other = (train_team(2, 2, n_worlds=2, seed=seed) for seed in (4, 4, 5))
    for name in ("policy", "value"):
        ours, same = getattr(one.networks, name), getattr(again.networks, name)
        for weights, equal in zip(ours.weights, same.weights, strict=True):
            np.testing.assert_array_equal(weights, equal)
    assert (one.networks.policy.weights[0] != other.networks.policy.weights[0]).any()
    np.testing.assert_array_equal(one.arrived, again.arrived)


@pytest.mark.slow
def test_a_team_learns():
    learned = train_team(4, 14, n_worlds=8, obstacles=4, seed=0)
    assert learned.arrived[:2].mean() < 0.4
    assert learned.arrived[-3:].mean() > 0.7
    assert len(learned.steps) == 14
    assert learned.policy.temperature == 1.0


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"robots": 0}, "robots must be at least 1"),
        ({"n_worlds": 0}, "n_worlds must be at least 1"),
        ({"clip": 2}, "clip must be"),
        ({"speed": 0}, "speed must be greater than 0"),
    ],
)
def test_a_wrong_setting_gets_one_clear_sentence(settings, message):
    with pytest.raises(ValueError, match=message):
        train_team(updates=1, seed=0, **settings)
