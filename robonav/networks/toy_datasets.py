"""Problems of two inputs and one answer, small enough to see what each hidden unit does."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from robonav.validation import check_generator, check_integer

from .multilayer_perceptron import Array, Network

EXTENT = 1.5
"""The square [-EXTENT, EXTENT] on either axis holds every example."""


def xor(m: int, *, seed: int | np.random.Generator) -> tuple[Array, Array]:
    """Four clouds; those in opposite corners belong together (exclusive or): one line cannot part them.

    Returns
    -------
    x (m, 2) and y (m, 1) of 0 and 1, for all problems here.
    """
    rng = check_generator("seed", seed)
    signs = rng.choice([-1.0, 1.0], size=(_count(m), 2))
    return 0.75 * signs + rng.normal(0, 0.2, signs.shape).clip(-0.7, 0.7), (
        signs[:, :1] == signs[:, 1:]
    ).astype(float)


def disc(m: int, *, seed: int | np.random.Generator) -> tuple[Array, Array]:
    """A disc inside a ring: no line does, and two do not either."""
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
    """Two half moons that reach into each other; a line gets most of them right."""
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
    """What a network of two inputs and one output answers all over the square: (resolution, resolution), y upwards."""
    line = np.linspace(
        -EXTENT, EXTENT, check_integer("resolution", resolution, at_least=2)
    )
    across, up = np.meshgrid(line, line)
    return network.forward(np.stack([across, up], axis=-1))[..., 0]


def _count(m: int) -> int:
    return check_integer("m", m, at_least=1)
