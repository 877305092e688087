"""The page's simulator against Python's: the same episodes, step by step."""

import base64

import numpy as np
import pytest
from numba import njit

from robonav.benchmark.policies import method, methods
from robonav.networks.multilayer_perceptron import random_network
from robonav.networks.policy import NetworkPolicy
from robonav.robot import (
    OUTCOMES,
    TARGET_ENCODINGS,
    Encoder,
    Reflex,
    Simulator,
    concatenate_worlds,
    navigate,
    obstacle_tracks,
    random_worlds,
    sense,
    straight,
    turn_to_clearer_side,
)
from robonav.robot._fast import DRIFTING, RUNNING, uniform
from robonav.widgets.simulator import CHOOSING, page_policy, page_world

DRIVE = """
const { policy, worlds, speed, steps, direction } = data;
const network = policy.network ? page.networks(policy.network)() : null;
const ask = (seen, { key }, step) => page.consult({ ...policy, network }, seen, page.gumbel(key, step)).action;
const choose = policy.rule ? page.RULES[policy.rule] : ask;
const episodes = worlds.map((first) => {
  let [world, pose, outcome] = [first, page.startPose(first), "running"];
  const path = [[pose.x, pose.y, pose.heading]];
  for (let step = 0; step < steps && outcome === "running"; step += 1) {
    const seen = page.sense(world, pose);
    const own = page.reflex(seen, speed, direction);
    ({ world, pose, outcome } = page.advance(world, pose, step, own < 0 ? choose(seen, world, step) : own, speed));
    path.push([pose.x, pose.y, pose.heading]);
  }
  return { path, outcome };
});
const poses = Float64Array.from(episodes.flatMap(({ path }) => path.flat()));
return {
  outcomes: episodes.map(({ outcome }) => outcome),
  lengths: episodes.map(({ path }) => path.length),
  poses: Buffer.from(poses.buffer).toString("base64"),
};
"""


def policies():
    rng = np.random.default_rng(5)
    for target in TARGET_ENCODINGS:
        encoder = Encoder(walls=target == "signed", target=target)
        yield (
            target,
            NetworkPolicy(
                random_network((encoder.size, 8, 5), seed=rng, spread=2.0), encoder
            ),
        )


@pytest.fixture(scope="module")
def thousand():
    """A thousand worlds, standing and moving, and the same for the page."""
    worlds = concatenate_worlds(
        [random_worlds(500, 20, seed=37), random_worlds(500, 10, 10, seed=38)]
    )
    return worlds, [page_world(world) for world in worlds]


@pytest.mark.parametrize(
    ("rule", "policy"), [("straight", straight), ("freer-side", turn_to_clearer_side)]
)
@pytest.mark.parametrize("speed", [2.0, pytest.param(3.5, marks=pytest.mark.slow)])
@pytest.mark.slow
def test_rules_drive_a_thousand_worlds_in_the_page_as_in_python(
    node, thousand, rule, policy, speed
):
    worlds, shown = thousand
    episodes = navigate(policy, worlds, speed, 100, record_paths=True)
    same(node, shown, {"rule": rule}, speed, 100, episodes.paths, episodes.outcome)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rule", "policy"), [("straight", straight), ("freer-side", turn_to_clearer_side)]
)
def test_a_robot_that_knows_the_sector_drives_in_the_page_as_in_python(
    node, thousand, rule, policy
):
    worlds, shown = thousand
    reflex = Reflex("sector")
    episodes = navigate(policy, worlds, 2.0, 100, record_paths=True, reflex=reflex)
    outcomes = episodes.outcome
    same(
        node, shown, {"rule": rule}, 2.0, 100, episodes.paths, outcomes, direction=reflex.direction
    )  # fmt: skip


def test_reflex_of_the_page_knows_by_default_what_pythons_knows(node):
    directions = node("simulator", "return page.ROBOT.direction;", {})
    assert directions == Reflex().direction


@pytest.mark.parametrize(("target", "policy"), [*policies()])
def test_networks_drive_in_the_page_as_in_python(node, target, policy):
    worlds = concatenate_worlds(
        [random_worlds(60, 15, seed=33), random_worlds(40, 8, 8, seed=34)]
    )
    episodes = navigate(policy, worlds, 2.5, 200, record_paths=True)
    same(node, worlds, page_policy(policy), 2.5, 200, episodes.paths, episodes.outcome)


def same(node, worlds, packed, speed, steps, paths, outcomes, **direction):
    """The page drives these paths, pose by pose."""
    shown = worlds if isinstance(worlds, list) else [page_world(w) for w in worlds]
    episodes = node(
        "simulator",
        DRIVE,
        {
            "worlds": shown,
            "policy": packed,
            "speed": speed,
            "steps": steps,
            **direction,
        },
    )
    assert episodes["outcomes"] == [
        end.replace("out of steps", "running") for end in outcomes
    ]
    assert episodes["lengths"] == [len(path) for path in paths]
    driven = np.frombuffer(base64.b64decode(episodes["poses"])).reshape(-1, 3)
    np.testing.assert_allclose(driven, np.concatenate(paths), rtol=0, atol=1e-9)


@njit
def draws(keys, step, actions):
    """A number in [0, 1) for each world and action."""
    numbers = np.empty((len(keys), actions))
    for i in range(len(keys)):
        for action in range(actions):
            numbers[i, action] = uniform(keys[i], CHOOSING, step, action, 0)
    return numbers


class Seeded:
    """A policy that draws its random numbers as the page does: by world, step and action."""

    def __init__(self, policy, worlds, speed, steps):
        self.policy, self.simulator, self.steps = (
            policy,
            Simulator(worlds, speed, max_steps=steps),
            steps,
        )

    def drive(self):
        """The paths and outcomes of all episodes."""
        simulator = self.simulator
        n = len(simulator)
        poses, ended = [simulator.poses.copy()], np.zeros(n, dtype=int)
        for step in range(self.steps):
            sensing = simulator.sense()
            own = Reflex()(sensing, simulator.speed)
            z = self.policy.logits(sensing)
            noise = -np.log(-np.log(draws(simulator.worlds.keys, step, z.shape[1])))
            chosen = (z + self.policy.temperature * noise).argmax(axis=1)
            simulator.step(np.where(own < 0, chosen, own))
            poses.append(simulator.poses.copy())
            ended[(ended == 0) & (simulator.outcome != RUNNING)] = step + 1
            if (simulator.outcome != RUNNING).all():
                break
        assert (ended > 0).all()
        return [np.array(poses)[: ended[i] + 1, i] for i in range(n)], OUTCOMES[
            simulator.outcome
        ]


def test_chance_drives_in_the_page_as_in_python(node):
    encoder = Encoder()
    network = random_network((encoder.size, 8, 5), seed=2, spread=2.0)
    policy = NetworkPolicy(network, encoder, temperature=1.5)
    worlds = concatenate_worlds(
        [random_worlds(60, 15, seed=35), random_worlds(40, 8, 8, seed=36)]
    )
    paths, outcomes = Seeded(policy, worlds, 2.0, 200).drive()
    same(node, worlds, page_policy(policy), 2.0, 200, paths, outcomes)
    greedy = navigate(
        NetworkPolicy(network, encoder), worlds, 2.0, 200, record_paths=True
    )
    assert sum(len(a) != len(b) for a, b in zip(paths, greedy.paths, strict=True)) > 10


def test_chances_are_boltzmanns(node):
    body = """const counts = [0, 0, 0];
    const z = Float64Array.from(data.z);
    for (let step = 0; step < 20000; step += 1) {
      const noise = page.gumbel([7, 9], step);
      counts[page.largest(z.map((sum, action) => sum + data.temperature * noise(action)))] += 1;
    }
    return counts;"""
    z = np.array([0.0, 0.5, -1.0])
    counts = np.array(node("simulator", body, {"z": z.tolist(), "temperature": 0.5}))
    expected = np.exp(z / 0.5) / np.exp(z / 0.5).sum()
    np.testing.assert_allclose(counts / 20_000, expected, atol=0.012)


NETWORKS = [name for name in methods() if isinstance(method(name), NetworkPolicy)]


@pytest.mark.parametrize("name", NETWORKS)
@pytest.mark.slow
def test_shipped_policies_drive_hundreds_of_worlds_in_the_page_as_in_python(
    node, thousand, name
):
    policy = method(name)
    worlds, shown = (all_of_them[::4] for all_of_them in thousand)
    if policy.temperature > 0:
        paths, outcomes = Seeded(policy, worlds, 2.0, 100).drive()
    else:
        episodes = navigate(policy, worlds, 2.0, 100, record_paths=True)
        paths, outcomes = episodes.paths, episodes.outcome
    same(node, shown, page_policy(policy), 2.0, 100, paths, outcomes)


def test_random_numbers_are_pythons(node):
    keys = np.array(
        [[0, 0], [1, 2], [2**32 - 1, 2**31], [123456789, 987654321]], dtype=np.uint32
    )
    counters = [(0, 0, 0), (1, 5, 1), (499, 1023, 7), (2**20 - 1, 1000, 3)]
    expected = [
        [uniform(key, DRIFTING, *counter) for counter in counters] for key in keys
    ]
    seen = node(
        "simulator",
        f"return data.keys.map((key) => data.counters.map((c) => page.uniform(key, {DRIFTING}, ...c)));",
        {"keys": keys.tolist(), "counters": counters},
    )
    np.testing.assert_array_equal(seen, expected)


def test_obstacles_move_as_in_python(node):
    worlds = random_worlds(5, 2, 10, seed=8)
    seen = node(
        "simulator",
        """return data.map((first) => {
          let world = first;
          const track = [world.obstacles.map(({ x, y }) => [x, y])];
          for (let step = 0; step < 300; step += 1) {
            world = { ...world, obstacles: page.drift(world, step) };
            track.push(world.obstacles.map(({ x, y }) => [x, y]));
          }
          return track;
        });""",
        [page_world(w) for w in worlds],
    )
    np.testing.assert_allclose(seen, obstacle_tracks(worlds, 300), rtol=0, atol=1e-9)


def test_sensing_is_pythons_everywhere(node):
    worlds = random_worlds(300, 15, seed=9)
    rng = np.random.default_rng(1)
    poses = np.column_stack([rng.uniform(0.5, 99.5, (300, 2)), rng.uniform(-3, 3, 300)])
    read = sense(worlds, poses)
    seen = node(
        "simulator",
        "return data.worlds.map((w, i) => page.sense(w, data.poses[i]));",
        {
            "worlds": [page_world(w) for w in worlds],
            "poses": [{"x": x, "y": y, "heading": h} for x, y, h in poses.tolist()],
        },
    )
    np.testing.assert_allclose(
        [s["ranges"] for s in seen], read.ranges, rtol=0, atol=1e-9
    )
    np.testing.assert_array_equal([s["walls"] for s in seen], read.walls)
    np.testing.assert_array_equal([s["region"] for s in seen], read.target_region)
    np.testing.assert_array_equal([s["seen"] for s in seen], read.target_seen)
