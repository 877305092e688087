"""Delete a folder that a student's code has filled: as deep and as full as it may be, without recursion.

This file uses the standard library only, because it also runs in the sandbox.
"""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any


def remove(folder: Path) -> None:
    """Delete a folder with everything in it, as far as possible."""
    empty(folder)
    _done(os.rmdir, folder)


def empty(folder: Path) -> None:
    """Delete everything in a folder, as far as possible.

    Each round deletes the files and empty folders of the two uppermost levels, and moves what is deeper up to the first
    level. No path gets longer than the system allows, and no call nests.
    """
    names = (folder / f"{os.urandom(8).hex()}{n}" for n in itertools.count())
    progress = True
    while progress:
        progress = False
        for entry in _entries(folder):
            progress |= _removed(entry, names)


def _removed(entry: os.DirEntry[str], names: Iterator[Path]) -> bool:
    """Delete a file or an empty folder, or empty a folder by one level. Return whether anything changed."""
    if not entry.is_dir(follow_symlinks=False):
        return _done(os.unlink, entry.path)
    if _done(os.rmdir, entry.path):  # most are empty, and there may be many
        return True
    _done(os.chmod, entry.path, 0o700)
    changed = False
    for inner in _entries(entry.path):
        if inner.is_dir(follow_symlinks=False):
            _done(os.chmod, inner.path, 0o700)
            changed |= _done(os.rename, inner.path, next(names))
        else:
            changed |= _done(os.unlink, inner.path)
    return _done(os.rmdir, entry.path) or changed


def _entries(folder: str | Path) -> Iterator[os.DirEntry[str]]:
    try:
        with os.scandir(folder) as entries:
            yield from entries
    except OSError:
        return


def _done(do: Callable[..., Any], *arguments: Any) -> bool:
    """Call ``do`` and return whether it succeeded."""
    try:
        do(*arguments)
    except OSError:
        return False
    return True
