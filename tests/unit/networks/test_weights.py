"""Weights go through a file unchanged, and what is not ours is refused with one sentence."""

import json

import numpy as np
import pytest
import torch
from safetensors.numpy import save_file
from safetensors.torch import save_file as save_torch_file

from robonav import __version__
from robonav.networks.multilayer_perceptron import random_network
from robonav.networks.network_stack import stacked
from robonav.networks.weights import Weights, load_weights, save_weights
from robonav.robot import NNQL_SENSORS, Encoder

ELEVEN = Encoder(target="number")
SIXTEEN = Encoder(NNQL_SENSORS, walls=True, target="signed")

MADE = {"seed": 3, "demonstrations": 25, "speed": 2.0, "note": "margin 5 m"}


@pytest.mark.parametrize(
    ("encoder", "hidden"),
    [(ELEVEN, (8,)), (SIXTEEN, (8,)), (Encoder(), ()), (ELEVEN, (4, 4))],
)
def test_weights_go_through_a_file_unchanged(tmp_path, encoder, hidden):
    network = random_network((encoder.size, *hidden, 5), seed=0)
    save_weights(
        tmp_path / "w.safetensors",
        Weights(network, "lfd", encoder, MADE, temperature=0.4),
    )
    loaded = load_weights(tmp_path / "w.safetensors")
    again = loaded.network
    for ours, theirs in zip(
        network.weights + network.biases, again.weights + again.biases, strict=True
    ):
        np.testing.assert_array_equal(ours, theirs)
    assert (loaded.method, loaded.encoder, loaded.made, loaded.version) == (
        "lfd",
        encoder,
        MADE,
        __version__,
    )
    assert loaded.temperature == 0.4


def test_a_stack_goes_through_a_file_too(tmp_path):
    networks = stacked([random_network((16, 5), seed=seed) for seed in range(4)])
    save_weights(tmp_path / "w", Weights(networks, "dqn", SIXTEEN))
    assert load_weights(tmp_path / "w").network.stack == (4,)


def test_network_and_encoder_have_to_fit():
    with pytest.raises(
        ValueError,
        match="network must take the 12 inputs its encoder gives, got one of 11",
    ):
        Weights(random_network((11, 8, 5), seed=0), "lfd", Encoder())


def test_the_same_weights_give_the_same_small_file(tmp_path):
    for name in ("a", "b"):
        save_weights(
            tmp_path / name,
            Weights(random_network((11, 8, 5), seed=0), "lfd", ELEVEN, MADE),
        )
    first = (tmp_path / "a").read_bytes()
    assert first == (tmp_path / "b").read_bytes()
    assert len(first) < 3000


@pytest.mark.parametrize("temperature", [-0.1, float("nan")])
def test_a_temperature_that_is_none_is_refused(temperature):
    with pytest.raises(ValueError, match="temperature must be"):
        Weights(random_network((11, 2), seed=0), "lfd", ELEVEN, temperature=temperature)


def test_what_json_does_not_know_is_refused_before_anything_is_written(tmp_path):
    with pytest.raises(TypeError, match="made must hold only types that JSON can hold"):
        save_weights(
            tmp_path / "w",
            Weights(random_network((11, 2), seed=0), "lfd", ELEVEN, {"seeds": {3}}),
        )
    assert not (tmp_path / "w").exists()


ENCODER = {"sensors": list(range(1, 10)), "walls": False, "target": "number"}


def note(**change):
    about = {
        "format": "robonav weights 1",
        "method": "lfd",
        "encoder": ENCODER,
        "made": {},
        "version": "0.1.0",
    }
    about["temperature"] = 0
    return {"robonav": json.dumps(about | change)}


GOOD = {"weights.1": np.ones((2, 11)), "biases.1": np.ones(2)}


@pytest.mark.parametrize(
    ("tensors", "metadata", "message"),
    [
        (GOOD, None, "was not written by robonav"),
        (GOOD, {"robonav": "{"}, "its note cannot be read"),
        (GOOD, {"robonav": "[]"}, "its note cannot be read"),
        (GOOD, {"robonav": "[" * 100_000}, "its note cannot be read"),
        (
            GOOD,
            note(format="robonav weights 2"),
            "has the format 'robonav weights 2', expected 'robonav weights 1'",
        ),
        (GOOD, note(method=3, made=[]), "does not say its method, made"),
        (GOOD, note(temperature=None), "does not say its temperature"),
        (GOOD, note(temperature=-1), "temperature must be at least 0"),
        (GOOD, note(temperature=True), "temperature must be a number"),
        ({"weights.1": np.ones((2, 11))}, note(), "does not hold a network"),
        (GOOD | {"more": np.ones(1)}, note(), "does not hold a network"),
        (
            {"weights.1": np.ones((2, 11)), "biases.1": np.ones(3)},
            note(),
            r"biases\[0\] must have shape \(2,\)",
        ),
        (GOOD, note(encoder={}), "does not hold a network and its encoder: 'sensors'"),
        (
            GOOD,
            note(encoder=ENCODER | {"sensors": ["1"]}),
            "sensors must be a whole number",
        ),
        (GOOD, note(encoder=ENCODER | {"target": "angle"}), "target must be one of"),
        (
            GOOD,
            note(encoder=ENCODER | {"walls": True}),
            "network must take the 20 inputs",
        ),
        (
            {"weights.1": np.full((2, 11), np.nan), "biases.1": np.ones(2)},
            note(),
            "finite numbers only",
        ),
    ],
)
def test_files_that_are_not_ours_are_refused(tmp_path, tensors, metadata, message):
    save_file(tensors, tmp_path / "w.safetensors", metadata=metadata)
    with pytest.raises(ValueError, match=message) as caught:
        load_weights(tmp_path / "w.safetensors")
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith("w.safetensors ")


@pytest.mark.parametrize("keep", [0, 7, 100, -1])
def test_a_cut_or_foreign_file_is_refused(tmp_path, keep):
    save_weights(
        tmp_path / "w", Weights(random_network((11, 8, 5), seed=0), "lfd", ELEVEN)
    )
    (tmp_path / "cut").write_bytes((tmp_path / "w").read_bytes()[:keep])
    with pytest.raises(ValueError, match="cut is not a whole safetensors file"):
        load_weights(tmp_path / "cut")
    (tmp_path / "text").write_text("import os\n" * 100)
    with pytest.raises(ValueError, match="text is not a whole safetensors file"):
        load_weights(tmp_path / "text")


def test_a_missing_file_is_said_to_be_missing(tmp_path):
    with pytest.raises(FileNotFoundError):
        load_weights(tmp_path / "nowhere")


def test_a_folder_is_said_to_be_a_folder(tmp_path):
    with pytest.raises(IsADirectoryError, match="is a folder, not a safetensors file"):
        load_weights(tmp_path)


def test_a_type_that_numpy_lacks_is_named(tmp_path):
    tensors = {name: torch.tensor(array) for name, array in GOOD.items()}
    tensors["weights.1"] = tensors["weights.1"].bfloat16()
    save_torch_file(tensors, tmp_path / "b.safetensors", metadata=note())
    with pytest.raises(ValueError, match=r"tensors of F16, F32, F64, got BF16"):
        load_weights(tmp_path / "b.safetensors")


def test_settings_of_numpys_types_are_written(tmp_path):
    made = {"seed": np.int64(3), "rates": np.array([0.5, 0.25])}
    network = random_network((11, 8, 5), seed=0)
    save_weights(tmp_path / "w", Weights(network, "lfd", ELEVEN, made))
    assert load_weights(tmp_path / "w").made == {"seed": 3, "rates": [0.5, 0.25]}
