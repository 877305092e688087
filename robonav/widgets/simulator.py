"""Worlds and policies in the format of the page's simulator (``simulator.js``)."""

from __future__ import annotations

import base64
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from robonav.lfd import Demonstrations, load_demonstrations
from robonav.networks.policy import NetworkPolicy
from robonav.robot import Worlds
from robonav.robot._fast import CIRCLE

from .shared import packed_network

CHOOSING = 5
"""Purpose of the random numbers by which the page samples actions, see ``robonav.robot._fast.uniform``."""


def page_world(world: Worlds) -> dict[str, Any]:
    """Pack the first world of a batch for the page: lengths in metres, angles in radians."""
    obstacles = [
        {
            "circle": bool(world.kinds[0, m] == CIRCLE),
            "x": float(world.centres[0, m, 0]),
            "y": float(world.centres[0, m, 1]),
            "a": float(world.shapes[0, m, 0]),
            "b": float(world.shapes[0, m, 1]),
            "turned": float(world.shapes[0, m, 2]),
            "speed": float(world.speeds[0, m]),
            "heading": float(world.headings[0, m]),
        }
        for m in np.flatnonzero(world.kinds[0])
    ]
    return {
        "size": world.size,
        "start": world.starts[0].tolist(),
        "target": world.targets[0].tolist(),
        "key": world.keys[0].tolist(),
        "obstacles": obstacles,
    }


def page_policy(policy: NetworkPolicy) -> dict[str, Any]:
    """Pack a network's policy for the page: its weights, its encoder and its temperature."""
    encoder = policy.encoder
    return {
        "network": packed_network(policy.network),
        "encoder": {
            "sensors": list(encoder.sensors),
            "walls": encoder.walls,
            "target": encoder.target,
        },
        "temperature": policy.temperature,
    }


def page_demonstrations(text: str) -> Demonstrations:
    """Read demonstrations that the page sent: the file that it would download, as base 64."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "demonstrations.npz"
        path.write_bytes(base64.b64decode(text))
        return load_demonstrations(path)
