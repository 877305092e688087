"""Read a submission: the bytes of its Python files and notebooks. Only the worker looks into them.

A submission is a folder, an archive, a notebook or a Python file. Archives in it are unpacked too. What nobody wrote as
an answer, such as a virtual environment, is passed over. The reader notes what it took in an unusual form, and lists
what it could not take with the reason.
"""

from __future__ import annotations

import bz2
import functools
import gzip
import hashlib
import io
import lzma
import os
import posixpath
import re
import stat
import tarfile
import zipfile
from collections import deque
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import BinaryIO, NamedTuple, cast

MOST_FILES, MOST_BYTES = 200, 8 << 20  # of Python files and notebooks
MOST_READ = 64 << 20  # bytes of all files that are read or unpacked
MOST_PACKED = 256 << 20  # bytes of an archive
MOST_ENTRIES, DEEPEST, MOST_REMARKS = 100_000, 40, 20
LONGEST_NAME, LONGEST_PART = 200, 80

# Windows adds .txt, and a browser .json or .txt, to a name whose ending it does not know.
CODE = re.compile(
    r"(?P<stem>.+?)\.(?P<kind>py|ipynb)(\.(txt|json|py))?", re.IGNORECASE | re.DOTALL
)
ARCHIVE = re.compile(
    r"(?P<stem>.+?)\.(zip|tar|tgz|tbz2?|txz|tar\.(gz|bz2|xz))",
    re.IGNORECASE | re.DOTALL,
)
UNREADABLE = re.compile(
    r"(?P<stem>.+?)\.(7z|rar|zst|gz|bz2|xz|z|lzh|ace)", re.IGNORECASE | re.DOTALL
)
PASSED_OVER = {"venv", "site-packages", "dist-packages", "node_modules"}
# In a large notebook, the outputs that take most room. A quote in the code of a cell has a backslash before it, so
# this never finds a part of the code.
OUTPUT = re.compile(
    rb'("(?:image/[a-z+]+|text/html|text/plain|application/[\w.+-]+)"\s*:\s*)'
    rb'(?:"(?:[^"\\]|\\.)*+"|\[(?:\s*"(?:[^"\\]|\\.)*+"\s*,?)*+\s*\])',
    re.DOTALL,
)


class Refused(ValueError):
    """Raised when nothing of a submission can be graded. The message tells the reason."""


@dataclass(frozen=True)
class Submission:
    """The contents of a submission's files.

    Attributes
    ----------
    files : dict of str to bytes
        The content of each file by name, such as ``ch2/backup.py``.
    notes : tuple of str
        What was taken in an unusual form.
    problems : tuple of str
        What was not taken, and why.
    """

    files: dict[str, bytes]
    notes: tuple[str, ...] = ()
    problems: tuple[str, ...] = ()

    @property
    def digest(self) -> str:
        """A hash of all names and contents, and of what was not taken."""
        digest = hashlib.sha256()
        for name, content in sorted(self.files.items()):
            digest.update(f"{len(name)} {name} {len(content)} ".encode() + content)
        digest.update(repr(self.problems).encode() if self.problems else b"")
        return digest.hexdigest()


def read(path: str | Path) -> Submission:
    """Read the submission at ``path``.

    Raises
    ------
    ValueError
        If the path is not a folder, an archive, a notebook or a Python file.
    Refused
        If it contains files, but none that can be graded.
    """
    path = Path(path)
    if not (path.is_symlink() or path.is_dir() or (os.path.lexists(path) and is_handed_in(path.name))):  # fmt: skip
        raise ValueError(
            f"a submission must be a folder, a zip, a notebook or a Python file, got {path}"
        )
    return gather({path.name: path})


def gather(parts: Mapping[str, Path], notes: Collection[str] = ()) -> Submission:
    """Read a submission of several files and folders, each under a name of its own."""
    reader = _Reader(notes)
    for name, path in parts.items():
        reader.read(name, path, alone=len(parts) == 1)
    if not reader.files and reader.others:
        reader.problem(
            f"no Python file or notebook is in it, only {', '.join(reader.others[:5])}"
        )
    if not reader.files and reader.problems:
        raise Refused("; ".join(reader.problems))
    return Submission(reader.files, tuple(reader.notes), tuple(reader.problems))


def load_submission(path: str | Path) -> Submission | Refused:
    """Return the submission at ``path``, or the reason why it is refused."""
    try:
        return read(path)
    except Refused as refused:
        return refused


def is_handed_in(name: str) -> bool:
    """Whether a file of this name is somebody's submission, even if it cannot be read."""
    return any(kind.fullmatch(name) for kind in (CODE, ARCHIVE, UNREADABLE))


def stem(name: str) -> str:
    """Return a file's name without the ending that tells its kind."""
    for kind in (CODE, ARCHIVE, UNREADABLE):
        if match := kind.fullmatch(name):
            return match["stem"]
    return name


class _NotTaken(Exception):
    """Raised with the reason why a file cannot be taken."""


class _Entry(NamedTuple):
    """A file in an archive. ``target`` is the name that a link points to."""

    name: str
    target: str | None
    open: Callable[[], BinaryIO]


class _Reader:
    """Collects the files of a submission."""

    def __init__(self, notes: Collection[str]) -> None:
        self.files: dict[str, bytes] = {}
        self.notes: list[str] = [*notes]
        self.problems: list[str] = []
        self.others: list[str] = []  # files that are not code
        self._bytes = self._read = self._entries = 0

    def read(self, name: str, path: Path, *, alone: bool) -> None:
        """Read a file, an archive or a folder. If it is the whole submission, names inside it count from it."""
        if path.is_symlink():
            self.problem(f"{path.name} is a link")
        elif path.is_dir():
            self._folder(path, "" if alone else f"{name}/")
        else:
            self._offer(name, functools.partial(_opened, path), 0, alone=alone)

    def note(self, remark: str) -> None:
        """Add a note, up to a number of notes."""
        _add(self.notes, remark)

    def problem(self, remark: str) -> None:
        """Add a problem, up to a number of problems."""
        _add(self.problems, remark)

    def _folder(self, root: Path, prefix: str) -> None:
        """Read the files of a folder, those of the outer folders first."""
        waiting, inside = deque([(root, 0)]), root.resolve()
        while waiting:
            folder, depth = waiting.popleft()
            try:
                entries = sorted(os.scandir(folder), key=lambda entry: entry.name)
            except OSError as error:
                self.problem(
                    f"the folder {folder.name!r} cannot be read: {error.strerror}"
                )
                continue
            if _is_installed(folder.name, {entry.name for entry in entries}):
                self._pass_over(folder.name)
                continue
            for entry in entries:
                path = folder / entry.name
                if entry.is_dir(follow_symlinks=False) and not self._skips(entry.name):
                    if depth < DEEPEST:
                        waiting.append((path, depth + 1))
                    else:
                        self.problem(f"folders more than {DEEPEST} deep were not read")
                elif not entry.is_dir():
                    name = prefix + path.relative_to(root).as_posix()
                    target = path.resolve() if entry.is_symlink() else path
                    if target.is_relative_to(inside) or not entry.is_symlink():
                        self._offer(name, functools.partial(_opened, target), 0)
                    else:
                        self.problem(f"{name} is a link that leaves the submission")

    def _archive(self, name: str, file: BinaryIO, prefix: str, depth: int) -> None:
        """Read the files of an archive, those of the outer folders first."""
        if depth >= 3:
            raise _NotTaken("it lies in too many archives")
        entries = (
            _zip_entries(file)
            if name.casefold().endswith("zip")
            else _tar_entries(file)
        )
        names = {entry.name: entry for entry in entries}
        installed = {
            posixpath.dirname(entry)
            for entry in names
            if _is_installed(
                posixpath.basename(posixpath.dirname(entry)),
                {posixpath.basename(entry)},
            )
        }
        for folder in sorted(installed):
            self._pass_over(posixpath.basename(folder))
        for entry in sorted(entries, key=lambda entry: entry.name.count("/")):
            folders = [str(folder) for folder in PurePosixPath(entry.name).parents]
            if installed.intersection(folders) or any(map(self._skips, folders)):
                continue
            opened = entry
            if entry.target is not None:
                where = posixpath.join(posixpath.dirname(entry.name), entry.target)
                if (where := posixpath.normpath(where)) not in names:
                    self.problem(f"{entry.name} is a link that leaves the submission")
                    continue
                opened = names[where]
            # An absolute name stays absolute, and is refused.
            self._offer(posixpath.join(prefix, entry.name), opened.open, depth + 1)

    def _offer(
        self, name: str, opener: Callable[[], BinaryIO], depth: int, alone: bool = False
    ) -> None:
        """Take a file if it is code, unpack it if it is an archive, and otherwise remember its name."""
        self._entries += 1
        base = posixpath.basename(name.replace("\\", "/"))
        if base.startswith(".") or self._entries > MOST_ENTRIES:
            if self._entries == MOST_ENTRIES + 1:
                self.problem(f"only the first {MOST_ENTRIES} files were looked at")
            return
        try:
            if CODE.fullmatch(base):
                self._take(name, opener)
            elif match := ARCHIVE.fullmatch(base):
                place = name[: len(name) - len(base)] + match["stem"] + "/"
                with opener() as file:
                    packed = file if depth == 0 else self._in_memory(file)
                    self._archive(base, packed, "" if alone else place, depth)
                if not alone:
                    self.note(f"{_shown(name)} was unpacked")
            elif UNREADABLE.fullmatch(base):
                raise _NotTaken(
                    "the grader cannot read this kind of archive; hand in a zip"
                )
            else:
                self.others.append(_shown(base))
        except _NotTaken as reason:
            self.problem(f"{_shown(name)} was not taken: {reason}")
        except Exception as error:  # each kind of archive has errors of its own
            what = error.strerror if isinstance(error, OSError) else error
            self.problem(f"{_shown(name)} cannot be read: {_shown(str(what or error))}")

    def _take(self, name: str, opener: Callable[[], BinaryIO]) -> None:
        """Add a Python file or notebook to the files."""
        safe = _safe(name)
        match = CODE.fullmatch(safe)
        assert match is not None
        safe = f"{match['stem']}.{match['kind'].lower()}"
        if len(self.files) >= MOST_FILES and safe not in self.files:
            self.problem(f"more than {MOST_FILES} Python files and notebooks")
            return
        most = MOST_READ if safe.endswith("ipynb") else MOST_BYTES
        with opener() as file:
            content = self._limited(file, most)
        if safe.endswith("ipynb") and len(content) > 1 << 20:
            content = OUTPUT.sub(rb'\1""', content)
        if content.startswith((b"\xff\xfe", b"\xfe\xff")):
            content = content.decode("utf-16").encode()
            self.note(f"{safe} was taken from UTF-16")
        if self._bytes + len(content) > MOST_BYTES:
            raise _NotTaken(f"more than {MOST_BYTES >> 20} MB of files")
        self._bytes += len(content)
        # The last file of a name counts, as when a zip is unpacked.
        self.files[safe] = content
        if safe != name.replace("\\", "/"):
            self.note(f"{_shown(name)} was taken as {safe}")

    def _limited(self, file: BinaryIO, most: int) -> bytes:
        """Return the content of a file that is not too large."""
        content = file.read(min(most, MOST_READ - self._read) + 1)
        self._read += len(content)
        if len(content) > most or self._read > MOST_READ:
            raise _NotTaken(f"more than {most >> 20} MB of files")
        return content

    def _in_memory(self, file: BinaryIO) -> BinaryIO:
        return io.BytesIO(self._limited(file, MOST_READ))

    def _skips(self, folder: str) -> bool:
        """Whether a folder holds nobody's answer, by its name."""
        name = posixpath.basename(folder)
        if name in PASSED_OVER:
            self._pass_over(name)
        hidden = name.startswith(".") and name not in (".", "..")
        return hidden or name in {
            "__pycache__",
            "__MACOSX",
            *PASSED_OVER,
        }

    def _pass_over(self, folder: str) -> None:
        self.note(f"the folder {_shown(folder)} was passed over")


def _is_installed(folder: str, names: set[str]) -> bool:
    """Whether a folder is a virtual environment or a copy of this package."""
    return "pyvenv.cfg" in names or (folder == "robonav" and "__init__.py" in names)


def _opened(path: Path) -> BinaryIO:
    """Open a regular file. A pipe or a device is not waited for."""
    flags = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
    descriptor = os.open(path, os.O_RDONLY | flags | getattr(os, "O_BINARY", 0))
    file = cast(BinaryIO, _Packed(io.FileIO(descriptor)))
    state = os.fstat(descriptor)
    if not stat.S_ISREG(state.st_mode) or state.st_size > MOST_PACKED:
        file.close()
        raise _NotTaken(f"it is not a regular file of at most {MOST_PACKED >> 20} MB")
    return file


class _Packed(io.BufferedReader):
    """A file of which no more than MOST_READ bytes are read at once, as a zip with an endless table would ask for."""

    def read(self, size: int | None = -1, /) -> bytes:
        """Read at most ``size`` bytes."""
        if size is not None and size > MOST_READ + 1:
            raise ValueError("its table of contents is too large")
        return super().read(size)


def _zip_entries(file: BinaryIO) -> list[_Entry]:
    archive = zipfile.ZipFile(file)
    found = []
    for entry in archive.infolist()[: MOST_ENTRIES + 1]:
        if not (entry.is_dir() or entry.filename.endswith("\\")):
            opener = cast(
                Callable[[], BinaryIO], functools.partial(archive.open, entry)
            )
            link = stat.S_ISLNK(entry.external_attr >> 16)
            target = opener().read(LONGEST_NAME).decode(errors="replace") if link else None  # fmt: skip
            found.append(_Entry(entry.filename.replace("\\", "/"), target, opener))
    return found


def _tar_entries(file: BinaryIO) -> list[_Entry]:
    start = file.read(6)
    file.seek(0)
    unpacked: BinaryIO = io.BytesIO()
    for magic, module in ((b"\x1f\x8b", gzip), (b"BZh", bz2), (b"\xfd7zXZ", lzma)):
        if start.startswith(magic):
            with module.open(file) as packed:
                unpacked.write(packed.read(MOST_READ + 1))
            break
    else:
        unpacked.write(file.read(MOST_READ + 1))
    if unpacked.tell() > MOST_READ:
        raise _NotTaken(f"more than {MOST_READ >> 20} MB of files")
    unpacked.seek(0)
    archive = tarfile.TarFile(fileobj=unpacked)
    found = []
    for entry in archive.getmembers()[: MOST_ENTRIES + 1]:
        opener = cast(
            Callable[[], BinaryIO], functools.partial(archive.extractfile, entry)
        )
        if entry.isfile():
            found.append(_Entry(entry.name, None, opener))
        elif entry.issym():
            found.append(_Entry(entry.name, entry.linkname, opener))
        elif entry.islnk():
            same = posixpath.relpath(
                entry.linkname, posixpath.dirname(entry.name) or "."
            )
            found.append(_Entry(entry.name, same, opener))
    return found


def _safe(name: str) -> str:
    """Return the name of a file so that every system can write it."""
    path = PurePosixPath(name.replace("\\", "/"))
    if path.is_absolute() or ".." in path.parts or re.match("[A-Za-z]:", name):
        raise _NotTaken("its name leaves the submission")
    parts = [_shown(part).replace(":", "_")[-LONGEST_PART:] for part in path.parts]
    while len("/".join(parts)) > LONGEST_NAME:
        del parts[0]
    return "/".join(parts)


def _shown(name: str) -> str:
    """Return a student's words in characters that every report can hold."""
    return _printable(name)[-LONGEST_NAME:]


def _printable(text: str) -> str:
    return "".join(c if c.isprintable() else "_" for c in text)


def _add(remarks: list[str], remark: str) -> None:
    remark = _printable(remark)
    if remark not in remarks and len(remarks) <= MOST_REMARKS:
        remarks.append(remark if len(remarks) < MOST_REMARKS else "and more")
