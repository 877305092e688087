"""Write files completely or not at all."""

from __future__ import annotations

import os
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

PARTIAL = ".partial-"
LONGEST_PREFIX = 40  # characters, so that the temporary name is not too long either


def remove_partial_files(folder: str | Path) -> None:
    """Remove temporary files that killed writers left below ``folder``. No writer may be active."""
    for path in Path(folder).rglob(f".*{PARTIAL}*"):
        path.unlink(missing_ok=True)


@contextmanager
def atomic_write(path: str | Path) -> Iterator[BinaryIO]:
    """Open ``path`` for binary writing. The file appears, complete, when the block ends without an error.

    The bytes go to a temporary file in the same folder, which is renamed at the end. A reader therefore never sees half
    a file, even if the writer is killed. A link stays a link, and a file that exists keeps its permissions. A path that
    is not a regular file, such as a device or a pipe, is written to directly.
    """
    target = Path(path).resolve()  # a link's target, so that the link stays
    if target.exists() and not target.is_file():
        with target.open("wb") as file:
            yield file
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    descriptor, temporary = tempfile.mkstemp(
        dir=target.parent, prefix=f".{target.name[:LONGEST_PREFIX]}{PARTIAL}"
    )
    try:
        with os.fdopen(descriptor, "wb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        os.chmod(temporary, _permissions(target))
        os.replace(temporary, target)
    except BaseException:
        with suppress(FileNotFoundError):
            os.unlink(temporary)
        raise


def write_text(path: str | Path, text: str) -> None:
    """Write a text file in UTF-8, whole or not at all, with the line ends that the text has.

    Examples
    --------
    >>> folder = Path(tempfile.mkdtemp())
    >>> write_text(folder / "note.txt", "Größe\\n")
    >>> (folder / "note.txt").read_bytes()
    b'Gr\\xc3\\xb6\\xc3\\x9fe\\n'
    """
    with atomic_write(path) as file:
        file.write(text.encode())


def _permissions(target: Path) -> int:
    """Return the permissions of a file that exists, or those that a new file gets."""
    if target.exists():
        return stat.S_IMODE(target.stat().st_mode)
    umask = os.umask(0)
    os.umask(umask)
    return 0o666 & ~umask
