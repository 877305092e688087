"""Arrays in npz files that name their format. Every fault of a file gives an error with one sentence."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import atomic


class Damaged(ValueError):
    """Raised for a file that is not a complete npz archive."""


class Pickled(ValueError):
    """Raised for an archive with a Python object, which could run code and is never loaded."""


def write_archive(
    path: str | Path, arrays: Mapping[str, Any], *, compressed: bool = True
) -> None:
    """Write arrays by name as an npz file, completely or not at all."""
    save = np.savez_compressed if compressed else np.savez
    with atomic.atomic_write(path) as file:
        save(file, **arrays)


def read_archive(path: str | Path) -> dict[str, NDArray[Any]]:
    """Read every array of an npz file by its name.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    Damaged
        If the file is not a complete npz archive.
    Pickled
        If the archive contains a Python object.
    """
    with open(path, "rb") as file:
        try:
            with np.load(file, allow_pickle=False) as archive:
                return {name: archive[name] for name in archive.files}
        except Exception as error:  # a damaged archive can raise almost any of these
            # numpy's message for an object in an archive
            if "Object arrays" in str(error):
                raise Pickled(str(error)) from None
            raise Damaged(str(error)) from None
