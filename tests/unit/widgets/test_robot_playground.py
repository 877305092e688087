"""The playground's data and files: what it saves is loaded by Python, what Python saves is loaded by it."""

import base64
import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from robonav.benchmark.policies import method
from robonav.lfd import load_demonstrations
from robonav.networks import NetworkPolicy
from robonav.networks.multilayer_perceptron import random_network
from robonav.networks.weights import Weights, save_weights
from robonav.robot import (
    Encoder,
    follow_policy,
    make_world,
    navigate,
    random_worlds,
    turn_to_clearer_side,
)
from robonav.robot._fast import uniform
from robonav.robot.team import (
    Teams,
    TeamSimulator,
    crossing,
    navigate_team,
    random_teams,
)
from robonav.widgets.robot_playground import robot_playground
from robonav.widgets.simulator import CHOOSING, page_policy, page_world

ROOT = Path(__file__).parents[3]
FILE = """
const bytes = page.demonstrationsFile([{ ...episode, world: episode.base }]);
return btoa(String.fromCharCode(...bytes));
"""


@pytest.fixture
def page(node):
    """The playground's whole front end under Node."""
    return partial(
        node, ("simulator", "team", "maps", "episode", "files", "robot_playground")
    )


@pytest.mark.parametrize(("obstacles", "moving"), [(12, 0), (6, 6), (0, 0)])
def test_a_demonstration_saved_by_the_page_is_a_demonstration(
    page, tmp_path, obstacles, moving
):
    world = random_worlds(1, obstacles, moving, seed=4)
    body = """
      const episode = page.makeEpisode(data, 2.5);
      while (episode.outcome === "running" && episode.step < 300) episode.go(page.turnToClearerSide(episode.sensing));
    """
    (tmp_path / "episode.npz").write_bytes(
        base64.b64decode(page(body + FILE, page_world(world)))
    )
    got = load_demonstrations(tmp_path / "episode.npz")
    expected = navigate(turn_to_clearer_side, world, 2.5, record_paths=True)
    assert got.worlds.digest() == world.digest()
    assert got.speed == 2.5
    assert got.outcome.tolist() == expected.outcome.tolist()
    np.testing.assert_allclose(got.poses, expected.paths[0][:-1], rtol=0, atol=1e-9)


def test_an_edited_world_is_driven_and_saved_as_edited(page, tmp_path):
    body = """
      const episode = page.makeEpisode(data, 2);
      const own = { circle: true, x: 50, y: 50, a: 5, b: 0, turned: 0, speed: 0, heading: 0 };
      episode.edit((world) => world.obstacles.push(own));
      episode.go(0);
    """
    world = random_worlds(1, 2, seed=4)
    (tmp_path / "episode.npz").write_bytes(
        base64.b64decode(page(body + FILE, page_world(world)))
    )
    got = load_demonstrations(tmp_path / "episode.npz")
    assert got.worlds.slots == 3
    assert got.worlds.shapes[0, 2, 0] == 5
    assert got.outcome[0] == "out of steps"


def test_weights_saved_by_python_drive_in_the_page(page, tmp_path):
    encoder = Encoder(target="signed")
    policy = NetworkPolicy(random_network((encoder.size, 6, 5), seed=3), encoder)
    save_weights(
        tmp_path / "own.safetensors",
        Weights(policy.network, "own", encoder, temperature=0.3),
    )
    content = base64.b64encode((tmp_path / "own.safetensors").read_bytes()).decode()
    got = page(
        "return page.weightsFromFile(Uint8Array.from(atob(data), (c) => c.charCodeAt(0)).buffer);",
        content,
    )
    assert got["network"]["sizes"] == [11, 6, 5]
    expected = page_policy(policy)
    assert (
        got["network"]["weights"][0]["data"]
        == expected["network"]["weights"][0]["data"]
    )
    assert got["encoder"]["target"] == "signed"
    assert got["temperature"] == 0.3


@pytest.mark.parametrize(
    "content", [b"", b"no weights at all", b"\x02\0\0\0\0\0\0\0{}"]
)
def test_files_that_hold_no_weights_are_refused_with_a_sentence(page, content):
    body = """
      try { page.weightsFromFile(Uint8Array.from(atob(data), (c) => c.charCodeAt(0)).buffer); }
      catch (error) { return error.message; }
    """
    said = page(body, base64.b64encode(content).decode())
    assert (
        said
        == "The file must hold weights saved by robonav: it is damaged or of another kind."
    )


def test_a_network_that_does_not_fit_what_it_reads_is_refused(page, tmp_path):
    network, encoder = random_network((11, 6, 5), seed=3), Encoder(target="signed")
    save_weights(tmp_path / "own.safetensors", Weights(network, "own", encoder))
    content = (tmp_path / "own.safetensors").read_bytes().replace(b"8, 9]", b"8]   ")
    body = """
      try { page.weightsFromFile(Uint8Array.from(atob(data), (c) => c.charCodeAt(0)).buffer); }
      catch (error) { return error.message; }
    """
    said = page(body, base64.b64encode(content).decode())
    assert "its network has 11 inputs, and it says that it reads 10 numbers" in said


def test_bad_settings_are_refused():
    with pytest.raises(ValueError, match="worlds must hold at least one"):
        robot_playground({})
    with pytest.raises(ValueError, match="speeds must hold 2 m/s"):
        robot_playground({"a": random_worlds(1, seed=0)}, speeds=[1.0])


def test_the_page_gets_worlds_and_policies():
    encoder = Encoder()
    lab = robot_playground(
        {"easy": random_worlds(1, 3, seed=0)},
        {"own": NetworkPolicy(random_network((encoder.size, 5), seed=0), encoder)},
    )
    assert [policy["name"] for policy in lab.data["policies"]] == [
        "own",
        "rule: straight",
        "rule: freer-side",
    ]
    assert len(lab.data["worlds"][0]["world"]["obstacles"]) == 3


@pytest.mark.parametrize(
    "encoder",
    [
        Encoder(),
        Encoder((1, 2), walls=True, target="one-hot"),
        Encoder(target="number"),
    ],
)
def test_every_input_of_a_network_has_a_name(page, encoder):
    shown = {
        "sensors": list(encoder.sensors),
        "walls": encoder.walls,
        "target": encoder.target,
    }
    names = page("return page.inputsOf(data);", shown)
    assert len(names) == encoder.size
    assert names[: len(encoder.sensors)] == [str(sensor) for sensor in encoder.sensors]


TEAM = """
const { world, policies, robots, steps } = data;
const drivers = policies.map((policy) => page.driver(policy.network ? page.unpacked(policy) : policy));
const others = page.crossing(robots, world.size).slice(1);
const episode = page.makeEpisode(page.clearedFor(world, others), 2, others);
for (let step = 0; step < steps; step += 1) {
  episode.goAll(episode.robots.map((robot, r) => drivers[r % drivers.length](episode.seenBy(robot)).action));
}
return {
  robots: episode.robots.map(({ path, outcome, met, sensing }) =>
    ({ path: path.map(({ x, y, heading }) => [x, y, heading]), outcome, met, ranges: sensing.ranges })),
  tally: page.tallyOf(episode.robots),
};
"""


class AsInThePage:
    """A shipped policy that draws its random numbers as the page does: by robot, step and action."""

    def __init__(self, name):
        self.policy = method(name)
        self.packed = page_policy(self.policy)

    def begin(self, simulator, rng):
        keys = simulator.teams.keys

        def select_actions(simulator, sensing, robots):
            z, step = self.policy.logits(sensing), simulator.steps[robots[0]]
            actions = range(z.shape[1])
            drawn = [
                [uniform(keys[robot], CHOOSING, step, action, 0) for action in actions]
                for robot in robots
            ]
            return (z - self.policy.temperature * np.log(-np.log(drawn))).argmax(axis=1)

        return select_actions


class FreerSide:
    """The rule, which needs no random numbers."""

    def __init__(self):
        self.packed = {"rule": "freer-side"}

    def begin(self, simulator, rng):
        return follow_policy(turn_to_clearer_side, rng)


@pytest.mark.parametrize("robots", [1, 2, 5, 16])
def test_several_robots_drive_in_the_page_as_in_python(page, robots):
    teams = random_teams(1, 16, 8, 6, seed=18).first(robots)
    company = [AsInThePage("dagger"), AsInThePage("lfd"), FreerSide(), AsInThePage("nirl")]  # fmt: skip
    expected = navigate_team(
        [company[robot % 4] for robot in range(robots)], teams, max_steps=50, record_paths=True
    )  # fmt: skip
    got = page(
        TEAM,
        {
            "world": page_world(teams.worlds),
            "policies": [policy.packed for policy in company],
            "robots": robots,
            "steps": 50,
        },
    )
    for robot, path in zip(got["robots"], expected.paths, strict=True):
        np.testing.assert_allclose(robot["path"], path, rtol=0, atol=1e-9)
    outcomes = [robot["outcome"].replace("running", "out of steps") for robot in got["robots"]]  # fmt: skip
    assert outcomes == expected.outcome[0].tolist()
    assert [robot["met"] for robot in got["robots"]] == expected.met[0].tolist()
    assert got["tally"] == {
        "arrived": expected.success.sum(),
        "collided": expected.collision.sum(),
        "met": expected.met.sum(),
        "running": (expected.outcome == "out of steps").sum(),
    }
    if robots == 16:
        assert 0 < expected.met.sum() < 16


def test_one_robot_of_a_team_drives_as_the_robot_that_is_alone(page):
    world = random_worlds(1, 10, 5, seed=4)
    alone = navigate(turn_to_clearer_side, world, max_steps=50, record_paths=True)
    shown = {"world": page_world(world), "policies": [FreerSide().packed], "robots": 1, "steps": 50}  # fmt: skip
    (robot,) = page(TEAM, shown)["robots"]
    np.testing.assert_allclose(robot["path"], alone.paths[0], rtol=0, atol=1e-9)


def test_each_robot_senses_the_others_as_in_python(page):
    teams = Teams(make_world(), [[(30, 50), (35, 52), (33, 44)]], [[(80, 50), (20, 50), (50, 90)]])  # fmt: skip
    simulator = TeamSimulator(teams)
    ends = [
        {"start": list(start), "target": list(target)}
        for start, target in zip(
            teams.starts[0].tolist(), teams.targets[0].tolist(), strict=True
        )
    ]
    body = """
      const [first, ...others] = data.ends;
      const episode = page.makeEpisode({ ...data.world, ...first }, 2, others);
      return episode.robots.map(({ sensing }) => sensing);
    """
    got = page(body, {"world": page_world(teams.worlds), "ends": ends})
    seen = simulator.sense()
    np.testing.assert_allclose([s["ranges"] for s in got], seen.ranges, rtol=0, atol=1e-9)  # fmt: skip
    assert (seen.ranges < 10).any(axis=1).all()
    assert [s["region"] for s in got] == seen.target_region.tolist()


def test_robots_that_meet_within_a_second_have_collided(page):
    """At both ends of the second they are more than 2 m apart; in between they are 1.98 m apart."""
    ends = [
        {"start": [50, 50], "target": [90, 50]},
        {"start": [52, 50.8], "target": [52, 90]},
    ]
    body = """
      const episode = page.makeEpisode({ ...data.world, ...data.ends[0] }, 4, [data.ends[1]]);
      episode.goAll([0, 0], false);
      return episode.robots.map(({ outcome, met }) => [outcome, met]);
    """
    got = page(body, {"world": page_world(make_world()), "ends": ends})
    assert got == [["collided", True]] * 2
    teams = Teams(make_world(), [[end["start"] for end in ends]], [[end["target"] for end in ends]])  # fmt: skip
    simulator = TeamSimulator(teams, 4.0)
    simulator.step(np.array([0, 0]))
    assert simulator.met.all()


def test_the_answers_of_the_page_are_what_its_robots_do(page):
    answer = re.search(
        r"Answers to 7\n(.*?)```",
        (ROOT / "book/playground.md").read_text("utf-8"),
        re.S,
    )
    assert answer
    world = page_world(random_worlds(1, 0, seed=0))
    body = TEAM.replace("step < steps", "!episode.over() && step < steps").replace(
        "return {", "return { seconds: episode.step,"
    )

    def drive(policy, robots):
        shown = {"world": world, "policies": [policy], "robots": robots, "steps": 500}
        got = page(body, shown)
        return got["tally"], got["seconds"]

    straight, seconds = drive({"rule": "straight"}, 16)
    assert straight == {"arrived": 0, "collided": 16, "met": 16, "running": 0}
    freer, _ = drive({"rule": "freer-side"}, 16)
    assert freer["collided"] == freer["met"]
    nnql, long = drive(page_policy(method("nnql")), 16)
    two, short = drive(page_policy(method("nnql")), 2)
    assert two["arrived"] == 2
    for sentence in (
        f"`straight`, {straight['arrived']} of 16 arrive",
        f"collide after {seconds} s",
        f"`freer-side`, {freer['arrived']} arrive, and {freer['met']} collide with a robot",
        f"With NNQL, {nnql['arrived']} arrive",
        f"the last robot arrives after {long} s",
        f"the last one arrives after {short} s",
    ):
        assert sentence in answer[1]


@pytest.mark.parametrize("size", [100, 60])
def test_robots_begin_where_pythons_do(page, size):
    ends = page("return page.crossing(16, data);", size)
    starts, targets = crossing(16, size)
    np.testing.assert_allclose([end["start"] for end in ends], starts, atol=1e-12)
    np.testing.assert_allclose([end["target"] for end in ends], targets, atol=1e-12)


def test_what_stands_on_the_start_of_a_robot_is_left_out(page):
    body = """
      const at = (x, y, a) => ({ circle: true, x, y, a, b: 0, turned: 0, speed: 0, heading: 0 });
      const world = { ...data, obstacles: [at(90, 14, 3), at(10, 90, 1), at(50, 50, 3), at(40, 14, 3)] };
      const left = (robots) => page.clearedFor(world, page.crossing(robots, 100).slice(1)).obstacles;
      return [1, 4].map((robots) => left(robots).map(({ x }) => x));
    """
    alone, four = page(body, page_world(make_world()))
    assert alone == [90, 10, 50, 40]
    assert four == [50, 40]
