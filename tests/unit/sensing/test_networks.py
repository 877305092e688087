"""Convolutions to read against torch's, and the networks made of them."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from robonav.sensing import (
    Picture,
    Ring,
    circular_convolution,
    fully_connected,
    picture_convolution,
    picture_network,
    ring_network,
    weights_of_layers,
)

RNG = np.random.default_rng


def by_hand(layers, x, convolve):
    """What convolutional layers with ReLUs between make of one reading, by the readable functions."""
    x = x[None]
    for layer in layers:
        if hasattr(layer, "stride"):
            x = convolve(x, layer.weight.detach().numpy(), layer.bias.detach().numpy())
        elif isinstance(layer, torch.nn.ReLU):
            x = np.maximum(x, 0)
    return x


@pytest.mark.parametrize("sectors", [9, 18, 72])
def test_ring_of_torch_is_the_convolution_to_read(sectors):
    layers = ring_network(Ring(sectors), seed=1).double().layers
    x = RNG(0).random(sectors)
    with torch.no_grad():
        found = layers(torch.from_numpy(x[None]))[0].numpy()
    np.testing.assert_allclose(found, by_hand(layers, x, circular_convolution), atol=1e-12)  # fmt: skip
    assert found.any()


@pytest.mark.parametrize("cells", [32, 20])
def test_picture_of_torch_is_the_convolution_to_read(cells):
    layers = picture_network(Picture(cells), seed=1).double().layers
    x = RNG(0).random((cells, cells))
    with torch.no_grad():
        found = layers(torch.from_numpy(x[None]))[0].numpy()

    def halving(x, weights, biases):
        return picture_convolution(x, weights, biases, stride=2)

    np.testing.assert_allclose(found, by_hand(layers, x, halving), atol=1e-12)
    assert found.any()


def test_circular_convolution_by_its_sum():
    rng = RNG(2)
    x, w, b = rng.random((2, 7)), rng.random((3, 2, 5)), rng.random(3)
    y = circular_convolution(x, w, b)
    for o in range(3):
        for i in range(7):
            expected = b[o] + sum(
                w[o, c, j] * x[c, (i + j - 2) % 7] for c in range(2) for j in range(5)
            )
            assert y[o, i] == pytest.approx(expected)


@pytest.mark.parametrize("places", [1, 4, 17])
def test_a_turned_ring_gives_turned_results(places):
    rng = RNG(3)
    x, w, b = rng.random((1, 18)), rng.random((4, 1, 5)), rng.random(4)
    turned = circular_convolution(np.roll(x, places, axis=1), w, b)
    np.testing.assert_allclose(turned, np.roll(circular_convolution(x, w, b), places, axis=1))  # fmt: skip


@pytest.mark.parametrize("make", [fully_connected, ring_network])
def test_weights_come_from_the_seed_alone(make):
    before = torch.random.get_rng_state()
    first, again, other = (make(Ring(9), seed=seed) for seed in (1, 1, 2))
    assert torch.equal(torch.random.get_rng_state(), before)
    pairs = list(zip(first.parameters(), again.parameters(), strict=True))
    assert all(torch.equal(*pair) for pair in pairs)
    assert not torch.equal(next(first.head.parameters()), next(other.head.parameters()))


def test_numbers_of_weights():
    counted = weights_of_layers((36,), outputs=32, channels=8, window=5)
    hidden = fully_connected(Ring(36), seed=0).head[0]
    of_target = 3 * 32
    assert counted["fully connected"] == hidden.weight.numel() + 32 - of_target
    around = ring_network(Ring(36), seed=0).layers[1]
    assert counted["convolutional"] == sum(p.numel() for p in around.parameters())


def test_logits_depend_on_reading_and_target():
    for sensor, make in ((Ring(18), ring_network), (Picture(), picture_network)):
        network = make(sensor, seed=0)
        reading, target = torch.zeros(1, *sensor.shape), torch.zeros(1, 3)
        logits = network(reading, target)
        assert logits.shape == (1, 5)
        assert not torch.equal(network(reading + 1, target), logits)
        assert not torch.equal(network(reading, target + 1), logits)
