"""The page's simulator against Python's: the same drives, step by step."""

import numpy as np
import pytest

from robonav.lfd.network import random_network
from robonav.lfd.policy import NetworkPolicy
from robonav.robot import (
    TARGET_ENCODINGS,
    Encoder,
    concatenate,
    freer_side,
    navigate,
    obstacle_tracks,
    random_worlds,
    sense,
    straight,
)
from robonav.robot.kernels import DRIFTING, uniform
from robonav.widgets.simulator import page_policy, page_world

DRIVE = """
const { policy, worlds, speed, steps } = data;
const network = policy.network ? page.networks(policy.network)() : null;
const ask = (seen) => page.consult({ network, encoder: policy.encoder }, seen).action;
const choose = policy.rule ? page.RULES[policy.rule] : ask;
return worlds.map((first) => {
  let [world, pose, outcome] = [first, page.startPose(first), "running"];
  const path = [[pose.x, pose.y, pose.heading]];
  for (let step = 0; step < steps && outcome === "running"; step += 1) {
    const seen = page.sense(world, pose);
    const own = page.reflex(seen, speed);
    ({ world, pose, outcome } = page.advance(world, pose, step, own < 0 ? choose(seen) : own, speed));
    path.push([pose.x, pose.y, pose.heading]);
  }
  return { path, outcome };
});
"""


def policies():
    rng = np.random.default_rng(5)
    for target in TARGET_ENCODINGS:
        encoder = Encoder(walls=target == "signed", target=target)
        yield target, NetworkPolicy(random_network((encoder.size, 8, 5), seed=rng, spread=2.0), encoder)


@pytest.mark.parametrize(("rule", "policy"), [("straight", straight), ("freer side", freer_side)])
@pytest.mark.parametrize("speed", [2.0, 3.5])
def test_rules_drive_in_the_page_as_in_python(node, rule, policy, speed):
    worlds = concatenate([random_worlds(120, 20, seed=31), random_worlds(80, 8, 12, seed=32)])
    compare(node, worlds, policy, {"rule": rule}, speed)


@pytest.mark.parametrize(("target", "policy"), [*policies()])
def test_networks_drive_in_the_page_as_in_python(node, target, policy):
    worlds = concatenate([random_worlds(60, 15, seed=33), random_worlds(40, 8, 8, seed=34)])
    compare(node, worlds, policy, page_policy(policy), 2.5)


def compare(node, worlds, policy, packed, speed, steps=200):
    expected = navigate(policy, worlds, speed, steps, record_paths=True)
    data = {"worlds": [page_world(w) for w in worlds], "policy": packed, "speed": speed, "steps": steps}
    drives = node("simulator", DRIVE, data)
    for drive, path, outcome in zip(drives, expected.paths, expected.outcome, strict=True):
        assert drive["outcome"] == outcome.replace("out of steps", "running")
        np.testing.assert_allclose(drive["path"], path, rtol=0, atol=1e-9)


def test_random_numbers_are_pythons(node):
    keys = np.array([[0, 0], [1, 2], [2**32 - 1, 2**31], [123456789, 987654321]], dtype=np.uint32)
    counters = [(0, 0, 0), (1, 5, 1), (499, 1023, 7), (2**20 - 1, 1000, 3)]
    expected = [[uniform(key, DRIFTING, *counter) for counter in counters] for key in keys]
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
    np.testing.assert_allclose([s["ranges"] for s in seen], read.ranges, rtol=0, atol=1e-9)
    np.testing.assert_array_equal([s["walls"] for s in seen], read.walls)
    np.testing.assert_array_equal([s["region"] for s in seen], read.target_region)
    np.testing.assert_array_equal([s["seen"] for s in seen], read.target_seen)
