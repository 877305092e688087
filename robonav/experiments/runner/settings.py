"""Settings in TOML: the conditions of a chapter's experiments, and the hyperparameters of its methods as values."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robonav import atomic


@dataclass(frozen=True)
class Settings(Mapping[str, Any]):
    """An immutable mapping that can be a key, so that a training is kept under its hyperparameters.

    Parameters
    ----------
    items_ : tuple of pairs
        Pairs of name and value, sorted by name.

    Examples
    --------
    >>> settings = Settings.of({"discount": 0.7, "temperature": [0.9, 0.1]})
    >>> settings["temperature"], {settings: "kept"}[settings]
    ((0.9, 0.1), 'kept')
    """

    items_: tuple[tuple[str, Any], ...]

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> Settings:
        """Make settings from a mapping, such as one read from TOML or JSON. Lists become tuples."""
        return cls(tuple(sorted((name, _frozen(v)) for name, v in values.items())))

    def __getitem__(self, name: str) -> Any:
        return dict(self.items_)[name]

    def __iter__(self) -> Iterator[str]:
        return iter(dict(self.items_))

    def __len__(self) -> int:
        return len(self.items_)

    def __or__(self, changes: Mapping[str, Any]) -> Settings:
        return Settings.of(dict(self.items_) | dict(changes))

    def as_json(self) -> str:
        """Return the settings as one line of text."""
        return json.dumps(dict(self.items_), sort_keys=True)


def read_settings(path: Path) -> dict[str, Any]:
    """Read the tables of a TOML file."""
    with path.open("rb") as file:
        return tomllib.load(file)


def write_hyperparameters(
    path: Path, comment: str, methods: Mapping[str, Mapping[str, Mapping[str, Any]]]
) -> None:
    """Write hyperparameters as TOML: a table for each method and each name below it, such as ``[nirl."0.65"]``."""
    lines = [f"# {comment}"]
    for method, entries in methods.items():
        for name, values in entries.items():
            lines += ["", f"[{method}.{json.dumps(name)}]" if name else f"[{method}]"]
            lines += [f"{key} = {json.dumps(value)}" for key, value in sorted(values.items())]  # fmt: skip
    atomic.write_text(path, "\n".join(lines) + "\n")


def _frozen(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else value
