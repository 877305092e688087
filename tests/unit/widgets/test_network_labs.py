"""The labs' data, and their JavaScript under Node: the page's numbers are Python's."""

import json
from itertools import product

import numpy as np
import pytest

from robonav.networks import toy_datasets
from robonav.networks.multilayer_perceptron import Network, random_network
from robonav.networks.network_stack import stacked
from robonav.networks.optimisers import fit, gradient_descent
from robonav.robot import Encoder, lfd_state, random_worlds, sense
from robonav.widgets.boundary_lab import boundary_lab
from robonav.widgets.network_lab import network_lab
from robonav.widgets.shared import (
    PALETTE,
    front_end,
    packed,
    packed_network,
    spread_out,
    style_sheet,
)


@pytest.mark.parametrize("dtype", ["float64", "float32", "int32", "uint8"])
def test_arrays_reach_the_page_as_they_are(node, dtype):
    array = np.arange(12).reshape(3, 4) * (0.1 if dtype.startswith("f") else 1)
    seen = node(
        "network_lab",
        "const a = page.unpack(data); return [a.shape, [...a.values]];",
        packed(array, dtype),
    )
    assert seen == [[3, 4], array.astype(dtype).ravel().tolist()]


@pytest.mark.parametrize("sizes", [(11, 8, 5), (2, 3, 1), (4, 3, 3, 2), (3, 2)])
def test_the_page_propagates_as_python_does(node, sizes):
    stack = stacked([random_network(sizes, seed=seed, spread=3) for seed in range(4)])
    x = np.random.default_rng(0).normal(size=(20, sizes[0]))
    body = """const at = page.networks(data.stack);
      return [0, 1, 2, 3].map((i) => data.x.map((x) => {
        const { activations, z } = page.propagate(at(i), x);
        return [...activations.at(-1), ...z, ...activations[1]]; }));"""
    seen = np.array(
        node("network_lab", body, {"stack": packed_network(stack), "x": x.tolist()})
    )
    expected = np.concatenate(
        [stack.forward(x), stack.logits(x), stack.activations(x)[1]], axis=-1
    )
    np.testing.assert_allclose(seen, expected, rtol=0, atol=1e-12)


def test_the_page_encodes_states_as_python_does(node):
    rng = np.random.default_rng(0)
    poses = np.column_stack(
        [rng.uniform(2, 98, (40, 2)), rng.uniform(-np.pi, np.pi, 40)]
    )
    sensing = sense(random_worlds(40, obstacles=30, seed=3), poses)
    states = lfd_state(sensing)
    seen = node("network_lab", "return data.map(page.encode);", states.tolist())
    np.testing.assert_allclose(seen, Encoder(target="number")(sensing), atol=1e-15)


def test_largest_is_the_first_of_equals(node):
    assert node(
        "network_lab", "return data.map(page.largest);", [[1, 3, 2], [2, 2], [-1]]
    ) == [1, 0, 0]


def test_the_answers_on_the_plane_are_the_networks(node):
    middle = (
        random_network((2, 3, 1), seed=1, spread=4).weights[0],
        np.array([[3.0, -3.0, 2.0]]),
    )
    network = Network(
        middle, (np.zeros(3), np.array([-1.0]))
    )  # undecided in the middle
    body = "return [...page.field(page.networks(data)(), 1.5, 12)];"
    pixels = np.array(node("boundary_lab", body, packed_network(network))).reshape(
        12, 12, 4
    )
    middles = ((np.arange(12) + 0.5) / 12 - 0.5) * 3
    across, down = np.meshgrid(middles, -middles)
    answers = network.forward(np.stack([across, down], axis=-1))[..., 0]
    yes = answers > 0.5
    edge = np.zeros_like(yes)
    edge[:, :-1] |= yes[:, :-1] != yes[:, 1:]
    edge[:-1] |= yes[:-1] != yes[1:]
    assert 0 < edge.sum() < edge.size
    np.testing.assert_allclose(
        pixels[~edge][:, 3], 280 * abs(answers - 0.5)[~edge], atol=0.51
    )
    assert (pixels[edge][:, 3] == 255).all()
    colours = [
        [int(PALETTE[name][at : at + 2], 16) for at in (1, 3, 5)]
        for name in ("BLUE", "ORANGE")
    ]
    np.testing.assert_array_equal(
        pixels[~edge][:, :3], np.array(colours)[yes[~edge].astype(int)]
    )


def test_lines_of_hidden_units_end_on_the_square(node):
    lines = [
        [1, 0, 0.5],
        [0, 2, -1],
        [1, 1, 0],
        [3, -1, 0.7],
        [1, 1, 9],
        [0, 0, 1],
        [0, 1, 5],
    ]
    ends = node(
        "boundary_lab",
        "return data.map(([a, b, c]) => page.crossing(a, b, c, 1.5));",
        lines,
    )
    assert ends[4:] == [None, None, None]
    for (w1, w2, b), found in zip(lines[:4], ends[:4], strict=True):
        for x, y in found:
            assert w1 * x + w2 * y + b == pytest.approx(0, abs=1e-12)
            assert max(abs(x), abs(y)) == pytest.approx(1.5)
        assert found[0] != found[1]


def test_network_lab_holds_the_training_it_was_given():
    rng = np.random.default_rng(0)
    x, y = rng.random((60, 11)), np.eye(5)[rng.integers(0, 5, 60)]
    training = fit(x, y, iterations=40, record=True)
    lab = network_lab(training, {"a moment": ([0] * 9 + [3, 0], 2)}, frames=10)
    shown = lab.data["frames"]
    assert shown[0] == 0
    assert shown[-1] == training.iterations
    assert shown == sorted(set(shown))
    assert lab.data["networks"]["weights"][0]["shape"] == [len(shown), 8, 11]
    assert lab.data["situations"] == [
        {"name": "a moment", "state": [0] * 9 + [3, 0], "action": 2}
    ]
    assert len(json.dumps(lab.data)) < 60_000


def test_boundary_lab_holds_every_combination():
    problem = toy_datasets.xor(30, seed=0)
    controls = {"problem": ["xor"], "hidden": ["1", "2"], "rate": ["1", "3"]}
    runs = {
        key: gradient_descent(
            random_network((2, int(key[1]), 1), seed=0),
            *problem,
            gradient_step=float(key[2]),
            iterations=8,
            record=True,
        )
        for key in product(*controls.values())
    }
    lab = boundary_lab(
        controls,
        runs,
        {"xor": problem},
        frames=[0, 4, 20],
        start=("xor", "2", "1"),
    )
    assert [control["value"] for control in lab.data["controls"]] == [0, 1, 0]
    assert [run["networks"]["sizes"][1] for run in lab.data["runs"]] == [1, 1, 2, 2]
    assert lab.data["runs"][0]["networks"]["weights"][0]["shape"] == [3, 1, 2]
    with pytest.raises(ValueError, match="runs must hold a training for"):
        boundary_lab(
            controls | {"rate": ["1", "9"]}, runs, {"xor": problem}, frames=[0]
        )


def test_what_cannot_be_shown_is_refused():
    x, y = np.random.default_rng(0).random((20, 11)), np.eye(5)[np.arange(20) % 5]
    moment = {"a": ([0] * 11, 0)}
    with pytest.raises(ValueError, match="record=True"):
        network_lab(fit(x, y, iterations=2), moment)
    with pytest.raises(ValueError, match="11 inputs and 5 outputs"):
        network_lab(fit(x[:, :3], y, iterations=2, record=True), moment)
    with pytest.raises(ValueError, match="at least one moment"):
        network_lab(fit(x, y, iterations=2, record=True), {})
    with pytest.raises(ValueError, match="record=True"):
        boundary_lab(
            {"p": ["c"]},
            {("c",): fit(x[:, :2], y[:, :1], iterations=1)},
            {"c": (x, y)},
            frames=[0],
        )


@pytest.mark.parametrize(("last", "count"), [(0, 5), (3, 10), (300, 60), (1000, 2)])
def test_frames_start_dense_and_reach_the_end(last, count):
    shown = spread_out(last, count)
    assert shown[0] == 0
    assert shown[-1] == last
    assert len(shown) <= count + 6
    assert (np.diff(shown) >= 1).all()


def test_colours_and_styles_are_the_books():
    assert front_end("network_lab").startswith('export const PALETTE = {"')
    assert PALETTE["ROBOT"] in front_end("network_lab")
    assert ".robonav .dial" in style_sheet("network_lab")
