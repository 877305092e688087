"""Rewards that the kernel learns for the page: as Python's own functions learn them, reported step by step."""

from __future__ import annotations

import base64

import numpy as np
import pytest

from robonav.lfd import demonstrate, save_demonstrations
from robonav.nirl import learn
from robonav.robot import random_worlds, sense
from robonav.widgets.reward_learning import FILES, reward_learning
from robonav.widgets.simulator import page_demonstrations, page_world

DEMONSTRATIONS = demonstrate(random_worlds(3, 20, seed=3))
SETTINGS = {
    "iterations": 4, "obstacles": 20, "inverseTemperature": 25, "seed": 5, "hidden": 10,
}  # fmt: skip
REQUEST = {
    "ask": "train", "run": 1, "method": "nirl", "robots": 2, "set": 0, "demonstrations": None, "settings": SETTINGS,
}  # fmt: skip


@pytest.fixture
def widget():
    world = random_worlds(1, 20, seed=4)
    return reward_learning({"three": DEMONSTRATIONS}, world, {}, seed=55_000)


@pytest.fixture
def sent(tmp_path):
    """The demonstrations as the page sends them."""
    path = tmp_path / "demonstrations.npz"
    save_demonstrations(path, DEMONSTRATIONS)
    return base64.b64encode(path.read_bytes()).decode()


def answers_of(widget, message):
    answers = []
    widget.send = answers.append
    widget._answer(widget, message, [])
    widget._thread.join(timeout=120)
    return answers


@pytest.mark.slow
def test_robots_are_trained_as_learn_trains_them(widget):
    *told, last = answers_of(widget, REQUEST)
    expected = [learn(DEMONSTRATIONS, "nirl", 5 + k, iterations=4) for k in range(2)]
    live = [item for answer in told for item in answer.get("live", ())]
    assert [item["at"] for item in live] == [1, 2, 3, 4] * 2
    for measure, of in (("arrived", "arrived"), ("balanced", "balanced")):
        histories = [getattr(result.history, of)[-4:] for result in expected]
        np.testing.assert_allclose(
            [item[measure] for item in live], 100 * np.concatenate(histories)
        )
    assert told[-1]["done"] == told[-1]["total"] == 8
    for got, want in zip(widget.trainings, expected, strict=True):
        np.testing.assert_array_equal(got.reward_weights, want.reward_weights)
    scores = [result.history.balanced[result.chosen] for result in expected]
    best = expected[int(np.argmax(scores))]
    assert last["ended"]["theta"] == best.reward_weights.ravel().tolist()
    assert last["ended"]["sentence"].startswith("2 robots cross ")


@pytest.mark.parametrize(
    "method",
    [
        pytest.param("apprenticeship", marks=pytest.mark.slow),
        pytest.param("relative-entropy", marks=pytest.mark.slow),
        "scirl",
    ],
)
def test_other_methods_learn_from_the_demonstrations_of_the_reader(
    widget, sent, method
):
    message = REQUEST | {"method": method, "robots": 1, "demonstrations": sent}
    *told, last = answers_of(widget, message)
    assert "error" not in last, last
    (got,) = widget.trainings
    want = learn(DEMONSTRATIONS, method, 5, iterations=4)
    np.testing.assert_array_equal(got.reward_weights, want.reward_weights)
    assert any("live" in answer for answer in told)


def test_the_page_sends_demonstrations_as_the_file_that_it_saves(sent):
    got = page_demonstrations(sent)
    np.testing.assert_array_equal(got.actions, DEMONSTRATIONS.actions)
    np.testing.assert_array_equal(got.poses, DEMONSTRATIONS.poses)


@pytest.mark.parametrize(
    ("change", "error"),
    [
        ({"method": "none"}, "ValueError: method must be"),
        ({"robots": 0}, "ValueError: robots must be"),
        ({"settings": SETTINGS | {"iterations": 0}}, "ValueError: iterations must be"),
        (
            {"demonstrations": base64.b64encode(b"no").decode()},
            "ValueError: demonstrations.npz is",
        ),
    ],
)
def test_what_cannot_be_trained_gets_one_sentence(widget, change, error):
    (answer,) = answers_of(widget, REQUEST | change)
    assert answer["error"].startswith(error)


def test_the_map_draws_the_reward_of_what_the_robot_perceives(node):
    theta = np.random.default_rng(0).normal(size=(5, 18))
    world = random_worlds(1, 20, seed=4)
    body = """const cells = page.mapCells(data.world, page.NIRL_SETTINGS);
      const rewards = [0, 1, 2, 3, 4, -1].map((a) => page.rewardMap(data.theta, cells, a));
      return {
        inputs: cells.map(({ input }) => [...input]),
        rewards: rewards.map((map) => map.map(({ reward }) => reward)),
      };"""
    got = node(
        FILES, body, {"world": page_world(world), "theta": theta.ravel().tolist()}
    )
    inputs = np.array(got["inputs"])
    assert inputs.shape[1] == 17
    ticks = np.arange(1, 100, 2)
    x, y = (part.ravel() for part in np.meshgrid(ticks, ticks))
    heading = np.arctan2(world.targets[0, 1] - y, world.targets[0, 0] - x)
    seen = sense(world[np.zeros(len(x), int)], np.column_stack([x, y, heading]))
    assert len(inputs) == (~seen.safe & (seen.ranges.min(axis=1) >= 1)).sum()
    expected = theta @ np.column_stack([inputs, np.ones(len(inputs))]).T
    np.testing.assert_allclose(got["rewards"][:5], expected, atol=1e-12)
    np.testing.assert_allclose(got["rewards"][5], expected.max(axis=0), atol=1e-12)
