"""The playground's data and files: what it saves is loaded by Python, what Python saves is loaded by it."""

import base64
from functools import partial

import numpy as np
import pytest

from robonav.lfd import load_demonstrations
from robonav.networks import NetworkPolicy
from robonav.networks.multilayer_perceptron import random_network
from robonav.networks.weights import Weights, save_weights
from robonav.robot import Encoder, navigate, random_worlds, turn_to_clearer_side
from robonav.widgets.robot_playground import robot_playground
from robonav.widgets.simulator import page_policy, page_world

FILE = """
const bytes = page.demonstrationsFile([{ ...episode, world: episode.base }]);
return btoa(String.fromCharCode(...bytes));
"""


@pytest.fixture
def page(node):
    """The playground's whole front end under Node."""
    return partial(node, ("simulator", "maps", "episode", "files", "robot_playground"))


@pytest.mark.parametrize(("obstacles", "moving"), [(12, 0), (6, 6), (0, 0)])
def test_a_demonstration_saved_by_the_page_is_a_demonstration(
    page, tmp_path, obstacles, moving
):
    world = random_worlds(1, obstacles, moving, seed=4)
    body = """
      const episode = page.makeEpisode(data, 2.5);
      while (episode.outcome === "running" && episode.step < 300) episode.go(page.freerSide(episode.sensing));
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
