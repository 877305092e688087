"""DAgger with a sensor, and randomised worlds."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from robonav.lfd import ComputerExpert
from robonav.robot import (
    REFLEX,
    Outcome,
    Simulator,
    navigate,
    neighbour_slip,
    random_worlds,
    straight,
)
from robonav.sensing import (
    Picture,
    Ring,
    SensorPolicy,
    dagger_with_sensor,
    fully_connected,
    labelled_examples,
    picture_network,
    randomised_simulators,
    ring_network,
)


def untrained(sensor=None, seed=0, temperature=0.3):
    sensor = sensor or Ring(18)
    make = ring_network if isinstance(sensor, Ring) else picture_network
    return SensorPolicy(sensor, make(sensor, seed=seed), temperature)


def rounds_of(n, worlds=4):
    return [Simulator(random_worlds(worlds, 20, seed=50 + i), max_steps=100) for i in range(n)]  # fmt: skip


@pytest.mark.slow
def test_few_rounds_teach_to_go_round_obstacles():
    policy = SensorPolicy(Ring(36), fully_connected(Ring(36), seed=0), 0.3)
    worlds = random_worlds(60, 20, seed=9)
    before = navigate(straight, worlds, max_steps=200).success.mean()
    trained = dagger_with_sensor(policy, rounds_of(4, 6), reflex=REFLEX, seed=0)
    after = navigate(trained, worlds, max_steps=200).success.mean()
    assert before < 0.4
    assert after > 0.8


@pytest.mark.slow
@pytest.mark.parametrize("sensor", [Ring(9), Picture(16)])
def test_a_seed_gives_the_same_network_again(sensor):
    trained = [
        dagger_with_sensor(untrained(sensor), rounds_of(2, 2), reflex=REFLEX, steps=4, seed=seed)
        for seed in (0, 0, 1)
    ]  # fmt: skip
    first, again, other = (next(policy.network.head.parameters()) for policy in trained)
    assert torch.equal(first, again)
    assert not torch.equal(first, other)


@pytest.mark.parametrize("expert_acts", [True, False])
def test_labels_are_the_experts_whoever_acts(expert_acts):
    asked = []

    class Recorded(ComputerExpert):
        def __call__(self, simulator, robots):
            actions = super().__call__(simulator, robots)
            asked.extend(actions.tolist())
            return actions

    (simulator,), rng = rounds_of(1), np.random.default_rng(0)
    seen = labelled_examples(simulator, untrained(), Recorded(), expert_acts, rng, REFLEX)  # fmt: skip
    assert seen.labels.tolist() == asked
    assert len(seen) == len(seen.readings) == len(seen.targets) > 0
    arrived = (simulator.outcome == Outcome.ARRIVED).all()
    assert arrived == expert_acts  # an untrained learner does not


def test_the_expert_acts_in_the_first_round_alone():
    rounds, (alone,) = rounds_of(2), rounds_of(1)
    dagger_with_sensor(untrained(), rounds, reflex=REFLEX, steps=0, seed=0)
    rng = np.random.default_rng(0)
    labelled_examples(alone, untrained(), ComputerExpert(), True, rng, REFLEX)
    assert np.array_equal(rounds[0].poses, alone.poses)
    assert (rounds[0].outcome == Outcome.ARRIVED).all()
    assert (rounds[1].outcome != Outcome.ARRIVED).any()


def test_readings_are_those_of_the_states_in_which_the_robot_was_asked():
    (simulator,) = rounds_of(1, 1)
    rng = np.random.default_rng(0)
    seen = labelled_examples(simulator, untrained(), ComputerExpert(), True, rng, REFLEX)  # fmt: skip
    assert (seen.readings.max(dim=1).values > 0).all()  # the reflex acts elsewhere
    assert set(seen.labels.tolist()) <= set(range(5))


def test_uncertainties_are_drawn_within_their_bounds():
    worlds = [random_worlds(2, seed=seed) for seed in range(30)]
    made = randomised_simulators(worlds, noise=0.8, slip=0.4, seed=3)
    noise = np.array([simulator.noise for simulator in made])
    slip = np.array([1 - simulator.slip[0, 0] for simulator in made])
    assert 0 <= noise.min() < 0.1
    assert 0.7 < noise.max() <= 0.8
    assert 0 <= slip.min() < 0.05
    assert 0.35 < slip.max() <= 0.4
    assert abs(np.corrcoef(noise, slip)[0, 1]) < 0.5
    again = randomised_simulators(worlds, noise=0.8, slip=0.4, seed=3)
    assert [simulator.noise for simulator in again] == noise.tolist()
    np.testing.assert_allclose(made[4].slip, neighbour_slip(slip[4]))


def test_without_uncertainty_nothing_is_off():
    worlds = [random_worlds(5, 10, seed=1)]
    (made,) = randomised_simulators(worlds, noise=0, slip=0, seed=0)
    assert made.noise == 0
    assert np.array_equal(made.slip, np.eye(6))


def test_a_policy_draws_its_actions_from_the_generator_alone():
    policy, worlds = untrained(temperature=5.0), random_worlds(10, 20, seed=2)
    ends = [navigate(policy, worlds, seed=seed, max_steps=60, record_paths=True) for seed in (1, 1, 2)]  # fmt: skip
    lengths = [np.concatenate(end.paths) for end in ends]
    assert np.array_equal(lengths[0], lengths[1])
    assert not np.array_equal(lengths[0], lengths[2])
