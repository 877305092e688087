"""Algorithm 3: from demonstrations to a policy."""

import re
from dataclasses import replace
from pathlib import Path
from textwrap import dedent
from typing import Any

import numpy as np
import pytest

from robonav.lfd import (
    behaviour_cloning,
    dagger,
    demonstrate,
    demonstrate_by_hand,
    labelled_states,
    learn_neighbours,
    learn_policy,
    save_demonstrations,
    sketch,
)
from robonav.networks import NetworkPolicy, random_network
from robonav.robot import Encoder, Sensing, lfd_state, navigate, random_worlds, straight


@pytest.fixture(scope="module")
def demonstrations():
    return demonstrate(random_worlds(25, 10, seed=41))


@pytest.fixture(scope="module")
def policy(demonstrations):
    return learn_policy(demonstrations, seed=1)


def test_examples_are_the_effective_pairs(demonstrations):
    x, y = labelled_states(demonstrations, Encoder(target="number"))
    assert x.shape == (len(demonstrations.effective), 11)
    assert np.allclose(
        x * np.array([7] * 9 + [9, 1]), lfd_state(demonstrations.effective.sensing)
    )
    assert (y.sum(axis=1) == 1).all()
    assert np.array_equal(y.argmax(axis=1), demonstrations.effective.actions)


def test_learning_beats_going_straight(policy):
    unseen = random_worlds(200, 10, seed=42)
    learned, baseline = (
        navigate(policy, unseen).success.mean(),
        navigate(straight, unseen).success.mean(),
    )
    assert learned > 0.9
    assert learned > baseline + 0.3


@pytest.mark.slow
def test_a_policy_learned_twice_with_one_seed_is_equal(demonstrations, policy):
    again, other = (
        learn_policy(demonstrations, seed=1),
        learn_policy(demonstrations, seed=2),
    )
    for mine, same, different in zip(
        policy.network.weights,
        again.network.weights,
        other.network.weights,
        strict=True,
    ):
        assert np.array_equal(mine, same)
        assert not np.array_equal(mine, different)


def test_the_thesis_network(demonstrations):
    assert learn_policy(
        demonstrations, iterations=2, encoder=Encoder(target="number")
    ).network.sizes == (11, 8, 5)


def test_strongest_output_is_taken(policy, demonstrations):
    sensing = demonstrations.effective.sensing
    actions = policy(sensing, np.random.default_rng(0))
    assert np.array_equal(actions, policy.logits(sensing).argmax(axis=1))
    assert actions.dtype == np.int64
    assert len(policy(sensing[:0], np.random.default_rng(0))) == 0


def test_saturated_outputs_still_differ():
    network = random_network((12, 5), seed=0)
    loud = NetworkPolicy(
        type(network)(tuple(1e4 * w for w in network.weights), (np.zeros(5),))
    )
    ranges = np.random.default_rng(3).uniform(1, 9, (50, 9))
    sensing = Sensing(
        ranges, np.zeros((50, 9), bool), np.full(50, 1), np.zeros(50, bool)
    )
    assert len(set(loud(sensing, np.random.default_rng(0)))) > 1


def test_a_network_that_does_not_fit_is_refused():
    with pytest.raises(ValueError, match="network must have 12 inputs"):
        NetworkPolicy(random_network((11, 8, 5), seed=0))


def test_nothing_to_learn_from():
    with pytest.raises(ValueError, match="must hold an effective pair"):
        learn_policy(demonstrate(random_worlds(0, 5, seed=1)))


@pytest.mark.parametrize(
    "learn",
    [
        labelled_states,
        learn_policy,
        behaviour_cloning,
        learn_neighbours,
        lambda demonstrations: dagger(demonstrations, []),
    ],
)
def test_only_demonstrations_are_learned_from(learn):
    with pytest.raises(
        TypeError, match="demonstrations must be Demonstrations, got str"
    ):
        learn("x")


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        (
            {"iterations": 10**9},
            ValueError,
            "iterations must be at most 100000, got 1000000000",
        ),
        ({"iterations": 2.5}, TypeError, "iterations must be a whole number, got 2.5"),
        ({"hidden": 0}, ValueError, "hidden must be at least 1"),
        ({"hidden": "x"}, TypeError, "hidden must be a whole number, got 'x'"),
        ({"encoder": "number"}, TypeError, "encoder must be Encoder, got str"),
        ({"seed": "x"}, TypeError, "seed must be a whole number"),
        ({"regularisation": -1}, ValueError, "regularisation must be at least 0"),
    ],
)
@pytest.mark.parametrize("learn", [learn_policy, behaviour_cloning])
def test_wrong_arguments_get_a_sentence(demonstrations, learn, options, error, message):
    with pytest.raises(error, match=message):
        learn(demonstrations, **options)


def test_wrong_types_at_the_other_doors(tmp_path):
    with pytest.raises(TypeError, match="worlds must be Worlds, got str"):
        sketch("x", seed=1)
    with pytest.raises(TypeError, match="worlds must be Worlds, got str"):
        demonstrate_by_hand("x", [])
    with pytest.raises(
        TypeError, match="demonstrations must be Demonstrations, got str"
    ):
        save_demonstrations(tmp_path / "d.npz", "x")
    assert not list(tmp_path.iterdir())


def test_behaviour_cloning_and_learn_policy():
    demonstrations = demonstrate(random_worlds(3, 10, seed=4))
    one = behaviour_cloning(demonstrations, iterations=20, seed=5).network
    other = learn_policy(demonstrations, iterations=20, seed=5).network
    assert all(map(np.array_equal, one.weights, other.weights))


@pytest.mark.slow
def test_the_python_of_the_playground_trains_a_robot_that_drives(tmp_path, monkeypatch):
    page = (Path(__file__).parents[3] / "book/playground.md").read_text("utf-8")
    code = [
        dedent(cell) for cell in re.findall(r" *```python\n(.*?)```", page, re.DOTALL)
    ]
    monkeypatch.chdir(tmp_path)
    demonstrations = demonstrate(random_worlds(4, 10, seed=3))
    outcome = np.array(["arrived", "arrived", "arrived", "collided"])
    save_demonstrations(
        "my-demonstrations.npz", replace(demonstrations, outcome=outcome)
    )
    names: dict[str, Any] = {}
    for cell in code:
        exec(cell, names)
    assert len(code) == 3
    assert len(names["mine"].worlds) == 3
    worlds = random_worlds(300, 10, seed=4)
    rate = navigate(names["policy"], worlds).success.mean()
    assert rate > navigate(straight, worlds).success.mean() + 0.3
    assert names["longer"].costs[-1] < names["longer"].costs[0]
