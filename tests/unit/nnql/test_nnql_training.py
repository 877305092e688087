"""Whole trainings: seeds that do not hear of one another, interrupted ones, bad arguments, curves that rise."""

import dataclasses
import json

import numpy as np
import pytest

from robonav.nnql import METHODS, STARTS, TARGETS, NavigationTask, train, weight_changes
from robonav.nnql._fast.checkpoints import load_checkpoint
from robonav.nnql._fast.networks import BatchedNetworks
from robonav.robot import NNQL_SENSORS, Encoder, navigate, random_worlds

SMALL = {
    "nnql": {},
    "online": {},
    "nfq": {"episodes_per_fit": 4, "sweeps": 2, "epochs": 15},
    "dqn": {"batch_size": 8, "target_update_interval": 30},
}


def same(one, other, row, other_row):
    """Whether two trainings agree in a row, to the last bit."""
    np.testing.assert_array_equal(one.outcomes[row], other.outcomes[other_row])
    np.testing.assert_array_equal(one.steps[row], other.steps[other_row])
    np.testing.assert_array_equal(one.returns[row], other.returns[other_row])
    for mine, theirs in zip(
        (*one.network.weights, *one.network.biases),
        (*other.network.weights, *other.network.biases),
        strict=True,
    ):
        np.testing.assert_array_equal(mine[row], theirs[other_row])


@pytest.mark.parametrize(("method", "pairs"), [("nnql", 30), ("online", 1)])
def test_nnql_trains_on_the_whole_episode_and_online_learning_on_its_latest_step(
    method, pairs, monkeypatch
):
    trained_on, sgd = [], BatchedNetworks.sgd

    def watched(networks, rows, x, y, first, last, **options):
        trained_on.extend(zip(first.tolist(), last.tolist(), strict=True))
        sgd(networks, rows, x, y, first, last, **options)

    monkeypatch.setattr(BatchedNetworks, "sgd", watched)
    training = train(method, seeds=1, episodes=4, task=NavigationTask(max_steps=30))
    expected = [
        (max(k - pairs, 0), k) for n in training.decisions[0] for k in range(1, n + 1)
    ]
    assert trained_on == expected
    assert training.decisions.max() > 5


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_seeds_together_are_seeds_apart(method):
    together = train(method, seeds=[4, 0, 9], episodes=12, **SMALL[method])
    for row, seed in enumerate((4, 0, 9)):
        same(
            together, train(method, seeds=[seed], episodes=12, **SMALL[method]), row, 0
        )


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_an_interrupted_training_ends_as_one_that_was_not(method, tmp_path):
    path, whole = (
        tmp_path / "training",
        train(method, seeds=3, episodes=13, **SMALL[method]),
    )

    def interrupt(done, total):
        if done > total / 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        train(
            method,
            seeds=3,
            episodes=13,
            checkpoint=path,
            checkpoint_interval=4,
            progress=interrupt,
            **SMALL[method],
        )
    counted = []
    resumed = train(
        method, seeds=3, episodes=13, checkpoint=path, checkpoint_interval=4,
        progress=lambda done, total: counted.append((done, total)), **SMALL[method],
    )  # fmt: skip
    assert counted[0][0] >= 3 * 4  # it did not begin again
    assert counted[-1] == (39, 39)
    for row in range(3):
        same(resumed, whole, row, row)
    finished = train(
        method,
        seeds=3,
        episodes=13,
        checkpoint=path,
        checkpoint_interval=4,
        **SMALL[method],
    )
    same(finished, whole, 0, 0)


def test_a_checkpoint_of_another_training_is_refused(tmp_path):
    path = tmp_path / "training"
    train("nnql", 2, 4, checkpoint=path)
    for other in (
        {"discount": 0.8},
        {"task": NavigationTask(obstacles=20)},
        {"task": NavigationTask(reward=lambda b, a, o: 0 * o)},
    ):
        with pytest.raises(
            ValueError,
            match="training belongs to a training with other seeds, settings or task",
        ):
            train("nnql", 2, 4, checkpoint=path, **other)
    with pytest.raises(ValueError, match="belongs to a training with other"):
        train("nnql", 3, 4, checkpoint=path)


def test_an_encoder_of_another_kind_is_another_training(tmp_path):
    class Rounded(Encoder):
        def __call__(self, sensing):
            return super().__call__(sensing).round(1)

    path, kind = tmp_path / "training", (NNQL_SENSORS, True, "number")
    train("nnql", 2, 4, checkpoint=path, task=NavigationTask(encoder=Encoder(*kind)))
    with pytest.raises(ValueError, match="belongs to a training with other"):
        train(
            "nnql", 2, 4, checkpoint=path, task=NavigationTask(encoder=Rounded(*kind))
        )


def test_rewards_that_differ_only_in_a_number_are_other_trainings(tmp_path):
    def paying(row):
        return lambda before, after, outcome: row[outcome]

    path, rows = tmp_path / "training", np.eye(4)
    train("nnql", 2, 4, checkpoint=path, task=NavigationTask(reward=paying(rows[1])))
    train(
        "nnql",
        2,
        4,
        checkpoint=path,
        task=NavigationTask(reward=paying(rows[1].copy())),
    )
    with pytest.raises(ValueError, match="belongs to a training with other"):
        train(
            "nnql", 2, 4, checkpoint=path, task=NavigationTask(reward=paying(rows[2]))
        )


def test_a_checkpoint_of_another_version_or_a_torn_one_is_refused(
    tmp_path, monkeypatch
):
    path = tmp_path / "training"
    train("nnql", 2, 4, checkpoint=path)
    monkeypatch.setattr("robonav.nnql._fast.checkpoints.__version__", "9.9")
    with pytest.raises(ValueError, match=r"was written by robonav .*, expected 9\.9"):
        train("nnql", 2, 4, checkpoint=path)
    monkeypatch.undo()
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(ValueError, match="training is not a whole checkpoint"):
        train("nnql", 2, 4, checkpoint=path)
    path.write_text(json.dumps({}))
    with pytest.raises(ValueError, match="training is not a whole checkpoint"):
        train("nnql", 2, 4, checkpoint=path)
    assert load_checkpoint(tmp_path / "none", {}, None, None) == 0


@pytest.mark.slow
def test_a_short_training_learns_and_its_curve_rises():
    training = train("nnql", 4, 120)
    curve = training.successes.reshape(4, 4, 30).mean(axis=(0, 2))
    assert curve[-1] > curve[0] + 0.3
    assert curve[-1] > 0.75
    worlds = random_worlds(200, seed=7, starts=STARTS, targets=TARGETS)
    rates = [
        navigate(policy, worlds, 2.5, 400).success.mean()
        for policy in training.policies
    ]
    assert np.mean(rates) > 0.85


def test_history_and_paths_when_asked_for():
    training = train("nnql", 2, 6, record=True)
    assert training.history.stack == (2, 7)
    same_end = training.history.weights[0][:, -1] == training.network.weights[0]
    assert same_end.all()
    assert (
        training.history.weights[0][:, 0] != training.history.weights[0][:, -1]
    ).any()
    for row in range(2):
        assert [len(path) - 1 for path in training.paths[row]] == training.steps[
            row
        ].tolist()
    same(training, train("nnql", 2, 6), 1, 1)


def test_the_training_of_one_seed():
    training = train("nnql", 3, 4, record=True)
    own = training[2]
    assert own.seeds == (2,)
    same(own, training, 0, 2)
    same(own, train("nnql", [2], 4), 0, 0)
    assert own.history.stack == (1, 5)
    assert own.paths == training.paths[2:]
    assert len(own.policies) == 1
    assert train("nnql", 2, 4)[0].history is None
    with pytest.raises(IndexError, match="row must be 0 to 2, got 3"):
        training[3]


def test_weight_changes_add_up_over_a_training():
    training = train("nnql", 2, 6, record=True)
    signed, absolute = (
        weight_changes(training.history, absolute=kind) for kind in (False, True)
    )
    assert signed.shape == absolute.shape == (2, 6, 2)
    for layer in range(2):
        w, b = training.history.weights[layer], training.history.biases[layer]
        whole = (w[:, -1] - w[:, 0]).sum(axis=(1, 2)) + (b[:, -1] - b[:, 0]).sum(axis=1)
        np.testing.assert_allclose(signed[:, :, layer].sum(axis=1), whole)
    assert (absolute >= np.abs(signed)).all()


def test_episodes_have_their_bounds_and_their_decisions():
    training = train("nnql", 3, 20, task=NavigationTask(max_steps=60))
    assert training.steps.max() <= 60
    assert (training.decisions <= training.steps).all()
    late = training.outcomes == "out of steps"
    assert (training.steps[late] == 60).all()
    assert set(np.unique(training.outcomes)) <= {"arrived", "collided", "out of steps"}


def test_worlds_of_training_never_meet_those_of_a_table():
    task = NavigationTask()
    practised = task.worlds([0, 1, 7], 0, 50)
    assert len({tuple(key) for key in practised.keys}) == 150
    np.testing.assert_array_equal(
        task.worlds([7], 0, 90).keys[:50], practised.keys[100:]
    )
    np.testing.assert_array_equal(task.worlds([7], 20, 50).keys, practised.keys[120:])
    asked = {
        tuple(key) for seed in range(200) for key in random_worlds(1, seed=seed).keys
    }
    assert not asked & {tuple(key) for key in practised.keys}


def test_every_encoding_trains():
    for target in ("number", "signed", "one-hot", "sine-cosine"):
        encoder = Encoder(NNQL_SENSORS, walls=True, target=target)
        training = train("nnql", 1, 2, task=NavigationTask(encoder=encoder))
        assert training.network.sizes == (encoder.size, 8, 5)
        assert training.policies[0].encoder == encoder
    assert train(
        "nnql", 1, 2, task=NavigationTask(encoder=Encoder(NNQL_SENSORS, True, "number"))
    ).network.sizes == (16, 8, 5)


def test_moving_obstacles_and_another_reward():
    task = NavigationTask(
        obstacles=5,
        moving=5,
        reward=lambda before, after, outcome: np.full(len(outcome), 0.5),
    )
    training = train("nnql", 2, 5, task=task)
    np.testing.assert_array_equal(training.returns, 0.5 * training.decisions)
    assert training.returns.max() > 0.5


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (
            {"method": "sarsa"},
            "method must be one of nnql, online, nfq, dqn, got 'sarsa'",
        ),
        ({"seeds": 0}, "seeds must be at least 1, got 0"),
        ({"seeds": [1, 1]}, "seeds must be at least one, and all different"),
        ({"seeds": []}, "seeds must be at least one"),
        ({"seeds": [0.5]}, "seeds must be a whole number"),
        ({"episodes": 0}, "episodes must be at least 1"),
        (
            {"learning_rate": 1.5},
            "learning_rate must be greater than 0 and at most 1, got 1.5",
        ),
        ({"discount": -0.1}, "discount must be at least 0"),
        ({"gradient_step": 0}, "gradient_step must be greater than 0"),
        ({"temperature": (0.9, 0)}, "temperature must be greater than 0, got 0"),
        ({"rescale": "squash"}, "rescale must be one of clip, shift, got 'squash'"),
        ({"passes": 0}, "passes must be at least 1"),
        ({"hidden": 0}, "hidden must be at least 1"),
        ({"checkpoint_interval": 0}, "checkpoint_interval must be at least 1"),
        ({"device": "abacus"}, "nnql takes the settings .*, got device"),
        (
            {"method": "dqn", "gradient_step": (0.1, 0.2)},
            "gradient_step must be a number",
        ),
        ({"record": True, "checkpoint": "x"}, "record must be False with a checkpoint"),
        (
            {"method": "nfq", "episodes_per_fit": 0},
            "episodes_per_fit must be at least 1",
        ),
        ({"method": "dqn", "batch_size": 0}, "batch_size must be at least 1"),
        (
            {"method": "dqn", "targets": max},
            "targets must be dqn_targets or double_dqn_targets in fast training",
        ),
    ],
)
def test_a_wrong_argument_gets_one_clear_sentence(wrong, message):
    with pytest.raises((ValueError, TypeError), match=message):
        train(**{"seeds": 1, "episodes": 1, **wrong})


def test_a_course_is_checked():
    with pytest.raises(ValueError, match="speed must be greater than 0"):
        NavigationTask(speed=0)
    with pytest.raises(ValueError, match="max_steps must be at least 1"):
        dataclasses.replace(NavigationTask(), max_steps=0)
