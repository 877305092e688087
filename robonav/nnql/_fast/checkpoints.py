"""A training saved to a file and continued from it, with the same result as if it had never stopped.

The worlds and random numbers of an episode depend on its seed and number alone. Between two episodes only what the
agents have learned has to be kept.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import joblib
import numpy as np

from robonav import archive
from robonav._version import __version__

from .agents import Agent
from .trainer import EpisodeStatistics

FORMAT = "robonav training 2"
_STATISTICS = ("outcomes", "steps", "decisions", "returns")


def save_checkpoint(
    path: str | Path,
    identity: Mapping[str, Any],
    agent: Agent,
    statistics: EpisodeStatistics,
    done: int,
) -> None:
    """Write the state of a training after ``done`` episodes of every seed.

    ``identity`` says which training it is: its method, seeds, settings and task.
    """
    about = {
        "format": FORMAT,
        "version": __version__,
        "training": training_hash(identity),
        "done": done,
    }
    arrays: dict[str, Any] = {
        f"about.{key}": np.array(value) for key, value in about.items()
    }
    arrays |= agent.state() | {name: getattr(statistics, name) for name in _STATISTICS}
    archive.write_archive(path, arrays, compressed=False)


def load_checkpoint(
    path: str | Path,
    identity: Mapping[str, Any],
    agent: Agent,
    statistics: EpisodeStatistics,
) -> int:
    """Restore agent and statistics from a file, and return the number of episodes done; 0 if there is no file.

    Raises
    ------
    ValueError
        If the file is not a checkpoint, or belongs to another version or to another training.
    """
    name = Path(path).name
    if not Path(path).exists():
        return 0
    try:
        arrays = archive.read_archive(path)
        about = {
            key: arrays.pop(f"about.{key}").item()
            for key in ("format", "version", "training", "done")
        }
    except (OSError, ValueError, KeyError):
        raise ValueError(f"{name} is not a whole checkpoint of robonav") from None
    if (about["format"], about["version"]) != (FORMAT, __version__):
        raise ValueError(
            f"{name} was written by robonav {about['version']} ({about['format']}), expected {__version__} ({FORMAT})"
        )
    if about["training"] != training_hash(identity):
        raise ValueError(
            f"{name} belongs to a training with other seeds, settings or task"
        )
    for key in _STATISTICS:
        getattr(statistics, key)[:] = arrays.pop(key)
    agent.restore(arrays)
    return int(about["done"])


def training_hash(identity: Mapping[str, Any]) -> str:
    """A hash of a training's settings; a reward or an encoder counts by its name and by the values that it holds."""
    return str(joblib.hash(_values(identity)))


def _values(value: Any) -> Any:
    """Settings as plain values: dataclasses by their fields, functions by their name and the values they close over."""
    if dataclasses.is_dataclass(value):
        fields = {
            field.name: getattr(value, field.name)
            for field in dataclasses.fields(value)
        }
        return type(value).__qualname__, _values(fields)
    if isinstance(value, Mapping):
        return [(key, _values(part)) for key, part in sorted(value.items())]
    if isinstance(value, list | tuple):
        return [_values(part) for part in value]
    if callable(value):
        closure = getattr(value, "__closure__", None) or ()
        held = [_values(cell.cell_contents) for cell in closure]
        return getattr(value, "__qualname__", type(value).__qualname__), held
    return value
