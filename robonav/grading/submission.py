"""Read a submission: the bytes of its Python files and notebooks. Only the worker looks into them.

A submission is a folder, a zip file, a notebook or a Python file. Links and paths that leave the submission are
refused. Files other than ``.py`` and ``.ipynb`` are ignored.
"""

from __future__ import annotations

import hashlib
import os
import stat
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import NoReturn

KINDS = (".py", ".ipynb")
MOST_FILES, MOST_BYTES, MOST_ZIPPED = 200, 8 << 20, 32 << 20
# and every hidden folder
PASSED_OVER = {
    "__pycache__",
    "__MACOSX",
    "venv",
    "site-packages",
    "node_modules",
}


class Refused(ValueError):
    """Raised when the whole submission cannot be graded. The message tells the reason."""


@dataclass(frozen=True)
class Submission:
    """The contents of a submission's files by name, such as ``ch2/backup.py``."""

    files: dict[str, bytes]

    @property
    def digest(self) -> str:
        """A hash of all names and contents."""
        digest = hashlib.sha256()
        for name, content in sorted(self.files.items()):
            digest.update(f"{len(name)} {name} {len(content)} ".encode() + content)
        return digest.hexdigest()


def read(path: str | Path) -> Submission:
    """Read the submission at ``path``.

    Raises
    ------
    ValueError
        If the path is not a folder, a zip file, a notebook or a Python file.
    Refused
        If it contains a link, a path that leaves it, or too many files or bytes.
    """
    path = Path(path)
    if path.is_symlink():
        raise Refused(f"{path.name} is a link")
    if path.is_dir():
        packed = _only_zip(path)
        entries = _from_zip(packed) if packed else _from_folder(path)
    elif path.is_file() and is_zip(path):
        entries = _from_zip(path)
    elif path.is_file() and path.suffix in KINDS:
        entries = iter([(path.name, _content(path))])
    else:
        raise ValueError(
            f"a submission must be a folder, a zip, a notebook or a Python file, got {path}"
        )
    files: dict[str, bytes] = {}
    size = 0
    for number, (name, content) in enumerate(entries, start=1):
        files[name] = (
            content  # the last file of a name counts, as when a zip is unpacked
        )
        size += len(content)
        if number > MOST_FILES or size > MOST_BYTES:
            raise Refused(
                f"more than {MOST_FILES} files or {MOST_BYTES >> 20} MB of Python files and notebooks"
            )
    return Submission(files)


def is_zip(path: Path) -> bool:
    """Whether the name ends in .zip."""
    return path.suffix.lower() == ".zip"


def load_submission(path: str | Path) -> Submission | Refused:
    """Return the submission at ``path``, or the reason why it is refused."""
    try:
        return read(path)
    except Refused as refused:
        return refused


def _only_zip(folder: Path) -> Path | None:
    """Return the zip file if a folder contains nothing else, as folders exported by learning platforms do."""
    try:
        entries = [
            entry for entry in folder.iterdir() if not entry.name.startswith(".")
        ]
    except OSError as error:
        _unreadable(error)
    return (
        entries[0]
        if len(entries) == 1 and is_zip(entries[0]) and entries[0].is_file()
        else None
    )


def _unreadable(error: OSError) -> NoReturn:
    raise Refused(
        f"the folder {Path(error.filename).name!r} cannot be read: {error.strerror}"
    ) from None


def _from_folder(folder: Path) -> Iterator[tuple[str, bytes]]:
    for place, folders, names in os.walk(folder, onerror=_unreadable):
        folders[:] = sorted(
            name for name in folders if _is_considered(PurePosixPath(name))
        )
        for name in sorted(names):
            path = Path(place, name)
            if path.suffix in KINDS and _is_considered(PurePosixPath(name)):
                yield _checked(path.relative_to(folder).as_posix()), _content(path)


def _from_zip(path: Path) -> Iterator[tuple[str, bytes]]:
    if path.is_symlink() or path.stat().st_size > MOST_ZIPPED:
        raise Refused(f"{path.name} is a link, or larger than {MOST_ZIPPED >> 20} MB")
    try:
        with zipfile.ZipFile(path) as archive:
            for entry in archive.infolist():
                inside = PurePosixPath(entry.filename)
                if (
                    entry.is_dir()
                    or inside.suffix not in KINDS
                    or not _is_considered(inside)
                ):
                    continue
                if stat.S_ISLNK(entry.external_attr >> 16):
                    raise Refused(f"{_checked(entry.filename)} is a link")
                with archive.open(entry) as file:
                    yield _checked(entry.filename), file.read(MOST_BYTES + 1)
    except Refused:
        raise
    except Exception as error:  # each method of compression has errors of its own
        raise Refused(f"the zip cannot be read: {error}") from None


def _content(path: Path) -> bytes:
    """Return the bytes of a regular file. A link, a pipe or a device is refused before it is opened."""
    try:
        descriptor = os.open(
            path,
            os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0),
        )
    except OSError as error:
        raise Refused(
            f"{path.name} is a link or cannot be read: {error.strerror}"
        ) from None
    with os.fdopen(descriptor, "rb") as file:
        if path.is_symlink() or not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise Refused(f"{path.name} is not a regular file")
        return file.read(MOST_BYTES + 1)


def _is_considered(path: PurePosixPath) -> bool:
    return not any(
        part in PASSED_OVER or (part.startswith(".") and part != "..")
        for part in path.parts
    )


def _checked(name: str) -> str:
    """Return the name if it stays inside the submission and every system can write it."""
    path = PurePosixPath(name)
    inside = (
        not path.is_absolute()
        and ".." not in path.parts
        and "\\" not in name
        and ":" not in name
    )
    if not (inside and name.isprintable() and len(name) <= 200):
        raise Refused(f"{name!r} is not the name of a file within the submission")
    return path.as_posix()
