"""The reward lab's JavaScript under Node: rewards, and episodes that follow them, are Python's."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from robonav.lfd import demonstrate
from robonav.nirl import (
    ENCODER,
    decision_rewards,
    expert_decisions,
    scale_to_unit_interval,
)
from robonav.nirl.decisions import add_constant
from robonav.robot import Reflex, Simulator, navigate, random_worlds
from robonav.robot._fast import ARRIVED, COLLIDED, RUNNING
from robonav.widgets.reward_lab import reward_lab
from robonav.widgets.simulator import page_world

SPEED, DISCOUNT = 2.0, 0.9


@pytest.fixture(scope="module")
def decisions():
    return expert_decisions(demonstrate(random_worlds(6, 20, seed=3)))


@pytest.fixture(scope="module")
def theta(decisions):
    """Least squares on what the expert did: a reward that drives in some maps and not in others."""
    return np.linalg.lstsq(
        decisions.features, np.eye(5)[decisions.actions], rcond=None
    )[0].T


@pytest.fixture
def page(node):
    return partial(node, ("simulator", "maps", "reward_lab"))


def lab(decisions, theta, **changes):
    worlds, others = {"one": random_worlds(1, 20, seed=5)}, random_worlds(3, 20, seed=6)
    return reward_lab(
        **{"reward_weights": theta, "encoder": ENCODER, "decisions": decisions}
        | changes,
        worlds=worlds,
        others=others,
    )


def test_rewards_and_judgements_are_pythons(page, decisions, theta):
    data = lab(decisions, theta).data
    body = """
      const [theta, inputs] = [page.unpack(data.theta).values, page.unpack(data.inputs).values];
      const decisions = { inputs, actions: page.unpack(data.actions).values, width: data.features.length - 1 };
      const width = decisions.width;
      const rewards = (m) => page.rewardsOf(theta, inputs.subarray(m * width, (m + 1) * width));
      const all = [...decisions.actions].map((_, m) => rewards(m));
      return { all, ...page.judged(theta, decisions) };"""
    seen = page(body, data)
    np.testing.assert_allclose(seen["all"], decisions.features @ theta.T, atol=1e-12)
    assert seen["scale"] == pytest.approx(
        np.percentile(abs(decision_rewards(theta, decisions)), 95), abs=1e-12
    )
    assert seen["accuracy"] == np.mean(
        (decisions.features @ theta.T).argmax(axis=1) == decisions.actions
    )


def plan(decisions, theta, depth):
    encoder = lab(decisions, theta).data["encoder"]
    scale = float(np.percentile(abs(decision_rewards(theta, decisions)), 95))
    return {
        "theta": theta.ravel().tolist(),
        "encoder": encoder,
        "discount": DISCOUNT,
        "speed": SPEED,
        "depth": depth,
        "scale": scale,
    }


def test_a_robot_that_looks_no_further_drives_as_in_python(page, decisions, theta):
    worlds = random_worlds(60, 20, seed=7)

    def policy(sensing, rng):
        return (add_constant(ENCODER(sensing)) @ theta.T).argmax(axis=1)

    expected = navigate(policy, worlds, SPEED, 200, record_paths=True)
    body = """return data.worlds.map((world) => page.episodeOf(data.plan, world))
      .map(({ poses, outcome }) => ({ poses, outcome }));"""
    episodes = page(
        body,
        {
            "plan": plan(decisions, theta, 1),
            "worlds": [page_world(world) for world in worlds],
        },
    )
    assert {"arrived", "collided"} <= {episode["outcome"] for episode in episodes}
    for episode, path, outcome in zip(
        episodes, expected.paths, expected.outcome, strict=True
    ):
        assert episode["outcome"] == outcome.replace("out of steps", "running")
        np.testing.assert_allclose(
            [list(pose.values()) for pose in episode["poses"]], path, rtol=0, atol=1e-9
        )


def values_ahead(theta, scale, simulator, depth):
    """The same by brute force: a copy of the simulator for each action."""
    sensing = simulator.sense()
    rewards = (add_constant(ENCODER(sensing)) @ theta.T)[0]
    units = scale_to_unit_interval(np.append(rewards, [scale] * 1000))[:5]
    found = []
    for action in range(5):
        after = copy_of(simulator)
        after.step(np.array([action]))
        for _ in range(5):
            own = Reflex()(after.sense(), SPEED)
            if after.outcome[0] != RUNNING or own[0] < 0:
                break
            after.step(own)
        asked = after.outcome[0] == RUNNING and Reflex()(after.sense(), SPEED)[0] < 0
        rest = {ARRIVED: 1.0, COLLIDED: 0.0}.get(int(after.outcome[0]))
        if rest is None:
            rest = (
                max(values_ahead(theta, scale, after, depth - 1))
                if depth > 1 and asked
                else 0.5
            )
        found.append((1 - DISCOUNT) * units[action] + DISCOUNT * rest)
    return found


def copy_of(simulator):
    other = Simulator(simulator.worlds, SPEED)
    for name in ("poses", "centres", "headings", "steps", "outcome"):
        setattr(other, name, getattr(simulator, name).copy())
    return other


def test_values_ahead_are_those_of_brute_force(page, decisions, theta):
    worlds = random_worlds(12, 20, 6, seed=8)
    rng = np.random.default_rng(0)
    moments, expected = [], []
    setting = plan(decisions, theta, 2)
    for world in worlds:
        simulator = Simulator(world, SPEED)
        for _ in range(12 + int(rng.integers(20))):
            own = Reflex()(simulator.sense(), SPEED)
            simulator.step(np.where(own < 0, 0, own))
        if (
            simulator.outcome[0] != RUNNING
            or Reflex()(simulator.sense(), SPEED)[0] >= 0
        ):
            continue
        here = replace(world, centres=simulator.centres, headings=simulator.headings)
        x, y, heading = simulator.poses[0].tolist()
        pose = {"x": x, "y": y, "heading": heading}
        moments.append(
            {"world": page_world(here), "pose": pose, "step": int(simulator.steps[0])}
        )
        expected.append(values_ahead(theta, setting["scale"], simulator, 2))
    assert len(moments) >= 4
    body = """return data.moments.map((moment) =>
      page.valuesAhead(data.plan, { ...moment, sensing: page.sense(moment.world, moment.pose) }, 2));"""
    seen = page(body, {"plan": setting, "moments": moments})
    np.testing.assert_allclose(seen, expected, atol=1e-9)


def test_percentiles_are_numpys(page):
    values = np.random.default_rng(0).normal(size=37)
    seen = page(
        "return [0, 0.5, 0.95, 1].map((share) => page.percentile(data, share));",
        values.tolist(),
    )
    np.testing.assert_allclose(
        seen, np.percentile(values, [0, 50, 95, 100]), atol=1e-12
    )


@pytest.mark.parametrize("target", ["number", "signed", "one-hot", "sine-cosine"])
def test_every_feature_has_a_name(decisions, target):
    encoder = replace(ENCODER, target=target)
    steps = expert_decisions(demonstrate(random_worlds(2, 20, seed=3)), encoder)
    features = lab(steps, np.zeros((5, encoder.size + 1)), encoder=encoder).data[
        "features"
    ]
    assert len(features) == encoder.size + 1
    assert features[-1]["kind"] == "constant"


def test_weights_that_do_not_fit_are_refused(decisions):
    with pytest.raises(ValueError, match="reward_weights must have shape"):
        lab(decisions, np.zeros((5, 4)))
