"""The log of a gradebook: what was graded and what was changed by hand. Lines are added and none is ever changed.

Each line of ``log.jsonl`` is one event in JSON. It holds a hash of the line before it, so that a line that was changed,
taken out or put in later shows. A program that is killed while it writes leaves at most a torn line, which is passed
over; what it was to record has then not been confirmed to anybody.
"""

from __future__ import annotations

import hashlib
import json
import os
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from filelock import FileLock

LOG = "log.jsonl"


@dataclass(frozen=True, eq=False)
class Log:
    """The events of a log, in order.

    Attributes
    ----------
    events : list of dict
        What was recorded, each with its ``kind`` and ``time``.
    torn : list of int
        Numbers of the lines that a killed program left unfinished.
    broken : list of int
        Numbers of the lines that do not follow the line before them: the file was changed by something else.
    last : str
        Hash of the last line.
    """

    events: list[dict[str, Any]]
    torn: list[int]
    broken: list[int]
    last: str

    def of_kind(self, kind: str) -> list[dict[str, Any]]:
        """Return the events of one kind, in order."""
        return [event for event in self.events if event["kind"] == kind]


def now() -> str:
    """Return the time in UTC, to the second, as the log writes it.

    Examples
    --------
    >>> len(now()), now()[-6:]
    (25, '+00:00')
    """
    return datetime.now(UTC).isoformat(timespec="seconds")


def append(folder: Path, kind: str, event: dict[str, Any]) -> dict[str, Any]:
    """Add an event to the log in a folder. It is on the disk when this function returns.

    Parameters
    ----------
    folder : Path
        The folder of the grades.
    kind : str
        What kind of event it is.
    event : dict
        What happened, as JSON can hold it.

    Returns
    -------
    dict
        The event with its kind and time.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> _ = append(folder, "mark", {"student": "ada", "points": 3})
    >>> [event["points"] for event in read(folder).events]
    [3]
    """
    path = folder / LOG
    with FileLock(folder / f".{LOG}.lock"):
        last, complete = _end(path)
        whole = {"kind": kind, "time": now(), **event, "after": last}
        line = json.dumps(whole, ensure_ascii=True).encode() + b"\n"
        if not complete:
            line = b"\n" + line  # after a torn line
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o666)
        try:
            while line:
                line = line[os.write(descriptor, line) :]
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
    return whole


def read(folder: Path) -> Log:
    """Return the log in a folder, which is empty if nothing was recorded yet.

    Examples
    --------
    >>> import tempfile
    >>> read(Path(tempfile.mkdtemp())).events
    []
    """
    try:
        content = (folder / LOG).read_bytes()
    except FileNotFoundError:
        return Log([], [], [], "")
    events, torn, broken, last = list[dict[str, Any]](), list[int](), list[int](), ""
    for number, line in enumerate(content.split(b"\n"), start=1):
        if not line:
            continue
        if (event := _event(line)) is None:
            torn.append(number)
            continue
        if event.get("after") != last:
            broken.append(number)
        events.append(event)
        last = _hash(line)
    return Log(events, torn, broken, last)


def _end(path: Path) -> tuple[str, bool]:
    """Return the hash of the last line that is whole, and whether no torn line follows it."""
    if not path.exists():
        return "", True
    with path.open("rb") as file:
        size = file.seek(0, os.SEEK_END)
        length = 1 << 16
        while True:
            file.seek(-min(length, size), os.SEEK_END)
            content = file.read()
            lines = content.split(b"\n")
            for line in reversed(lines if length >= size else lines[1:]):
                if _event(line) is not None:
                    return _hash(line), content.endswith(b"\n")
            if length >= size:
                return "", content.endswith(b"\n") or not content
            length *= 4


def _event(line: bytes) -> dict[str, Any] | None:
    """Return the event in a line, or None if it is torn."""
    try:
        event = json.loads(line)
        return event if event["kind"] and event["time"] else None
    except (ValueError, KeyError, TypeError, RecursionError):
        return None


def _hash(line: bytes) -> str:
    return hashlib.sha256(line).hexdigest()[:32]
