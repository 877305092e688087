"""Training put down in a file and taken up again: the same result as if it had never stopped.

Episodes depend on their seed and number alone, so that between two episodes only what was learned has to be kept.
"""

from __future__ import annotations

import hashlib
import io
import zipfile
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import numpy as np

from robonav import atomic
from robonav._version import __version__

from .agents import Agent
from .trainer import EpisodeStatistics

FORMAT = "robonav training 1"
_STATISTICS = ("outcomes", "steps", "decisions", "returns")


def save_checkpoint(
    path: str | Path,
    identity: dict[str, Any],
    agent: Agent,
    statistics: EpisodeStatistics,
    done: int,
) -> None:
    """Write what a training has come to after ``done`` episodes of every seed.

    ``identity`` says which training it is: seeds, settings, task.
    """
    about = {
        "format": FORMAT,
        "version": __version__,
        "training": _digest(identity),
        "done": done,
    }
    arrays: dict[str, Any] = {
        f"about.{key}": np.array(value) for key, value in about.items()
    }
    arrays |= agent.state() | {name: getattr(statistics, name) for name in _STATISTICS}
    with atomic.atomic_write(path) as file:
        np.savez(file, **arrays)


def load_checkpoint(
    path: str | Path,
    identity: dict[str, Any],
    agent: Agent,
    statistics: EpisodeStatistics,
) -> int:
    """Put agent and statistics where a file left them, and return the number of episodes done; 0 if there is no file.

    Raises
    ------
    ValueError : if the file is no checkpoint, or one of another version, or of another training.
    """
    name = Path(path).name
    if not Path(path).exists():
        return 0
    try:
        with np.load(io.BytesIO(Path(path).read_bytes()), allow_pickle=False) as file:
            arrays = dict(file)
        about = {
            key: arrays.pop(f"about.{key}").item()
            for key in ("format", "version", "training", "done")
        }
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        raise ValueError(f"{name} is not a whole checkpoint of robonav") from None
    if (about["format"], about["version"]) != (FORMAT, __version__):
        raise ValueError(
            f"{name} was written by robonav {about['version']} ({about['format']}), expected {__version__} ({FORMAT})"
        )
    if about["training"] != _digest(identity):
        raise ValueError(
            f"{name} belongs to a training with other seeds, settings or task"
        )
    for key in _STATISTICS:
        getattr(statistics, key)[:] = arrays.pop(key)
    agent.restore(arrays)
    return int(about["done"])


def _digest(identity: dict[str, Any]) -> str:
    """A name for a training; functions, such as a reward, go by what they say and what they hold on to."""
    named = {key: _plain(value) for key, value in identity.items()}
    return hashlib.sha256(repr(sorted(named.items())).encode()).hexdigest()


def _plain(value: Any) -> Any:
    fields = getattr(value, "__dataclass_fields__", None)
    if fields is not None:
        return type(value).__qualname__, {
            name: _plain(getattr(value, name)) for name in fields
        }
    if isinstance(value, dict):
        return sorted((key, _plain(part)) for key, part in value.items())
    if isinstance(value, list | tuple):
        return [_plain(part) for part in value]
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, CodeType):
        return value.co_code, _plain(value.co_consts), value.co_names
    if isinstance(value, FunctionType):
        held = [cell.cell_contents for cell in value.__closure__ or ()]
        return value.__qualname__, _plain(value.__code__), _plain(held)
    return value
