"""Data sets with two inputs and one label, small enough to see what each hidden unit does."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from robonav.validation import check_generator, check_integer

from .multilayer_perceptron import Array, Network

EXTENT = 1.5
"""The square [-EXTENT, EXTENT] on either axis holds every example."""


def xor(m: int, *, seed: int | np.random.Generator) -> tuple[Array, Array]:
    """Draw four clouds of points, where opposite corners have the same label (exclusive or).

    One line cannot separate the labels.

    Parameters
    ----------
    m : int
        Number of examples.
    seed : int or Generator
        Of the random numbers.

    Returns
    -------
    x : (m, 2) array
        Points.
    y : (m, 1) array
        Labels 0 and 1.

    Examples
    --------
    >>> from robonav.networks.toy_datasets import xor
    >>> x, y = xor(4, seed=0)
    >>> x.shape, y.ravel().tolist()
    ((4, 2), [1.0, 0.0, 1.0, 1.0])
    """
    rng = check_generator("seed", seed)
    signs = rng.choice([-1.0, 1.0], size=(_count(m), 2))
    return 0.75 * signs + rng.normal(0, 0.2, signs.shape).clip(-0.7, 0.7), (
        signs[:, :1] == signs[:, 1:]
    ).astype(float)


def disc(m: int, *, seed: int | np.random.Generator) -> tuple[Array, Array]:
    """Draw a disc (label 1) inside a ring (label 0); parameters and results are those of :func:`xor`.

    Three lines are needed to enclose the disc.

    Examples
    --------
    >>> from robonav.networks.toy_datasets import disc
    >>> disc(50, seed=0)[0].shape
    (50, 2)
    """
    rng = check_generator("seed", seed)
    inside = rng.random(_count(m)) < 0.5
    radius = np.where(
        inside, rng.uniform(0, 0.55, len(inside)), rng.uniform(0.8, 1.3, len(inside))
    )
    angle = rng.uniform(0, 2 * np.pi, len(inside))
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]), inside[
        :, None
    ].astype(float)


def moons(m: int, *, seed: int | np.random.Generator) -> tuple[Array, Array]:
    """Draw two half moons that reach into each other; parameters and results are those of :func:`xor`.

    One line classifies most of the points correctly, but not all.

    Examples
    --------
    >>> from robonav.networks.toy_datasets import moons
    >>> moons(50, seed=0)[1].shape
    (50, 1)
    """
    rng = check_generator("seed", seed)
    upper = rng.random(_count(m)) < 0.5
    angle = rng.uniform(0, np.pi, len(upper))
    sign = np.where(upper, 1, -1)
    moon = np.column_stack(
        [sign * (0.9 * np.cos(angle) - 0.4), sign * (0.9 * np.sin(angle) - 0.25)]
    )
    return moon + rng.normal(0, 0.1, moon.shape).clip(-0.2, 0.2), upper[:, None].astype(
        float
    )


TOY_DATASETS: dict[str, Callable[..., tuple[Array, Array]]] = {
    "xor": xor,
    "disc": disc,
    "moons": moons,
}


def field(network: Network, *, resolution: int = 100) -> Array:
    """Return the outputs of a network with two inputs and one output on a grid over the square.

    Parameters
    ----------
    network : Network
        A single network.
    resolution : int
        Points along each side.

    Returns
    -------
    (resolution, resolution) array
        Rows go upwards, columns to the right.

    Examples
    --------
    >>> from robonav.networks import random_network
    >>> from robonav.networks.toy_datasets import field
    >>> field(random_network((2, 3, 1), seed=0), resolution=5).shape
    (5, 5)
    """
    line = np.linspace(
        -EXTENT, EXTENT, check_integer("resolution", resolution, at_least=2)
    )
    across, up = np.meshgrid(line, line)
    return network.forward(np.stack([across, up], axis=-1))[..., 0]


def _count(m: int) -> int:
    return check_integer("m", m, at_least=1)
